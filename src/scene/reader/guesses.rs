//! Finds attributes by their names, and guesses which attribute a misspelt word was meant to be.

use crate::scene::entity::Entity;
use crate::scene::pparm::Attribute;
use crate::text::{self, nearest};
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// Finds the attribute of this name or alias.
pub fn find_attribute(entity: &'static Entity, name: &str) -> Option<&'static dyn Attribute> {
    entity.attributes().find(|attribute| attribute.name() == name || attribute.aliases().contains(&name))
}

/// The guesses made so far, by entity type and misspelt word, so that no word is looked up twice.
pub type Guesses = HashMap<(&'static str, String), Option<&'static str>>;

/// The maximum number of different words of a scene for which a guess is made. A scene with more has other faults than
/// misspellings.
const MAX_GUESSES: usize = 10_000;

/// Returns the attribute that a misspelt word was probably meant to be.
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
            *free.insert(nearest(word, entity.attributes().map(|attribute| attribute.name())))
        }
    };
    near.and_then(|name| find_attribute(entity, name))
}
