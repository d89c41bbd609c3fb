//! Elements of PLY files: what the properties of each are, and what is made of them.

use super::at_corners::{Attributes, NO_VALUE};
use super::model::{Model, Wanted, shown};
use super::polygons::Polygons;
use glam::DVec3;
use std::ops::Range;
use std::sync::Arc;

/// The names of the property with the corners of a face, as different programs write it.
const CORNERS: [&str; 3] = ["vertex_indices", "vertex_index", "vertex_indexes"];

/// The names of the property with the texture coordinates of a face's corners.
const UV_OF_CORNERS: [&str; 2] = ["texcoord", "texture_coordinates"];

/// The names of the numbers of a vertex or a face, in their order.
const NUMBERS: [&[&str]; NUMBERS_OF_VERTEX] = [
    &["x"],
    &["y"],
    &["z"],
    &["nx"],
    &["ny"],
    &["nz"],
    &["red", "diffuse_red"],
    &["green", "diffuse_green"],
    &["blue", "diffuse_blue"],
    &["s", "u", "texture_u"],
    &["t", "v", "texture_v"],
    &["texnumber", "texture_id"],
    &["alpha", "diffuse_alpha"],
];

/// The ranges of a vertex's coordinates, normal, colour and texture coordinates among its numbers.
pub(super) const COORDINATES: Range<usize> = 0..3;
const NORMAL: Range<usize> = 3..6;
pub(super) const COLOUR: Range<usize> = 6..9;
pub(super) const UV: Range<usize> = 9..11;

/// The place of the number of a face's image.
const IMAGE: usize = 11;

/// The place of the fraction that a vertex covers of what is behind it.
const ALPHA: usize = 12;

/// The maximum light of a colour. Products of larger ones may overflow.
const MAX_LIGHT: f64 = 1e6;

/// The number of numbers that are read of a vertex or a face.
const NUMBERS_OF_VERTEX: usize = 13;

/// The numbers of a vertex or a face.
pub(super) type Vertex = [f64; NUMBERS_OF_VERTEX];

/// The type of a number.
#[derive(Clone, Copy, Debug)]
pub(super) enum Number {
    /// A signed integer of this many bytes.
    Signed(usize),
    /// An unsigned integer of this many bytes.
    Unsigned(usize),
    Float,
    Double,
}

impl Number {
    fn of(name: &[u8]) -> Result<Self, String> {
        Ok(match name {
            b"char" | b"int8" => Self::Signed(1),
            b"uchar" | b"uint8" => Self::Unsigned(1),
            b"short" | b"int16" => Self::Signed(2),
            b"ushort" | b"uint16" => Self::Unsigned(2),
            b"int" | b"int32" => Self::Signed(4),
            b"uint" | b"uint32" => Self::Unsigned(4),
            b"int64" => Self::Signed(8),
            b"uint64" => Self::Unsigned(8),
            b"float" | b"float32" => Self::Float,
            b"double" | b"float64" => Self::Double,
            _ => return Err(format!("`{}` is not a type of PLY", shown(name))),
        })
    }

    /// Returns the integer that stands for 1 in a colour.
    fn greatest(self) -> Option<f64> {
        match self {
            Self::Signed(size) | Self::Unsigned(size) => Some(((1_u64 << (8 * size.min(4))) - 1) as f64),
            Self::Float | Self::Double => None,
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

/// A property of an element. An element has its properties one after the other.
#[derive(Clone, Copy, Debug)]
pub(super) enum Field {
    /// A number of a vertex or a face, by its index.
    Vertex(usize, Number),
    /// The corners of a face: the types of their count, and of their indices.
    Corners(Number, Number),
    /// The texture coordinates of a face's corners: the types of their count, and of their numbers.
    Uv(Number, Number),
    /// An unused number.
    Number(Number),
    /// An unused list: the types of its length, and of its values.
    List(Number, Number),
}

/// The elements with one name, as the header describes them.
#[derive(Debug)]
pub(super) struct Section {
    pub name: String,
    pub count: usize,
    pub fields: Vec<Field>,
    pub kind: Kind,
    /// The number of vertices in the file.
    pub vertices: usize,
    /// The wanted contents beside triangles.
    wanted: Wanted,
}

/// The kinds of elements that are read. Others are skipped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Vertex,
    Face,
    /// Strips of triangles. Each corner forms a triangle with the two before it, and a negative number ends a strip.
    Strips,
    Other,
}

/// Returns the coordinates of a vertex.
pub(super) fn coordinates(vertex: &Vertex) -> DVec3 {
    DVec3::new(vertex[0], vertex[1], vertex[2])
}

/// Returns the normal of a vertex.
pub(super) fn normal(vertex: &Vertex) -> [f32; 3] {
    [0, 1, 2].map(|axis| vertex[NORMAL.start + axis] as f32)
}

/// Returns the texture coordinates of a vertex.
pub(super) fn uv(vertex: &Vertex) -> [f32; 2] {
    [0, 1].map(|axis| vertex[UV.start + axis] as f32)
}

impl Section {
    pub fn new(name: &str, count: usize, wanted: Wanted) -> Self {
        let kind = match name {
            "vertex" => Kind::Vertex,
            "face" => Kind::Face,
            "tristrips" => Kind::Strips,
            _ => Kind::Other,
        };
        Self { name: name.to_owned(), count, fields: Vec::new(), kind, vertices: 0, wanted }
    }

    /// Reads the definition of a property, or returns `None` if words are missing.
    pub fn field(&self, words: &[&[u8]]) -> Option<Result<Field, String>> {
        let is_corners = |name: &[u8]| {
            matches!(self.kind, Kind::Face | Kind::Strips)
                && CORNERS.iter().any(|known| known.as_bytes() == name)
        };
        let has_looks = self.wanted.materials.is_some();
        let is_uv = |name: &[u8]| {
            self.kind == Kind::Face && has_looks && UV_OF_CORNERS.iter().any(|known| known.as_bytes() == name)
        };
        let is_wanted = |place: &usize| match self.kind {
            Kind::Vertex => {
                COORDINATES.contains(place)
                    || NORMAL.contains(place) && self.wanted.normals
                    || (COLOUR.contains(place) || UV.contains(place)) && has_looks
                    || *place == ALPHA && self.wanted.covers_in_part()
            }
            Kind::Face => (COLOUR.contains(place) || *place == IMAGE) && has_looks,
            Kind::Strips | Kind::Other => false,
        };
        let place = |name: &[u8]| {
            let is_name = |known: &&str| known.as_bytes() == name;
            NUMBERS.iter().position(|names| names.iter().any(&is_name)).filter(is_wanted)
        };
        let is_coordinate = |name: &[u8]| place(name).is_some_and(|place| COORDINATES.contains(&place));
        let wrong = |name: &[u8], what: &str| {
            Err(format!("`{}` of its elements `{}` is not {what}", shown(name), self.name))
        };
        Some(match words {
            [b"list", length, number, name, ..] => {
                let both = Number::of(length).and_then(|length| Ok((length, Number::of(number)?)));
                match both {
                    Err(message) => Err(message),
                    _ if is_coordinate(name) => wrong(name, "a number"),
                    Ok((length, _)) if !length.is_whole() => {
                        wrong(name, "a list with a whole number of values")
                    }
                    Ok((_, number)) if is_corners(name) && !number.is_whole() => {
                        wrong(name, "a list of whole numbers")
                    }
                    Ok((length, number)) if is_corners(name) => Ok(Field::Corners(length, number)),
                    Ok((length, number)) if is_uv(name) => Ok(Field::Uv(length, number)),
                    Ok((length, number)) => Ok(Field::List(length, number)),
                }
            }
            [number, name, ..] if is_corners(name) => Number::of(number).and_then(|_| wrong(name, "a list")),
            [number, name, ..] => Number::of(number).map(|number| match place(name) {
                Some(place) => Field::Vertex(place, number),
                None => Field::Number(number),
            }),
            _ => return None,
        })
    }

    /// Tells whether vertices have all of these numbers.
    pub fn has(&self, mut numbers: Range<usize>) -> bool {
        let is_field = |number| {
            self.fields.iter().any(|field| matches!(field, Field::Vertex(place, _) if *place == number))
        };
        numbers.all(is_field)
    }

    /// Tells whether the normals, the colours and the texture coordinates of vertices are read.
    pub fn reads(&self) -> [bool; 3] {
        [NORMAL, COLOUR, UV].map(|numbers| self.has(numbers))
    }

    /// Returns the type of a number of vertices, if they have it.
    fn number(&self, of: usize) -> Option<Number> {
        self.fields.iter().find_map(|field| match field {
            Field::Vertex(place, number) if *place == of => Some(*number),
            _ => None,
        })
    }

    /// Returns the colour of a vertex, and the fraction that it covers. Integers are levels of an image, and other
    /// numbers are light.
    pub fn colour(&self, vertex: &Vertex) -> [f32; 4] {
        let greatest = self.number(COLOUR.start).and_then(Number::greatest);
        let colour = [0, 1, 2].map(|channel| vertex[COLOUR.start + channel]);
        let covered = |number: Number| vertex[ALPHA] / number.greatest().unwrap_or(1.0);
        let covered = self.number(ALPHA).map_or(1.0, covered);
        let [red, green, blue] = colour.map(|channel| match (greatest, self.wanted.materials) {
            (Some(greatest), Some(display)) => {
                display.light_of((255.0 * channel / greatest).round() as u8) as f32
            }
            _ => {
                if channel > 0.0 {
                    channel.min(MAX_LIGHT) as f32
                } else {
                    0.0
                }
            }
        });
        [red, green, blue, if covered >= 0.0 { covered.min(1.0) as f32 } else { 0.0 }]
    }

    /// Adds a vertex, with the attributes that are read.
    pub fn put(&self, vertex: &Vertex, vertices: &mut Vec<DVec3>, attributes: &mut Attributes) {
        let [has_normals, has_colours, has_uv] = self.reads();
        vertices.push(coordinates(vertex));
        attributes.normals.values.extend(has_normals.then(|| normal(vertex)));
        attributes.colours.values.extend(has_colours.then(|| self.colour(vertex)));
        attributes.uv.values.extend(has_uv.then(|| uv(vertex)));
    }

    /// Adds what a face has beside its corners, of which there are `count`, to the triangles before it and its own.
    pub fn put_face(&self, numbers: &Vertex, uv: &[f32], (count, before): (usize, usize), model: &mut Model) {
        let Attributes { uv: at, colours, .. } = &mut model.attributes;
        let add = |list: &mut Arc<Vec<[u32; 3]>>, indices: &[u32]| {
            let list = Arc::make_mut(list);
            list.resize(before, [NO_VALUE; 3]);
            Polygons::add_values(indices, list);
        };
        if self.fields.iter().any(|field| matches!(field, Field::Uv(..))) {
            let (pairs, first) = (uv.as_chunks::<2>().0, at.values.len() as u32);
            let is_whole = pairs.len() == count;
            at.values.extend(if is_whole { pairs } else { &[] });
            let index = |corner: usize| if is_whole { first + corner as u32 } else { NO_VALUE };
            add(&mut at.faces, &(0..count).map(index).collect::<Vec<_>>());
        }
        if self.has(COLOUR) {
            add(&mut colours.faces, &vec![colours.values.len() as u32; count]);
            colours.values.push(self.colour(numbers));
        }
        if self.has(IMAGE..IMAGE + 1) {
            let slot = Some(numbers[IMAGE] + 1.0).filter(|slot| (0.0..=f64::from(u16::MAX)).contains(slot));
            model.slots.resize(before, 0);
            model.slots.resize(model.faces.len(), slot.unwrap_or(0.0) as u16);
        }
    }

    /// Adds the triangles of a face, or of strips, with this index. `corners` is scratch space.
    pub fn add(
        &self,
        index: usize,
        given: &[i64],
        corners: &mut Vec<u32>,
        faces: &mut Vec<[u32; 3]>,
        polygons: &mut Polygons,
    ) -> Result<(), String> {
        let (count, is_strip) = (self.vertices, self.kind == Kind::Strips);
        let is_known = |corner: &i64| (0..count as i64).contains(corner) || is_strip && *corner < 0;
        if let Some(corner) = given.iter().find(|corner| !is_known(corner)) {
            let what = if is_strip { "strip" } else { "face" };
            return Err(format!("{what} {index} refers to vertex {corner}, and there are {count}, from 0"));
        }
        for part in given.split(|corner| *corner < 0) {
            corners.clear();
            corners.extend(part.iter().map(|corner| *corner as u32));
            if !is_strip {
                polygons.add(corners, faces);
                continue;
            }
            for (at, three) in corners.windows(3).enumerate() {
                let [a, b, c] = [three[at % 2], three[1 - at % 2], three[2]];
                // A repeated corner joins strips.
                if a != b && b != c && a != c {
                    faces.push([a, b, c]);
                }
            }
        }
        Ok(())
    }
}
