//! PLY, as text and as bytes of either order.

use super::at_corners::{AtCorners, Attributes, NO_VALUE};
use super::finish::{Finish, Map};
use super::model::{MemoryBudget, Model, ReadError, Wanted};
use super::ply_header::{Encoding, Header, header};
use super::textures::Textures;
use super::{ply_bytes, ply_text};
use std::mem::take;
use std::path::Path;

/// Reads a file in a folder.
pub fn read(bytes: &[u8], folder: &Path, budget: &MemoryBudget) -> Result<Model, ReadError> {
    let Header { encoding, sections, rest, images, line } = header(bytes, budget.wanted)?;
    let (mut model, polygons) = match encoding {
        Encoding::Ascii => ply_text::read(rest, line, &sections, budget),
        Encoding::LittleEndian => ply_bytes::read::<false>(bytes, rest, &sections, budget),
        Encoding::BigEndian => ply_bytes::read::<true>(bytes, rest, &sections, budget),
    }?;
    let faces = model.faces.len();
    model.attributes.lists().for_each(|list| list.resize(faces, [NO_VALUE; 3]));
    if !images.is_empty() && budget.wanted.materials.is_some() {
        let one = u16::from(model.slots.is_empty());
        model.slots.resize(faces, one);
        furnish(&mut model, &images, folder, budget);
    } else {
        model.slots.clear();
    }
    polygons.cut(&mut model);
    let Attributes { normals, uv, colours } = take(&mut model.attributes);
    model.attributes = Attributes {
        normals: of_corners_or_vertices(normals, &model.faces),
        uv: of_corners_or_vertices(uv, &model.faces),
        colours: of_corners_or_vertices(colours, &model.faces),
    };
    Ok(model)
}

/// Makes the values at the corners of faces from those of vertices, unless the faces have their own.
fn of_corners_or_vertices<T: Copy>(values: AtCorners<T>, faces: &[[u32; 3]]) -> AtCorners<T> {
    if values.is_empty() { AtCorners::of_vertices(values.values, faces) } else { values }
}

/// Makes a material of each image. An image takes the place of other colours, which would be seen twice.
fn furnish(model: &mut Model, images: &[(String, usize)], folder: &Path, budget: &MemoryBudget) {
    let mut textures = Textures::new(folder, budget);
    for (name, line) in images {
        let texture = textures.named(name, &format!("line {line}"));
        let map = Map::new;
        model.materials.push(name.clone());
        model.finishes.push(Some(Finish { colours: texture.map(map), ..Finish::default() }));
    }
    let count = images.len();
    model.slots.iter_mut().filter(|slot| usize::from(**slot) > count).for_each(|slot| *slot = 0);
    if model.finishes.iter().flatten().any(|finish| finish.colours.is_some()) {
        model.attributes.colours = AtCorners::default();
    }
    textures.finish(model);
}

/// Tells whether a file is a text.
pub fn is_text(bytes: &[u8]) -> bool {
    header(bytes, Wanted::default()).is_ok_and(|header| header.encoding == Encoding::Ascii)
}
