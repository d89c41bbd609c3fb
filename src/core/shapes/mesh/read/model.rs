//! What a file of a mesh holds, and how its faults are told.

use crate::text;
use bytesize::ByteSize;
use glam::DVec3;
use std::fmt;

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
    /// What was not taken as the file says it.
    pub remarks: Vec<Remark>,
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

/// How much memory a mesh may take while its file is read and its tree is built.
#[derive(Clone, Copy)]
pub struct MemoryBudget {
    /// In bytes; the file's are included.
    memory: u64,
    /// The length of the file in bytes.
    file: u64,
}

/// The memory that a vertex and a face take, in bytes: at most while the tree is built, which needs several lists of
/// faces, their boxes and edges.
const TAKEN: [u64; 2] = [48, 160];

/// About the bytes of memory that a mesh takes, at least, for each byte of its file: those of a face in a wordy text, an
/// STL, take 160 bytes and 48 for each corner, beside the file.
const LEAST: u64 = 3;

impl MemoryBudget {
    /// Refuses a file whose mesh surely takes more memory than there is, before it is read.
    pub fn new(memory: u64, file: u64) -> Result<Self, String> {
        if file.saturating_mul(LEAST) > memory {
            return Err(format!(
                "it has {}, which may take more than the {} of memory that are left",
                ByteSize(file),
                ByteSize(memory)
            ));
        }
        Ok(Self { memory, file })
    }

    /// Refuses more vertices and faces than there is memory for.
    #[inline]
    pub fn holds(&self, vertices: usize, faces: usize) -> Result<(), String> {
        let taken = [vertices, faces].into_iter().zip(TAKEN).map(|(count, each)| count as u64 * each);
        if self.file + taken.sum::<u64>() <= self.memory {
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
