//! Syntax of other programs that scenes do not have: brackets, commas, `=`, `;`, curly quotes, comments after `//`,
//! colours such as `#8080ff`. In a scene with errors, each kind is reported once, with its correction. The scene is
//! then read again without this syntax, which avoids errors that follow from it.

use super::fault::{Fault, Severity};
use super::loops;
use super::report::Report;
use super::tokens::{Token, TokenForm, Tokens};
use std::collections::BTreeMap;
use std::ops::Range;

/// Syntax of other programs that scenes do not have.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum ForeignSyntax {
    Comment,
    Colour,
    Quotes,
    Brackets,
    Equals,
    Semicolon,
}

/// The places of such syntax in a text, and the replacement for the first one.
struct Finding {
    replacement: String,
    places: Vec<Range<usize>>,
}

/// A text without foreign syntax. The remaining characters keep their places.
struct Cleaned {
    bytes: Vec<u8>,
    found: BTreeMap<ForeignSyntax, Finding>,
}

/// Returns the report on a scene with errors. If the text has fewer errors without foreign syntax, it is the report of
/// reading the cleaned text `again`, with errors about the syntax. Otherwise, it is the given report.
pub fn explained(
    report: Report<'static>,
    text: &str,
    again: impl FnOnce(&str) -> Report<'static>,
) -> Report<'static> {
    let mut cleaned = Cleaned { bytes: text.as_bytes().to_vec(), found: BTreeMap::new() };
    cleaned.all();
    let Some(clean) = String::from_utf8(cleaned.bytes).ok().filter(|_| !cleaned.found.is_empty()) else {
        return report;
    };
    let errors = report.count(Severity::Error);
    let mut better = again(&clean);
    if better.count(Severity::Error) >= errors {
        return report;
    }
    better.shows_in_place(text);
    for (syntax, found) in cleaned.found {
        better.add_gathered(syntax.fault(&found));
    }
    better
}

impl ForeignSyntax {
    fn fault(self, Finding { replacement, places }: &Finding) -> Fault {
        let (message, help) = match self {
            Self::Comment => (
                "a comment begins with `#`, not with `//` or `/*`",
                "a `#` after white space begins a comment, which ends with its line",
            ),
            Self::Colour => (
                "a `#` begins a comment, not a colour",
                "a colour is red, green and blue, and 1 is the brightest that an image can show",
            ),
            Self::Quotes => (
                "curly quotes do not quote a name",
                "put a word with white space in straight quotes; word processors replace these with curly ones",
            ),
            Self::Brackets => {
                ("values are not written with brackets or commas", "separate values by white space")
            }
            Self::Equals => (
                "there is no `=` between an attribute and its values",
                "write `NAME VALUES`; in a file whose name ends in .toml, a scene is TOML, and has `=`",
            ),
            Self::Semicolon => (
                "there is no `;` after an attribute",
                "an attribute ends where the next one begins, and an entity with its `}`",
            ),
        };
        let label = match self {
            Self::Equals | Self::Semicolon => "leave it out".to_owned(),
            Self::Comment | Self::Colour | Self::Quotes | Self::Brackets => format!("write `{replacement}`"),
        };
        let mut fault = Fault::error(places.first().cloned(), message).label(label).help(help);
        places.iter().skip(1).for_each(|place| fault.count_similar(Some(place.clone())));
        fault
    }
}

/// Tells whether the second word of a text begins with the brace of an entity, and the first word is thus its name.
fn is_followed_by_a_brace(text: &str) -> bool {
    text.split_whitespace().nth(1).is_some_and(|word| word.starts_with('{'))
}

impl Cleaned {
    /// Replaces all foreign syntax. The text is searched only for syntax that its bytes allow.
    fn all(&mut self) {
        if self.bytes.contains(&b'/') {
            self.comments();
        }
        if self.bytes.contains(&b'#') {
            self.colours();
        }
        if !self.bytes.is_ascii() {
            self.quotes();
        }
        if self.bytes.iter().any(|byte| is_mark(char::from(*byte))) {
            self.marks();
        }
    }

    fn find(&mut self, syntax: ForeignSyntax, place: Range<usize>, replacement: impl FnOnce() -> String) {
        match self.found.get_mut(&syntax) {
            Some(found) => found.places.push(place),
            None => {
                drop(self.found.insert(syntax, Finding { replacement: replacement(), places: vec![place] }))
            }
        }
    }

    fn text(&self) -> String {
        // Only whole characters are replaced by others.
        String::from_utf8_lossy(&self.bytes).into_owned()
    }

    /// Replaces comments that begin with `//` or `/*`, where a word could begin, by white space.
    fn comments(&mut self) {
        let text = self.text();
        let end_of_line = |at: usize| text[at..].find('\n').map_or(text.len(), |length| at + length);
        let (mut at, mut end, mut may_begin) = (0, end_of_line(0), true);
        while let Some(letter) = text[at..].chars().next() {
            let rest = &text[at..];
            // Looked for once in each line.
            if at > end {
                end = end_of_line(at);
            }
            let line = end - at;
            let (length, is_foreign) = match letter {
                '#' if may_begin => (line, false),
                '"' if may_begin => (rest[1..line.max(1)].find('"').map_or(1, |end| end + 2), false),
                // An entity may have such a name.
                '/' if may_begin && is_followed_by_a_brace(rest) => (1, false),
                '/' if may_begin && rest.starts_with("//") => (line, true),
                '/' if may_begin && rest.starts_with("/*") => {
                    (rest.find("*/").map_or(rest.len(), |end| end + 2), true)
                }
                letter => (letter.len_utf8(), false),
            };
            may_begin = letter.is_whitespace() || "{}".contains(letter) || is_foreign;
            if is_foreign {
                let comment = rest[..length].trim_end();
                let first = comment.lines().next().unwrap_or_default();
                let place = at..at + first.len();
                let words = first.trim_start_matches(['/', '*']).trim_end_matches(['/', '*']).trim();
                self.find(ForeignSyntax::Comment, place, || format!("# {words}"));
                for byte in &mut self.bytes[at..at + length] {
                    *byte = if matches!(byte, b'\n' | b'\r') { *byte } else { b' ' };
                }
            }
            at += length;
        }
    }

    /// Replaces each colour such as `#8080ff` after a word on its line by three numbers.
    fn colours(&mut self) {
        let text = self.text();
        let mut start = 0;
        for line in text.split_inclusive('\n') {
            let mut before = "";
            for word in line.split_ascii_whitespace() {
                let at = start + (word.as_ptr() as usize - line.as_ptr() as usize);
                let digits = word.strip_prefix('#').map(|rest| rest.trim_end_matches(['}', ';']));
                let is_name = before == "="
                    || before.starts_with(|c: char| c.is_ascii_alphabetic()) && !before.contains('"');
                match digits.and_then(|digits| Some((digits, colour(digits)?))) {
                    Some((digits, [red, green, blue])) if is_name => {
                        let place = at..at + 1 + digits.len();
                        let placeholder = format!("{:<1$}", "1 1 1", place.len().max(5));
                        // A short colour needs the white space after it.
                        if self
                            .bytes
                            .get(place.end..at + placeholder.len())
                            .is_some_and(|rest| rest.iter().all(u8::is_ascii_whitespace))
                        {
                            self.bytes[at..at + placeholder.len()].copy_from_slice(placeholder.as_bytes());
                            let shown = |level: u8| {
                                let text = format!("{:.3}", f64::from(level) / 255.0);
                                text.trim_end_matches('0').trim_end_matches('.').to_owned()
                            };
                            self.find(ForeignSyntax::Colour, place, || {
                                [red, green, blue].map(shown).join(" ")
                            });
                        }
                    }
                    _ if word.starts_with('#') => break,
                    _ => {}
                }
                before = word;
            }
            start += line.len();
        }
    }

    /// Replaces curly quotes around words by straight ones.
    fn quotes(&mut self) {
        let text = self.text();
        let mut start = 0;
        for line in text.split_inclusive('\n') {
            self.quotes_of(line, start);
            start += line.len();
        }
    }

    fn quotes_of(&mut self, line: &str, start: usize) {
        let length = |at: usize| line[at..].chars().next().map_or(1, char::len_utf8);
        let mut at = 0;
        while let Some(open) = line[at..].find(['“', '„', '”', '‘']).map(|found| at + found) {
            let before = line[..open].chars().next_back();
            at = open + length(open);
            if !before.is_none_or(|before| before.is_whitespace() || "{}=".contains(before)) {
                continue;
            }
            let Some(close) = line[at..].find(['”', '“', '’']).map(|found| at + found) else { return };
            let (first, end) = (at, close + length(close));
            at = end;
            if line[first..close].contains('"') {
                continue;
            }
            // Each straight quote is next to its word, in the last or the first byte of the curly one.
            self.bytes[start + open..start + first].fill(b' ');
            self.bytes[start + close..start + end].fill(b' ');
            self.bytes[start + first - 1] = b'"';
            self.bytes[start + close] = b'"';
            self.find(ForeignSyntax::Quotes, start + open..start + end, || {
                format!("\"{}\"", &line[first..close])
            });
        }
    }

    /// Replaces brackets, commas, `=` and `;` around values by white space.
    fn marks(&mut self) {
        let text = self.text();
        let nowhere = &mut Report::default();
        let mut tokens = Tokens::of(&text, nowhere);
        let mut run: Option<Range<usize>> = None;
        let mut depth = 0_usize;
        while let Some(token) = tokens.step(nowhere) {
            let word = tokens.raw(token);
            match token.form {
                TokenForm::Open => depth += 1,
                TokenForm::Close => depth = depth.saturating_sub(1),
                // The marks of a loop tell what it means. An attribute may be called `repeat`.
                _ if loops::word(word).is_some_and(|word| depth == 0 || word != "repeat") => {
                    let end = token.start + loops::head(&text, token.start).map_or(0, str::len);
                    while tokens.ahead[0].is_some_and(|next| next.start < end) {
                        tokens.step(nowhere);
                    }
                    continue;
                }
                _ => {}
            }
            let is_name = tokens.ahead[0].is_some_and(|next| next.form == TokenForm::Open);
            let is_open = run.as_ref().is_some_and(|run| {
                let inner = &text[run.clone()];
                inner.ends_with(',') || inner.contains(['<', '(', '[']) && !inner.ends_with(['>', ')', ']'])
            });
            let marked = (token.form == TokenForm::Word && !is_name).then(|| marks(word, is_open)).flatten();
            let Some(marks) = marked else {
                // Within brackets, a value may have no marks.
                match &mut run {
                    Some(run) if is_open && token.form == TokenForm::Word => run.end = token.end,
                    _ => self.end_of_run(&text, &mut run),
                }
                continue;
            };
            self.one(&text, token, &marks, &mut run);
        }
        self.end_of_run(&text, &mut run);
    }

    fn one(&mut self, text: &str, token: Token, marks: &[usize], run: &mut Option<Range<usize>>) {
        let mut values: Option<Range<usize>> = None;
        for at in marks.iter().map(|at| token.start + at) {
            self.bytes[at] = b' ';
            let syntax = match text.as_bytes()[at] {
                b'=' => ForeignSyntax::Equals,
                b';' => ForeignSyntax::Semicolon,
                _ => {
                    values = Some(values.map_or(at, |values| values.start)..at + 1);
                    continue;
                }
            };
            self.find(syntax, at..at + 1, String::new);
        }
        let word = text[token.place()].trim_end_matches(';');
        let Some(values) = values else {
            if let Some(run) =
                run.as_mut().filter(|run| text[..run.end].ends_with(',') && !word.contains('='))
            {
                run.end = token.start + word.len();
            }
            return self.end_of_run(text, run);
        };
        // The word before an opening bracket is an attribute: `ambient(1,1,1)`.
        let opens = word.find(['<', '(', '[']).map(|at| token.start + at);
        let start = opens.map_or(token.start, |opens| opens.min(values.start));
        let place = start..token.start + word.len();
        let is_over = run.as_ref().is_some_and(|run| text[run.clone()].ends_with(['>', ')', ']']));
        match run {
            Some(run) if !is_over && opens.is_none() => run.end = place.end,
            _ => {
                self.end_of_run(text, run);
                *run = Some(place);
            }
        }
    }

    fn end_of_run(&mut self, text: &str, run: &mut Option<Range<usize>>) {
        let Some(place) = run.take() else { return };
        let replacement = text[place.clone()].replace(is_mark, " ");
        let replacement = replacement.split_whitespace().collect::<Vec<_>>().join(" ");
        self.find(ForeignSyntax::Brackets, place, || replacement);
    }
}

/// Tells whether a character is never part of a value, and other programs put it around and between values.
fn is_mark(c: char) -> bool {
    matches!(c, '<' | '>' | '(' | ')' | '[' | ']' | ',' | ';' | '=')
}

/// Returns the positions of a word's marks, unless they are part of a name.
fn marks(word: &str, is_within: bool) -> Option<Vec<usize>> {
    if !word.contains(is_mark) {
        return None;
    }
    let all = |of: &dyn Fn(char) -> bool| {
        let marks = word.char_indices().filter(|(_, c)| of(*c));
        Some(marks.map(|(at, _)| at).collect::<Vec<_>>())
    };
    let is_number = |piece: &str| piece.parse::<f64>().is_ok();
    let pieces: Vec<_> = word.split(is_mark).filter(|piece| !piece.is_empty()).collect();
    // Without brackets, the word may be two numbers, or one with a decimal comma.
    let is_decimal = !is_within
        && matches!(word.split_once(','), Some((one, other))
        if [one, other].iter().all(|digits| digits.trim_start_matches(['+', '-']).bytes().all(|b| b.is_ascii_digit())
            && digits.ends_with(|c: char| c.is_ascii_digit())));
    if is_decimal {
        None
    } else if pieces.iter().all(|piece| is_number(piece))
        || pieces.iter().skip(1).any(|piece| is_number(piece))
    {
        all(&is_mark)
    } else if word.contains('=') {
        all(&|c| c == '=' || c == ';')
    } else if word.ends_with([';', ',']) {
        Some((word.trim_end_matches([';', ',']).len()..word.len()).collect())
    } else {
        None
    }
}

/// Returns the channels of a colour with three or six hexadecimal digits.
fn colour(digits: &str) -> Option<[u8; 3]> {
    if !digits.bytes().all(|digit| digit.is_ascii_hexdigit()) {
        return None;
    }
    let level = |at: usize| u8::from_str_radix(&digits[at..at + 2], 16).ok();
    match digits.len() {
        3 => {
            let level = |at: usize| u8::from_str_radix(&digits[at..=at], 16).ok().map(|level| 17 * level);
            Some([level(0)?, level(1)?, level(2)?])
        }
        6 => Some([level(0)?, level(2)?, level(4)?]),
        _ => None,
    }
}

#[cfg(test)]
mod tests;
