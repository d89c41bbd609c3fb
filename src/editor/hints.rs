//! Names of the values of a row, shown between the values.

use super::types::value_name;
use super::view::{Item, View};
use std::ops::Range;

/// A name shown before a value.
#[derive(Clone, Debug, PartialEq)]
pub struct Hint {
    /// The first byte of the value.
    pub at: usize,
    /// The name of the value.
    pub name: &'static str,
}

/// Returns the names of the values in a range of a text, for complete rows.
pub fn hints(view: &View, range: &Range<usize>) -> Vec<Hint> {
    let mut hints = Vec::new();
    view.visit(&mut |item, _| {
        let Item::Entity(entity) = item else { return };
        if entity.place.end < range.start || entity.place.start > range.end {
            return;
        }
        for attribute in &entity.attributes {
            let Some(known) = attribute.known else { continue };
            if attribute.values.len() < 2 || !known.arity().allow(attribute.values.len()) {
                continue;
            }
            let named = attribute
                .values
                .iter()
                .enumerate()
                .map(|(index, word)| Hint { at: word.start, name: value_name(known, index) });
            hints.extend(named.filter(|hint| !hint.name.is_empty() && range.contains(&hint.at)));
        }
    });
    hints
}
