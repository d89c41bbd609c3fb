//! Words of a text: their places and quotes.

use std::ops::Range;

/// A word of a text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Word {
    /// The first byte, including an opening quote.
    pub start: usize,
    /// The first byte after the word.
    pub end: usize,
    /// The form of its quotes.
    pub form: Form,
}

/// The quotes around a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// No quotes.
    Bare,
    /// Quotes of this many bytes at each end, with escape sequences in between.
    Quoted(u8),
    /// Quotes of this many bytes at each end, without escape sequences in between.
    Literal(u8),
    /// Only an opening quote.
    Unclosed,
}

impl Word {
    /// Returns the range of the word with its quotes.
    pub fn place(self) -> Range<usize> {
        self.start..self.end
    }

    /// Returns the range of the word without its quotes.
    pub fn inner(self) -> Range<usize> {
        let (before, after) = match self.form {
            Form::Bare => (0, 0),
            Form::Quoted(quote) | Form::Literal(quote) => (quote.into(), quote.into()),
            Form::Unclosed => (1, 0),
        };
        let start = (self.start + before).min(self.end);
        start..(self.end - after).max(start)
    }

    /// Tells whether a cursor is in the word, or at one of its ends.
    pub fn has(self, at: usize) -> bool {
        (self.start..=self.end).contains(&at)
    }
}
