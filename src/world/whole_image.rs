//! Whether the file of an image is whole, for formats whose decoders make do with what there is.

use crate::files::ImageBytes;
use image::ImageFormat;
use std::io::{self, ErrorKind, SeekFrom};

/// Tells whether the file of an image has its end, as far as its format shows. Begins anywhere, and ends at the start.
///
/// # Errors
/// Returns the errors of the system.
pub(super) fn has_end(format: ImageFormat, bytes: &mut dyn ImageBytes, length: u64) -> io::Result<bool> {
    bytes.rewind()?;
    let has_end = match format {
        ImageFormat::Jpeg => has_end_of_jpeg(bytes),
        ImageFormat::WebP => has_end_of_riff(bytes, length),
        _ => Ok(true),
    };
    bytes.rewind()?;
    match has_end {
        Err(error) if error.kind() == ErrorKind::UnexpectedEof => Ok(false),
        has_end => has_end,
    }
}

/// Looks for the marker at the end of a JPEG, which is not that of a thumbnail within one of its segments
/// (ITU-T T.81, annex B).
fn has_end_of_jpeg(bytes: &mut dyn ImageBytes) -> io::Result<bool> {
    let mut marker = [0];
    while bytes.skip_until(0xff)? > 0 {
        bytes.read_exact(&mut marker)?;
        while marker[0] == 0xff {
            bytes.read_exact(&mut marker)?;
        }
        match marker[0] {
            0xd9 => return Ok(true),
            // Part of the coded data, or a marker without a segment.
            0x00 | 0x01 | 0xd0..=0xd8 => {}
            _ => {
                let mut length = [0; 2];
                bytes.read_exact(&mut length)?;
                let rest = i64::from(u16::from_be_bytes(length)).saturating_sub(2).max(0);
                bytes.seek(SeekFrom::Current(rest))?;
            }
        }
    }
    Ok(false)
}

/// Compares the length of a RIFF file with the one that its header gives.
fn has_end_of_riff(bytes: &mut dyn ImageBytes, length: u64) -> io::Result<bool> {
    let mut header = [0; 8];
    bytes.read_exact(&mut header)?;
    let [.., a, b, c, d] = header;
    Ok(8 + u64::from(u32::from_le_bytes([a, b, c, d])) <= length)
}
