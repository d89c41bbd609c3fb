//! The elements of a PLY in text: each has a line.

use super::blocks::{self, line_ends, never, words};
use super::model::{ENDS_EARLY, MemoryBudget, Model, ReadError, coordinate, fan};
use super::ply_header::{Field, Kind, Number, Section, unexpected};
use glam::DVec3;
use memchr::memchr_iter;

/// What a block of lines holds.
#[derive(Default)]
struct Part {
    vertices: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
    /// The first fault, with the index of its element.
    fault: Option<(usize, String)>,
    given: Vec<i64>,
    corners: Vec<u32>,
}

/// Reads what follows the header, which ends before this line.
pub(super) fn read(
    mut rest: &[u8],
    mut line: usize,
    sections: &[Section],
    budget: &MemoryBudget,
) -> Result<Model, ReadError> {
    let mut model = Model::default();
    for section in sections {
        let end = match section.count.checked_sub(1) {
            None => Some(0),
            Some(last) => memchr_iter(b'\n', rest).nth(last).map(|end| end + 1),
        };
        // The last line of a file may have no end.
        let is_cut = end.is_none() && blocks::lines(rest).count() < section.count;
        let (lines, after) = rest.split_at(end.unwrap_or(rest.len()));
        if section.kind != Kind::Other {
            let take = |part: Part| {
                budget
                    .holds(model.vertices.len() + part.vertices.len(), model.faces.len() + part.faces.len())
                    .map_err(ReadError::file)?;
                model.vertices.extend(part.vertices);
                model.faces.extend(part.faces);
                part.fault.map_or(Ok(()), |(index, message)| Err(ReadError::line(line + index, message)))
            };
            blocks::read(
                lines,
                never,
                line_ends,
                |block, first| Part::read(block, first, section, budget),
                take,
            )?;
        }
        if is_cut {
            return Err(ReadError::file(ENDS_EARLY));
        }
        (rest, line) = (after, line + section.count);
    }
    Ok(model)
}

impl Part {
    /// Reads a block of lines up to the first fault; its first element has this index.
    fn read(block: &[u8], first: usize, section: &Section, budget: &MemoryBudget) -> Self {
        let mut part = Self::default();
        for (index, line) in (first..).zip(blocks::lines(block)) {
            if let Err(message) = part.element(line, index, section, budget) {
                part.fault = Some((index, message));
                break;
            }
        }
        part
    }

    fn element(
        &mut self,
        line: &[u8],
        index: usize,
        section: &Section,
        budget: &MemoryBudget,
    ) -> Result<(), String> {
        let mut at = [0.0; 3];
        self.fields(line, section, &mut at, budget).ok_or_else(|| unexpected(line, false))?;
        match section.kind {
            Kind::Vertex if DVec3::from(at).is_finite() => self.vertices.push(DVec3::from(at)),
            Kind::Vertex => {
                let wrong = words(line).find_map(|word| coordinate(word).err());
                return Err(wrong.unwrap_or_else(|| format!("vertex {index} is not finite")));
            }
            Kind::Face => {
                section.corners(index, &self.given, &mut self.corners)?;
                budget.holds(section.vertices, self.faces.len() + self.corners.len())?;
                fan(&self.corners, &mut self.faces);
            }
            Kind::Other => {}
        }
        Ok(())
    }

    /// Reads the properties of an element; `None` where the line does not have them.
    fn fields(
        &mut self,
        line: &[u8],
        section: &Section,
        at: &mut [f64; 3],
        budget: &MemoryBudget,
    ) -> Option<()> {
        let mut words = words(line);
        for field in &section.fields {
            let word = str::from_utf8(words.next()?).ok()?;
            match *field {
                Field::Number(_) => {}
                Field::Coordinate(axis, number) => at[axis] = scalar(word, number)?,
                Field::List(..) => {
                    if let Some(last) = word.parse::<usize>().ok()?.checked_sub(1) {
                        words.nth(last)?;
                    }
                }
                Field::Corners(_, number) => {
                    self.given.clear();
                    for _ in 0..word.parse::<usize>().ok()? {
                        self.given.push(whole(str::from_utf8(words.next()?).ok()?, number)?);
                        // A polygon may be as long as the file: what does not fit is refused with its faces.
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

/// Reads a whole number of a type.
fn whole(word: &str, number: Number) -> Option<i64> {
    let range = match number {
        Number::Signed(size) => -1 << (8 * size - 1)..1 << (8 * size - 1),
        Number::Unsigned(size) => 0..1 << (8 * size),
        Number::Float | Number::Double => return None,
    };
    word.parse().ok().filter(|whole| range.contains(whole))
}
