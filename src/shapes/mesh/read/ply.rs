//! PLY, in text and in bytes of either order.

use super::model::{Broken, MAX_VERTICES, Model, coordinate, lines};
use crate::text::abridged;
use glam::DVec3;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{Encoding, Header, Property, PropertyAccess, PropertyAccessResult};
use std::io::ErrorKind;

/// A vertex or a face, as the parser fills it in.
#[derive(Default)]
struct Element {
    at: [f64; 3],
    corners: Vec<i64>,
}

impl PropertyAccess for Element {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if let Some(axis) = ["x", "y", "z"].iter().position(|axis| *axis == name) {
            let Some(number) = number(&property) else { return PropertyAccessResult::UnsupportedType };
            self.at[axis] = number;
        } else if CORNERS.contains(&name) {
            let Some(corners) = integers(property) else { return PropertyAccessResult::UnsupportedType };
            self.corners = corners;
        }
        PropertyAccessResult::Set
    }
}

/// The names that programs give to the corners of faces.
const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

fn number(property: &Property) -> Option<f64> {
    Some(match *property {
        Property::Char(number) => number.into(),
        Property::UChar(number) => number.into(),
        Property::Short(number) => number.into(),
        Property::UShort(number) => number.into(),
        Property::Int(number) => number.into(),
        Property::UInt(number) => number.into(),
        Property::Float(number) => number.into(),
        Property::Double(number) => number,
        _ => return None,
    })
}

fn integers(property: Property) -> Option<Vec<i64>> {
    fn all<T: Into<i64>>(of: Vec<T>) -> Vec<i64> {
        of.into_iter().map(Into::into).collect()
    }
    Some(match property {
        Property::ListChar(list) => all(list),
        Property::ListUChar(list) => all(list),
        Property::ListShort(list) => all(list),
        Property::ListUShort(list) => all(list),
        Property::ListInt(list) => all(list),
        Property::ListUInt(list) => all(list),
        _ => return None,
    })
}

/// Reads a file.
pub fn read(bytes: &[u8]) -> Result<Model, Broken> {
    let parser = Parser::<Element>::new();
    let mut reader = Reader::new(bytes);
    let header = parser.read_header(&mut reader).map_err(|error| fault(&error, true, bytes))?;
    let is_text = header.encoding == Encoding::Ascii;
    may_fit(&header, bytes.len())?;
    let mut model = Model::default();
    for (name, definition) in &header.elements {
        // Where the first of these elements is: its line, or its byte.
        let (line, byte) = (reader.line(), bytes.len() - reader.get_ref().len());
        let broken = |index: usize, message: String| {
            if is_text { Broken::line(line + index, message) } else { Broken::byte(byte, message) }
        };
        let elements = parser.read_payload_for_element(&mut reader, definition, &header);
        let elements = elements.map_err(|error| fault(&error, is_text, bytes))?;
        match name.as_str() {
            "vertex" => {
                for (index, Element { at, .. }) in elements.into_iter().enumerate() {
                    let at = DVec3::from(at);
                    if !at.is_finite() {
                        return Err(broken(index, format!("vertex {index} is not finite")));
                    }
                    model.vertices.push(at);
                }
            }
            "face" => {
                let count = model.vertices.len();
                for (face, Element { corners, .. }) in elements.into_iter().enumerate() {
                    if corners.len() < 3 {
                        let message = format!("face {face} has {} vertices, and needs three", corners.len());
                        return Err(broken(face, message));
                    }
                    if let Some(corner) = corners.iter().find(|corner| !(0..count as i64).contains(corner)) {
                        let message =
                            format!("face {face} refers to vertex {corner}, and there are {count}, from 0");
                        return Err(broken(face, message));
                    }
                    for pair in corners[1..].windows(2) {
                        model.faces.push([corners[0], pair[0], pair[1]].map(|corner| corner as u32));
                    }
                }
            }
            _ => {}
        }
    }
    Ok(model)
}

/// Refuses a header that promises more than the file can hold: each element takes at least a byte.
fn may_fit(header: &Header, size: usize) -> Result<(), Broken> {
    let mut left = size;
    for (name, element) in &header.elements {
        let has = |names: &[&str]| names.iter().any(|name| element.properties.contains_key(*name));
        if element.count > left {
            let message =
                format!("the header promises {} of `{name}`, and the file ends before", element.count);
            return Err(Broken::file(message));
        }
        if element.properties.is_empty() && element.count > 0 {
            return Err(Broken::file(format!("its elements `{name}` have no properties")));
        }
        left -= element.count;
        if name == "vertex" && !(has(&["x"]) && has(&["y"]) && has(&["z"])) {
            return Err(Broken::file("its vertices do not have `x`, `y` and `z`"));
        }
        if name == "face" && !has(&CORNERS) {
            return Err(Broken::file("its faces do not have `vertex_indices`"));
        }
        if name == "vertex" && element.count > MAX_VERTICES {
            return Err(Broken::file("it has more than 2^31 vertices"));
        }
    }
    Ok(())
}

/// Says what the parser says, in a line and without the text that it repeats.
fn fault(error: &ParseError, is_text: bool, bytes: &[u8]) -> Broken {
    let at = error.line().filter(|_| is_text).and_then(|line| lines(bytes).nth(line.saturating_sub(1)));
    if error.kind() == ErrorKind::UnexpectedEof {
        let message = "the file ends before all of its elements";
        return if is_text { Broken::file(message) } else { Broken::byte(bytes.len(), message) };
    }
    let Some((number, line)) = at else {
        let text = error.to_string();
        let message = text.lines().next().unwrap_or_default().trim_end_matches('.').to_lowercase();
        return if is_text { Broken::file(message) } else { Broken::byte(bytes.len(), message) };
    };
    let is_header = line.split_ascii_whitespace().next().is_none_or(|word| HEADER.contains(&word));
    let wrong = line.split_ascii_whitespace().find_map(|word| coordinate(word).err());
    let message = match wrong.filter(|_| !is_header) {
        Some(wrong) => wrong,
        None => format!("`{}` is not what the header makes expect here", abridged(line.trim())),
    };
    Broken::line(number, message)
}

/// The words with which lines of a header begin.
const HEADER: [&str; 7] = ["ply", "format", "comment", "obj_info", "element", "property", "end_header"];
