//! PLY, as text and as bytes of either order.

use super::at_corners::{AtCorners, Attributes};
use super::model::{MemoryBudget, Model, ReadError, Wanted};
use super::ply_header::{Encoding, Header, header};
use super::{ply_bytes, ply_text};
use std::mem::take;

/// Reads a file.
pub fn read(bytes: &[u8], budget: &MemoryBudget) -> Result<Model, ReadError> {
    let Header { encoding, sections, rest, line } = header(bytes, budget.wanted)?;
    let (mut model, polygons) = match encoding {
        Encoding::Ascii => ply_text::read(rest, line, &sections, budget),
        Encoding::LittleEndian => ply_bytes::read::<false>(bytes, rest, &sections, budget),
        Encoding::BigEndian => ply_bytes::read::<true>(bytes, rest, &sections, budget),
    }?;
    polygons.cut(&mut model);
    // Until here, the attributes are those of vertices.
    let Attributes { normals, uv, colours } = take(&mut model.attributes);
    model.attributes = Attributes {
        normals: AtCorners::of_vertices(normals.values, &model.faces),
        uv: AtCorners::of_vertices(uv.values, &model.faces),
        colours: AtCorners::of_vertices(colours.values, &model.faces),
    };
    Ok(model)
}

/// Tells whether a file is a text.
pub fn is_text(bytes: &[u8]) -> bool {
    header(bytes, Wanted::default()).is_ok_and(|header| header.encoding == Encoding::Ascii)
}
