//! Lists of any length as values of attributes.

use crate::body::NamedBody;
use crate::scene::counts::Counts;
use crate::scene::value::{Datum, Type, Value};
use std::sync::Arc;

/// A list of values, each of one or several numbers or the name of an object, with a minimum and a maximum number of
/// values.
#[derive(Clone, Debug, PartialEq)]
pub struct List<T, const MIN: usize, const MAX: usize>(pub Vec<T>);

impl<T: Value, const MIN: usize, const MAX: usize> Value for List<T, MIN, MAX> {
    const TYPE: Type = T::TYPE;
    const EACH: &[&str] = T::EACH;
    const ARITY: Counts = match T::ARITY {
        Counts::Of([group]) => Counts::List { group: *group, least: MIN, most: MAX },
        _ => panic!("each value of a list takes the same number of numbers"),
    };

    fn to_datum(&self) -> Datum {
        let mut all = self.0.iter().map(T::to_datum);
        let first = all.next().unwrap_or(Datum::Absent);
        all.fold(first, |all, next| match (all, next) {
            (Datum::Numbers(all), Datum::Numbers(next)) => Datum::Numbers([all, next].concat()),
            (Datum::Whole(all), Datum::Whole(next)) => Datum::Whole([all, next].concat()),
            (Datum::Object { name, body }, next) => joined(vec![(name, body)], next),
            (Datum::Objects(all), next) => joined(all, next),
            (all, _) => all,
        })
    }

    fn from_datum(datum: &Datum) -> Option<Self> {
        let Counts::List { group, .. } = Self::ARITY else { return None };
        let list: Option<Vec<T>> = match datum {
            Datum::Numbers(all) => {
                all.chunks(group).map(|one| T::from_datum(&Datum::Numbers(one.to_vec()))).collect()
            }
            Datum::Whole(all) => {
                all.chunks(group).map(|one| T::from_datum(&Datum::Whole(one.to_vec()))).collect()
            }
            Datum::Objects(all) => all
                .iter()
                .map(|(name, body)| T::from_datum(&Datum::Object { name: name.clone(), body: body.clone() }))
                .collect(),
            _ => None,
        };
        list.map(Self)
    }
}

fn joined(mut all: Vec<(Arc<str>, NamedBody)>, next: Datum) -> Datum {
    if let Datum::Object { name, body } = next {
        all.push((name, body));
    }
    Datum::Objects(all)
}
