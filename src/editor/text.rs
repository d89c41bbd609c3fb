//! A text and its lines. Positions are those of editors: lines and UTF-16 units, both from 0.

use serde::{Deserialize, Serialize};
use std::ops::Range;
use std::sync::Arc;
use tabray_core::text::boundary;

/// A position in a text: the line and the number of UTF-16 units before it on the line, both from 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Position {
    /// The line, from 0.
    pub line: u32,
    /// The UTF-16 units of the line before the position.
    pub character: u32,
}

/// A text and the starts of its lines. Clones share both.
#[derive(Clone, Debug)]
pub struct Text {
    text: Arc<str>,
    starts: Arc<[usize]>,
}

impl Text {
    /// Finds the lines of a text. Each ends with a line feed, a carriage return, or both.
    pub fn new(text: impl Into<Arc<str>>) -> Self {
        let text = text.into();
        let bytes = text.as_bytes();
        let is_end = |at: &usize| bytes[*at] == b'\n' || bytes.get(at + 1) != Some(&b'\n');
        let ends = memchr::memchr2_iter(b'\n', b'\r', bytes).filter(is_end);
        let starts = std::iter::once(0).chain(ends.map(|at| at + 1)).collect();
        Self { text, starts }
    }

    /// Returns the text itself.
    pub fn as_str(&self) -> &str {
        &self.text
    }

    /// Returns the text with shared ownership.
    pub fn shared(&self) -> Arc<str> {
        self.text.clone()
    }

    /// Returns the range of a line, in bytes, without its end.
    fn line(&self, line: usize) -> Range<usize> {
        let Some(start) = self.starts.get(line).copied() else { return self.text.len()..self.text.len() };
        let end = self.starts.get(line + 1).copied().unwrap_or(self.text.len());
        start..start + self.text[start..end].trim_end_matches(['\n', '\r']).len()
    }

    /// Returns the line of a byte, from 0.
    pub fn line_of(&self, at: usize) -> usize {
        self.starts.partition_point(|start| *start <= at).saturating_sub(1)
    }

    /// Returns the position of a byte. A byte within a character has the position of the character.
    pub fn position(&self, at: usize) -> Position {
        let at = boundary(&self.text, at);
        let line = self.line_of(at);
        let before = &self.text[self.starts[line]..at];
        // A line may be as long as the text.
        let units = if before.is_ascii() { before.len() } else { before.chars().map(char::len_utf16).sum() };
        Position { line: line as u32, character: units as u32 }
    }

    /// Returns the byte at a position. A position after the end of a line gives the end of the line, and a position
    /// within a character gives the beginning of the character.
    pub fn offset(&self, position: Position) -> usize {
        let line = self.line(position.line as usize);
        let mut left = position.character as usize;
        if self.text.as_bytes()[line.clone()].iter().take(left).all(u8::is_ascii) {
            return (line.start + left).min(line.end);
        }
        for (at, letter) in self.text[line.clone()].char_indices() {
            let Some(rest) = left.checked_sub(letter.len_utf16()) else { return line.start + at };
            if left == 0 {
                return line.start + at;
            }
            left = rest;
        }
        line.end
    }

    /// Returns the text with a range replaced by another text.
    pub fn edited(&self, place: Range<usize>, with: &str) -> Self {
        let [start, end] = [place.start, place.end.max(place.start)].map(|at| boundary(&self.text, at));
        Self::new([&self.text[..start], with, &self.text[end..]].concat())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn units_of_utf_16_are_counted() {
        let text = Text::new("a\u{1f600}b\r\nß\rc\n");
        for (at, line, character) in
            [(0, 0, 0), (1, 0, 1), (5, 0, 3), (6, 0, 4), (8, 1, 0), (10, 1, 1), (11, 2, 0), (13, 3, 0)]
        {
            assert_eq!(text.position(at), Position { line, character }, "{at}");
            assert_eq!(text.offset(Position { line, character }), at);
        }
        // The positions are within a character, after the end of a line, and after the end of the text.
        assert_eq!(text.offset(Position { line: 0, character: 2 }), 1);
        assert_eq!(text.offset(Position { line: 1, character: 9 }), 10);
        assert_eq!(text.offset(Position { line: 9, character: 9 }), 13);
    }

    proptest! {
        #![proptest_config(crate::properties())]

        #[test]
        fn positions_are_those_of_the_text_in_utf_16(words in prop::collection::vec("[a-zß\u{10000}-\u{10010}\u{301}]{0,4}", 1..20), ends in prop::collection::vec(0..3_usize, 20)) {
            let mut text = String::new();
            for (word, end) in words.iter().zip(ends) {
                text += word;
                text += ["\n", "\r\n", " "][end];
            }
            let whole = Text::new(text.as_str());
            for (at, _) in text.char_indices().filter(|(at, _)| !text[..*at].ends_with('\r')) {
                let position = whole.position(at);
                // A client that keeps its text as UTF-16 computes the same.
                let lines: Vec<&str> = text.split('\n').collect();
                let units: Vec<u16> = lines[position.line as usize].encode_utf16().collect();
                let before = lines[..position.line as usize].iter().map(|line| line.len() + 1).sum::<usize>();
                let there = String::from_utf16(&units[..position.character as usize]).expect("no character is cut");
                prop_assert_eq!(before + there.len(), at);
                prop_assert_eq!(whole.offset(position), at);
            }
        }
    }
}
