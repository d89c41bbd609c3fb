//! Checks and packs valid entities. All others are left to [`AttributeChecker`](super::attributes::AttributeChecker),
//! which explains the errors.

use super::guesses::{Table, Tables};
use super::names::Names;
use super::parsed::{Form, Parsed, Word};
use super::values::{self, ValueError};
use crate::registry::Registry;
use std::mem::replace;
use std::ops::Range;
use tabray_core::scene::attribute::Attribute;
use tabray_core::scene::counts::OneOf;
use tabray_core::scene::entity::Entity;
use tabray_core::scene::kind::Kind;
use tabray_core::scene::store::{Packer, Store};
use tabray_core::scene::value::{Datum, Type};

/// Checked and packed entities, with scratch memory.
pub struct ValidPacker<'r> {
    registry: &'r Registry,
    tables: Tables,
    bytes: Vec<u8>,
    /// The entities, with their ranges of the bytes, or `None` for an unusual entity.
    entities: Vec<Option<Packed<Range<usize>>>>,
    /// The values of an attribute.
    numbers: Datum,
    whole: Datum,
    /// For each attribute of the table, the index of the entity's attribute.
    given: Vec<Option<usize>>,
}

/// A checked and packed entity.
pub struct Packed<B> {
    /// The type.
    pub entity: &'static Entity,
    /// The hash of the name.
    pub hash: u32,
    pub bytes: B,
}

impl<'r> ValidPacker<'r> {
    /// Makes a checker without entities.
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

    /// Tells whether an entity can wait: nothing can refer to it, and it is not the first of its type. Entities after
    /// it can be checked before it.
    pub fn waits(&mut self, store: &Store, parsed: &Parsed<'_>) -> bool {
        let Some(table) = self.tables.named(self.registry, &parsed.kind.text) else { return false };
        let entity = self.tables[table].entity;
        matches!(entity.kind(), Kind::Object | Kind::Light) && store.number(entity).is_some()
    }

    /// Returns the checked entities, or `None` for unusual ones.
    pub fn packed(&self) -> impl Iterator<Item = Option<Packed<&[u8]>>> {
        self.entities.iter().map(|packed| {
            let Packed { entity, hash, bytes } = packed.as_ref()?;
            Some(Packed { entity, hash: *hash, bytes: &self.bytes[bytes.clone()] })
        })
    }

    /// Checks objects and lights, and keeps them in place of the previous ones. The entities that they refer to must be
    /// defined.
    pub fn check(&mut self, names: &Names, store: &Store, parsed: &[&Parsed<'_>]) {
        self.bytes.clear();
        self.entities.clear();
        for parsed in parsed {
            let start = self.bytes.len();
            let packed = self.pack(names, store, parsed);
            if packed.is_none() {
                self.bytes.truncate(start);
            }
            self.entities.push(packed.map(|entity| Packed {
                entity,
                hash: names.hash(entity.kind(), &parsed.name.text),
                bytes: start..self.bytes.len(),
            }));
        }
    }

    /// Packs an entity, and returns its type, or `None` for an unusual entity.
    fn pack(&mut self, names: &Names, store: &Store, parsed: &Parsed<'_>) -> Option<&'static Entity> {
        if parsed.is_damaged || parsed.count() == 0 {
            return None;
        }
        let table = self.tables.named(self.registry, &parsed.kind.text)?;
        let table = &self.tables[table];
        let number = store.number(table.entity)?;
        find(table, parsed, &mut self.given)?;
        let mut packed = Packer::begin(&mut self.bytes, number, &parsed.name.text, true);
        // Defaults at the end take no memory, because most objects name no shader.
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
            if !known.attribute.arity().allow(words.len()) {
                return None;
            }
            match (known.value_type, words) {
                (Type::Number | Type::Rotation, words) => {
                    if let Datum::Numbers(numbers) = &mut self.numbers {
                        read(numbers, words, values::number)?;
                    }
                    is_right(known.attribute, &self.numbers).then_some(())?;
                    packed.numbers(&self.numbers);
                }
                (Type::Whole, words) => {
                    if let Datum::Whole(numbers) = &mut self.whole {
                        read(numbers, words, values::whole)?;
                    }
                    is_right(known.attribute, &self.whole).then_some(())?;
                    packed.numbers(&self.whole);
                }
                (Type::Name(kind), [word])
                    if !matches!(word.form, Form::Number | Form::Truth | Form::Faulty) =>
                {
                    let index = names.defined(kind, &word.text)?;
                    is_right(known.attribute, store.datum(index)).then_some(())?;
                    packed.datum(index);
                }
                _ => return None,
            }
        }
        Some(table.entity)
    }
}

/// Finds an entity's attributes in a table, by their indices. Returns `None` if one is unknown or repeated, or if a
/// group is not given exactly once.
fn find(table: &Table, parsed: &Parsed<'_>, given: &mut Vec<Option<usize>>) -> Option<()> {
    given.clear();
    given.resize(table.len(), None);
    for (index, (name, _)) in parsed.attributes().enumerate() {
        if given[table.find_next(&name.text, index)?].replace(index).is_some() {
            return None;
        }
    }
    let is_given = |name: &&&str| table.find(name).is_some_and(|index| given[index].is_some());
    let is_one = |group: &OneOf| group.names.iter().filter(is_given).count() == 1;
    table.groups().iter().all(|group| is_one(group)).then_some(())
}

fn is_right(attribute: &dyn Attribute, datum: &Datum) -> bool {
    attribute.allows(datum) && attribute.beyond_squares(datum).is_none()
}

/// Reads numbers into a list, in place of its contents.
fn read<T>(numbers: &mut Vec<T>, words: &[Word<'_>], read: fn(&str) -> Result<T, ValueError>) -> Option<()> {
    numbers.clear();
    for word in words {
        let is_text = matches!(word.form, Form::Text | Form::Faulty);
        let number = if is_text { None } else { read(&word.text).ok() };
        numbers.push(number?);
    }
    Some(())
}
