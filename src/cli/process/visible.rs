//! Output in which invisible characters are written as escapes.

use std::io::{self, Write};
use tabray_core::text;

/// Writes text to another writer, as [`text::visible_lines`] shows it. It takes whole pieces of text, as formatting hands
/// them out.
pub struct Visible<'w>(pub &'w mut dyn Write);

impl Write for Visible<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write_all(text::visible_lines(&String::from_utf8_lossy(bytes)).as_bytes())?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}
