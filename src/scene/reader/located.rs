//! Places of a report as places in the files of its scene, for editors.

use super::excerpt;
use super::fault::Fault;
use super::report::Report;
use std::ops::Range;

/// A place in one of the texts that a scene is read from.
pub struct Located<'r> {
    /// The name of the file as messages show it, or that of the option.
    pub name: &'r str,
    /// The text of the file, up to its end.
    pub text: &'r str,
    /// The range of that text, in bytes.
    pub place: Range<usize>,
    /// What is so at the place; may be empty.
    pub label: &'r str,
}

impl Report<'_> {
    /// Returns the place of a fault, and then the further places that help to understand it. A fault that has no place is
    /// at the beginning of the scene.
    pub(crate) fn located<'r>(&'r self, fault: &'r Fault) -> Vec<Located<'r>> {
        let parts = self.parts();
        let others = excerpt::others(fault).filter_map(|(place, label)| Some((place.clone()?, label)));
        let first = (fault.place.clone().unwrap_or(0..0), fault.label.as_str());
        let located = |(place, label): (Range<usize>, &'r str)| {
            let lines = parts.at(place.start);
            Located { name: lines.name, text: lines.text, place: lines.place(&place), label }
        };
        std::iter::once(first).chain(others).map(located).collect()
    }
}
