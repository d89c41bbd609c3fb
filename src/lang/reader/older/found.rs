//! Objects and lights as read.

use super::codes::{Code, Numbers};
use super::rows::Number;
use std::ops::Range;

/// An object or a light as read.
pub struct Found<'a> {
    pub code: &'static Code,
    /// The place of the code.
    pub place: Range<usize>,
    /// The materials, in the order of their lines.
    pub materials: Vec<Vec<Given>>,
    pub lines: Vec<Given>,
    pub file: Option<(&'a str, Range<usize>)>,
}

/// A line of numbers as read.
pub struct Given {
    pub line: Numbers,
    pub values: Vec<Number>,
}

impl Given {
    /// Returns the place of the numbers.
    pub fn place(&self) -> Range<usize> {
        let end = self.values.last().map_or(0, |last| last.place.end);
        self.values.first().map_or(end, |first| first.place.start)..end
    }
}
