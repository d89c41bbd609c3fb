//! Headers of PLY files.

use super::blocks::{is_blank, words};
use super::model::{ENDS_EARLY, MAX_VERTICES, ReadError, Wanted, coordinate, shown};
use super::ply_section::{COLOUR, COORDINATES, Field, Kind, Section, UV};
use memchr::memchr;

/// The maximum length of a header, in bytes.
const LONGEST_HEADER: usize = 1 << 20;

/// The encoding of the elements of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// A header, and the rest of the file.
pub(super) struct Header<'h> {
    pub encoding: Encoding,
    pub sections: Vec<Section>,
    pub rest: &'h [u8],
    /// The names of images, each with its line, as MeshLab and OpenMVS write them.
    pub images: Vec<(String, usize)>,
    /// The number of the header's lines.
    pub line: usize,
}

/// Reads the header. Lines that begin with words unknown to PLY, which some programs write, count as comments.
pub(super) fn header(bytes: &[u8], wanted: Wanted) -> Result<Header<'_>, ReadError> {
    let first = &bytes[..bytes.len().min(LONGEST_HEADER)];
    // All lines end like the first one. Only if that has a single carriage return, a carriage return ends a line,
    // because bytes may follow.
    let end = match first.iter().position(|byte| matches!(byte, b'\r' | b'\n')) {
        Some(at) if first[at] == b'\r' && first.get(at + 1) != Some(&b'\n') => b'\r',
        _ => b'\n',
    };
    let (mut encoding, mut sections, mut images, mut rest) = (None, Vec::<Section>::new(), Vec::new(), first);
    for line in 1.. {
        let Some(length) = memchr(end, rest) else {
            let is_cut = first.len() == bytes.len();
            return Err(ReadError::file(if is_cut {
                ENDS_EARLY
            } else {
                "its header does not end within 1 MiB"
            }));
        };
        let (text, after) = (&rest[..length], &rest[length + 1..]);
        rest = after;
        let error = |message: String| ReadError::line(line, message);
        let mut words = words(text);
        match words.next() {
            Some(b"format") => {
                encoding = Some(match words.next() {
                    Some(b"ascii") => Encoding::Ascii,
                    Some(b"binary_little_endian") => Encoding::LittleEndian,
                    Some(b"binary_big_endian") => Encoding::BigEndian,
                    _ => return Err(error(unexpected(text, true))),
                });
            }
            Some(b"element") => {
                let (name, count) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
                let count = str::from_utf8(count).ok().and_then(|count| count.parse().ok());
                let count = count.ok_or_else(|| error(unexpected(text, true)))?;
                sections.push(Section::new(&String::from_utf8_lossy(name), count, wanted));
            }
            Some(b"property") => {
                let section = sections.last_mut().ok_or_else(|| error(unexpected(text, true)))?;
                let words: Vec<_> = words.collect();
                let field = section.field(&words).unwrap_or_else(|| Err(unexpected(text, true)));
                section.fields.push(field.map_err(error)?);
            }
            Some(b"end_header") => {
                let encoding = encoding.ok_or_else(|| {
                    ReadError::file("its header has no line `format`, such as `format ascii 1.0`")
                })?;
                let vertices = sections.iter().find(|section| section.kind == Kind::Vertex);
                let vertices = vertices.map_or(0, |section| section.count);
                sections.iter_mut().for_each(|section| section.vertices = vertices);
                read_once(&mut sections);
                may_fit(&sections, bytes.len()).map_err(ReadError::file)?;
                let rest = &bytes[first.len() - rest.len()..];
                return Ok(Header { encoding, sections, rest, images, line });
            }
            Some(b"comment") if words.next() == Some(b"TextureFile") => {
                let name = String::from_utf8_lossy(words.rest.trim_ascii()).into_owned();
                images.extend((!name.is_empty()).then_some((name, line)));
            }
            Some(word) if line == 1 && !word.eq_ignore_ascii_case(b"ply") => {
                return Err(error("a PLY begins with the word `ply`".to_owned()));
            }
            _ => {}
        }
    }
    Err(ReadError::file(ENDS_EARLY))
}

/// Reads what both vertices and faces have only once: the texture coordinates of faces, and the colours of vertices.
fn read_once(sections: &mut [Section]) {
    let has = |kind: Kind, is_field: fn(&Field) -> bool| {
        sections.iter().any(|section| section.kind == kind && section.fields.iter().any(is_field))
    };
    let has_uv = has(Kind::Face, |field| matches!(field, Field::Uv(..)));
    let has_colours =
        has(Kind::Vertex, |field| matches!(field, Field::Vertex(place, _) if COLOUR.contains(place)));
    for section in sections {
        for field in &mut section.fields {
            if let Field::Vertex(place, number) = *field
                && (section.kind == Kind::Vertex && has_uv && UV.contains(&place)
                    || section.kind == Kind::Face && has_colours && COLOUR.contains(&place))
            {
                *field = Field::Number(number);
            }
        }
    }
}

/// Refuses a header with more elements than the file can hold: each takes at least a byte.
fn may_fit(sections: &[Section], size: usize) -> Result<(), String> {
    let mut left = size;
    if sections.iter().filter(|section| section.kind == Kind::Vertex).count() > 1 {
        return Err("it has more than one list of elements `vertex`".to_owned());
    }
    for section in sections {
        let Section { name, count, fields, kind, .. } = section;
        if *count > left {
            return Err(format!(
                "the header announces {count} elements `{name}`, more than the file has room for"
            ));
        }
        if fields.is_empty() && *count > 0 {
            return Err(format!("its elements `{name}` have no properties"));
        }
        left -= count;
        if *kind == Kind::Vertex && !section.has(COORDINATES) {
            return Err("its vertices do not have `x`, `y` and `z`".to_owned());
        }
        let has_corners = fields.iter().any(|field| matches!(field, Field::Corners(..)));
        if matches!(kind, Kind::Face | Kind::Strips) && !has_corners {
            return Err(format!("its elements `{name}` do not have `vertex_indices`"));
        }
        if *kind == Kind::Vertex && *count > MAX_VERTICES {
            return Err("it has more than 2^31 vertices".to_owned());
        }
    }
    Ok(())
}

/// Returns an error for a text that contradicts the header.
pub(super) fn unexpected(text: &[u8], is_header: bool) -> String {
    let wrong = words(text).find_map(|word| coordinate(word).err());
    wrong.filter(|_| !is_header).unwrap_or_else(|| {
        let blanks = text.iter().take_while(|byte| is_blank(byte)).count();
        format!("`{}` is not what the header announces here", shown(text[blanks..].trim_ascii_end()))
    })
}
