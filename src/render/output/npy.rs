//! The header of a file with a NumPy array ("NPY format", version 1).

use std::io::{self, Write};

/// The first bytes of each file.
pub const MAGIC: &[u8] = b"\x93NUMPY";

/// Writes the header of an array with this type and shape, both as NumPy writes them: `'<f8'` and `(3, 4)`.
///
/// # Errors
/// Returns the errors of `out`.
pub fn begin(descr: &str, shape: &str, out: &mut dyn Write) -> io::Result<()> {
    let head = format!("{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}, }}");
    // The numbers begin at a multiple of 64 bytes.
    let length = (MAGIC.len() + 4 + head.len() + 1).next_multiple_of(64) - MAGIC.len() - 4;
    out.write_all(MAGIC)?;
    out.write_all(&[1, 0])?;
    out.write_all(&(length as u16).to_le_bytes())?;
    writeln!(out, "{head:0$}", length - 1)
}
