//! Wavefront OBJ: vertices, faces, and the names of their materials. All else is ignored.

use super::model::{Broken, MAX_VERTICES, Model, coordinate, lines};
use crate::text;
use glam::DVec3;
use std::collections::HashMap;

/// Reads a file's text.
pub fn read(bytes: &[u8]) -> Result<Model, Broken> {
    // A byte order mark is no part of the text.
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut model = Model::default();
    let mut names = HashMap::new();
    let mut slot = 0;
    let mut corners = Vec::new();
    for (number, line) in lines(bytes) {
        let fault = |message: String| Broken::line(number, message);
        let line = line.split('#').next().unwrap_or_default();
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => {
                let mut at = [0.0; 3];
                for part in &mut at {
                    let word =
                        words.next().ok_or_else(|| fault("a vertex needs three coordinates".to_owned()))?;
                    *part = coordinate(word).map_err(fault)?;
                }
                if model.vertices.len() == MAX_VERTICES {
                    return Err(fault("there are more than 2^31 vertices".to_owned()));
                }
                model.vertices.push(DVec3::from(at));
            }
            Some("f") => {
                corners.clear();
                for word in words {
                    corners.push(corner(word, model.vertices.len()).map_err(fault)?);
                }
                if corners.len() < 3 {
                    let count = corners.len();
                    return Err(fault(format!("a face needs three vertices, and this one has {count}")));
                }
                for pair in corners[1..].windows(2) {
                    model.faces.push([corners[0], pair[0], pair[1]]);
                }
                if slot != 0 || !model.slots.is_empty() {
                    model.slots.resize(model.faces.len(), slot);
                }
            }
            Some("usemtl") => {
                let name = words.collect::<Vec<_>>().join(" ");
                if name.is_empty() {
                    return Err(fault("`usemtl` needs the name of a material".to_owned()));
                }
                // Faces so far without a material keep none.
                model.slots.resize(model.faces.len(), 0);
                let next = names.len() + 1;
                slot = *names.entry(name).or_insert_with_key(|name| {
                    model.materials.push(name.clone());
                    next as u16
                });
                if next > usize::from(u16::MAX) {
                    return Err(fault("there are more than 65534 materials".to_owned()));
                }
            }
            _ => {}
        }
    }
    Ok(model)
}

/// Reads a corner of a face, `vertex/texture/normal`: its vertex counts from 1, or backward from -1.
fn corner(word: &str, count: usize) -> Result<u32, String> {
    let vertex = word.split('/').next().unwrap_or_default();
    let index: i64 =
        vertex.parse().map_err(|_| format!("`{}` is not a vertex's number", text::abridged(word)))?;
    let found = match index {
        1.. => usize::try_from(index - 1).ok(),
        0 => return Err("vertices count from 1, and there is none of number 0".to_owned()),
        _ => usize::try_from(index.unsigned_abs()).ok().and_then(|back| count.checked_sub(back)),
    };
    found.filter(|index| *index < count).map(|index| index as u32).ok_or_else(|| {
        let before =
            if count == 1 { "1 vertex precedes".to_owned() } else { format!("{count} vertices precede") };
        format!("there is no vertex {index}: {before} this face")
    })
}
