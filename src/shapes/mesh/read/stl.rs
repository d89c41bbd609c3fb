//! STL, in text and in bytes.

use super::model::{Broken, MAX_VERTICES, Model, coordinate, lines};
use crate::text;
use glam::DVec3;

/// The bytes before the first triangle: a title, and the number of triangles.
const HEADER: usize = 84;
/// The bytes of a triangle: a normal, three corners and two bytes more.
const TRIANGLE: usize = 50;

/// Reads a file. It is binary if its length is what its number of triangles says, as titles of binary files may begin
/// with `solid` too.
pub fn read(bytes: &[u8]) -> Result<Model, Broken> {
    let count = bytes.get(80..HEADER).map(|count| word(count) as usize);
    let is_binary = count.is_some_and(|count| bytes.len() - HEADER == TRIANGLE * count);
    let begins = bytes.trim_ascii_start();
    if !is_binary && begins.starts_with(b"solid") {
        return in_text(bytes);
    }
    let Some(count) = count else {
        return Err(Broken::byte(bytes.len(), "the file ends before its number of triangles"));
    };
    if (bytes.len() - HEADER) / TRIANGLE < count {
        let message =
            format!("the file ends after {} of {count} triangles", (bytes.len() - HEADER) / TRIANGLE);
        return Err(Broken::byte(bytes.len(), message));
    }
    let mut model = Model::default();
    for (index, triangle) in bytes[HEADER..].chunks_exact(TRIANGLE).take(count).enumerate() {
        for corner in 0..3 {
            let part =
                |axis: usize| f64::from(f32::from_bits(word(&triangle[12 + 12 * corner + 4 * axis..][..4])));
            let at = DVec3::new(part(0), part(1), part(2));
            if !at.is_finite() {
                let byte = HEADER + TRIANGLE * index + 12 + 12 * corner;
                return Err(Broken::byte(byte, format!("a corner of triangle {} is not finite", index + 1)));
            }
            model.vertices.push(at);
        }
    }
    finish(model)
}

/// Reads a number from four bytes, the lowest first.
fn word(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte))
}

fn in_text(bytes: &[u8]) -> Result<Model, Broken> {
    let mut model = Model::default();
    // The number of corners before the current facet.
    let mut start = 0;
    let mut last = 1;
    for (number, line) in lines(bytes) {
        let fault = |message: String| Broken::line(number, message);
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("vertex") => {
                let mut at = [0.0; 3];
                for part in &mut at {
                    let word =
                        words.next().ok_or_else(|| fault("a vertex needs three coordinates".to_owned()))?;
                    *part = coordinate(word).map_err(fault)?;
                }
                model.vertices.push(DVec3::from(at));
            }
            Some("endloop") => {
                let count = model.vertices.len() - start;
                if count != 3 {
                    return Err(fault(format!("a facet has three vertices, and this one has {count}")));
                }
                start += 3;
            }
            Some("facet" | "outer" | "endfacet" | "solid" | "endsolid") | None => {}
            Some(word) => return Err(fault(format!("`{}` is not a word of STL", text::abridged(word)))),
        }
        last = number;
    }
    if model.vertices.len() != start {
        return Err(Broken::line(last, "the file ends within a facet"));
    }
    finish(model)
}

/// Makes a face of every three vertices.
fn finish(mut model: Model) -> Result<Model, Broken> {
    if model.vertices.len() > MAX_VERTICES {
        return Err(Broken::file("it has more than 2^31 corners"));
    }
    model.faces =
        (0..model.vertices.len() as u32 / 3).map(|index| [3 * index, 3 * index + 1, 3 * index + 2]).collect();
    Ok(model)
}
