//! The tokens of a scene in the notes' syntax: words, braces, white space and comments. Each byte belongs to one of
//! them.

use super::fault::Fault;
use super::parsed::{Form, Word};
use super::report::Report;
use std::borrow::Cow;
use std::mem::replace;
use std::ops::Range;

/// A part of a text, and its place.
#[derive(Clone, Copy)]
pub struct Token {
    /// Its form.
    pub form: TokenForm,
    /// Where it begins in the text, in bytes.
    pub start: usize,
    /// Where it ends in the text, in bytes.
    pub end: usize,
}

/// The form of a token.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum TokenForm {
    /// A word.
    Word,
    /// A word in quotes.
    Quoted,
    /// A word after an unclosed quote.
    Unclosed,
    /// An opening brace.
    Open,
    /// A closing brace.
    Close,
    /// White space.
    Space,
    /// A comment, up to the end of its line.
    Comment,
}

impl Token {
    /// Reads the token at a byte of a text. At the beginning of a word, a `#` begins a comment, and a `"` a quoted
    /// word.
    #[inline]
    pub fn at(text: &str, start: usize, report: &mut Report<'_>) -> Option<Self> {
        let bytes = text.as_bytes();
        let (form, end) = match *bytes.get(start)? {
            b'#' => {
                let end = text[start..].find('\n').map_or(bytes.len(), |length| start + length);
                (TokenForm::Comment, end)
            }
            b'"' => {
                let (is_closed, length) = quoted(&text[start..], start, report);
                (if is_closed { TokenForm::Quoted } else { TokenForm::Unclosed }, start + length)
            }
            b'{' => (TokenForm::Open, start + 1),
            b'}' => (TokenForm::Close, start + 1),
            _ => match space_end(text, start) {
                end if end > start => (TokenForm::Space, end),
                _ => (TokenForm::Word, word_end(text, start)),
            },
        };
        Some(Self { form, start, end })
    }

    /// Tells whether the token only separates others.
    #[inline]
    pub fn is_trivia(self) -> bool {
        matches!(self.form, TokenForm::Space | TokenForm::Comment)
    }

    /// Returns whether this is a brace.
    #[inline]
    pub fn is_brace(self) -> bool {
        matches!(self.form, TokenForm::Open | TokenForm::Close)
    }

    #[inline]
    pub(super) fn form(self) -> Form {
        if matches!(self.form, TokenForm::Quoted | TokenForm::Unclosed) { Form::Text } else { Form::Any }
    }

    /// Returns its range in the text, in bytes.
    #[inline]
    pub fn place(self) -> Range<usize> {
        self.start..self.end
    }
}

/// The class of a byte.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Class {
    Letter,
    /// A letter that begins something else at the beginning of a word.
    Mark,
    Space,
    Brace,
    /// A part of a multibyte character, which may be white space.
    Wide,
}

/// The classes of all bytes.
const CLASSES: [Class; 256] = {
    let mut classes = [Class::Letter; 256];
    let mut byte = 0;
    while byte < 256 {
        classes[byte] = match byte as u8 {
            b'{' | b'}' => Class::Brace,
            b'#' | b'"' => Class::Mark,
            128.. => Class::Wide,
            byte if (byte as char).is_whitespace() => Class::Space,
            _ => Class::Letter,
        };
        byte += 1;
    }
    classes
};

/// Marks the highest bit of the first of eight bytes that may not be a letter of a word, and possibly those of later
/// ones. Marked are white space, braces, and a few others.
#[inline(always)]
fn perhaps_others(eight: u64) -> u64 {
    const ONES: u64 = u64::MAX / 255;
    let (low, high) = (eight.wrapping_sub(0x21 * ONES) & !eight, (eight & (0x7f * ONES)) + 0x05 * ONES);
    (low | high | eight) & (0x80 * ONES)
}

/// Returns the end of the word at a byte of a text, which is the beginning of white space or a brace.
#[inline]
fn word_end(text: &str, mut at: usize) -> usize {
    let bytes = text.as_bytes();
    while let Some(eight) = bytes.get(at..).and_then(<[u8]>::first_chunk) {
        let others = perhaps_others(u64::from_le_bytes(*eight));
        at += if others == 0 { 8 } else { others.trailing_zeros() as usize / 8 };
        if others != 0 {
            break;
        }
    }
    while let Some(byte) = bytes.get(at) {
        match CLASSES[usize::from(*byte)] {
            Class::Letter | Class::Mark => at += 1,
            Class::Wide => match text[at..].chars().next() {
                Some(letter) if !letter.is_whitespace() => at += letter.len_utf8(),
                _ => break,
            },
            Class::Space | Class::Brace => break,
        }
    }
    at
}

/// Returns the end of the white space at a byte of a text.
#[inline]
fn space_end(text: &str, mut at: usize) -> usize {
    let bytes = text.as_bytes();
    while let Some(byte) = bytes.get(at) {
        match CLASSES[usize::from(*byte)] {
            Class::Space => at += 1,
            Class::Wide => match text[at..].chars().next() {
                Some(letter) if letter.is_whitespace() => at += letter.len_utf8(),
                _ => break,
            },
            Class::Letter | Class::Mark | Class::Brace => break,
        }
    }
    at
}

/// Returns the end of the single-byte white space at a byte of a text.
#[inline]
pub fn after_space(text: &str, mut at: usize) -> usize {
    let is_space = |byte: &u8| CLASSES[usize::from(*byte)] == Class::Space;
    while text.as_bytes().get(at).is_some_and(is_space) {
        at += 1;
    }
    at
}

/// Returns the end of the word at a byte of a text, if there is one with a single-byte first letter.
#[inline]
pub fn plain_word(text: &str, at: usize) -> Option<usize> {
    let first = CLASSES[usize::from(*text.as_bytes().get(at)?)];
    (first == Class::Letter).then(|| word_end(text, at))
}

/// The words and braces of a text, with enough lookahead to recognise the beginning of an entity.
pub struct Tokens<'a> {
    pub text: &'a str,
    at: usize,
    pub ahead: [Option<Token>; 3],
}

impl<'a> Tokens<'a> {
    pub fn of(text: &'a str, report: &mut Report<'_>) -> Self {
        Self::from(text, 0, report)
    }

    pub fn from(text: &'a str, at: usize, report: &mut Report<'_>) -> Self {
        let mut tokens = Self { text, at, ahead: [None; 3] };
        for _ in 0..3 {
            tokens.step(report);
        }
        tokens
    }

    /// Advances by one token, and returns the token.
    pub fn step(&mut self, report: &mut Report<'_>) -> Option<Token> {
        let next = self.read(report);
        let [first, second, third] = self.ahead;
        self.ahead = [second, third, next];
        first
    }

    /// Reads the token after the lookahead.
    #[inline]
    fn read(&mut self, report: &mut Report<'_>) -> Option<Token> {
        loop {
            self.at = after_space(self.text, self.at);
            if let Some(end) = plain_word(self.text, self.at) {
                let start = replace(&mut self.at, end);
                return Some(Token { form: TokenForm::Word, start, end });
            }
            let token = Token::at(self.text, self.at, report)?;
            self.at = token.end;
            if !token.is_trivia() {
                return Some(token);
            }
        }
    }

    /// Returns the word of a token, without quotes and escapes.
    #[inline]
    pub fn text(&self, token: Token) -> Cow<'a, str> {
        match token.form {
            TokenForm::Quoted => unescaped(&self.text[token.start + 1..token.end - 1]),
            TokenForm::Unclosed => Cow::Borrowed(self.text[token.start + 1..token.end].trim_end_matches('"')),
            _ => Cow::Borrowed(self.raw(token)),
        }
    }

    /// Returns the text of a token, including quotes.
    #[inline]
    pub fn raw(&self, token: Token) -> &'a str {
        &self.text[token.start..token.end]
    }

    #[inline]
    pub(super) fn word(&self, token: Token) -> Word<'a> {
        Word::at(self.text(token), token.form(), token.place())
    }
}

/// Finds the end of the quoted word at the beginning of a text. Returns whether it has one, and the length of the word
/// in bytes, including the quotes.
fn quoted(text: &str, at: usize, report: &mut Report<'_>) -> (bool, usize) {
    let mut letters = text.char_indices().skip(1);
    while let Some((index, letter)) = letters.next().filter(|(_, letter)| *letter != '\n') {
        match letter {
            '"' => return (true, index + 1),
            '\\' if continued(&text[index..]) > 0 => {
                letters.by_ref().find(|(_, letter)| *letter == '\n');
            }
            '\\' => match letters.next() {
                Some((_, '"' | '\\')) => {}
                other => {
                    let end = index + 1 + other.map_or(0, |(_, letter)| letter.len_utf8());
                    report.add(
                        Fault::error(Some(at + index..at + end), "unknown escape sequence")
                            .help("in quotes, write `\\\\` for a backslash and `\\\"` for a quote"),
                    );
                }
            },
            _ => {}
        }
    }
    report.add(Fault::error(Some(at..at + 1), "missing closing quote").help(
        "a quoted word must end on the line on which it begins; a `\\` at the end of that line continues it on the next",
    ));
    (false, unclosed(text))
}

/// Returns the length of the line break at the beginning of a text, with the `\` before it, or 0 if there is none.
fn continued(text: &str) -> usize {
    ["\\\n", "\\\r\n"].into_iter().find(|end| text.starts_with(end)).map_or(0, str::len)
}

/// Returns the probable length of a word with an opening quote but no closing one on its line: up to a later closing
/// quote, or else the line, of which a formula ends at a brace, and any other word with a brace after it at white space.
fn unclosed(text: &str) -> usize {
    let line = text.find('\n').unwrap_or(text.len());
    if let Some(length) = text[line..].find(['"', '{', '}', '#'])
        && text[line + length..].starts_with('"')
        && !text[..line + length].ends_with(char::is_whitespace)
    {
        return line + length + 1;
    }
    let line = text[..line].trim_end();
    let (word, is_operator) = (word_end(text, 1), |letter| "+-*/^".contains(letter));
    match line.find(['{', '}', '#']) {
        None => line.len(),
        Some(end) if line[word..].trim_start().starts_with(is_operator) => line[..end].trim_end().len(),
        Some(_) => word,
    }
}

/// Returns the text of a quoted word: `\\` and `\"` stand for a backslash and a quote, and other escape sequences are
/// dropped. A `\` at the end of a line gives as many spaces as bytes, so that the following text keeps its place.
pub fn unescaped(text: &str) -> Cow<'_, str> {
    if !text.contains('\\') {
        return Cow::Borrowed(text);
    }
    let (mut word, mut rest) = (String::with_capacity(text.len()), text);
    while let Some(at) = rest.find('\\') {
        word += &rest[..at];
        let (length, stands_for) = match (continued(&rest[at..]), rest[at + 1..].chars().next()) {
            (0, None) => (1, ""),
            (0, Some('"')) => (2, "\""),
            (0, Some('\\')) => (2, "\\"),
            (0, Some(letter)) => (1 + letter.len_utf8(), ""),
            (length, _) => (length, &"   "[..length]),
        };
        word += stands_for;
        rest = &rest[at + length..];
    }
    word += rest;
    Cow::Owned(word)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(crate::properties())]

        #[test]
        fn tokens_hold_every_byte_once(text in "[ab#\"\\\\{} \t\n\r\u{a0}\u{2003}\u{e9}\u{1f600}]{0,40}") {
            let (mut at, mut last) = (0, TokenForm::Word);
            while let Some(token) = Token::at(&text, at, &mut Report::default()) {
                prop_assert!(token.start == at && token.end > at && text.is_char_boundary(token.end));
                prop_assert!(!(last == TokenForm::Space && token.form == TokenForm::Space));
                (at, last) = (token.end, token.form);
            }
            prop_assert_eq!(at, text.len());
        }
    }
}
