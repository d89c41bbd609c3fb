//! STL, as text and as bytes.

use super::blocks::{self, Lines, Words, never, words};
use super::model::{MAX_VERTICES, MemoryBudget, Model, ReadError, Remark, coordinate, shown};
use glam::DVec3;
use tabray_world::parallel;
use tabray_world::text;

/// The number of bytes before the first triangle: a title, and the number of triangles.
const HEADER: usize = 84;
/// The number of bytes of a triangle: a normal, three corners and two more bytes.
const TRIANGLE: usize = 50;

/// Tells whether the length of a file fits its number of triangles.
pub fn is_whole(bytes: &[u8]) -> bool {
    bytes.get(80..HEADER).is_some_and(|count| bytes.len() - HEADER == TRIANGLE * word(count) as usize)
}

/// Tells whether a file is a text. The titles of binary files may also begin with `solid`, but some of their bytes are
/// 0.
pub fn is_text(bytes: &[u8]) -> bool {
    let begins = words(bytes).next().is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    begins && !is_whole(bytes) && !bytes[..bytes.len().min(4 * HEADER)].contains(&0)
}

/// Reads a file.
pub fn read(bytes: &[u8], budget: &MemoryBudget) -> Result<Model, ReadError> {
    if is_text(bytes) {
        return in_text(bytes, budget);
    }
    let Some(announced) = bytes.get(80..HEADER).map(|count| word(count) as usize) else {
        return Err(ReadError::byte(bytes.len(), "the file ends before its number of triangles"));
    };
    let mut count = (bytes.len() - HEADER) / TRIANGLE;
    // Some programs write the greatest number before they know how many triangles follow.
    if count < announced && announced <= MAX_VERTICES / 3 {
        let message = format!("the file ends after {count} of {announced} triangles");
        return Err(ReadError::byte(bytes.len(), message));
    }
    budget.holds(3 * count, count).map_err(ReadError::file)?;
    let byte = |corner: usize| HEADER + TRIANGLE * (corner / 3) + 12 + 12 * (corner % 3);
    let at = |corner: usize| {
        let part = |axis: usize| f64::from(f32::from_bits(word(&bytes[byte(corner) + 4 * axis..][..4])));
        DVec3::new(part(0), part(1), part(2))
    };
    let mut vertices = vec![DVec3::ZERO; 3 * count];
    parallel::fill(&mut vertices, at);
    let (mut remarks, found) = (Vec::new(), count);
    if let Some(corner) = parallel::find_first(vertices.len(), |corner| !vertices[corner].is_finite()) {
        // The bytes after the announced triangles may be something else.
        if announced == 0 || corner / 3 < announced {
            let message = format!("a corner of triangle {} is not finite", corner / 3 + 1);
            return Err(ReadError::byte(byte(corner), message));
        }
        count = announced;
        vertices.truncate(3 * count);
    }
    if found != announced {
        let help = if count == announced {
            "the rest of the file is left out, because it holds no triangles"
        } else {
            "all triangles in the file are used"
        };
        let message =
            format!("has a file that announces {} and holds {found}", text::count(announced, "triangle"));
        remarks.push(Remark { message, help });
    }
    finish(vertices, remarks)
}

/// Reads a little-endian number from four bytes.
fn word(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte))
}

/// The keywords of a text.
#[derive(Clone, Copy)]
enum Keyword {
    Vertex,
    EndLoop,
    /// A name follows `solid` and `endsolid`.
    Solid,
    EndSolid,
    Facet,
    EndFacet,
    Outer,
}

impl Keyword {
    /// Returns the next keyword among words, and skips other words.
    fn next(words: &mut Words) -> Option<Self> {
        while let Some(word) = words.next() {
            if let Some(keyword) = Self::of(word, words) {
                return Some(keyword);
            }
        }
        None
    }

    /// Returns the keyword that a word is, alone or with the next word of the `rest`: `end loop` is `endloop`.
    fn of(word: &[u8], rest: &mut Words) -> Option<Self> {
        if word.eq_ignore_ascii_case(b"end") {
            let mut ahead = rest.clone();
            let next = ahead.next()?;
            *rest = ahead;
            return Self::known(&[b"end", next].concat());
        }
        Self::known(word)
    }

    fn known(word: &[u8]) -> Option<Self> {
        let all: [(&[u8], Self); 7] = [
            (b"vertex", Self::Vertex),
            (b"endloop", Self::EndLoop),
            (b"facet", Self::Facet),
            (b"outer", Self::Outer),
            (b"endfacet", Self::EndFacet),
            (b"solid", Self::Solid),
            (b"endsolid", Self::EndSolid),
        ];
        all.into_iter().find_map(|(known, keyword)| word.eq_ignore_ascii_case(known).then_some(keyword))
    }
}

/// A place in a text.
#[derive(Clone, Copy, PartialEq)]
enum Place {
    Solid,
    Facet,
    /// After `endsolid`.
    End,
}

/// The contents of a block of a text.
#[derive(Default)]
struct Part {
    vertices: Vec<DVec3>,
    /// The line of the first `endloop`, and the number of vertices before it.
    first: Option<(usize, usize)>,
    /// The number of vertices before the last `endloop`.
    last: usize,
    /// The place in which the block ends, if any place begins or ends in it.
    place: Option<Place>,
}

fn in_text(bytes: &[u8], budget: &MemoryBudget) -> Result<Model, ReadError> {
    let mut vertices = Vec::new();
    // The number of corners before the current facet.
    let (mut start, mut place) = (0, Place::Solid);
    let take = |part: Part, line| {
        if let Some((number, count)) = part.first {
            three(vertices.len() - start + count)
                .map_err(|message| ReadError::line(line + number, message))?;
            start = vertices.len() + part.last;
        }
        let count = vertices.len() + part.vertices.len();
        budget.holds(count, count / 3).map_err(ReadError::file)?;
        vertices.extend(part.vertices);
        place = part.place.unwrap_or(place);
        Ok(())
    };
    blocks::read(bytes, &mut 0, never, |_| 0, |block, _| Part::read(block, budget), take)?;
    if place == Place::Facet || vertices.len() != start {
        return Err(ReadError::line(blocks::line_ends(bytes) + 1, "the file ends within a facet"));
    }
    let remark = (place != Place::End).then(|| Remark {
        message: "has a file without `endsolid` at its end".to_owned(),
        help: "all facets in the file are used; if the file was cut off, copy or export it again",
    });
    finish(vertices, remark.into_iter().collect())
}

/// Refuses a facet that does not have three vertices.
fn three(count: usize) -> Result<(), String> {
    let message = || format!("a facet has three vertices, and this one has {count}");
    if count == 3 { Ok(()) } else { Err(message()) }
}

impl Part {
    /// Reads a block up to the first error.
    fn read(block: &[u8], budget: &MemoryBudget) -> (Self, Lines) {
        let mut part = Self::default();
        let lines = blocks::each_line(block, |number, line| part.line(number, line, budget));
        (part, lines)
    }

    /// Reads a line, which may have several keywords. Unused words after a keyword are skipped.
    fn line(&mut self, number: usize, line: &[u8], budget: &MemoryBudget) -> Result<(), String> {
        let mut words = words(line);
        let Some(first) = words.next() else { return Ok(()) };
        let mut keyword = Keyword::of(first, &mut words);
        if keyword.is_none() {
            return Err(format!("`{}` is not a word of STL", shown(first)));
        }
        while let Some(current) = keyword {
            match current {
                Keyword::Vertex => {
                    let mut at = [0.0; 3];
                    for part in &mut at {
                        *part = coordinate(words.next().ok_or("a vertex needs three coordinates")?)?;
                    }
                    budget.holds(self.vertices.len(), self.vertices.len() / 3)?;
                    self.vertices.push(DVec3::from(at));
                }
                Keyword::EndLoop => {
                    let count = self.vertices.len() - self.last;
                    match self.first {
                        None => self.first = Some((number, count)),
                        Some(_) => three(count)?,
                    }
                    self.last = self.vertices.len();
                }
                // A name may consist of any words. In a file of one line, the first facet follows it.
                Keyword::Solid | Keyword::EndSolid => {
                    let is_end = matches!(current, Keyword::EndSolid);
                    let normal = words
                        .by_ref()
                        .skip_while(|word| !word.eq_ignore_ascii_case(b"facet"))
                        .find(|word| word.eq_ignore_ascii_case(b"normal"));
                    self.place = Some(match normal {
                        _ if is_end => Place::End,
                        Some(_) => Place::Facet,
                        None => Place::Solid,
                    });
                }
                Keyword::Facet => self.place = Some(Place::Facet),
                Keyword::EndFacet => self.place = Some(Place::Solid),
                Keyword::Outer => {}
            }
            keyword = Keyword::next(&mut words);
        }
        Ok(())
    }
}

/// Makes a face from each three vertices.
fn finish(vertices: Vec<DVec3>, remarks: Vec<Remark>) -> Result<Model, ReadError> {
    if vertices.len() > MAX_VERTICES {
        return Err(ReadError::file("it has more than 2^31 corners"));
    }
    let faces =
        (0..vertices.len() as u32 / 3).map(|index| [3 * index, 3 * index + 1, 3 * index + 2]).collect();
    Ok(Model { vertices, faces, remarks, ..Model::default() })
}
