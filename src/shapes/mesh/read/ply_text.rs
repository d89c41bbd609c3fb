//! The elements of a PLY as text. Each has a line, but other layouts are accepted.

use super::at_corners::{AtCorners, NO_VALUE};
use super::blocks::{self, Lines, Words, is_blank, never, words};
use super::model::{ENDS_EARLY, MemoryBudget, Model, ReadError, coordinate};
use super::ply_header::unexpected;
use super::ply_section::{Field, Kind, Number, Section, Vertex, coordinates};
use super::polygons::Polygons;
use memchr::memchr_iter;
use std::sync::Arc;

/// The contents of a block of a text.
#[derive(Default)]
struct Part {
    model: Model,
    polygons: Polygons,
    given: Vec<i64>,
    uv: Vec<f32>,
    corners: Vec<u32>,
}

/// Reads the text after the header, which ends before this line. If each element has a line, all cores read lines, and
/// otherwise the text is read word by word.
pub(super) fn read(
    rest: &[u8],
    line: usize,
    sections: &[Section],
    budget: &MemoryBudget,
) -> Result<(Model, Polygons), ReadError> {
    by_lines(rest, line, sections, budget).or_else(|error| {
        by_words(rest, line, sections, budget).map_err(|other| if other.at.is_some() { other } else { error })
    })
}

fn by_lines(
    mut rest: &[u8],
    mut line: usize,
    sections: &[Section],
    budget: &MemoryBudget,
) -> Result<(Model, Polygons), ReadError> {
    let (mut model, mut polygons) = Default::default();
    for section in sections {
        let (lines, after) = rest.split_at(end_of(rest, section.count)?);
        let take = |part, _| add(part, &mut model, &mut polygons, budget);
        let read = |block: &[u8], first| Part::read(block, first, section, budget);
        blocks::read(lines, &mut line, never, count, read, take)?;
        rest = after;
    }
    Ok((model, polygons))
}

fn by_words(
    rest: &[u8],
    line: usize,
    sections: &[Section],
    budget: &MemoryBudget,
) -> Result<(Model, Polygons), ReadError> {
    let (mut model, mut polygons) = Default::default();
    let mut words = words(rest);
    for section in sections {
        let mut part = Part::default();
        for index in 0..section.count {
            part.element(&mut words, index, section, budget).map_err(|message| {
                if words.rest.is_empty() {
                    return ReadError::file(ENDS_EARLY);
                }
                let before = &rest[..rest.len() - words.rest.len()];
                ReadError::line(line + blocks::line_ends(before) + 1, message)
            })?;
        }
        add(part, &mut model, &mut polygons, budget)?;
    }
    Ok((model, polygons))
}

fn add(
    mut part: Part,
    model: &mut Model,
    polygons: &mut Polygons,
    budget: &MemoryBudget,
) -> Result<(), ReadError> {
    let before = model.faces.len();
    // What faces have is counted from the beginning of the part.
    let (whole, own) = (&mut model.attributes, &mut part.model.attributes);
    shift(&mut own.uv, &mut whole.uv, before);
    shift(&mut own.colours, &mut whole.colours, before);
    if !part.model.slots.is_empty() {
        model.slots.resize(before, 0);
        model.slots.append(&mut part.model.slots);
    }
    model.append(part.model, budget)?;
    polygons.append(part.polygons, before);
    Ok(())
}

/// Counts the values of a part's faces from those of the whole file, of which some faces came before.
fn shift<T: Copy>(part: &mut AtCorners<T>, whole: &mut AtCorners<T>, before: usize) {
    if part.is_empty() {
        return;
    }
    let first = whole.values.len() as u32;
    let own = Arc::make_mut(&mut part.faces).iter_mut().flatten();
    own.filter(|corner| **corner != NO_VALUE).for_each(|corner| *corner += first);
    Arc::make_mut(&mut whole.faces).resize(before, [NO_VALUE; 3]);
}

fn is_empty(line: &[u8]) -> bool {
    line.iter().all(is_blank)
}

/// Returns the number of lines that are not empty.
fn count(text: &[u8]) -> usize {
    blocks::lines(text).filter(|line| !is_empty(line)).count()
}

/// Returns the end of the first `count` lines that are not empty.
fn end_of(text: &[u8], count: usize) -> Result<usize, ReadError> {
    let (mut start, mut left) = (0, count);
    // The last line of a file may have no newline.
    for end in memchr_iter(b'\n', text).map(|end| end + 1).chain([text.len()]) {
        if left == 0 {
            return Ok(start);
        }
        left -= usize::from(!is_empty(&text[start..end]));
        start = end;
    }
    if left == 0 { Ok(start) } else { Err(ReadError::file(ENDS_EARLY)) }
}

impl Part {
    /// Reads a block of lines up to the first error. Its first element has this index.
    fn read(block: &[u8], mut index: usize, section: &Section, budget: &MemoryBudget) -> (Self, Lines) {
        let mut part = Self::default();
        let lines = blocks::each_line(block, |_, line| {
            if section.kind != Kind::Other && !is_empty(line) {
                part.element(&mut words(line), index, section, budget)?;
                index += 1;
            }
            Ok(())
        });
        (part, lines)
    }

    fn element(
        &mut self,
        words: &mut Words,
        index: usize,
        section: &Section,
        budget: &MemoryBudget,
    ) -> Result<(), String> {
        let (start, mut vertex) = (words.rest, Vertex::default());
        let is_whole = self.fields(words, section, &mut vertex, budget).is_some();
        let text = || &start[..start.len() - words.rest.len()];
        if !is_whole {
            return Err(unexpected(text(), false));
        }
        match section.kind {
            Kind::Vertex if coordinates(&vertex).is_finite() => {
                section.put(&vertex, &mut self.model.vertices, &mut self.model.attributes);
            }
            Kind::Vertex => {
                let wrong = blocks::words(text()).find_map(|word| coordinate(word).err());
                return Err(wrong.unwrap_or_else(|| format!("vertex {index} is not finite")));
            }
            Kind::Face | Kind::Strips => {
                let before = self.model.faces.len();
                budget.holds(section.vertices, before + self.given.len())?;
                section.add(
                    index,
                    &self.given,
                    &mut self.corners,
                    &mut self.model.faces,
                    &mut self.polygons,
                )?;
                section.put_face(&vertex, &self.uv, (self.given.len(), before), &mut self.model);
            }
            Kind::Other => {}
        }
        Ok(())
    }

    /// Reads the properties of an element, or returns `None` if the words do not fit them.
    fn fields(
        &mut self,
        words: &mut Words,
        section: &Section,
        vertex: &mut Vertex,
        budget: &MemoryBudget,
    ) -> Option<()> {
        self.uv.clear();
        for field in &section.fields {
            let word = str::from_utf8(words.next()?).ok()?;
            match *field {
                Field::Number(_) => {}
                Field::Vertex(place, number) => vertex[place] = scalar(word, number)?,
                Field::List(..) => {
                    if let Some(last) = word.parse::<usize>().ok()?.checked_sub(1) {
                        words.nth(last)?;
                    }
                }
                Field::Uv(_, number) => {
                    for _ in 0..word.parse::<usize>().ok()? {
                        self.uv.push(scalar(str::from_utf8(words.next()?).ok()?, number)? as f32);
                    }
                }
                Field::Corners(_, number) => {
                    self.given.clear();
                    for _ in 0..word.parse::<usize>().ok()? {
                        self.given.push(whole(str::from_utf8(words.next()?).ok()?, number)?);
                        // A polygon may be as long as the file. If it does not fit in memory, its faces are refused
                        // later.
                        if self.given.len().is_multiple_of(1 << 16)
                            && budget.holds(0, self.given.len()).is_err()
                        {
                            break;
                        }
                    }
                }
            }
        }
        Some(())
    }
}

/// Reads a number of a type.
fn scalar(word: &str, number: Number) -> Option<f64> {
    match number {
        Number::Float => word.parse::<f32>().ok().map(f64::from),
        Number::Double => word.parse().ok(),
        Number::Signed(_) | Number::Unsigned(_) => whole(word, number).map(|whole| whole as f64),
    }
}

/// Reads an integer of a type.
fn whole(word: &str, number: Number) -> Option<i64> {
    let range = match number {
        Number::Signed(size) => i64::MIN >> (64 - 8 * size)..=i64::MAX >> (64 - 8 * size),
        Number::Unsigned(size) => 0..=i64::MAX >> 63_usize.saturating_sub(8 * size),
        Number::Float | Number::Double => return None,
    };
    word.parse().ok().filter(|whole| range.contains(whole))
}
