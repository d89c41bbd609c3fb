//! The lines of a scene of numbers. Each line begins with the expected numbers, and the rest is a comment.

use std::ops::Range;

/// A line that is not blank, without surrounding white space.
#[derive(Clone, Copy)]
pub struct Row<'a> {
    /// The position of the line in the whole text, in bytes.
    pub start: usize,
    pub text: &'a str,
    /// The code for which a word stands alone on the line, in a scene that has words for its types.
    pub code: Option<u32>,
}

/// A number of a line, as C's `scanf` would read it.
#[derive(Clone)]
pub struct Number {
    pub value: f64,
    pub place: Range<usize>,
    /// Whether something other than white space follows directly.
    is_joined: bool,
}

impl Number {
    /// Returns the possible code for the number.
    pub fn code(&self) -> Option<u32> {
        (self.value.fract() == 0.0 && (0.0..1e6).contains(&self.value)).then_some(self.value as u32)
    }
}

/// Returns the lines of a text that begins at `start`, except blank ones.
pub fn rows(text: &str, start: usize) -> impl Iterator<Item = Row<'_>> {
    text.split(['\n', '\r']).filter_map(move |line| {
        let row = line.trim();
        let start = start + (row.as_ptr() as usize - text.as_ptr() as usize);
        (!row.is_empty()).then_some(Row { start, text: row, code: None })
    })
}

impl<'a> Row<'a> {
    /// Returns the range of the line in the whole text.
    pub fn place(&self) -> Range<usize> {
        self.start..self.start + self.text.len()
    }

    /// Tells whether the line begins with a number.
    pub fn is_of_numbers(&self) -> bool {
        self.code.is_some() || number_length(self.text).is_some()
    }

    /// Returns the numbers at the beginning of the line, up to `most` of them.
    pub fn numbers(&self, most: usize) -> Vec<Number> {
        if let Some(code) = self.code {
            let (_, place) = self.word();
            return vec![Number { value: f64::from(code), place, is_joined: false }];
        }
        let (mut numbers, mut at) = (Vec::with_capacity(most), 0);
        while numbers.len() < most
            && let Some(length) = number_length(&self.text[at..])
            && let Ok(value) = self.text[at..at + length].parse()
        {
            let end = at + length;
            let rest = self.text[end..].trim_start();
            let is_joined = !rest.is_empty() && rest.len() == self.text.len() - end;
            numbers.push(Number { value, place: self.start + at..self.start + end, is_joined });
            if is_joined {
                break;
            }
            at = self.text.len() - rest.len();
        }
        numbers
    }

    /// Returns the optional index after a code on its line.
    pub fn index(&self) -> Option<Number> {
        self.numbers(2).into_iter().nth(1).filter(|index| !index.is_joined)
    }

    /// Returns the text that looks like further digits of a number of the line: `,5` after `1`.
    pub fn more_digits(&self, number: &Number) -> Option<&'a str> {
        let rest = &self.text[number.place.end - self.start..];
        let digits = rest.strip_prefix([',', '.', '-', '+'])?;
        let length = digits.find(|c: char| !c.is_ascii_digit()).unwrap_or(digits.len());
        (length > 0).then(|| &rest[..length + 1])
    }

    /// Returns the first word of the line, and its range in the whole text.
    pub fn word(&self) -> (&'a str, Range<usize>) {
        let word = self.text.split_whitespace().next().unwrap_or_default();
        (word, self.start..self.start + word.len())
    }
}

/// Returns the length of the number at the beginning of a text: `.5`, `-3`, `1e-4`.
fn number_length(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let digits = |from: usize| bytes[from..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let sign = |from: usize| usize::from(matches!(bytes.get(from), Some(b'+' | b'-')));
    let whole = sign(0) + digits(sign(0));
    let has_point = bytes.get(whole) == Some(&b'.');
    let mut length = whole + if has_point { 1 + digits(whole + 1) } else { 0 };
    if length - sign(0) == usize::from(has_point) {
        return None;
    }
    if matches!(bytes.get(length), Some(b'e' | b'E')) {
        let exponent = length + 1 + sign(length + 1);
        if exponent < bytes.len() && digits(exponent) > 0 {
            length = exponent + digits(exponent);
        }
    }
    Some(length)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(line: &str, most: usize) -> Vec<f64> {
        let row = rows(line, 0).next().expect("a line");
        row.numbers(most).iter().map(|number| number.value).collect()
    }

    #[test]
    fn a_line_begins_with_numbers_and_ends_with_a_comment() {
        assert_eq!(values("0 0 1 normal 0 0 1", 4), [0.0, 0.0, 1.0]);
        assert_eq!(values("\t.5 -.34 +2. 1e1 7", 4), [0.5, -0.34, 2.0, 10.0]);
        assert_eq!(values("13---->head", 2), [13.0]);
        assert_eq!(values("1, 2, 3", 3), [1.0]);
        assert_eq!(values("2e centre", 3), [2.0]);
        assert_eq!(values("1e+ centre", 3), [1.0]);
        for line in ["infinite plane", "nan", "-", ".", "+.", "e5", "# 1"] {
            assert!(!rows(line, 0).next().expect("a line").is_of_numbers(), "{line}");
        }
    }

    #[test]
    fn lines_end_as_on_any_system() {
        let places: Vec<_> = rows("a\r\n\n  b \rc", 3).map(|row| row.place()).collect();
        assert_eq!(places, [3..4, 9..10, 12..13]);
    }

    #[test]
    fn an_index_stands_apart() {
        let index = |line| rows(line, 0).next().and_then(|row| row.index()).map(|index| index.value);
        assert_eq!(index("13 1.33 sphere"), Some(1.33));
        assert_eq!(index("13 2nd sphere"), None);
        assert_eq!(index("13 sphere 2"), None);
    }
}
