//! Finds attributes by their names, distinguishes attributes from values, and guesses the attribute that a misspelt
//! word meant.

use super::cures;
use crate::registry::Registry;
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::ops::{Deref, Index};
use std::ptr;
use tabray_core::scene::attribute::Attribute;
use tabray_core::scene::counts::OneOf;
use tabray_core::scene::entity::Entity;
use tabray_core::scene::value::Type;
use tabray_core::text::{self, nearest};

/// Finds the attribute with this name or alias.
pub fn find_attribute(entity: &'static Entity, name: &str) -> Option<&'static dyn Attribute> {
    entity.attributes().find(|attribute| attribute.name() == name || attribute.aliases().contains(&name))
}

/// The attributes of an entity type, for fast lookup.
pub struct Table {
    pub entity: &'static Entity,
    attributes: Vec<KnownAttribute>,
    groups: Vec<&'static OneOf>,
}

/// An attribute of an entity type.
pub struct KnownAttribute {
    pub attribute: &'static dyn Attribute,
    pub value_type: Type,
    /// The maximum number of values.
    pub max: usize,
    pub is_required: bool,
    name: &'static str,
}

impl Table {
    fn new(entity: &'static Entity) -> Self {
        let known = |attribute: &'static dyn Attribute| KnownAttribute {
            attribute,
            value_type: attribute.value_type(),
            max: attribute.arity().most(),
            is_required: attribute.default().is_none(),
            name: attribute.name(),
        };
        let groups = entity.groups().collect();
        Self { entity, attributes: entity.attributes().map(known).collect(), groups }
    }

    /// Returns the groups of attributes. A scene must give exactly one of each.
    pub fn groups(&self) -> &[&'static OneOf] {
        &self.groups
    }

    /// Finds the index of the attribute with this name or alias, which is likely to be `next`.
    pub fn find_next(&self, name: &str, next: usize) -> Option<usize> {
        let is_next = self.attributes.get(next).is_some_and(|known| known.name == name);
        if is_next { Some(next) } else { self.find(name) }
    }

    /// Finds the index of the attribute with this name or alias.
    pub fn find(&self, name: &str) -> Option<usize> {
        let known = self.attributes.iter().position(|known| known.name == name);
        known.or_else(|| self.attributes.iter().position(|known| known.attribute.aliases().contains(&name)))
    }

    /// Returns the index of the attribute that a misspelt word probably meant.
    pub fn near(&self, word: &str, guesses: &mut Guesses) -> Option<usize> {
        near_attribute(self.entity, word, guesses).and_then(|near| self.find(near.name()))
    }
}

/// Gives direct access to the attributes, in the order of the table.
impl Deref for Table {
    type Target = [KnownAttribute];

    fn deref(&self) -> &[KnownAttribute] {
        &self.attributes
    }
}

/// The tables of the entity types used so far.
#[derive(Default)]
pub struct Tables {
    all: Vec<Table>,
    /// The index of the last table found by a name.
    last: usize,
}

impl Tables {
    /// Returns the index of the table of the entity type with this name or alias. Most entities have the same type as
    /// the one before.
    pub fn named(&mut self, registry: &Registry, name: &str) -> Option<usize> {
        if self.all.get(self.last).is_none_or(|table| table.entity.name != name) {
            self.last = self.of(registry.find(name)?);
        }
        Some(self.last)
    }

    /// Returns the index of the table of an entity type.
    fn of(&mut self, entity: &'static Entity) -> usize {
        let known = self.all.iter().position(|table| ptr::eq(table.entity, entity));
        known.unwrap_or_else(|| {
            self.all.push(Table::new(entity));
            self.all.len() - 1
        })
    }
}

impl Index<usize> for Tables {
    type Output = Table;

    fn index(&self, table: usize) -> &Table {
        &self.all[table]
    }
}

/// The guesses so far, by entity type and misspelt word, to avoid repeated lookups.
pub type Guesses = HashMap<(&'static str, String), Option<&'static str>>;

/// The maximum number of different words of a scene with guesses. A scene with more has other errors than misspellings.
const MAX_GUESSES: usize = 10_000;

/// Returns the attribute that a misspelt word probably meant.
pub fn near_attribute(
    entity: &'static Entity,
    word: &str,
    guesses: &mut Guesses,
) -> Option<&'static dyn Attribute> {
    let is_full = guesses.len() >= MAX_GUESSES;
    let near = match guesses.entry((entity.name, text::abridged(word).into_owned())) {
        Entry::Occupied(known) => *known.get(),
        Entry::Vacant(_) if is_full => None,
        Entry::Vacant(free) => {
            let lower = word.to_lowercase();
            let other = entity.attributes().find(|attribute| attribute.known_as().contains(&lower.as_str()));
            let other = other.map(|attribute| attribute.name());
            let near = || nearest(word, entity.attributes().map(|attribute| attribute.name()));
            *free.insert(other.or_else(near))
        }
    };
    near.and_then(|name| find_attribute(entity, name))
}

/// Tells whether a word is a value rather than the next attribute. `already` is the number of values before it. In a
/// draft, the word may be on a line below them.
pub fn is_value(
    table: Option<&Table>,
    attribute: Option<&KnownAttribute>,
    (already, is_below): (usize, bool),
    word: &str,
    guesses: &mut Guesses,
) -> bool {
    let max = attribute.map_or(1, |attribute| attribute.max);
    match attribute.map(|attribute| attribute.value_type) {
        // Of several formulas, the later ones may be omitted.
        Some(Type::Formula(_)) if already > 0 && !looks_like_number(word) => {
            let is_attribute =
                table.is_some_and(|table| table.find(word).is_some() || table.near(word, guesses).is_some());
            already < max && !is_attribute
        }
        // A name may look like anything, even like a number or an attribute: `material material`. The names of a list,
        // of any length, end at the next attribute.
        Some(Type::Name(_)) if max > 1 => table.is_none_or(|table| table.find(word).is_none()),
        Some(Type::Word | Type::File | Type::Name(_) | Type::Choice(_) | Type::Formula(_) | Type::Truth) => {
            let is_attribute = || table.is_some_and(|table| table.find(word).is_some());
            already < max && !(is_below && is_attribute())
        }
        _ if looks_like_number(word) => true,
        _ => {
            let Some(table) = table else { return already < max };
            table.find(word).is_none()
                && if already < max {
                    table.near(word, guesses).is_none()
                } else {
                    cures::is_of_a_number(word)
                }
        }
    }
}

/// Tells whether a word begins like a number.
#[inline]
pub fn looks_like_number(word: &str) -> bool {
    let bytes = word.as_bytes();
    let signs = bytes.iter().take_while(|byte| matches!(byte, b'+' | b'-')).count();
    let unsigned = &bytes[signs..];
    unsigned.first().is_some_and(|byte| byte.is_ascii_digit() || *byte == b'.')
        || ["nan", "inf", "infinity"].iter().any(|number| unsigned.eq_ignore_ascii_case(number.as_bytes()))
}
