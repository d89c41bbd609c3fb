//! The parts of a scene's text: its file, the included files, and the options that set values. Places count from the
//! beginning of the first part.

use std::ops::Range;

/// A named part of a scene's text.
#[derive(Clone, Debug)]
pub struct TextPart {
    /// The name of the file, or the option.
    pub name: String,
    /// The range of the part in the whole text, in bytes.
    pub range: Range<usize>,
    /// The place of the `include`, for a file without the name of a scene. Messages show nothing of such a file,
    /// because it may be any file of the machine.
    pub included_at: Option<Range<usize>>,
}

/// The parts of a text, with their lines.
pub struct Parts<'t>(Vec<Lines<'t>>);

impl<'t> Parts<'t> {
    /// Finds the lines of a text. Without parts, it is one part with this name.
    pub fn of(name: &'t str, text: &'t str, parts: &'t [TextPart]) -> Self {
        if parts.is_empty() {
            return Self(vec![Lines::of(name, text, 0)]);
        }
        Self(
            parts
                .iter()
                .map(|part| Lines::of(&part.name, &text[part.range.clone()], part.range.start))
                .collect(),
        )
    }

    /// Returns the part that contains a byte of the whole text.
    pub fn at(&self, byte: usize) -> &Lines<'t> {
        let after = self.0.partition_point(|part| part.start <= byte);
        &self.0[after.saturating_sub(1)]
    }
}

/// The lines of one part.
pub struct Lines<'t> {
    /// The name of the part in messages.
    pub name: &'t str,
    pub text: &'t str,
    /// The position of the part in the whole text, in bytes.
    start: usize,
    /// The positions of the line ends in the part, in bytes, except for that of the last line.
    pub ends: Vec<usize>,
}

impl<'t> Lines<'t> {
    fn of(name: &'t str, text: &'t str, start: usize) -> Self {
        Self { name, text, start, ends: text.match_indices('\n').map(|(at, _)| at).collect() }
    }

    /// Tells whether a byte of the whole text is in this part.
    pub fn has(&self, byte: usize) -> bool {
        (self.start..=self.start + self.text.len()).contains(&byte)
    }

    /// Converts a place in the whole text to a place in this part.
    pub fn place(&self, place: &Range<usize>) -> Range<usize> {
        let local = |at: usize| at.saturating_sub(self.start).min(self.text.len());
        local(place.start)..local(place.end)
    }

    /// Returns the line and the column of a byte of the part, both from 1.
    pub fn line_and_column(&self, byte: usize) -> (usize, usize) {
        let before = self.ends.partition_point(|end| *end < byte);
        let start = before.checked_sub(1).map_or(0, |line| self.ends[line] + 1);
        (1 + before, 1 + self.text[start..byte].chars().count())
    }
}
