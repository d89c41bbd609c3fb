//! Checks and packs entities in which nothing is wrong; whatever else there is, [`Against`](super::attributes::Against)
//! explains.

use super::guesses::Tables;
use super::names::Names;
use super::parsed::{Form, Parsed, Word};
use super::values::{self, Complaint};
use crate::scene::entity::Entity;
use crate::scene::kind::Kind;
use crate::scene::registry::Registry;
use crate::scene::store::{Packed, Store};
use crate::scene::value::{Datum, Type};
use std::mem::replace;
use std::ops::Range;

/// Entities that were checked and packed, and the memory in which that is done.
pub struct Quick<'r> {
    registry: &'r Registry,
    tables: Tables,
    /// The type that was looked up last.
    last: Option<&'static Entity>,
    bytes: Vec<u8>,
    /// The type of each entity and its range of the bytes, or `None` where something is out of the ordinary.
    entities: Vec<Option<(&'static Entity, Range<usize>)>>,
    /// The values of an attribute.
    numbers: Datum,
    whole: Datum,
    /// The indices of the entity's attributes, for each attribute of its table.
    given: Vec<Option<usize>>,
}

impl<'r> Quick<'r> {
    /// Checks no entities yet.
    pub fn new(registry: &'r Registry) -> Self {
        Self {
            registry,
            tables: Tables::default(),
            last: None,
            bytes: Vec::new(),
            entities: Vec::new(),
            numbers: Datum::Numbers(Vec::new()),
            whole: Datum::Whole(Vec::new()),
            given: Vec::new(),
        }
    }

    /// Tells whether nothing can refer to an entity, so that entities after it can be checked before it.
    pub fn waits(&mut self, parsed: &Parsed<'_>) -> bool {
        let entity = self.find(&parsed.kind.text);
        entity.is_none_or(|entity| matches!(entity.kind(), Kind::Object | Kind::Light))
    }

    fn find(&mut self, kind: &str) -> Option<&'static Entity> {
        self.last = self.last.filter(|last| last.name == kind).or_else(|| self.registry.find(kind));
        self.last
    }

    /// Returns the type and the bytes of each of the entities that were checked, or `None` where something is out of
    /// the ordinary.
    pub fn packed(&self) -> impl Iterator<Item = Option<(&'static Entity, &[u8])>> {
        self.entities
            .iter()
            .map(|entity| entity.as_ref().map(|(entity, range)| (*entity, &self.bytes[range.clone()])))
    }

    /// Checks objects and lights in place of others. What they refer to must be defined.
    pub fn check(&mut self, names: &Names, store: &Store, parsed: &[&Parsed<'_>]) {
        self.bytes.clear();
        self.entities.clear();
        for parsed in parsed {
            let start = self.bytes.len();
            let entity = self.find(&parsed.kind.text);
            let number = entity.and_then(|entity| Some((entity, store.number(entity)?)));
            let packed = number.and_then(|number| self.pack(names, store, number, parsed));
            if packed.is_none() {
                self.bytes.truncate(start);
            }
            self.entities.push(packed.and(entity).map(|entity| (entity, start..self.bytes.len())));
        }
    }

    /// Packs an entity; `None` where something is out of the ordinary.
    fn pack(
        &mut self,
        names: &Names,
        store: &Store,
        (entity, number): (&'static Entity, usize),
        parsed: &Parsed<'_>,
    ) -> Option<()> {
        if parsed.is_damaged || parsed.is_empty() {
            return None;
        }
        let table = self.tables.of(entity);
        let table = &self.tables[table];
        self.given.clear();
        self.given.resize(table.len(), None);
        for (index, (name, _)) in parsed.attributes().enumerate() {
            if self.given[table.find(&name.text)?].replace(index).is_some() {
                return None;
            }
        }
        for group in table.groups() {
            let is_given = |name: &&&str| table.find(name).is_some_and(|index| self.given[index].is_some());
            if group.names.iter().filter(is_given).count() != 1 {
                return None;
            }
        }
        let mut packed = Packed::begin(&mut self.bytes, number, &parsed.name.text, true);
        // Defaults at the end take no memory: most objects name no shader.
        let mut defaults = 0;
        for (known, given) in table.iter().zip(&self.given) {
            let Some(given) = given else {
                if known.is_required {
                    return None;
                }
                defaults += 1;
                continue;
            };
            (0..replace(&mut defaults, 0)).for_each(|_| packed.default());
            let words = parsed.values_of(*given);
            let is_right = |datum: &Datum| {
                known.attribute.allows(datum) && known.attribute.beyond_squares(datum).is_none()
            };
            if !known.attribute.arity().allow(words.len()) {
                return None;
            }
            match (known.value_type, words) {
                (Type::Number, words) => {
                    if let Datum::Numbers(numbers) = &mut self.numbers {
                        read(numbers, words, values::number)?;
                    }
                    is_right(&self.numbers).then_some(())?;
                    packed.numbers(&self.numbers);
                }
                (Type::Whole, words) => {
                    if let Datum::Whole(numbers) = &mut self.whole {
                        read(numbers, words, values::whole)?;
                    }
                    is_right(&self.whole).then_some(())?;
                    packed.numbers(&self.whole);
                }
                (Type::Name(kind), [word])
                    if !matches!(word.form, Form::Number | Form::Truth | Form::Faulty) =>
                {
                    let index = names.defined(kind, &word.text)?;
                    is_right(store.datum(index)).then_some(())?;
                    packed.datum(index);
                }
                _ => return None,
            }
        }
        Some(())
    }
}

/// Reads numbers in place of others.
fn read<T>(numbers: &mut Vec<T>, words: &[Word<'_>], read: fn(&str) -> Result<T, Complaint>) -> Option<()> {
    numbers.clear();
    for word in words {
        let is_text = matches!(word.form, Form::Text | Form::Faulty);
        let number = if is_text { None } else { read(&word.text).ok() };
        numbers.push(number?);
    }
    Some(())
}
