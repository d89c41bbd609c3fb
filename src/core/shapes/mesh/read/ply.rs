//! PLY, in text and in bytes of either order.

use super::model::{MemoryBudget, Model, ReadError};
use super::ply_header::{Encoding, Header, header};
use super::{ply_bytes, ply_text};

/// Reads a file.
pub fn read(bytes: &[u8], budget: &MemoryBudget) -> Result<Model, ReadError> {
    let Header { encoding, sections, rest, line } = header(bytes)?;
    let (mut model, polygons) = match encoding {
        Encoding::Ascii => ply_text::read(rest, line, &sections, budget),
        Encoding::LittleEndian => ply_bytes::read::<false>(bytes, rest, &sections, budget),
        Encoding::BigEndian => ply_bytes::read::<true>(bytes, rest, &sections, budget),
    }?;
    polygons.cut(&mut model);
    Ok(model)
}

/// Tells whether a file is a text.
pub fn is_text(bytes: &[u8]) -> bool {
    header(bytes).is_ok_and(|header| header.encoding == Encoding::Ascii)
}
