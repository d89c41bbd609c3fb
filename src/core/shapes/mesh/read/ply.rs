//! PLY, in text and in bytes of either order.

use super::model::{MemoryBudget, Model, ReadError};
use super::ply_header::{Section, header, may_fit};
use super::{ply_bytes, ply_text};
use ply_rs_bw::ply::Encoding;

/// Reads a file.
pub fn read(bytes: &[u8], budget: &MemoryBudget) -> Result<Model, ReadError> {
    let (header, rest, line) = header(bytes)?;
    may_fit(&header, bytes.len())?;
    let vertices = header.elements.get("vertex").map_or(0, |element| element.count);
    let sections = header.elements.values().map(|element| Section::new(element, vertices));
    let sections = sections.collect::<Result<Vec<_>, _>>()?;
    match header.encoding {
        Encoding::Ascii => ply_text::read(rest, line, &sections, budget),
        Encoding::BinaryLittleEndian => ply_bytes::read::<false>(bytes, rest, &sections, budget),
        Encoding::BinaryBigEndian => ply_bytes::read::<true>(bytes, rest, &sections, budget),
    }
}
