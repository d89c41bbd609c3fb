//! Checks and packs entities in which nothing is wrong; whatever else there is,
//! [`AttributeChecker`](super::attributes::AttributeChecker) explains.

use super::guesses::Tables;
use super::names::Names;
use super::parsed::{Form, Parsed, Word};
use super::values::{self, ValueError};
use crate::registry::Registry;
use std::mem::replace;
use std::ops::Range;
use tabray_core::scene::entity::Entity;
use tabray_core::scene::kind::Kind;
use tabray_core::scene::store::{Packer, Store};
use tabray_core::scene::value::{Datum, Type};

/// Entities that were checked and packed, and the memory in which that is done.
pub struct Quick<'r> {
    registry: &'r Registry,
    tables: Tables,
    bytes: Vec<u8>,
    /// The type of each entity, the hash of its name and its range of the bytes, or `None` where something is out of the
    /// ordinary.
    entities: Vec<Option<(&'static Entity, u32, Range<usize>)>>,
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
            bytes: Vec::new(),
            entities: Vec::new(),
            numbers: Datum::Numbers(Vec::new()),
            whole: Datum::Whole(Vec::new()),
            given: Vec::new(),
        }
    }

    /// Tells whether nothing can refer to an entity, so that entities after it can be checked before it.
    pub fn waits(&mut self, parsed: &Parsed<'_>) -> bool {
        let table = self.tables.named(self.registry, &parsed.kind.text);
        table.is_none_or(|table| matches!(self.tables[table].entity.kind(), Kind::Object | Kind::Light))
    }

    /// Returns the type, the hash of the name and the bytes of each of the entities that were checked, or `None` where
    /// something is out of the ordinary.
    pub fn packed(&self) -> impl Iterator<Item = Option<(&'static Entity, u32, &[u8])>> {
        let packed = self.entities.iter().map(Option::as_ref);
        packed.map(|of| of.map(|(entity, hash, range)| (*entity, *hash, &self.bytes[range.clone()])))
    }

    /// Checks objects and lights in place of others. What they refer to must be defined.
    pub fn check(&mut self, names: &Names, store: &Store, parsed: &[&Parsed<'_>]) {
        self.bytes.clear();
        self.entities.clear();
        for parsed in parsed {
            let start = self.bytes.len();
            let packed = self.pack(names, store, parsed);
            if packed.is_none() {
                self.bytes.truncate(start);
            }
            let hash = |entity: &Entity| names.hash(entity.kind(), &parsed.name.text);
            self.entities.push(packed.map(|entity| (entity, hash(entity), start..self.bytes.len())));
        }
    }

    /// Packs an entity, and returns its type; `None` where something is out of the ordinary.
    fn pack(&mut self, names: &Names, store: &Store, parsed: &Parsed<'_>) -> Option<&'static Entity> {
        if parsed.is_damaged || parsed.count() == 0 {
            return None;
        }
        let table = self.tables.named(self.registry, &parsed.kind.text)?;
        let table = &self.tables[table];
        let number = store.number(table.entity)?;
        self.given.clear();
        self.given.resize(table.len(), None);
        for (index, (name, _)) in parsed.attributes().enumerate() {
            if self.given[table.find_next(&name.text, index)?].replace(index).is_some() {
                return None;
            }
        }
        for group in table.groups() {
            let is_given = |name: &&&str| table.find(name).is_some_and(|index| self.given[index].is_some());
            if group.names.iter().filter(is_given).count() != 1 {
                return None;
            }
        }
        let mut packed = Packer::begin(&mut self.bytes, number, &parsed.name.text, true);
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
                (Type::Number | Type::Rotation, words) => {
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
        Some(table.entity)
    }
}

/// Reads numbers in place of others.
fn read<T>(numbers: &mut Vec<T>, words: &[Word<'_>], read: fn(&str) -> Result<T, ValueError>) -> Option<()> {
    numbers.clear();
    for word in words {
        let is_text = matches!(word.form, Form::Text | Form::Faulty);
        let number = if is_text { None } else { read(&word.text).ok() };
        numbers.push(number?);
    }
    Some(())
}
