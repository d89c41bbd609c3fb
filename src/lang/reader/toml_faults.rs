//! The syntax errors of a scene in TOML, and the pieces for parsing a scene that has some.

use super::fault::Fault;
use std::iter;
use std::ops::Range;
use toml::de::Error;

/// The maximum length of a line, and of a part of a text that is parsed at once before the whole text is known to be
/// valid, in bytes. For each token and each error, the parser uses many times the memory of its text.
pub const LINE: usize = 1 << 16;
const PART: usize = 1 << 17;

/// A syntax error: its place and its message.
pub type SyntaxError = (Range<usize>, String);

pub fn is_duplicate(error: &Error) -> bool {
    error.message() == DUPLICATE
}

const DUPLICATE: &str = "duplicate key";

/// Returns the ends of the lines before a line that begins with a bracket.
pub fn before_titles(text: &str) -> Vec<usize> {
    text.match_indices("\n[").map(|(at, _)| at).collect()
}

/// Returns the first syntax error of each line, in order. Later errors on a line mostly follow from the first.
pub fn places(errors: &[Error], text: &str, titles: &[usize]) -> Vec<SyntaxError> {
    let place = |error: &Error| {
        let place = error.span().unwrap_or(text.len()..text.len());
        // The range of a missing token between two others may end before it begins.
        place.start.min(place.end)..place.start.max(place.end)
    };
    let mut places: Vec<_> = errors.iter().map(|error| (place(error), error.message().to_owned())).collect();
    places.sort_by_key(|(place, _)| place.start);
    let mut end = 0;
    let mut second_title = 0..0;
    places.retain(|(place, message)| {
        // Duplicates below a repeated title follow from the title, and are not reported.
        if message == DUPLICATE {
            let line = text[..place.start].rfind('\n').map_or(0, |end| end + 1);
            if text[line..].starts_with('[') {
                second_title = place.end..next(titles, place.end).unwrap_or(text.len());
            }
            if second_title.contains(&place.start) {
                return false;
            }
        }
        let is_first = place.start >= end;
        if is_first {
            end = text[place.start..].find('\n').map_or(text.len() + 1, |length| place.start + length + 1);
        }
        is_first
    });
    places
}

/// Returns the first of these sorted positions from `from` on.
pub fn next(places: &[usize], from: usize) -> Option<usize> {
    places.get(places.partition_point(|place| *place < from)).copied()
}

/// Converts a syntax error to a fault.
pub fn fault_of(place: Range<usize>, message: &str, text: &str) -> Fault {
    let before = &text[..place.start];
    let begins_line = before.rfind('\n').is_some_and(|end| before[end..].trim().is_empty());
    let (place, message, help) = match message {
        DUPLICATE => {
            let key = text[place.clone()].to_owned();
            let help = "a table or an attribute may appear only once; for lights that share a name, write `[[TYPE.NAME]]`";
            (place, format!("duplicate `{key}`"), help)
        }
        _ if message.contains("array") && (begins_line || place.start == text.len()) => {
            let end = before.trim_end().len();
            (end..end, "missing `]`".to_owned(), "several values go in brackets: `center = [4, 2, -4]`")
        }
        _ if message.starts_with("string values") => {
            (place, "unquoted word".to_owned(), "names need quotes: `material = \"red\"`")
        }
        _ if message.starts_with("key with no value") => {
            (place, "missing `=`".to_owned(), "write attributes as `NAME = VALUE`")
        }
        _ => {
            (place, message.to_owned(), "a value is a number, a quoted word, or several of them in brackets")
        }
    };
    Fault::error(Some(place), message).help(help)
}

/// Finds the first line that is too long.
pub fn long_line(text: &str) -> Option<Range<usize>> {
    let mut at = 0;
    let mut lines = text.split('\n').map(|line| {
        at += line.len() + 1;
        at - 1 - line.len()..at - 1
    });
    lines.find(|line| line.len() > LINE)
}

/// Tells whether a line is the title of an entity.
pub fn is_title(line: &str) -> bool {
    let line = line.split('#').next().unwrap_or_default().trim();
    let name = line.strip_prefix('[').and_then(|line| line.strip_suffix(']'));
    name.is_some_and(|name| name.contains('.') && !name.contains([',', '=']))
}

/// Splits a text into parts that can be parsed at once, each of as many pieces as fit. A short text is one part.
pub fn parts(text: &str) -> Vec<Range<usize>> {
    if text.len() <= PART {
        return iter::once(0..text.len()).collect();
    }
    let mut parts = pieces(text);
    parts.dedup_by(|next, part| {
        let fits = next.end - part.start <= PART;
        if fits {
            part.end = next.end;
        }
        fits
    });
    parts
}

/// Splits a text before each title, and before other lines if there is no title for a long time.
pub fn pieces(text: &str) -> Vec<Range<usize>> {
    let mut starts = vec![0];
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        let is_long = at + line.len() - starts[starts.len() - 1] > PART;
        if at > 0 && (is_long || is_title(line)) {
            starts.push(at);
        }
        at += line.len();
    }
    let ends = starts[1..].iter().copied().chain([text.len()]);
    starts.iter().copied().zip(ends).map(|(start, end)| start..end).collect()
}
