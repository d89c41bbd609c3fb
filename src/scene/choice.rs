//! Things of which an attribute names one, by name or by number: procedural shaders and profiles.
//!
//! Each sort of them is a registry of its own; a plugin file adds one.

use crate::words;
use crate::world::accuracy::Accuracy;
use std::panic::Location;

/// One of several things of a sort.
pub trait Choice: Copy + Send + Sync + 'static {
    /// What they are, in the singular: "profile".
    const WHAT: &'static str;
    /// All of them, in no order.
    fn all() -> Vec<Self>;
    /// How a scene names this one.
    fn option(&self) -> ChoiceName;
}

/// How a scene names one of several things.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChoiceName {
    /// Its name.
    pub name: &'static str,
    /// The number that the notes give it.
    pub number: Option<i64>,
    /// What it is, in a few words.
    pub meaning: &'static str,
    /// Where it is registered.
    pub place: &'static Location<'static>,
}

/// A sort of things to choose from.
#[derive(Clone, Copy, Debug)]
pub struct Choices {
    /// What they are, in the singular.
    pub what: &'static str,
    all: fn() -> Vec<ChoiceName>,
}

impl Choices {
    /// All things of a sort.
    pub const fn of<T: Choice>() -> Self {
        Self { what: T::WHAT, all: sorted::<T> }
    }

    /// Their names, those with numbers first, in the order of their numbers.
    pub fn all(&self) -> Vec<ChoiceName> {
        (self.all)()
    }

    /// All of them, by number and name, as messages list them.
    pub fn listed(&self) -> String {
        let shown = |choice: ChoiceName| match choice.number {
            Some(number) => format!("{number} (`{}`)", choice.name),
            None => format!("`{}`", choice.name),
        };
        self.all().into_iter().map(shown).collect::<Vec<_>>().join(", ")
    }

    /// The one of this name.
    pub fn named(&self, name: &str) -> Option<ChoiceName> {
        self.all().into_iter().find(|choice| choice.name == name)
    }

    /// The one of this number.
    pub fn numbered(&self, number: i64) -> Option<ChoiceName> {
        self.all().into_iter().find(|choice| choice.number == Some(number))
    }
}

fn sorted<T: Choice>() -> Vec<ChoiceName> {
    let mut all: Vec<_> = T::all().iter().map(T::option).collect();
    all.sort_by_key(|choice| (choice.number.unwrap_or(i64::MAX), choice.name));
    all
}

/// What is contradictory among things of a sort: a name or a number taken twice, with both places.
pub(crate) fn contradictions<T: Choice>() -> Vec<String> {
    let all = sorted::<T>();
    let mut faults = Vec::new();
    for (index, second) in all.iter().enumerate() {
        for first in &all[..index] {
            if first.name == second.name || (first.number.is_some() && first.number == second.number) {
                faults.push(format!(
                    "two plugins register the {} `{}` or its number, at {} and at {}: rename or renumber one of them",
                    T::WHAT,
                    second.name,
                    words::place(first.place),
                    words::place(second.place)
                ));
            }
        }
    }
    faults
}

impl Choice for Accuracy {
    const WHAT: &'static str = "accuracy";

    fn all() -> Vec<Self> {
        Self::ALL.to_vec()
    }

    fn option(&self) -> ChoiceName {
        const PLACE: &Location<'static> = Location::caller();
        let (name, meaning) = self.named();
        ChoiceName { name, number: None, meaning, place: PLACE }
    }
}
