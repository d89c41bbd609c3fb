//! Wavefront OBJ: vertices, faces, and the names of their materials. All else is ignored.

use super::blocks::{self, words};
use super::model::{MAX_VERTICES, MemoryBudget, Model, ReadError, coordinate, shown};
use super::polygons::Polygons;
use glam::DVec3;
use memchr::memchr;
use std::borrow::Cow;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// What a block of a file holds.
#[derive(Default)]
struct Part {
    vertices: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
    polygons: Polygons,
    /// The names of materials, each with the number of the block's triangles before it and its line; no name is that of
    /// the mesh's own material.
    uses: Vec<(usize, String, usize)>,
    /// The largest number of a vertex that comes after its face, and the line.
    ahead: Option<(u32, usize)>,
    lines: usize,
    /// The first fault, with its line.
    fault: Option<(usize, String)>,
}

/// Reads a file's text.
pub fn read(bytes: &[u8], budget: &MemoryBudget) -> Result<Model, ReadError> {
    let mut model = Model::default();
    let mut names = HashMap::new();
    let mut polygons = Polygons::default();
    let (mut slot, mut line, mut ahead) = (0, 0, Vec::new());
    let take = |part: Part| {
        budget
            .holds(model.vertices.len() + part.vertices.len(), model.faces.len() + part.faces.len())
            .map_err(ReadError::file)?;
        let before = model.faces.len();
        model.vertices.extend(part.vertices);
        model.faces.extend(part.faces);
        polygons.append(part.polygons, before);
        ahead.extend(part.ahead.map(|(vertex, number)| (vertex, line + number)));
        for (faces, name, number) in part.uses {
            // Faces so far without a material keep none.
            model.slots.resize(before + faces, slot);
            if name.is_empty() {
                slot = 0;
                continue;
            }
            slot = match names.entry(name) {
                Entry::Occupied(known) => *known.get(),
                Entry::Vacant(free) => {
                    let next = u16::try_from(model.materials.len() + 1)
                        .map_err(|_| ReadError::line(line + number, "there are more than 65535 materials"))?;
                    model.materials.push(free.key().clone());
                    *free.insert(next)
                }
            };
        }
        if slot != 0 || !model.slots.is_empty() {
            model.slots.resize(model.faces.len(), slot);
        }
        let fault = part.fault.map(|(number, message)| ReadError::line(line + number, message));
        line += part.lines;
        fault.map_or(Ok(()), Err)
    };
    blocks::read(bytes, continues, vertices, |block, before| Part::read(block, before, budget), take)?;
    let count = model.vertices.len();
    if let Some((vertex, line)) = ahead.into_iter().find(|(vertex, _)| *vertex as usize >= count) {
        let message = format!("there is no vertex {}: the file has {count}", u64::from(vertex) + 1);
        return Err(ReadError::line(line, message));
    }
    polygons.cut(&mut model);
    Ok(model)
}

/// Says why a file without faces has none.
pub fn without_faces(bytes: &[u8]) -> String {
    let of = |known: &[&str]| {
        let mut words = blocks::lines(bytes).filter_map(|line| words(line).next());
        words.find(|word| known.iter().any(|known| known.as_bytes() == *word)).map(shown)
    };
    if let Some(word) = of(&["curv", "curv2", "surf"]) {
        return format!("its curved surfaces (`{word}`) are not read: export it as a mesh of polygons");
    }
    if let Some(word) = of(&["l", "p"]) {
        return format!("it has lines or points (`{word}`) and no faces");
    }
    match of(&["v"]) {
        Some(_) => "it has vertices and no faces: it is a cloud of points".to_owned(),
        None => "no line of it begins with `v` or `f`, so it is no OBJ".to_owned(),
    }
}

/// Tells whether a line goes on in the next one: it ends with a backslash that is not in a comment.
fn continues(line: &[u8]) -> bool {
    line.strip_suffix(b"\r").unwrap_or(line).ends_with(b"\\") && memchr(b'#', line).is_none()
}

/// Calls `each` with the number of every line, from 1, and the line, until that fails. Lines that are continued are one,
/// without a comment. Returns the number of lines.
fn each_line<'b, E>(
    block: &'b [u8],
    mut each: impl FnMut(usize, Cow<'b, [u8]>) -> Result<(), E>,
) -> Result<usize, E> {
    let mut lines = blocks::lines(block);
    let mut count = 0;
    while let Some(line) = lines.next() {
        count += 1;
        let first = count;
        if !continues(line) {
            each(first, Cow::Borrowed(line))?;
            continue;
        }
        let (mut whole, mut next) = (Vec::new(), Some(line));
        while let Some(line) = next {
            let goes_on = continues(line);
            let end = if goes_on { line.iter().rposition(|byte| *byte == b'\\') } else { memchr(b'#', line) };
            whole.extend_from_slice(&line[..end.unwrap_or(line.len())]);
            whole.push(b' ');
            next = if goes_on { lines.next() } else { None };
            count += usize::from(next.is_some());
        }
        each(first, Cow::Owned(whole))?;
    }
    Ok(count)
}

/// Returns the number of a block's vertices.
fn vertices(block: &[u8]) -> usize {
    let (mut count, mut is_continued) = (0, false);
    for line in blocks::lines(block) {
        count += usize::from(!is_continued && words(line).next() == Some(b"v"));
        is_continued = continues(line);
    }
    count
}

impl Part {
    /// Reads a block with so many vertices before it, up to the first fault.
    fn read(block: &[u8], before: usize, budget: &MemoryBudget) -> Self {
        let mut part = Self::default();
        let mut corners = Vec::new();
        let read = each_line(block, |number, line| {
            part.line(number, &line, before, &mut corners, budget).map_err(|message| (number, message))
        });
        match read {
            Ok(lines) => part.lines = lines,
            Err(fault) => part.fault = Some(fault),
        }
        part
    }

    fn line(
        &mut self,
        number: usize,
        line: &[u8],
        before: usize,
        corners: &mut Vec<u32>,
        budget: &MemoryBudget,
    ) -> Result<(), String> {
        let mut words = words(&line[..memchr(b'#', line).unwrap_or(line.len())]);
        match words.next() {
            Some(b"v") => {
                let mut at = [0.0; 3];
                for part in &mut at {
                    *part = coordinate(words.next().ok_or("a vertex needs three coordinates")?)?;
                }
                if before + self.vertices.len() == MAX_VERTICES {
                    return Err("there are more than 2^31 vertices".to_owned());
                }
                self.vertices.push(DVec3::from(at));
            }
            Some(b"f") => {
                corners.clear();
                let count = before + self.vertices.len();
                for word in words {
                    let corner = corner(word, count)?;
                    if corner as usize >= count && self.ahead.is_none_or(|(most, _)| most < corner) {
                        self.ahead = Some((corner, number));
                    }
                    corners.push(corner);
                    // A polygon may be as long as the file.
                    if corners.len().is_multiple_of(1 << 16) {
                        budget.holds(count, self.faces.len() + corners.len())?;
                    }
                }
                budget.holds(count, self.faces.len() + corners.len())?;
                self.polygons.add(corners, &mut self.faces);
            }
            Some(b"usemtl") => self.uses.push((self.faces.len(), material(line), number)),
            _ => {}
        }
        Ok(())
    }
}

/// Returns the name that follows `usemtl`. It may have a `#`, as in `Material #25`; one between blanks begins a comment.
fn material(line: &[u8]) -> String {
    let name = words(line).skip(1).take_while(|word| *word != b"#");
    name.map(String::from_utf8_lossy).collect::<Vec<_>>().join(" ")
}

/// Reads a corner of a face, `vertex/texture/normal`: its vertex counts from 1, or backward from -1 of those so far. A vertex
/// may come after its faces.
fn corner(word: &[u8], count: usize) -> Result<u32, String> {
    let vertex = &word[..word.iter().position(|byte| *byte == b'/').unwrap_or(word.len())];
    let index: Option<i64> = str::from_utf8(vertex).ok().and_then(|vertex| vertex.parse().ok());
    let index = index.ok_or_else(|| format!("`{}` is not a vertex's number", shown(word)))?;
    let found = match index {
        1.. => usize::try_from(index - 1).ok().filter(|index| *index < MAX_VERTICES),
        0 => return Err("vertices are counted from 1, so there is no vertex 0".to_owned()),
        _ => usize::try_from(index.unsigned_abs()).ok().and_then(|back| count.checked_sub(back)),
    };
    found.map(|index| index as u32).ok_or_else(|| {
        let before =
            if count == 1 { "1 vertex precedes".to_owned() } else { format!("{count} vertices precede") };
        format!("there is no vertex {index}: {before} this face")
    })
}
