//! Headers of PLY files: the elements of a file, and what is read of each.

use super::blocks::words;
use super::model::{ENDS_EARLY, MAX_VERTICES, ReadError, coordinate, shown};
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{DefaultElement, ElementDef, Header, PropertyDef, PropertyType, ScalarType};
use std::io::ErrorKind;

/// The names that programs give to the corners of faces.
const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// The longest header, in bytes: the parser takes many times the memory of the header's lines.
const LONGEST_HEADER: usize = 1 << 20;

/// The type of a number.
#[derive(Clone, Copy)]
pub(super) enum Number {
    /// A whole number of so many bytes, from a negative one upward.
    Signed(usize),
    /// A whole number of so many bytes, from 0 upward.
    Unsigned(usize),
    Float,
    Double,
}

impl Number {
    fn of(scalar: &ScalarType) -> Self {
        match scalar {
            ScalarType::Char => Self::Signed(1),
            ScalarType::UChar => Self::Unsigned(1),
            ScalarType::Short => Self::Signed(2),
            ScalarType::UShort => Self::Unsigned(2),
            ScalarType::Int => Self::Signed(4),
            ScalarType::UInt => Self::Unsigned(4),
            ScalarType::Float => Self::Float,
            ScalarType::Double => Self::Double,
        }
    }

    fn is_whole(self) -> bool {
        matches!(self, Self::Signed(_) | Self::Unsigned(_))
    }

    /// Returns the number's length in bytes.
    #[inline(always)]
    pub fn size(self) -> usize {
        match self {
            Self::Signed(size) | Self::Unsigned(size) => size,
            Self::Float => 4,
            Self::Double => 8,
        }
    }
}

/// What is read of a property. An element has its properties one after the other.
#[derive(Clone, Copy)]
pub(super) enum Field {
    /// The coordinate along this axis.
    Coordinate(usize, Number),
    /// The corners of a face: the type of their number, and their own.
    Corners(Number, Number),
    /// A number that is not needed.
    Number(Number),
    /// A list that is not needed: the type of its length, and of its numbers.
    List(Number, Number),
}

/// The elements of a name, as the header describes them.
pub(super) struct Section {
    pub count: usize,
    pub fields: Vec<Field>,
    pub kind: Kind,
    /// The number of vertices in the file.
    pub vertices: usize,
}

/// The elements that are read; others are skipped.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Kind {
    Vertex,
    Face,
    Other,
}

/// Reads the header: returns it, what comes after it, and the line where that begins.
pub(super) fn header(bytes: &[u8]) -> Result<(Header, &[u8], usize), ReadError> {
    let first = &bytes[..bytes.len().min(LONGEST_HEADER)];
    let mut reader = Reader::new(first);
    let header = Parser::<DefaultElement>::new().read_header(&mut reader).map_err(|error| {
        if error.kind() == ErrorKind::UnexpectedEof && first.len() < bytes.len() {
            return ReadError::file("its header does not end within 1 MiB");
        }
        fault(&error, first)
    })?;
    let rest = &bytes[first.len() - reader.get_ref().len()..];
    Ok((header, rest, reader.line()))
}

impl Section {
    pub fn new(element: &ElementDef, vertices: usize) -> Result<Self, ReadError> {
        let kind = match element.name.as_str() {
            "vertex" => Kind::Vertex,
            "face" => Kind::Face,
            _ => Kind::Other,
        };
        let field = |(name, property): (&String, &PropertyDef)| {
            let axis = ["x", "y", "z"].iter().position(|axis| axis == name).filter(|_| kind == Kind::Vertex);
            let is_corners = kind == Kind::Face && CORNERS.contains(&name.as_str());
            let wrong = |what: &str| {
                Err(ReadError::file(format!("`{name}` of its elements `{}` is not {what}", element.name)))
            };
            match &property.data_type {
                PropertyType::Scalar(number) => match axis {
                    _ if is_corners => wrong("a list"),
                    Some(axis) => Ok(Field::Coordinate(axis, Number::of(number))),
                    None => Ok(Field::Number(Number::of(number))),
                },
                PropertyType::List(length, number) => {
                    let (length, number) = (Number::of(length), Number::of(number));
                    match axis {
                        Some(_) => wrong("a number"),
                        None if !length.is_whole() => wrong("a list with a whole number of values"),
                        None if is_corners && !number.is_whole() => wrong("a list of whole numbers"),
                        None if is_corners => Ok(Field::Corners(length, number)),
                        None => Ok(Field::List(length, number)),
                    }
                }
            }
        };
        let fields = element.properties.iter().map(field).collect::<Result<_, _>>()?;
        Ok(Self { count: element.count, fields, kind, vertices })
    }

    /// Checks the corners of the face of this index, and makes 32 bits of each.
    pub fn corners(&self, face: usize, given: &[i64], corners: &mut Vec<u32>) -> Result<(), String> {
        if given.len() < 3 {
            return Err(format!("face {face} has {} vertices, and needs three", given.len()));
        }
        let count = self.vertices;
        if let Some(corner) = given.iter().find(|corner| !(0..count as i64).contains(corner)) {
            return Err(format!("face {face} refers to vertex {corner}, and there are {count}, from 0"));
        }
        corners.clear();
        corners.extend(given.iter().map(|corner| *corner as u32));
        Ok(())
    }
}

/// Refuses a header that promises more than the file can hold: each element takes at least a byte.
pub(super) fn may_fit(header: &Header, size: usize) -> Result<(), ReadError> {
    let mut left = size;
    for (name, element) in &header.elements {
        let has = |names: &[&str]| names.iter().any(|name| element.properties.contains_key(*name));
        if element.count > left {
            let message = format!(
                "the header announces {} elements `{name}`, more than the file has room for",
                element.count
            );
            return Err(ReadError::file(message));
        }
        if element.properties.is_empty() && element.count > 0 {
            return Err(ReadError::file(format!("its elements `{name}` have no properties")));
        }
        left -= element.count;
        if name == "vertex" && !(has(&["x"]) && has(&["y"]) && has(&["z"])) {
            return Err(ReadError::file("its vertices do not have `x`, `y` and `z`"));
        }
        if name == "face" && !has(&CORNERS) {
            return Err(ReadError::file("its faces do not have `vertex_indices`"));
        }
        if name == "vertex" && element.count > MAX_VERTICES {
            return Err(ReadError::file("it has more than 2^31 vertices"));
        }
    }
    Ok(())
}

/// Says what the parser says of a header, in a line and without the text that it repeats.
fn fault(error: &ParseError, bytes: &[u8]) -> ReadError {
    if error.kind() == ErrorKind::UnexpectedEof {
        return ReadError::file(ENDS_EARLY);
    }
    let line = error.line().and_then(|line| Some((line, bytes.split(|byte| *byte == b'\n').nth(line - 1)?)));
    let Some((number, line)) = line else {
        let text = error.to_string();
        return ReadError::file(text.lines().next().unwrap_or_default().trim_end_matches('.').to_lowercase());
    };
    ReadError::line(number, unexpected(line, true))
}

/// Says that a line is not what the header makes expect.
pub(super) fn unexpected(line: &[u8], is_header: bool) -> String {
    let wrong = words(line).find_map(|word| coordinate(word).err());
    wrong
        .filter(|_| !is_header)
        .unwrap_or_else(|| format!("`{}` is not what the header announces here", shown(line.trim_ascii())))
}
