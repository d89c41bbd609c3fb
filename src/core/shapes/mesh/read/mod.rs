//! Files of triangle meshes: OBJ, PLY and STL.

mod blocks;
mod model;
mod obj;
mod ply;
mod ply_bytes;
mod ply_header;
mod ply_text;
mod stl;
#[cfg(test)]
mod tests;

use model::MemoryBudget;
pub use model::{FilePosition, Model, ReadError};

use crate::files;
use crate::memory;
use crate::text;
use bytesize::ByteSize;
use std::io::{self, Read};
use std::path::Path;

/// Reads a file by the format of its name or, if that names none, by how it begins. Takes no more memory than so many
/// bytes, roughly.
///
/// # Errors
/// What is wrong, and where.
pub fn read(path: &Path, memory: u64) -> Result<Model, ReadError> {
    let cannot = |error: io::Error| {
        let is_missing = error.kind() == io::ErrorKind::NotFound;
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
    let model = match (ending.as_str(), &bytes[..]) {
        ("obj", bytes) => obj::read(bytes, &budget),
        ("stl", bytes) => stl::read(bytes, &budget),
        ("ply", bytes) | (_, bytes @ [b'p', b'l', b'y', b'\r' | b'\n', ..]) => ply::read(bytes, &budget),
        _ => {
            return Err(ReadError::file("its name does not end in `.obj`, `.ply` or `.stl`"));
        }
    }?;
    if model.faces.is_empty() {
        return Err(ReadError::file("it has no faces"));
    }
    Ok(model)
}
