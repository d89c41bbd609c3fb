//! Small helps for messages: the word that was meant, lists of words, reasons, and texts for programs.

use clap::ValueEnum;
use image::ImageError;
use serde::Serialize;
use std::io;
use std::panic::Location;
use std::path::Path;

/// The word of `known` that `word` was most likely meant to be.
pub fn nearest<'k>(word: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    let lower = word.to_lowercase();
    known
        .into_iter()
        .map(|candidate| (strsim::damerau_levenshtein(&lower, candidate), candidate))
        .filter(|(distance, candidate)| *distance <= candidate.len().max(lower.len()).div_ceil(3))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

/// The file that a path which leads nowhere was most likely meant to lead to: the name of one in the same folder.
pub fn nearest_file(path: &Path) -> Option<String> {
    let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    let entries = folder.read_dir().ok()?.filter_map(Result::ok);
    let mut names: Vec<_> = entries.filter_map(|entry| entry.file_name().into_string().ok()).collect();
    // A folder hands them out in any order.
    names.sort();
    nearest(path.file_name()?.to_str()?, names.iter().map(String::as_str)).map(str::to_owned)
}

/// Why the system refused something: lower case, without its number.
pub fn reason(error: &io::Error) -> String {
    let text = error.to_string();
    let text = text.split(" (os error").next().unwrap_or_default();
    match text.as_bytes() {
        [first, second, ..] if second.is_ascii_lowercase() => {
            char::from(first.to_ascii_lowercase()).to_string() + text.get(1..).unwrap_or_default()
        }
        _ => text.to_owned(),
    }
}

/// Why a file gives no picture.
pub fn picture_reason(error: &ImageError) -> String {
    match error {
        ImageError::IoError(error) if error.kind() != io::ErrorKind::UnexpectedEof => reason(error),
        ImageError::Unsupported(_) => "it is not a PPM or PNG image".to_owned(),
        ImageError::Limits(_) => "it is too large".to_owned(),
        _ => "it is corrupt".to_owned(),
    }
}

/// The file and line of a plugin that registers something.
pub fn place(location: &Location<'_>) -> String {
    let file = location.file().replace('\\', "/");
    format!("{}:{}", file.strip_prefix("src/../").unwrap_or(&file), location.line())
}

/// Words in backticks, commas between them.
pub fn list<'w>(words: impl IntoIterator<Item = &'w str>) -> String {
    words.into_iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ")
}

/// A number that is not below 0 to three digits.
pub fn short(number: f64) -> String {
    if number == 0.0 || (1e-3..1e6).contains(&number) {
        let digits = if number < 1e-2 {
            5
        } else if number < 100.0 {
            3
        } else {
            0
        };
        let text = format!("{number:.digits$}");
        if digits > 0 { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    } else {
        format!("{number:.2e}")
    }
}

/// A count with its noun: `1 error`, `2 errors`.
pub fn count(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// A value as JSON, on one line. Its type says which fields it has, in the order in which they are written.
pub fn json(value: &impl Serialize) -> String {
    serde_json::to_string(value).expect(NAMED)
}

/// A value as JSON, with a field on each line, the last one ended.
pub fn json_in_lines(value: &impl Serialize) -> String {
    serde_json::to_string_pretty(value).expect(NAMED) + "\n"
}

const NAMED: &str = "only a map whose keys are no names has no JSON";

/// What the command line calls one of several values.
pub fn name(value: &impl ValueEnum) -> String {
    value.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
}

/// A text with a capital for its first letter.
pub fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}
