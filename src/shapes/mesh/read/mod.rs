//! Files of triangle meshes: OBJ, PLY and STL.

mod obj;
mod ply;
mod stl;
#[cfg(test)]
mod tests;

use crate::files;
use crate::text;
use bytesize::ByteSize;
use glam::DVec3;
use std::borrow::Cow;
use std::fmt;
use std::io::{self, Read};
use std::path::Path;

/// The triangles of a file, before they are placed in a scene.
#[derive(Debug, Default, PartialEq)]
pub struct Model {
    /// The vertices, in the file's own coordinates; all are finite.
    pub vertices: Vec<DVec3>,
    /// The corners of each triangle, as indices of `vertices`. Polygons are cut into triangles from their first corner.
    pub faces: Vec<[u32; 3]>,
    /// The names of materials, in the order of their first use.
    pub materials: Vec<String>,
    /// The material of each face, as an index of `materials` plus 1; 0 for none. Empty where no face has any.
    pub slots: Vec<u16>,
}

/// Why a file cannot be read: where, and what is wrong there.
#[derive(Debug, PartialEq)]
pub struct Broken {
    /// The place in the file; `None` for the file as a whole.
    pub at: Option<At>,
    /// What is wrong, in lower case.
    pub message: String,
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum At {
    /// A line, from 1.
    Line(usize),
    /// A byte, from 0, in a file without lines.
    Byte(usize),
}

impl fmt::Display for At {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

impl Broken {
    fn file(message: impl Into<String>) -> Self {
        Self { at: None, message: message.into() }
    }

    fn line(line: usize, message: impl Into<String>) -> Self {
        Self { at: Some(At::Line(line)), message: message.into() }
    }

    fn byte(byte: usize, message: impl Into<String>) -> Self {
        Self { at: Some(At::Byte(byte)), message: message.into() }
    }
}

/// About the bytes of memory that a mesh takes, at most, for each byte of its file while it is read and its tree is
/// built: a face of a binary PLY has 13 bytes, and takes about 100.
const BYTES_PER_BYTE: u64 = 8;

/// Reads a file by the format of its name or, if that names none, by how it begins. Takes no more memory than so many
/// bytes, roughly.
///
/// # Errors
/// What is wrong, and where.
pub fn read(path: &Path, memory: u64) -> Result<Model, Broken> {
    let cannot = |error: io::Error| {
        let is_missing = error.kind() == io::ErrorKind::NotFound;
        let near = if is_missing { text::nearest_file(path) } else { None };
        let reason =
            near.map_or(text::reason(&error), |near| format!("it does not exist, but `{near}` does"));
        Broken::file(reason)
    };
    let mut file = files::open(path).map_err(cannot)?;
    let size = file.metadata().map_err(cannot)?.len();
    if size.saturating_mul(BYTES_PER_BYTE) > memory {
        return Err(Broken::file(format!(
            "it has {}, which may take more than the {} of memory that are left",
            ByteSize(size),
            ByteSize(memory)
        )));
    }
    let mut bytes = Vec::with_capacity(size as usize);
    file.by_ref().take(size).read_to_end(&mut bytes).map_err(cannot)?;
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default().to_lowercase();
    let model = match (ending.as_str(), &bytes[..]) {
        ("obj", bytes) => obj::read(bytes),
        ("stl", bytes) => stl::read(bytes),
        ("ply", bytes) | (_, bytes @ [b'p', b'l', b'y', b'\r' | b'\n', ..]) => ply::read(bytes),
        _ => {
            return Err(Broken::file("its name does not end in `.obj`, `.ply` or `.stl`"));
        }
    }?;
    if model.faces.is_empty() {
        return Err(Broken::file("it has no faces"));
    }
    Ok(model)
}

/// The largest number of vertices: indices are 32 bits wide.
const MAX_VERTICES: usize = 1 << 31;

/// Reads a coordinate.
fn coordinate(word: &str) -> Result<f64, String> {
    match word.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(_) => Err(format!("`{}` is not a finite number", text::abridged(word))),
        Err(_) => Err(format!("`{}` is not a number", text::abridged(word))),
    }
}

/// Returns the lines of a text with their numbers, from 1. Bytes that are not UTF-8 are replaced.
fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let lines = bytes.split(|byte| *byte == b'\n').enumerate();
    lines.map(|(index, line)| (index + 1, String::from_utf8_lossy(line)))
}
