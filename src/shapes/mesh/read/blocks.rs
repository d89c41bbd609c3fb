//! Lines of a text, and blocks of lines for reading on all cores.

use super::model::ReadError;
use memchr::{memchr, memchr_iter, memrchr};
use std::mem::replace;
use std::ops::Add;
use tabray_world::parallel;

/// The approximate length of a block in bytes.
const BLOCK: usize = 1 << 17;

/// The number of blocks for each thread that are read before their contents are merged. It is small, because these
/// contents are held twice.
const BLOCKS_PER_THREAD: usize = 2;

/// Cuts a text into blocks of whole lines. The last line of a block does not continue in the next block, as `continues`
/// tells.
struct Blocks<'b> {
    rest: &'b [u8],
    continues: fn(&[u8]) -> bool,
}

impl<'b> Iterator for Blocks<'b> {
    type Item = &'b [u8];

    fn next(&mut self) -> Option<&'b [u8]> {
        let mut end = BLOCK.min(self.rest.len());
        while let Some(line) = memchr(b'\n', &self.rest[end..]) {
            let start = memrchr(b'\n', &self.rest[..end]).map_or(0, |start| start + 1);
            let is_whole = !(self.continues)(&self.rest[start..end + line]);
            end += line + 1;
            if is_whole {
                let (block, rest) = self.rest.split_at(end);
                self.rest = rest;
                return Some(block);
            }
        }
        Some(std::mem::take(&mut self.rest)).filter(|block| !block.is_empty())
    }
}

/// The number of lines of a block, or the first error in it with the number of its line, from 1.
pub(super) type Lines = Result<usize, (usize, String)>;

/// Reads a text block by block on all cores. `count` counts elements in a block, `read` reads a block up to the first
/// error, given the count before it, and `take` receives what it has read in the order of the text, with the number of
/// lines before it, which is `line` at first.
pub(super) fn read<T: Send, C: Add<Output = C> + Copy + Default + Send + Sync>(
    text: &[u8],
    line: &mut usize,
    continues: fn(&[u8]) -> bool,
    count: impl Fn(&[u8]) -> C + Sync,
    read: impl Fn(&[u8], C) -> (T, Lines) + Sync,
    mut take: impl FnMut(T, usize) -> Result<(), ReadError>,
) -> Result<(), ReadError> {
    let mut blocks = Blocks { rest: text, continues };
    let mut before = C::default();
    loop {
        let some: Vec<_> = blocks.by_ref().take(BLOCKS_PER_THREAD * parallel::threads()).collect();
        if some.is_empty() {
            return Ok(());
        }
        let counts = parallel::map(some.len(), |block| count(some[block]));
        let befores: Vec<_> = counts
            .into_iter()
            .map(|count| {
                let sum = before + count;
                replace(&mut before, sum)
            })
            .collect();
        let parts = parallel::map(some.len(), |block| read(some[block], befores[block]));
        for (part, lines) in parts {
            take(part, *line)?;
            *line += lines.map_err(|(number, message)| ReadError::line(*line + number, message))?;
        }
    }
}

/// Tells that no line continues in the next one.
pub(super) fn never(_: &[u8]) -> bool {
    false
}

/// Returns the number of line ends.
pub(super) fn line_ends(text: &[u8]) -> usize {
    memchr_iter(b'\n', text).count()
}

/// Returns the lines of a text, without their ends.
pub(super) fn lines(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut rest = Some(text).filter(|text| !text.is_empty());
    std::iter::from_fn(move || {
        let text = rest?;
        let end = memchr(b'\n', text);
        rest = end.map(|end| &text[end + 1..]).filter(|rest| !rest.is_empty());
        Some(&text[..end.unwrap_or(text.len())])
    })
}

/// Calls `each` with the number of each line, from 1, and the line, until an error.
pub(super) fn each_line(text: &[u8], mut each: impl FnMut(usize, &[u8]) -> Result<(), String>) -> Lines {
    lines(text).enumerate().try_fold(0, |_, (before, line)| {
        let number = before + 1;
        each(number, line).map(|()| number).map_err(|message| (number, message))
    })
}

/// Tells whether a text ends within a number, as far as that can be seen.
pub(super) fn ends_within_number(text: &[u8]) -> bool {
    matches!(text.last(), Some(b'.' | b'e' | b'E' | b'+' | b'-' | b'/'))
}

/// Tells whether a byte is white space, including a vertical tab.
pub(super) fn is_blank(byte: &u8) -> bool {
    matches!(byte, b' ' | b'\t'..=b'\r')
}

/// The words of a text, separated by white space.
#[derive(Clone)]
pub(super) struct Words<'w> {
    /// The text after the last word that was returned.
    pub rest: &'w [u8],
}

impl<'w> Iterator for Words<'w> {
    type Item = &'w [u8];

    #[inline]
    fn next(&mut self) -> Option<&'w [u8]> {
        let start = self.rest.iter().position(|byte| !is_blank(byte)).unwrap_or(self.rest.len());
        let word = &self.rest[start..];
        let (word, rest) = word.split_at(word.iter().position(is_blank).unwrap_or(word.len()));
        self.rest = rest;
        Some(word).filter(|word| !word.is_empty())
    }
}

/// Returns the words of a text.
pub(super) fn words(text: &[u8]) -> Words<'_> {
    Words { rest: text }
}

/// Replaces single carriage returns, the line ends of old programs, with newlines.
pub(super) fn end_lines(text: &mut [u8]) {
    let mut at = 0;
    while let Some(next) = memchr(b'\r', &text[at..]) {
        at += next + 1;
        if text.get(at) != Some(&b'\n') {
            text[at - 1] = b'\n';
        }
    }
}
