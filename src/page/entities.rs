//! The list of a page about a scene: its numbers, and its entities that have some.

use super::fields::{self, Fields, Named};
use super::{Shown, numbers};
use tabray_lang::registry::Registry;

/// Lists the scene's own numbers, if there are any, and its entities.
pub fn all(registry: &Registry, shown: Shown) -> Vec<Named> {
    let numbers = numbers::of(registry, shown).map(|numbers| numbers.entity);
    numbers.into_iter().chain(fields::all(shown.model)).collect()
}

/// Returns the numbers of an entry of the list; `None` if the scene has none.
pub fn fields(registry: &Registry, shown: Shown, order: &str) -> Option<Fields> {
    match order {
        numbers::ORDER => numbers::of(registry, shown),
        _ => fields::of_entity(registry, shown, order.parse().ok()?),
    }
}
