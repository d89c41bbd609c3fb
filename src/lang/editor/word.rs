//! Words of a text: where they stand, and how they are quoted.

use std::ops::Range;

/// A word of a text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Word {
    /// The first byte, that of the quote if it has one.
    pub start: usize,
    /// The first byte after it.
    pub end: usize,
    /// The form of its quotes.
    pub form: Form,
}

/// The forms of quotes around a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Not at all.
    Bare,
    /// By quotes of this many bytes at each end, with escape sequences in between.
    Quoted(u8),
    /// By quotes that this many bytes at each end are, without escape sequences.
    Literal(u8),
    /// Only by a quote at its beginning.
    Unclosed,
}

impl Word {
    /// Returns the range of the word with its quotes.
    pub fn place(self) -> Range<usize> {
        self.start..self.end
    }

    /// Returns the range of the word within its quotes.
    pub fn inner(self) -> Range<usize> {
        let (before, after) = match self.form {
            Form::Bare => (0, 0),
            Form::Quoted(quote) | Form::Literal(quote) => (quote.into(), quote.into()),
            Form::Unclosed => (1, 0),
        };
        let start = (self.start + before).min(self.end);
        start..(self.end - after).max(start)
    }

    /// Tells whether a cursor is at the word: in it, or at one of its ends.
    pub fn has(self, at: usize) -> bool {
        (self.start..=self.end).contains(&at)
    }
}
