//! What a file of a mesh holds, and how its faults are told.

use crate::text;
use glam::DVec3;
use std::borrow::Cow;
use std::fmt;

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
    /// Makes a fault of the file as a whole.
    pub fn file(message: impl Into<String>) -> Self {
        Self { at: None, message: message.into() }
    }

    /// Makes a fault of a line, from 1.
    pub fn line(line: usize, message: impl Into<String>) -> Self {
        Self { at: Some(At::Line(line)), message: message.into() }
    }

    /// Makes a fault at a byte, from 0.
    pub fn byte(byte: usize, message: impl Into<String>) -> Self {
        Self { at: Some(At::Byte(byte)), message: message.into() }
    }
}

/// The largest number of vertices: indices are 32 bits wide.
pub(super) const MAX_VERTICES: usize = 1 << 31;

/// Reads a coordinate.
pub(super) fn coordinate(word: &str) -> Result<f64, String> {
    match word.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(_) => Err(format!("`{}` is not a finite number", text::abridged(word))),
        Err(_) => Err(format!("`{}` is not a number", text::abridged(word))),
    }
}

/// Returns the lines of a text with their numbers, from 1. Bytes that are not UTF-8 are replaced.
pub(super) fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let lines = bytes.split(|byte| *byte == b'\n').enumerate();
    lines.map(|(index, line)| (index + 1, String::from_utf8_lossy(line)))
}
