//! Wavefront OBJ: vertices, faces, the names of their materials and, if wanted, normals, texture coordinates and
//! colours. Other contents are ignored.

use super::at_corners::{AtCorners, Attributes, NO_VALUE};
use super::blocks::{self, Lines, Words, words};
use super::model::{MAX_VERTICES, MemoryBudget, Model, ReadError, coordinate, shown};
use super::mtl;
use super::polygons::Polygons;
use glam::DVec3;
use memchr::{memchr, memrchr};
use std::borrow::Cow;
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::ops::Add;
use std::path::Path;
use std::sync::Arc;
use tabray_world::display::Display;

/// The elements of the lines `v`, `vt` and `vn`, in singular and plural.
const NAMES: [[&str; 2]; 3] = [["vertex", "vertices"], ["`vt`", "`vt`"], ["`vn`", "`vn`"]];

/// The numbers of lines `v`, `vt` and `vn`.
#[derive(Clone, Copy, Default)]
struct Counts([usize; 3]);

impl Add for Counts {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self([0, 1, 2].map(|of| self.0[of] + other.0[of]))
    }
}

/// The contents of a block of a file.
#[derive(Default)]
struct Part {
    model: Model,
    polygons: Polygons,
    /// The names of materials, each with the number of the block's triangles before it and its line. An empty name
    /// stands for the mesh's own material.
    uses: Vec<(usize, String, usize)>,
    /// The names after `mtllib`, and their line.
    libraries: Vec<(Vec<u8>, usize)>,
    /// The colours of vertices as written, up to the last vertex with a colour, or NaN for a vertex without one.
    colours: Vec<[f32; 3]>,
    /// For each of `v`, `vt` and `vn`, the largest index that a face refers to ahead of its element, and the line of
    /// the face.
    ahead: [Option<(u32, usize)>; 3],
}

/// Reads the text of a file in a folder.
pub fn read(bytes: &[u8], folder: &Path, budget: &MemoryBudget) -> Result<Model, ReadError> {
    let mut model = Model::default();
    let mut names = HashMap::new();
    let mut polygons = Polygons::default();
    let (mut slot, mut ahead) = (0, [const { Vec::new() }; 3]);
    let (mut libraries, mut colours) = (Vec::new(), Vec::new());
    let take = |part: Part, line: usize| {
        let [vertices, before] = [model.vertices.len(), model.faces.len()];
        model.append(part.model, budget)?;
        if !part.colours.is_empty() {
            colours.resize(vertices, NO_COLOUR);
            colours.extend(part.colours);
        }
        polygons.append(part.polygons, before);
        for (all, found) in ahead.iter_mut().zip(part.ahead) {
            all.extend(found.map(|(index, number)| (index, line + number)));
        }
        libraries.extend(part.libraries.into_iter().map(|(names, number)| (names, line + number)));
        for (faces, name, number) in part.uses {
            // Faces before the first material have none.
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
        Ok(())
    };
    let read = |block: &[u8], before| Part::read(block, before, budget);
    blocks::read(bytes, &mut 0, continues, counts, read, take)?;
    if let Some(within) = ends_within(bytes) {
        return Err(ReadError::line(blocks::line_ends(bytes) + 1, format!("the file ends within {within}")));
    }
    let Attributes { normals, uv, .. } = &model.attributes;
    let counts = [model.vertices.len(), uv.values.len(), normals.values.len()];
    for ((ahead, count), [name, _]) in ahead.into_iter().zip(counts).zip(NAMES) {
        // Some programs refer to normals or texture coordinates in files without any.
        let is_told = count > 0 || name == NAMES[0][0];
        let mut ahead = ahead.into_iter().filter(|_| is_told);
        if let Some((index, line)) = ahead.find(|(index, _)| *index as usize >= count) {
            let message = format!("there is no {name} {}: the file has {count}", u64::from(index) + 1);
            return Err(ReadError::line(line, message));
        }
    }
    model.attributes.drop_unused();
    if budget.wanted.materials.is_some() {
        mtl::furnish(&mut model, &libraries, folder, budget);
    }
    polygons.cut(&mut model);
    if let Some(display) = budget.wanted.materials.filter(|_| !colours.is_empty()) {
        colours.resize(model.vertices.len(), NO_COLOUR);
        model.attributes.colours = AtCorners::of_vertices(lights(colours, display), &model.faces);
    }
    Ok(model)
}

/// Returns what a file ends within, as far as its last line shows where that has no end.
fn ends_within(bytes: &[u8]) -> Option<&'static str> {
    let last = &bytes[memrchr(b'\n', bytes).map_or(0, |end| end + 1)..];
    let mut words = words(&last[..memchr(b'#', last).unwrap_or(last.len())]);
    let least = match words.next()? {
        b"v" | b"vn" | b"f" => 3,
        b"vt" => 1,
        _ => return None,
    };
    if last.ends_with(b"\\") || words.count() < least {
        return Some("a line");
    }
    blocks::ends_within_number(last).then_some("a number")
}

/// The colour of a vertex without one.
const NO_COLOUR: [f32; 3] = [f32::NAN; 3];

/// Converts the colours of vertices to light, like the bytes of an image. Colours are from 0 to 1 or, if any number is
/// above 1, from 0 to 255. A vertex without a colour is white.
fn lights(colours: Vec<[f32; 3]>, display: Display) -> Vec<[f32; 4]> {
    let greatest = colours.iter().flatten().fold(0.0, |most: f32, channel| most.max(*channel));
    let bytes = if greatest > 1.0 { 1.0 } else { 255.0 };
    let light = |channel: f32| {
        let byte = if channel.is_nan() { 255.0 } else { (bytes * channel).round() };
        display.light_of(byte as u8) as f32
    };
    colours
        .into_iter()
        .map(|colour| colour.map(light))
        .map(|[red, green, blue]| [red, green, blue, 1.0])
        .collect()
}

/// Returns the reason why a file has no faces.
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
        None => "no line of it begins with `v` or `f`, so it is not an OBJ".to_owned(),
    }
}

/// Tells whether a line continues in the next one: it ends with a backslash outside of a comment.
fn continues(line: &[u8]) -> bool {
    line.strip_suffix(b"\r").unwrap_or(line).ends_with(b"\\") && memchr(b'#', line).is_none()
}

/// Calls `each` with the number of each line, from 1, and the line, until an error. Continued lines count as one line,
/// without a comment.
fn each_line<'b>(block: &'b [u8], mut each: impl FnMut(usize, Cow<'b, [u8]>) -> Result<(), String>) -> Lines {
    let mut lines = blocks::lines(block);
    let mut count = 0;
    while let Some(line) = lines.next() {
        count += 1;
        let first = count;
        let mut each = |line| each(first, line).map_err(|message| (first, message));
        if !continues(line) {
            each(Cow::Borrowed(line))?;
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
        each(Cow::Owned(whole))?;
    }
    Ok(count)
}

/// Counts the lines `v`, `vt` and `vn` of a block.
fn counts(block: &[u8]) -> Counts {
    let (mut counts, mut is_continued) = (Counts::default(), false);
    for line in blocks::lines(block) {
        let of = match words(line).next() {
            Some(b"v") => Some(0),
            Some(b"vt") => Some(1),
            Some(b"vn") => Some(2),
            _ => None,
        };
        of.filter(|_| !is_continued).into_iter().for_each(|of| counts.0[of] += 1);
        is_continued = continues(line);
    }
    counts
}

impl Part {
    /// Reads a block up to the first error, given the counts before it.
    fn read(block: &[u8], mut counts: Counts, budget: &MemoryBudget) -> (Self, Lines) {
        let (mut part, mut corners) = (Self::default(), Default::default());
        let lines =
            each_line(block, |number, line| part.line(number, &line, &mut counts, &mut corners, budget));
        (part, lines)
    }

    fn line(
        &mut self,
        number: usize,
        line: &[u8],
        Counts(counts): &mut Counts,
        corners: &mut [Vec<u32>; 3],
        budget: &MemoryBudget,
    ) -> Result<(), String> {
        let wanted = budget.wanted;
        let Attributes { normals, uv, .. } = &mut self.model.attributes;
        let mut words = words(&line[..memchr(b'#', line).unwrap_or(line.len())]);
        match words.next() {
            Some(b"v") => {
                let mut at = [0.0; 3];
                for part in &mut at {
                    *part = coordinate(words.next().ok_or("a vertex needs three coordinates")?)?;
                }
                if counts[0] == MAX_VERTICES {
                    return Err("there are more than 2^31 vertices".to_owned());
                }
                counts[0] += 1;
                self.model.vertices.push(DVec3::from(at));
                if wanted.materials.is_some()
                    && let [Ok(red), Ok(green), Ok(blue)] =
                        [part(&mut words), part(&mut words), part(&mut words)]
                {
                    self.colours.resize(self.model.vertices.len() - 1, NO_COLOUR);
                    self.colours.push([red, green, blue]);
                }
            }
            Some(b"vt") => {
                counts[1] += 1;
                if wanted.materials.is_some() {
                    // A texture coordinate may have one, two or three components.
                    let [u, v] = [part(&mut words)?, part(&mut words).unwrap_or(0.0)];
                    uv.values.push([u, v]);
                }
            }
            Some(b"vn") => {
                counts[2] += 1;
                if wanted.normals {
                    normals.values.push([part(&mut words)?, part(&mut words)?, part(&mut words)?]);
                }
            }
            Some(b"f") => {
                corners.iter_mut().for_each(Vec::clear);
                let is_wanted = [true, wanted.materials.is_some(), wanted.normals];
                for word in words {
                    let mut parts = word.split(|byte| *byte == b'/');
                    for of in 0..3 {
                        let part = parts.next().unwrap_or_default();
                        if !is_wanted[of] {
                            continue;
                        }
                        let index =
                            if part.is_empty() && of > 0 { NO_VALUE } else { index(word, part, counts, of)? };
                        let is_ahead = index as usize >= counts[of] && index != NO_VALUE;
                        if is_ahead && self.ahead[of].is_none_or(|(most, _)| most < index) {
                            self.ahead[of] = Some((index, number));
                        }
                        corners[of].push(index);
                    }
                    // A polygon may be as long as the file.
                    if corners[0].len().is_multiple_of(1 << 16) {
                        budget.holds(counts[0], self.model.faces.len() + corners[0].len())?;
                    }
                }
                budget.holds(counts[0], self.model.faces.len() + corners[0].len())?;
                self.polygons.add(&corners[0], &mut self.model.faces);
                Polygons::add_values(&corners[1], Arc::make_mut(&mut uv.faces));
                Polygons::add_values(&corners[2], Arc::make_mut(&mut normals.faces));
            }
            Some(b"mtllib") if wanted.materials.is_some() => {
                self.libraries.push((after_first_word(line).to_vec(), number))
            }
            Some(b"usemtl") => self.uses.push((self.model.faces.len(), mtl::material(line), number)),
            _ => {}
        }
        Ok(())
    }
}

/// Returns what follows the first word of a line.
fn after_first_word(line: &[u8]) -> &[u8] {
    let mut words = words(line);
    words.next();
    words.rest
}

/// Reads a number, which may be NaN: some programs divide by 0.
fn part(words: &mut Words) -> Result<f32, String> {
    let word = words.next().ok_or("a number is missing")?;
    let number = str::from_utf8(word).ok().and_then(|word| word.parse().ok());
    number.ok_or_else(|| format!("`{}` is not a number", shown(word)))
}

/// Reads an index of a face's corner, `vertex/texture/normal`. Indices count from 1, or backward from -1, the last
/// element so far. Elements may come after the faces that refer to them.
fn index(word: &[u8], part: &[u8], counts: &[usize; 3], of: usize) -> Result<u32, String> {
    let (count, [one, several]) = (counts[of], NAMES[of]);
    let index: Option<i64> = str::from_utf8(part).ok().and_then(|part| part.parse().ok());
    let index = index.ok_or_else(|| format!("`{}` is not a vertex's number", shown(word)))?;
    let found = match index {
        1.. => usize::try_from(index - 1).ok().filter(|index| *index < MAX_VERTICES),
        0 => return Err(format!("{several} are counted from 1, so there is no {one} 0")),
        _ => usize::try_from(index.unsigned_abs()).ok().and_then(|back| count.checked_sub(back)),
    };
    found.map(|index| index as u32).ok_or_else(|| {
        let before =
            if count == 1 { format!("1 {one} precedes") } else { format!("{count} {several} precede") };
        format!("there is no {one} {index}: {before} this face")
    })
}
