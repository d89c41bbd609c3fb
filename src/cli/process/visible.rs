//! Output that shows what is not seen as escapes.

use std::fmt;
use std::io::{self, Write};
use tabray_core::text;

/// Writes formatted text to another writer, as [`text::visible_lines`] shows it.
pub struct Visible<'w>(pub &'w mut dyn Write);

impl Write for Visible<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes)
    }

    fn write_fmt(&mut self, words: fmt::Arguments<'_>) -> io::Result<()> {
        self.0.write_all(text::visible_lines(&words.to_string()).as_bytes())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}
