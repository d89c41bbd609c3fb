//! The contents of a mesh file, and the messages about its faults.

use super::at_corners::Attributes;
use super::finish::Finish;
use crate::text;
use crate::world::display::Display;
use bytesize::ByteSize;
use glam::DVec3;
use std::fmt;
use std::path::PathBuf;

/// What is wrong with a file that was cut.
pub(super) const ENDS_EARLY: &str = "the file ends before all of its elements";

/// The triangles of a file, before they are placed in a scene.
#[derive(Debug, Default, PartialEq)]
pub struct Model {
    /// The vertices, in the file's own coordinates; all are finite.
    pub vertices: Vec<DVec3>,
    /// The corners of each triangle, as indices of `vertices`. Polygons are cut into triangles.
    pub faces: Vec<[u32; 3]>,
    /// The names of materials, in the order of their first use.
    pub materials: Vec<String>,
    /// The material of each face, as an index of `materials` plus 1; 0 for none. Empty where no face has any.
    pub slots: Vec<u16>,
    /// The index of the flat side of which each triangle is a part, rising; empty where each is a side of its own.
    pub sides: Vec<u32>,
    /// The look that the file gives each of these materials, where looks are wanted and known.
    pub finishes: Vec<Option<Finish>>,
    /// The wanted attributes of the corners of faces.
    pub attributes: Attributes,
    /// What was not taken as the file says it.
    pub remarks: Vec<Remark>,
    /// The files that it names, whether they exist or not.
    pub files: Vec<PathBuf>,
}

/// What is read of a file beside its triangles.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wanted {
    /// Its normals.
    pub normals: bool,
    /// Whether materials, texture coordinates and colours are wanted. If so, this is how the rendered image shows
    /// light: a byte stands for the light that the image shows with it.
    pub materials: Option<Display>,
}

impl Wanted {
    /// Returns the number of lists that the corners of faces have, at most.
    fn lists(self) -> u64 {
        u64::from(self.normals) + 2 * u64::from(self.materials.is_some())
    }
}

/// Something about a file that its user should know.
#[derive(Debug, PartialEq)]
pub struct Remark {
    /// What it is, phrased to follow the name of the mesh.
    pub message: String,
    /// What it means, or what to do about it.
    pub help: &'static str,
}

/// Why a file cannot be read: where, and what is wrong there.
#[derive(Debug, PartialEq)]
pub struct ReadError {
    /// The place in the file; `None` for the file as a whole.
    pub at: Option<FilePosition>,
    /// What is wrong, in lower case.
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
    /// Makes a fault of the file as a whole.
    pub fn file(message: impl Into<String>) -> Self {
        Self { at: None, message: message.into() }
    }

    /// Makes a fault of a line, from 1.
    pub fn line(line: usize, message: impl Into<String>) -> Self {
        Self { at: Some(FilePosition::Line(line)), message: message.into() }
    }

    /// Makes a fault at a byte, from 0.
    pub fn byte(byte: usize, message: impl Into<String>) -> Self {
        Self { at: Some(FilePosition::Byte(byte)), message: message.into() }
    }
}

/// The largest number of vertices: indices are 32 bits wide.
pub(super) const MAX_VERTICES: usize = 1 << 31;

/// What is wanted of a file, and how much memory its mesh may take while it is read and its tree is built.
#[derive(Clone, Copy)]
pub struct MemoryBudget {
    /// What is read beside triangles.
    pub wanted: Wanted,
    /// In bytes; the file's are included.
    memory: u64,
    /// The length of the file in bytes.
    file: u64,
    /// What a vertex and a face take, in bytes.
    taken: [u64; 2],
}

/// The memory that a vertex and a face take, in bytes: at most while the tree is built, which needs several lists of
/// faces, their boxes and edges.
const TAKEN: [u64; 2] = [48, 160];

/// The memory that a list of values at the corners of faces takes for a vertex and a face, in bytes: this includes the
/// memory for reordering it.
const TAKEN_BY_LIST: [u64; 2] = [24, 24];

/// About the bytes of memory that a mesh takes, at least, for each byte of its file: a face in a wordy text, an STL,
/// takes 160 bytes and 48 for each corner, in addition to the file.
const LEAST: u64 = 3;

impl MemoryBudget {
    /// Refuses a file before it is read if its mesh surely takes more memory than is available.
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

    /// Returns the memory that is left beside the file, in bytes.
    pub fn left(&self) -> u64 {
        self.memory.saturating_sub(self.file)
    }

    /// Refuses more vertices and faces than there is memory for.
    #[inline]
    pub fn holds(&self, vertices: usize, faces: usize) -> Result<(), String> {
        let [of_vertices, of_faces] = self.taken;
        // What a header says may be any number.
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

/// Returns a part of a file as messages show it: in UTF-8, and not too long.
pub(super) fn shown(part: &[u8]) -> String {
    text::abridged(&String::from_utf8_lossy(part)).to_string()
}
