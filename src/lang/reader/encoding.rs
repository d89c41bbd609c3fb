//! Decodes a file's bytes as a scene's text, or reports errors.

use super::fault::Fault;
use super::report::Report;
use crate::syntax::Syntax;

/// The number of pairs of bytes for recognising UTF-16 without a byte order mark, and the minimum number.
const PAIRS: [usize; 2] = [8, 256];

/// Decodes a file's bytes as UTF-8 text.
///
/// # Errors
/// Returns the probable encoding of the text, or the first place that is not UTF-8 text.
pub fn decode<'b>(name: &str, bytes: &'b [u8]) -> Result<&'b str, Report<'static>> {
    if let Some(encoding) = utf_16(bytes) {
        let mut report = Report::new(name, String::new(), Syntax::default());
        report.add(Fault::error(None, format!("the scene is encoded in {encoding}, not in UTF-8")).help(
            format!(
                "save it again as UTF-8 in your editor, or convert it with `iconv -f {encoding} -t UTF-8`"
            ),
        ));
        return Err(report);
    }
    let nul = if bytes.contains(&0) { bytes.iter().position(|byte| *byte == 0) } else { None };
    let bad = match (std::str::from_utf8(bytes), nul) {
        (Ok(text), None) => return Ok(text.strip_prefix('\u{feff}').unwrap_or(text)),
        (text, _) => text.err().map(|error| error.valid_up_to()),
    };
    let (place, message) = match bad {
        Some(bad) if nul.is_none_or(|nul| bad < nul) => match windows_1252(bytes, bad) {
            Some((encoding, text)) => return Err(in_one_byte(name, bad, encoding, text)),
            None => (bad..bad + char::REPLACEMENT_CHARACTER.len_utf8(), "invalid UTF-8"),
        },
        _ => {
            let nul = nul.unwrap_or_default();
            (nul..nul + 1, "unexpected NUL byte")
        }
    };
    // Up to the error, the lossy text has the same bytes.
    let mut report = Report::new(name, String::from_utf8_lossy(bytes).into_owned(), Syntax::default());
    let help = "a scene is plain text, a sequence of entities `TYPE NAME { ATTRIBUTES }`";
    report.add(Fault::error(Some(place), message).help(help));
    Err(report)
}

/// Returns the probable encoding of a text that is not UTF-8.
pub fn other(bytes: &[u8]) -> Option<&'static str> {
    let bad = std::str::from_utf8(bytes).err().map(|error| error.valid_up_to());
    let in_one_byte = || windows_1252(bytes, bad?).map(|(encoding, _)| encoding);
    utf_16(bytes).or_else(in_one_byte)
}

/// Returns the encoding of a text in UTF-16, which has a byte order mark, or zeros in nearly every other byte.
fn utf_16(bytes: &[u8]) -> Option<&'static str> {
    match bytes {
        [0xff, 0xfe, rest @ ..] if rest.len() % 2 == 0 => return Some("UTF-16"),
        [0xfe, 0xff, rest @ ..] if rest.len() % 2 == 0 => return Some("UTF-16"),
        _ => {}
    }
    let [least, most] = PAIRS;
    let pairs = bytes.chunks_exact(2).take(most);
    let count = pairs.len();
    let zeros = |at: usize| pairs.clone().filter(|pair| pair[at] == 0 && pair[1 - at] != 0).count();
    let is_most = |zeros: usize| count >= least && 8 * zeros >= 7 * count;
    match [zeros(0), zeros(1)].map(is_most) {
        [true, _] => Some("UTF-16BE"),
        [_, true] => Some("UTF-16LE"),
        _ => None,
    }
}

/// Reads bytes as text with one byte per character, and returns the encoding. The first byte that is not ASCII is at
/// `bad`. Returns `None` for control characters, which are not text.
fn windows_1252(bytes: &[u8], bad: usize) -> Option<(&'static str, String)> {
    let is_text = |byte: &u8| !byte.is_ascii_control() || matches!(byte, b'\t' | b'\n' | b'\r' | 0x0c);
    if !bytes[..bad].is_ascii() || !bytes.iter().all(is_text) {
        return None;
    }
    let is_latin = !bytes.iter().any(|byte| (0x80..0xa0).contains(byte));
    let letter = |byte: &u8| match byte {
        0x80 => '€',
        0x91 => '‘',
        0x92 => '’',
        0x93 => '“',
        0x94 => '”',
        0x96 => '–',
        0x97 => '—',
        0x81..0xa0 => char::REPLACEMENT_CHARACTER,
        byte => char::from(*byte),
    };
    Some((if is_latin { "Latin-1" } else { "Windows-1252" }, bytes.iter().map(letter).collect()))
}

fn in_one_byte(name: &str, bad: usize, encoding: &str, text: String) -> Report<'static> {
    let letter = text[bad..].chars().next().unwrap_or_default();
    let place = bad..bad + letter.len_utf8();
    let mut report = Report::new(name, text, Syntax::default());
    let message = format!("the scene is not encoded in UTF-8, but probably in {encoding}");
    let label = format!("`{letter}`, if it is {encoding}");
    report.add(Fault::error(Some(place), message).label(label).help(format!(
        "save it again as UTF-8 in your editor, or convert it with `iconv -f {} -t UTF-8`",
        encoding.to_uppercase().replace("LATIN-1", "LATIN1")
    )));
    report
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn utf_16_is_recognised_by_its_mark_or_by_its_zeros() {
        let units: Vec<u16> = "camera eye { pixeldim 8 6 }".encode_utf16().collect();
        let little: Vec<u8> = units.iter().flat_map(|unit| unit.to_le_bytes()).collect();
        let big: Vec<u8> = units.iter().flat_map(|unit| unit.to_be_bytes()).collect();
        assert_eq!(utf_16(&little), Some("UTF-16LE"));
        assert_eq!(utf_16(&big), Some("UTF-16BE"));
        assert_eq!(utf_16(&[&[0xff, 0xfe][..], &little].concat()), Some("UTF-16"));
        assert_eq!(utf_16(b"camera eye { pixeldim 8 6 }"), None);
        assert_eq!(utf_16(&[0; 64]), None);
        assert_eq!(utf_16(&little[..8]), None, "too short to tell");
    }
}
