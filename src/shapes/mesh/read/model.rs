//! The contents of a mesh file, and its error messages.

use super::at_corners::Attributes;
use super::finish::Finish;
use super::staging::Staging;
use bytesize::ByteSize;
use glam::DVec3;
use std::fmt;
use std::path::PathBuf;
use tabray_world::display::Display;
use tabray_world::rules::Rules;
use tabray_world::text;

/// The error of a truncated file.
pub(super) const ENDS_EARLY: &str = "the file ends before all of its elements";

/// The triangles of a file, before they are placed in a scene.
#[derive(Debug, Default, PartialEq)]
pub struct Model {
    /// The vertices, in the file's own coordinates. All are finite.
    pub vertices: Vec<DVec3>,
    /// The corners of each triangle, as indices into `vertices`. Polygons are cut into triangles.
    pub faces: Vec<[u32; 3]>,
    /// The names of materials, in the order of their first use.
    pub materials: Vec<String>,
    /// The material of each face, as an index into `materials` plus 1, or 0 for none. It is empty if no face has a
    /// material.
    pub slots: Vec<u16>,
    /// For each triangle, the index of the flat polygon that contains it, in rising order. It is empty if each triangle
    /// is a polygon of its own.
    pub sides: Vec<u32>,
    /// The appearance of each of these materials in the file, if wanted and known.
    pub finishes: Vec<Option<Finish>>,
    /// The wanted attributes of the corners of faces.
    pub attributes: Attributes,
    /// Deviations from what the file says.
    pub remarks: Vec<Remark>,
    /// The files named in this one, whether they exist or not.
    pub files: Vec<PathBuf>,
    /// From where the file is seen, and by which lights.
    pub staging: Staging,
}

impl Model {
    /// Adds the vertices, the faces and their attributes of a further part of a file.
    pub(super) fn append(&mut self, part: Self, budget: &MemoryBudget) -> Result<(), ReadError> {
        let [vertices, faces] =
            [self.vertices.len() + part.vertices.len(), self.faces.len() + part.faces.len()];
        budget.holds(vertices, faces).map_err(ReadError::file)?;
        self.vertices.extend(part.vertices);
        self.faces.extend(part.faces);
        self.attributes.extend(part.attributes);
        Ok(())
    }
}

/// The optional contents of a file, beside its triangles.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wanted {
    /// Whether normals are wanted.
    pub normals: bool,
    /// Materials, texture coordinates and colours are wanted if this is `Some`. Bytes of colours are converted to the
    /// light that the rendered image shows for the same byte.
    pub materials: Option<Display>,
}

impl Wanted {
    /// Tells whether surfaces may cover a part of what is behind them, as they may by the free rules of light.
    pub fn covers_in_part(self) -> bool {
        self.materials.is_some_and(|display| display.rules() == Rules::Free)
    }

    /// Returns the maximum number of lists for the corners of faces.
    fn lists(self) -> u64 {
        u64::from(self.normals) + 2 * u64::from(self.materials.is_some())
    }
}

/// A fact about a file that its user should know.
#[derive(Debug, PartialEq)]
pub struct Remark {
    /// The fact, phrased to follow the name of the mesh.
    pub message: String,
    /// Its meaning, or what to do about it.
    pub help: &'static str,
}

/// The reason why a file cannot be read, with the place.
#[derive(Debug, PartialEq)]
pub struct ReadError {
    /// The place in the file, or `None` for the file as a whole.
    pub at: Option<FilePosition>,
    /// The error, in lower case.
    pub message: String,
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilePosition {
    /// A line, from 1.
    Line(usize),
    /// A byte, from 0, in a file without lines.
    Byte(usize),
}

impl fmt::Display for FilePosition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

impl ReadError {
    /// Makes an error of the file as a whole.
    pub fn file(message: impl Into<String>) -> Self {
        Self { at: None, message: message.into() }
    }

    /// Makes an error in a line, from 1.
    pub fn line(line: usize, message: impl Into<String>) -> Self {
        Self { at: Some(FilePosition::Line(line)), message: message.into() }
    }

    /// Makes an error at a byte, from 0.
    pub fn byte(byte: usize, message: impl Into<String>) -> Self {
        Self { at: Some(FilePosition::Byte(byte)), message: message.into() }
    }
}

/// The maximum number of vertices: indices are 32 bits wide.
pub(super) const MAX_VERTICES: usize = 1 << 31;

/// The wanted contents of a file, and the memory for reading its mesh and building the tree.
#[derive(Clone, Copy)]
pub struct MemoryBudget {
    /// The wanted contents beside triangles.
    pub wanted: Wanted,
    /// The memory in bytes, including the bytes of the file.
    memory: u64,
    /// The length of the file in bytes.
    file: u64,
    /// The memory of a vertex and of a face, in bytes.
    taken: [u64; 2],
}

/// The maximum memory of a vertex and of a face, in bytes. Building the tree needs most: several lists of faces, their
/// boxes and edges.
const TAKEN: [u64; 2] = [48, 160];

/// The memory of a vertex and of a face in a list of values at the corners of faces, in bytes. This includes the memory
/// for reordering the list.
const TAKEN_BY_LIST: [u64; 2] = [24, 24];

/// The approximate minimum memory of a mesh, in bytes for each byte of its file. In an STL, a verbose text, a face
/// takes 160 bytes and 48 for each corner, in addition to the file.
const LEAST: u64 = 3;

impl MemoryBudget {
    /// Refuses a file before it is read if its mesh certainly takes more memory than available.
    pub fn new(memory: u64, file: u64, wanted: Wanted) -> Result<Self, String> {
        if file.saturating_mul(LEAST) > memory {
            return Err(format!(
                "it has {}, which may take more than the {} of memory that are left",
                ByteSize(file),
                ByteSize(memory)
            ));
        }
        let taken = [0, 1].map(|of| TAKEN[of] + wanted.lists() * TAKEN_BY_LIST[of]);
        Ok(Self { wanted, memory, file, taken })
    }

    /// Returns the memory left beside the file, in bytes.
    pub fn left(&self) -> u64 {
        self.memory.saturating_sub(self.file)
    }

    /// Refuses more vertices and faces than fit in memory.
    #[inline]
    pub fn holds(&self, vertices: usize, faces: usize) -> Result<(), String> {
        let [of_vertices, of_faces] = self.taken;
        // A header may give any number.
        let vertices_take = (vertices as u64).saturating_mul(of_vertices);
        let taken = (faces as u64).saturating_mul(of_faces).saturating_add(vertices_take);
        if self.file.saturating_add(taken) <= self.memory {
            Ok(())
        } else {
            Err(self.refusal(vertices, faces))
        }
    }

    #[cold]
    fn refusal(&self, vertices: usize, faces: usize) -> String {
        format!(
            "it has at least {vertices} vertices and {faces} faces, which may take more than the {} of memory that are left",
            ByteSize(self.memory)
        )
    }
}

/// Reads a coordinate.
pub(super) fn coordinate(word: &[u8]) -> Result<f64, String> {
    match str::from_utf8(word).ok().and_then(|word| word.parse::<f64>().ok()) {
        Some(number) if number.is_finite() => Ok(number),
        Some(_) => Err(format!("`{}` is not a finite number", shown(word))),
        None => Err(format!("`{}` is not a number", shown(word))),
    }
}

/// Returns a part of a file for messages, in UTF-8 and shortened if long.
pub(super) fn shown(part: &[u8]) -> String {
    text::abridged(&String::from_utf8_lossy(part)).to_string()
}
