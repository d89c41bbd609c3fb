//! Places of a report as places in the files of its scene, for editors.

use super::excerpt;
use super::fault::Fault;
use super::report::Report;
use std::iter;
use std::ops::Range;

/// A place in one of the texts of a scene.
pub struct Located<'r> {
    /// The name of the file in messages, or that of the option.
    pub name: &'r str,
    /// The text of the file, up to its end.
    pub text: &'r str,
    /// The range of that text, in bytes.
    pub place: Range<usize>,
    /// A note about the place, which may be empty.
    pub label: &'r str,
}

impl Report<'_> {
    /// Returns each fault with its place, and then the further places that help to understand it. A fault without a
    /// place is at the beginning of the scene.
    pub fn located(&self) -> impl Iterator<Item = (&Fault, Vec<Located<'_>>)> {
        let parts = self.parts();
        self.faults().iter().map(move |fault| {
            let others = excerpt::others(fault).filter_map(|(place, label)| Some((place.clone()?, label)));
            let first = (fault.place.clone().unwrap_or(0..0), fault.label.as_str());
            let located = |(place, label): (Range<usize>, _)| {
                let lines = parts.at(place.start);
                Located { name: lines.name, text: lines.text, place: lines.place(&place), label }
            };
            (fault, iter::once(first).chain(others).map(located).collect())
        })
    }
}
