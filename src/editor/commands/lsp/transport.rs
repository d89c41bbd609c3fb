//! Reads the messages of an editor. The length that one claims to have costs no memory before as much has come, and a
//! header that does not end is refused.

use super::documents::LARGEST;
use lsp_server::Message;
use std::io::{self, BufRead, Read};
use std::str;

/// The maximum length of a line of a header in bytes.
const LONGEST_LINE: u64 = 1 << 10;

/// The maximum length of a message in bytes: twice the largest text, which may have as many escapes as letters.
const LONGEST: u64 = 2 * LARGEST;

/// Reads the next message, or why what its header announces is none; `None` if there are no more.
///
/// # Errors
/// Those of the input; of kind `InvalidData`, with the reason, if it cannot be told where the next message begins.
pub fn read(input: &mut impl BufRead) -> io::Result<Option<Result<Message, String>>> {
    let wrong = |reason: String| io::Error::new(io::ErrorKind::InvalidData, reason);
    let mut length = None;
    loop {
        let mut line = Vec::new();
        input.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut line)?;
        if line.is_empty() {
            return Ok(None);
        }
        let line = str::from_utf8(&line).ok().and_then(|line| line.strip_suffix("\r\n"));
        if line == Some("") {
            break;
        }
        let Some((name, value)) = line.and_then(|line| line.split_once(':')) else {
            return Err(wrong("what it says is not preceded by a header".to_owned()));
        };
        if name.eq_ignore_ascii_case("Content-Length") {
            let value = value.trim();
            length = Some(value.parse().map_err(|_| wrong(format!("`{value}` is not a length")))?);
        }
    }
    let length: u64 = length.ok_or_else(|| wrong("a header has no `Content-Length`".to_owned()))?;
    if length > LONGEST {
        let skipped = io::copy(&mut input.by_ref().take(length), &mut io::sink())?;
        if skipped < length {
            return Err(wrong(format!("a message ends after {skipped} of {length} bytes")));
        }
        return Ok(Some(Err(format!("a message of {length} bytes is too long: the maximum is {LONGEST}"))));
    }
    let mut text = Vec::new();
    input.by_ref().take(length).read_to_end(&mut text)?;
    if (text.len() as u64) < length {
        return Err(wrong(format!("a message ends after {} of {length} bytes", text.len())));
    }
    Ok(Some(serde_json::from_slice(&text).map_err(|error| format!("this message is malformed: {error}"))))
}
