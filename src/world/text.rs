//! Small helpers for the text of messages: guesses at misspelt words, lists of words, reasons, and JSON.

use crate::files;
use image::error::ImageFormatHint;
use image::{ImageError, ImageFormat};
use serde::Serialize;
use std::borrow::Cow;
use std::ffi::OsStr;
use std::io;
use std::ops::RangeInclusive;
use std::panic::Location;
use std::path::Path;

pub use tabray_exact::text::{count, list, shortest};

/// The longest word for which a guess is made, in bytes. Names are shorter, so a longer word is not a misspelt name.
const MAX_LENGTH: usize = 128;

/// The budget of one search for the word that was meant, in pairs of letters to compare: enough for about 1,000 names
/// of 8 letters, and about a millisecond.
const BUDGET: usize = 1 << 16;

/// Returns the word of `known` that `word` was most likely meant to be, as far as `BUDGET` allows finding it.
pub fn nearest<'k>(word: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    if word.len() > MAX_LENGTH {
        return None;
    }
    let lower = word.to_lowercase();
    let letters = lower.chars().count();
    let mut left = BUDGET;
    known
        .into_iter()
        .filter_map(|candidate| {
            let max_distance = candidate.len().max(lower.len()).div_ceil(3);
            let count = if candidate.len() > MAX_LENGTH { usize::MAX } else { candidate.chars().count() };
            // Each letter of difference in length costs one edit.
            if count.abs_diff(letters) > max_distance {
                return None;
            }
            left = left.checked_sub(count * letters)?;
            let distance = strsim::damerau_levenshtein(&lower, candidate);
            // Among words that are equally far, a word to which letters were added comes first, and then the word with
            // more letters in the same places.
            let unlike = || match lower.starts_with(candidate) || lower.ends_with(candidate) {
                true => 0.0,
                false => 1.0 - strsim::jaro(&lower, candidate),
            };
            (distance <= max_distance).then(|| (distance, unlike(), candidate))
        })
        .min_by(|one, other| one.0.cmp(&other.0).then(one.1.total_cmp(&other.1)))
        .map(|(_, _, candidate)| candidate)
}

/// The longest run of letters without white space that a message shows in full, in bytes, and how many bytes of a
/// longer run are kept at its beginning and at its end.
const RUN: (usize, [usize; 2]) = (120, [64, 24]);

/// The longest message that is shown in full, in bytes, and how many bytes of a longer message are kept at its
/// beginning and at its end.
const MESSAGE: (usize, [usize; 2]) = (4000, [1600, 400]);

/// Shortens a message that is too long to be read: a word of a scene may be as long as its file.
pub fn abridged(text: &str) -> Cow<'_, str> {
    if text.len() <= RUN.0 {
        return Cow::Borrowed(text);
    }
    let mut short = String::new();
    for part in text.split_inclusive(char::is_whitespace) {
        short += &cut(part, RUN);
        // What comes later is cut off in any case, except for the end.
        if short.len() > 8 * MESSAGE.0 {
            short += &cut(&text[boundary(text, text.len() - MESSAGE.1[1])..], RUN);
            break;
        }
    }
    Cow::Owned(cut(&short, MESSAGE).into_owned())
}

fn cut(text: &str, (max_len, [first, last]): (usize, [usize; 2])) -> Cow<'_, str> {
    if text.len() <= max_len {
        return Cow::Borrowed(text);
    }
    let [first, last] = [first, text.len() - last].map(|at| boundary(text, at));
    Cow::Owned(format!("{}…{}", &text[..first], &text[last..]))
}

/// Characters, besides control characters, that have no width, change the direction of text, or end a line.
const UNSEEN: [RangeInclusive<char>; 15] = [
    '\u{ad}'..='\u{ad}',
    '\u{34f}'..='\u{34f}',
    '\u{61c}'..='\u{61c}',
    '\u{115f}'..='\u{1160}',
    '\u{17b4}'..='\u{17b5}',
    '\u{180b}'..='\u{180f}',
    '\u{200b}'..='\u{200f}',
    '\u{2028}'..='\u{202e}',
    '\u{2060}'..='\u{206f}',
    '\u{3164}'..='\u{3164}',
    '\u{fe00}'..='\u{fe0f}',
    '\u{feff}'..='\u{feff}',
    '\u{ffa0}'..='\u{ffa0}',
    '\u{fff0}'..='\u{fffb}',
    '\u{e0000}'..='\u{e0fff}',
];

/// Tells whether a character is invisible or a control character.
pub fn is_unseen(letter: char) -> bool {
    letter.is_control() || letter > '~' && UNSEEN.iter().any(|range| range.contains(&letter))
}

/// Escapes invisible characters as `\u{200b}`, and line ends as `\n`: a word with an invisible character looks like
/// another word, and a control character commands the terminal.
pub fn visible(text: &str) -> Cow<'_, str> {
    visible_but(text, &[])
}

/// Escapes invisible characters as [`visible`] does, but keeps line ends and tabs, for texts that people read on a
/// terminal or on a page.
pub fn visible_lines(text: &str) -> Cow<'_, str> {
    visible_but(text, &['\n', '\t'])
}

fn visible_but<'t>(text: &'t str, kept: &[char]) -> Cow<'t, str> {
    let is_shown = |letter: char| !is_unseen(letter) || kept.contains(&letter);
    let Some(first) = text.find(|letter| !is_shown(letter)) else { return Cow::Borrowed(text) };
    let mut shown = text[..first].to_owned();
    for letter in text[first..].chars() {
        if is_shown(letter) {
            shown.push(letter);
        } else {
            shown.extend(letter.escape_default());
        }
    }
    Cow::Owned(shown)
}

/// Shows a path, or another string of the system: as [`visible`] does, with bytes that are not UTF-8 as `\xff`.
pub fn shown(word: impl AsRef<OsStr>) -> String {
    let mut shown = String::new();
    for chunk in word.as_ref().as_encoded_bytes().utf8_chunks() {
        shown += &visible(chunk.valid());
        shown.extend(chunk.invalid().iter().map(|byte| format!("\\x{byte:02x}")));
    }
    shown
}

/// Returns the last character boundary of a text that is not after byte `at`.
pub fn boundary(text: &str, at: usize) -> usize {
    (0..=at.min(text.len())).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0)
}

/// Quotes a word of a command for a shell. Invisible characters, and bytes that are not UTF-8, are written as
/// `$'\033'`, which bash, zsh, and POSIX of 2024 can read.
pub fn quoted(word: &OsStr) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "_-./:=+,@%".contains(c);
    match word.to_str() {
        Some(word) if !word.is_empty() && word.chars().all(is_plain) => word.to_owned(),
        Some(word) if !word.contains(is_unseen) => format!("'{}'", word.replace('\'', r"'\''")),
        _ => {
            let seen = |byte: u8| match byte {
                b'\'' | b'\\' => format!("\\{}", char::from(byte)),
                b' '..=b'~' => char::from(byte).to_string(),
                // Three octal digits: a shell may read more than two hexadecimal ones.
                byte => format!("\\{byte:03o}"),
            };
            format!("$'{}'", word.as_encoded_bytes().iter().map(|byte| seen(*byte)).collect::<String>())
        }
    }
}

/// Kinds of files by the extensions of their names. None is meant by the name of another: `knot.obj` names `knot.mtl`,
/// `knot.gltf` names `knot.bin`.
const KINDS: [&[&str]; 5] = [
    &["ray", "toml", "txt"],
    &["obj", "ply", "stl", "gltf", "glb"],
    &["mtl"],
    &["bin"],
    &["png", "jpg", "jpeg", "ppm", "pgm", "bmp", "tif", "tiff", "tga", "webp", "gif", "hdr", "exr", "pfm"],
];

/// Returns the name of the file in the same folder that was probably meant by the path of a missing file.
pub fn nearest_file(path: &Path) -> Option<String> {
    let kind = |name: &Path| {
        let ending = name.extension()?.to_str()?.to_lowercase();
        KINDS.iter().position(|kind| kind.contains(&&ending[..]))
    };
    let wanted = kind(path);
    let may_be_meant = |name: &String| match (wanted, kind(Path::new(name))) {
        (Some(wanted), Some(kind)) => kind == wanted,
        _ => true,
    };
    let entries = files::read_dir(path.parent().unwrap_or(Path::new(""))).ok()?.filter_map(Result::ok);
    let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
    let mut names: Vec<_> = names.filter(may_be_meant).collect();
    // A folder lists its files in any order.
    names.sort_unstable();
    nearest(path.file_name()?.to_str()?, names.iter().map(String::as_str)).map(str::to_owned)
}

/// Returns why the system refused an operation: in lower case, without the error's number.
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

/// The message about a file that is not an image.
pub const NO_IMAGE: &str = "it is not an image that can be read";

/// The message about a file of a format that is not read, or not in all its kinds.
pub(super) fn not_read(format: ImageFormat) -> String {
    let name = format.extensions_str().first().unwrap_or(&"").to_uppercase();
    let what = if format.reading_enabled() { " of a kind" } else { "" };
    format!("it is a {name}{what}, which is not read: save it as PNG")
}

/// Returns why a file could not be read as an image.
pub fn picture_reason(error: &ImageError) -> String {
    match error {
        ImageError::IoError(error) if error.kind() != io::ErrorKind::UnexpectedEof => reason(error),
        ImageError::Unsupported(error) => match error.format_hint() {
            ImageFormatHint::Exact(format) => not_read(format),
            _ => NO_IMAGE.to_owned(),
        },
        ImageError::Limits(_) => "it is too large".to_owned(),
        _ => "it is corrupt".to_owned(),
    }
}

/// Returns the file and line of a source position; for a plugin of this workspace, the path from its top folder.
pub fn place(location: &Location<'_>) -> String {
    format!("{}:{}", location.file().replace('\\', "/"), location.line())
}

/// Lists words in prose: `x`, `x and y`, `x, y and z`.
pub fn and(words: &[&str]) -> String {
    match words {
        [words @ .., last] if !words.is_empty() => format!("{} and {last}", words.join(", ")),
        words => words.concat(),
    }
}

/// Returns the plural of a noun: `methods`, `choices of materials`.
pub fn plural(noun: &str) -> String {
    match noun.split_once(" of ") {
        Some((noun, rest)) => format!("{noun}s of {rest}"),
        None => format!("{noun}s"),
    }
}

/// Returns the article of a word in lower case: `a` or `an`.
pub fn article(word: &str) -> &'static str {
    let mut letters = word.chars();
    let (first, second) = (letters.next().unwrap_or(' '), letters.next().unwrap_or(' '));
    let begins_with_vowel = match first {
        'a' | 'e' | 'i' | 'o' => true,
        // `union` begins as `you` does.
        'u' => !word.starts_with("uni"),
        // Before most consonants, the letter is spoken by its name: `fplane`, `rgb`.
        'f' => !"aeiouylr".contains(second),
        'h' | 'l' | 'm' | 'n' => !"aeiouy".contains(second),
        'r' => !"aeiouyh".contains(second),
        _ => false,
    };
    if begins_with_vowel { "an" } else { "a" }
}

/// Returns a word in lower case with its article: `a light`, `an object`.
pub fn with_article(word: &str) -> String {
    format!("{} {word}", article(word))
}

/// Writes a number that is not below 0 to about three significant digits.
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

/// Writes a value as JSON on one line. The fields stand in the order in which its type declares them. Invisible
/// characters are escaped.
pub fn json(value: &impl Serialize) -> String {
    escaped(serde_json::to_string(value).expect(NAMED))
}

/// Writes a value as JSON with a field on each line, and a line end after the last.
pub fn json_in_lines(value: &impl Serialize) -> String {
    escaped(serde_json::to_string_pretty(value).expect(NAMED)) + "\n"
}

/// Escapes the invisible characters of JSON. Except for line ends between values, such characters can stand only in
/// strings.
fn escaped(json: String) -> String {
    let is_shown = |letter: char| letter == '\n' || !is_unseen(letter);
    if json.chars().all(is_shown) {
        return json;
    }
    let mut escaped = String::with_capacity(json.len());
    for letter in json.chars() {
        if is_shown(letter) {
            escaped.push(letter);
        } else {
            let units = letter.encode_utf16(&mut [0; 2]).to_vec();
            escaped.extend(units.iter().map(|unit| format!("\\u{unit:04x}")));
        }
    }
    escaped
}

const NAMED: &str = "only a map whose keys are no names has no JSON";

/// Writes a SHA-256: `sha256:` and its hexadecimal digits.
pub fn sha256(hash: &[u8]) -> String {
    let digits: String = hash.iter().map(|byte| format!("{byte:02x}")).collect();
    format!("sha256:{digits}")
}

/// A type with few values, which people choose by name.
pub trait Named: Copy + PartialEq + 'static {
    /// All values, in the order in which they are listed.
    const ALL: &'static [Self];

    /// Returns the value's name.
    fn name(self) -> &'static str;

    /// Returns the value with this name.
    fn of_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|value| value.name() == name)
    }
}

/// Names all values of a type, each once, for [`Named`].
#[macro_export]
macro_rules! named {
    ($type:ty { $($value:ident => $name:literal),+ $(,)? }) => {
        impl $crate::text::Named for $type {
            const ALL: &'static [Self] = &[$(Self::$value),+];

            fn name(self) -> &'static str {
                match self {
                    $(Self::$value => $name),+
                }
            }
        }
    };
}

/// Returns a text with its first letter in upper case.
pub fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_of_words_that_are_equally_far_has_more_letters_in_the_same_places() {
        assert_eq!(nearest("plain", ["place", "plane"]), Some("plane"));
        assert_eq!(nearest("texmode", ["texname", "mode"]), Some("mode"));
    }

    #[test]
    fn what_is_not_seen_is_shown_as_an_escape_and_shown_words_stay() {
        for (word, told) in [
            ("a\x1b[2Jb", "a\\u{1b}[2Jb"),
            ("\u{9b}2J", "\\u{9b}2J"),
            ("a\nb\tc\x7f", "a\\nb\\tc\\u{7f}"),
            ("\u{202e}yar\u{2066}\u{200d}", "\\u{202e}yar\\u{2066}\\u{200d}"),
            ("Ä \\ 'é' 👍", "Ä \\ 'é' 👍"),
        ] {
            assert_eq!((&*visible(word), &*visible(told), shown(word)), (told, told, told.to_owned()));
            let json = json(&word);
            assert!(!json.contains(is_unseen), "{json}");
            assert_eq!(serde_json::from_str::<String>(&json).expect("JSON"), word);
        }
        assert_eq!(visible_lines("a\n\tb\r\x1b"), "a\n\tb\\r\\u{1b}");
    }

    #[cfg(unix)]
    #[test]
    fn words_for_a_shell_keep_every_byte_and_show_it() {
        use std::os::unix::ffi::OsStrExt;
        for (bytes, told) in [
            (&b"a.ray"[..], "a.ray"),
            (b"it's", r"'it'\''s'"),
            (b"a\x1b'\\b", r"$'a\033\'\\b'"),
            (b"\xff7", r"$'\3777'"),
        ] {
            assert_eq!(quoted(OsStr::from_bytes(bytes)), told);
        }
        assert_eq!(shown(OsStr::from_bytes(b"a\xff\xc3\xa4\xc3")), "a\\xff\u{e4}\\xc3");
    }

    #[test]
    fn articles_are_those_of_spoken_words() {
        for word in ["ellipsoid", "angle", "object", "image", "umbrella", "fplane", "hdr", "nx", "rgb"] {
            assert_eq!(article(word), "an", "{word}");
        }
        for word in
            ["union", "pplane", "frustum", "flute", "hyperboloid", "light", "mesh", "rhombus", "sphere", ""]
        {
            assert_eq!(article(word), "a", "{word}");
        }
    }
}
