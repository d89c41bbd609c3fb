//! Entities with the same words as another one, except for names and numbers: a scene may have millions. Such an entity
//! is parsed in the memory of the other one, and no word is looked up.
//!
//! The grammar only depends on the beginnings of numbers, and not on names. An entity with otherwise the same words as
//! a parsed entity thus has the same attributes, with the same numbers of values.

use super::guesses::looks_like_number;
use super::parsed::{Form, Parsed, Word};
use super::tokens::{after_space, plain_word};
use std::borrow::Cow;
use std::ops::Range;

/// A parsed entity.
pub struct SameWords {
    /// The range of its type.
    pub kind: Range<usize>,
    /// The range between its braces.
    pub body: Range<usize>,
}

impl<'a> Parsed<'a> {
    /// Replaces this entity by the one that begins at a byte of a text, if that has the same words. Otherwise, this
    /// entity becomes invalid.
    pub(super) fn take_same_words(&mut self, text: &'a str, at: usize) -> Option<SameWords> {
        let mut words = Words { text, at: after_space(text, at) };
        let start = words.at;
        if self.is_damaged || !words.next(&mut self.kind, |new, old| new == old) {
            return None;
        }
        let kind = start..words.at;
        if !words.next(&mut self.name, |_, _| true) {
            return None;
        }
        let open = words.brace(b'{')?;
        if !self.all_words(|word, is_value| {
            words.next(word, |new, old| {
                new == old || is_value && looks_like_number(new) && looks_like_number(old)
            })
        }) {
            return None;
        }
        let close = words.brace(b'}')?;
        self.place = Some(start..close);
        Some(SameWords { kind, body: open..close - 1 })
    }
}

/// The words of a text.
struct Words<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Words<'a> {
    /// Replaces a word by the next one, with its place, if a condition holds for both. Neither may be quoted.
    #[inline]
    fn next(&mut self, word: &mut Word<'a>, is_alike: impl FnOnce(&str, &str) -> bool) -> bool {
        let start = after_space(self.text, self.at);
        let Some(end) = plain_word(self.text, start).filter(|_| word.form == Form::Any) else { return false };
        let new = &self.text[start..end];
        if !is_alike(new, &word.text) {
            return false;
        }
        self.at = end;
        (word.text, word.place) = (Cow::Borrowed(new), Some(start..end));
        true
    }

    /// Returns the end of the next brace, if it is this one.
    fn brace(&mut self, brace: u8) -> Option<usize> {
        let at = after_space(self.text, self.at);
        self.at = at + 1;
        (self.text.as_bytes().get(at) == Some(&brace)).then_some(self.at)
    }
}

#[cfg(test)]
mod tests {
    use crate::reader::options::ReadOptions;
    use crate::reader::report::Report;
    use crate::reader::sources::Sources;
    use crate::reader::statements;
    use crate::registry::Registry;
    use crate::syntax::Syntax;
    use proptest::prelude::*;

    /// Parses a text, with room for this many entities at once, in the memory of earlier ones or not.
    fn parsed(text: &str, together: usize, reuses: bool) -> String {
        let registry = Registry::get().expect("no two plugins claim one name");
        let sources = Sources::alone("scene", text, ReadOptions::default());
        let mut report = Report::new("scene", text, Syntax::Notes);
        let mut all = String::new();
        if let Some(mut parser) = statements::parser(registry, &sources, &mut report) {
            let mut memory = vec![None; together];
            loop {
                let count = parser.entities(&mut memory);
                if count == 0 {
                    break;
                }
                memory[..count].iter().for_each(|entity| all += &format!("{entity:?}\n"));
                if !reuses {
                    memory.fill(None);
                }
            }
        }
        all + &report.into_owned().to_string()
    }

    proptest! {
        #![proptest_config(crate::properties())]

        #[test]
        fn alike_entities_are_parsed_as_others_are(
            kinds in prop::collection::vec(0..24, 4..24),
            numbers in prop::collection::vec("-?[0-9]{1,12}(\\.[0-9]{0,9})?|nan|1e5|\\+\\.5", 24),
            together in 1..4_usize,
        ) {
            let mut text = "camera eye { pixeldim 4 3 worlddim 8 6 viewpoint 4 3 7 }\n".to_owned();
            for (index, kind) in kinds.iter().enumerate() {
                let [a, b] = [index, index + 7].map(|index| &numbers[index % numbers.len()]);
                text += &match kind {
                    0..8 => format!("sphere s{index} {{ material white center {a} 2 {b} radius {b} }}\n"),
                    8..12 => format!("plane p{index} {{ material red normal 0 1 {a} point {a} {b} 1 }}\n"),
                    12 => format!("sphere s{index} {{ material white centre {a} 2 {b} radius {b} }}\n"),
                    13 => format!("sphere s{index} {{ material white center {a} 2 {b} radius \"{b}\" }}\n"),
                    14 => format!("sphere s{index} {{ material {a} center {a} 2 {b} radius {b} }}\n"),
                    15 => format!("sphere s{index} {{ material white center {a} 2 radius {b} }}\n"),
                    16 => format!("sphere \"s{index}\" {{ material white center {a} 2 {b} radius {b} }}\n"),
                    17 => format!("sphere s{index}{{material white#x\ncenter {a} 2 {b}\u{2003}radius {b}}}\n"),
                    18 => format!("sphere\ts{index} {{material white center {a} 2 {b} radius {b}}}\r\n"),
                    19 => format!("sphere s{index} {{ material white colour {a} 2 {b} radius {b} }}\n"),
                    20 => format!("union u{index} {{ material white of s1 s{index} }}\n"),
                    21 => format!("repeat i 2 {{ sphere s{index} {{ material white center {a} 2 \"i\" radius 1 }} }}\n"),
                    22 => format!("let n{index} 3\n"),
                    _ => format!("sphere s{index} {{ material white center {a} 2 {b} radius {b}\n"),
                };
            }
            prop_assert_eq!(parsed(&text, together, true), parsed(&text, together, false), "{}", text);
        }
    }
}
