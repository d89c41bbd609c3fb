//! The parts of a scene's text: its file, the files that it includes, and the options that set values. All places count
//! from the beginning of the first part.

use std::ops::Range;

/// A part of a scene's text, which messages name.
#[derive(Clone, Debug)]
pub struct TextPart {
    /// The name of the file, or the option.
    pub name: String,
    /// The part's range of the whole text, in bytes.
    pub range: Range<usize>,
    /// The place where a file is included whose name is not that of a scene. Messages show nothing of such a file,
    /// because it may be any file of the machine.
    pub included_at: Option<Range<usize>>,
}

/// The parts of a text, with their lines.
pub struct Parts<'t>(Vec<Lines<'t>>);

impl<'t> Parts<'t> {
    /// Finds the lines of a text. It is one part of this name if there are no others.
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

    /// Returns the part in which a byte of the whole text lies.
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
    /// The positions of the line ends in the part, in bytes, without that of the last line.
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

    /// Returns a place of the whole text as a place in this part.
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
