//! A scene as it was when it was last sound.

use crate::render::plan::Plan;
use crate::render::trace;
use crate::scene::model::Model;
use crate::scene::reader::Place;
use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicBool, Ordering};

/// A sound scene, its text and what became of it.
pub struct Frame {
    /// Which one it is, counted from 1.
    pub version: u64,
    /// What messages call it.
    pub name: String,
    /// What it was read from.
    pub text: String,
    /// What may not mean what was intended.
    pub warnings: String,
    /// The scene itself.
    pub model: Model,
    /// Where each entity stands in the text.
    pub places: Vec<Place>,
    /// Whether a newer one has taken its place.
    pub stale: AtomicBool,
}

impl Frame {
    /// Breaks where nobody wants it any more.
    pub fn check(&self) -> ControlFlow<()> {
        if self.stale.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// The first and the last line of the object that the middle of a pixel shows, counted from 1.
    pub fn lines_of(&self, [x, y]: [usize; 2]) -> Option<[usize; 2]> {
        let hit =
            trace::first_hit(&Plan::new(&self.model), &self.model.camera.value.sight(x as f64, y as f64))?;
        lines(&self.text, self.places.get(hit.object.args.order)?.as_ref()?)
    }
}

/// The first and the last line of a place in a text, counted from 1.
pub fn lines(text: &str, place: &Range<usize>) -> Option<[usize; 2]> {
    let line = |at: usize| Some(1 + text.get(..at)?.matches('\n').count());
    Some([line(place.start)?, line(place.end)?])
}
