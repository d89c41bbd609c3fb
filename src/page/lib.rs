//! Queries of a page about its scene, and changes of the scene's text: shared by the page of `watch` and the one in a
//! browser alone. With the feature `commands`, also `tabray watch`.

pub mod camera;
pub mod display;
pub mod entities;
pub mod fields;
#[cfg(feature = "fuzz")]
#[doc(hidden)]
#[path = "../../tests/fuzz/watch.rs"]
pub mod fuzz;
pub mod html;
pub mod navigation;
pub mod numbers;
pub mod queries;
pub mod trial_values;
#[cfg(feature = "commands")]
mod watch;

use std::ops::Range;
use tabray_core::render::plan::Plan;
use tabray_core::render::trace;
use tabray_core::scene::model::Model;
use tabray_editor::{self as editor, Text, View};
use tabray_lang::reader::Places;
use tabray_lang::registry::Registry;

/// A valid scene that a page shows.
#[derive(Clone, Copy)]
pub struct Shown<'s> {
    /// The model of the scene.
    pub model: &'s Model,
    /// The name of the scene in messages.
    pub name: &'s str,
    /// The text of the scene.
    pub text: &'s str,
    /// The values that are set in addition to the text.
    pub sets: &'s [String],
}

impl Shown<'_> {
    /// Reads the text as an editor does.
    pub fn view(&self, registry: &Registry) -> View {
        editor::read(registry, self.name, Text::new(self.text))
    }

    /// Returns the first and the last line of the object that the centre of a pixel shows, from 1.
    pub fn lines_of(&self, [x, y]: [usize; 2], places: &Places) -> Option<[usize; 2]> {
        let sight = self.model.camera.value.sight(x as f64, y as f64);
        let hit = trace::first_hit(&Plan::new(self.model), &sight)?;
        lines(self.text, places.get(hit.object.args.order()).as_ref()?)
    }
}

/// Returns the first and the last line of a place in a text, from 1.
pub fn lines(text: &str, place: &Range<usize>) -> Option<[usize; 2]> {
    let line = |at: usize| Some(1 + text.get(..at)?.matches('\n').count());
    Some([line(place.start)?, line(place.end)?])
}

// Tests read scenes, and so need entity types.
#[cfg(test)]
use tabray_plugins as _;
