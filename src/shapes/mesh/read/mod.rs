//! Files of triangle meshes: OBJ, PLY, STL and glTF.

mod at_corners;
mod blocks;
mod finish;
mod format;
mod gltf;
mod model;
mod mtl;
mod obj;
mod ply;
mod ply_bytes;
mod ply_header;
mod ply_section;
mod ply_text;
mod polygons;
pub mod staging;
mod stl;
#[cfg(test)]
mod tests;
mod textures;

pub(super) use at_corners::in_order_of_use;
pub use at_corners::{AtCorners, Attributes, NO_VALUE};
pub use finish::{Finish, Map, Opacity, Polish, Wrap};
use format::Format;
use model::MemoryBudget;
pub use model::{FilePosition, Model, ReadError, Remark, Wanted};

use bytesize::ByteSize;
use std::io::{self, Read};
use std::path::Path;
use tabray_world::files::held::SceneFile;
use tabray_world::memory;
use tabray_world::text;

/// The message about a file without normals, if normals are wanted.
pub const NO_NORMALS: &str = "has a file without normals";

/// The message about a file without materials and colours, if these are wanted.
pub const NO_LOOKS: &str = "has a file without materials and colours";

/// Reads the triangles of a file, and the wanted attributes. Recognises the format by the beginning of the file, or
/// else by the extension of its name. Takes roughly at most `memory` bytes.
///
/// # Errors
/// Returns the error, with its place in the file.
pub fn read(path: &Path, wanted: Wanted, memory: u64) -> Result<Model, ReadError> {
    let cannot = |error: io::Error| {
        let is_missing = error.kind() == io::ErrorKind::NotFound;
        if is_missing && path.as_os_str().as_encoded_bytes().contains(&b'\\') {
            return ReadError::file("it does not exist: folders are separated by `/`, not `\\`");
        }
        let near = if is_missing { text::nearest_file(path) } else { None };
        let reason =
            near.map_or(text::reason(&error), |near| format!("it does not exist, but `{near}` does"));
        ReadError::file(reason)
    };
    let mut file = SceneFile::open(path).map_err(cannot)?;
    let size = file.length().map_err(cannot)?;
    let budget = MemoryBudget::new(memory, size, wanted).map_err(ReadError::file)?;
    let mut bytes = Vec::new();
    let is_held =
        usize::try_from(size).is_ok_and(|size| memory::may_fail(|| bytes.try_reserve_exact(size).is_ok()));
    if !is_held {
        return Err(ReadError::file(format!("not enough memory for its {}", ByteSize(size))));
    }
    file.by_ref().take(size).read_to_end(&mut bytes).map_err(cannot)?;
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default().to_lowercase();
    let folder = path.parent().unwrap_or(Path::new(""));
    model(bytes, &ending, folder, &budget)
}

/// Reads the bytes of a file in a folder. `ending` is the extension of the file's name, in lower case.
fn model(mut bytes: Vec<u8>, ending: &str, folder: &Path, budget: &MemoryBudget) -> Result<Model, ReadError> {
    // A byte order mark is not part of a text.
    let start = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
    let bytes = &mut bytes[start..];
    let format = Format::of(bytes, ending).map_err(ReadError::file)?;
    if format.is_text(bytes) {
        blocks::end_lines(bytes);
    }
    let mut model = match format {
        Format::Obj => obj::read(bytes, folder, budget),
        Format::Ply => ply::read(bytes, folder, budget),
        Format::Stl => stl::read(bytes, budget),
        Format::Gltf => gltf::read(bytes, folder, budget),
    }?;
    if model.faces.is_empty() {
        let reason = match &model.remarks[..] {
            [] => format.without_faces(bytes, model.vertices.len()),
            _ => "none of its faces has three corners".to_owned(),
        };
        return Err(ReadError::file(reason));
    }
    if budget.wanted.normals && model.attributes.normals.is_empty() {
        model.remarks.push(Remark {
            message: NO_NORMALS.to_owned(),
            help: "its normals are those of its faces, smoothed except across creases",
        });
    }
    if budget.wanted.materials.is_some() && model.finishes.is_empty() && model.attributes.colours.is_empty() {
        model.remarks.push(Remark { message: NO_LOOKS.to_owned(), help: "it has the material of the scene" });
    }
    Ok(model)
}
