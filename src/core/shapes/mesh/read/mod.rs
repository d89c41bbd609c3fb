//! Files of triangle meshes: OBJ, PLY and STL.

mod blocks;
mod format;
mod model;
mod obj;
mod ply;
mod ply_bytes;
mod ply_header;
mod ply_text;
mod polygons;
mod stl;
#[cfg(test)]
mod tests;

use format::Format;
use model::MemoryBudget;
pub use model::{FilePosition, Model, ReadError, Remark};

use crate::files;
use crate::memory;
use crate::text;
use bytesize::ByteSize;
use std::io::{self, Read};
use std::path::Path;

/// Reads a file by how it begins or, where that tells nothing, by the ending of its name. Takes no more memory than so many
/// bytes, roughly.
///
/// # Errors
/// What is wrong, and where.
pub fn read(path: &Path, memory: u64) -> Result<Model, ReadError> {
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
    let mut file = files::open(path).map_err(cannot)?;
    let size = file.metadata().map_err(cannot)?.len();
    let budget = MemoryBudget::new(memory, size).map_err(ReadError::file)?;
    let mut bytes = Vec::new();
    let is_held =
        usize::try_from(size).is_ok_and(|size| memory::may_fail(|| bytes.try_reserve_exact(size).is_ok()));
    if !is_held {
        return Err(ReadError::file(format!("there is no memory for its {}", ByteSize(size))));
    }
    file.by_ref().take(size).read_to_end(&mut bytes).map_err(cannot)?;
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default().to_lowercase();
    model(bytes, &ending, &budget)
}

/// Reads the bytes of a file whose name has this ending, in lower case.
fn model(mut bytes: Vec<u8>, ending: &str, budget: &MemoryBudget) -> Result<Model, ReadError> {
    // A byte order mark is no part of a text.
    let start = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
    let bytes = &mut bytes[start..];
    let format = Format::of(bytes, ending).map_err(ReadError::file)?;
    if format.is_text(bytes) {
        blocks::end_lines(bytes);
    }
    let model = match format {
        Format::Obj => obj::read(bytes, budget),
        Format::Ply => ply::read(bytes, budget),
        Format::Stl => stl::read(bytes, budget),
    }?;
    if model.faces.is_empty() {
        let reason = match &model.remarks[..] {
            [] => format.without_faces(bytes, model.vertices.len()),
            _ => "none of its faces has three corners".to_owned(),
        };
        return Err(ReadError::file(reason));
    }
    Ok(model)
}
