//! Files of meshes, outside of scenes.

use crate::process::failure::Failure;
use glam::DVec3;
use std::path::Path;
use tabray_core::geometry::Rotation;
use tabray_core::shapes::mesh::read::{self, Wanted};
use tabray_core::shapes::mesh::{Look, Surface, ToWorld};
use tabray_core::text::{count, shortest};

/// Reads the surface of a file as a mesh of a scene is read, in the file's own coordinates.
pub fn read(path: &Path, wanted: Wanted) -> Result<Surface, Failure> {
    let refused = |what: String| {
        let help = "a mesh is an OBJ, PLY, STL or glTF file".to_owned();
        Failure::Usage(format!("cannot read `{}` as a mesh: {what}", path.display()), Some(help))
    };
    let model = read::read(path, wanted, u64::MAX).map_err(|error| {
        let place = error.at.map_or(String::new(), |at| format!("{at}: "));
        refused(format!("{place}{}", error.message))
    })?;
    let placement = ToWorld::new(DVec3::ONE, Rotation::NONE, DVec3::ZERO);
    let look = Look { crease: None, is_two_sided: true };
    Surface::new(model, &placement, look).map_err(|error| refused(format!("it {}", error.message().0)))
}

/// The endings of the names of files of meshes.
const ENDINGS: [&str; 5] = ["glb", "gltf", "obj", "ply", "stl"];

/// Tells by its name whether a file holds a mesh.
pub fn is_one(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ENDINGS.iter().any(|known| ending.eq_ignore_ascii_case(known)))
}

/// Describes what a file holds: a line for each fact.
pub fn described(surface: &Surface) -> String {
    let [low, high] = surface.bounds();
    let sides = |at: DVec3, between: &str| at.to_array().map(six_digits).join(between);
    let mut open = Vec::new();
    if surface.why_not_closed.open > 0 {
        open.push(format!("open at {}", count(surface.why_not_closed.open, "edge")));
    }
    if surface.why_not_closed.clashing > 0 {
        open.push(format!("turned against each other at {}", count(surface.why_not_closed.clashing, "edge")));
    }
    let closed = if open.is_empty() { "yes".to_owned() } else { format!("no: {}", open.join(", ")) };
    let units = units((high - low).max_element());
    let mut text = format!(
        "bounds  {} to {}\nsize    {}\nfaces   {}\nparts   {}\nclosed  {closed}\nunits   {units}\n",
        sides(low, " "),
        sides(high, " "),
        sides(high - low, " x "),
        count(surface.face_count(), "triangle"),
        surface.count_parts(),
    );
    if !surface.materials.is_empty() {
        text += &format!("names   {}\n", surface.materials.join(", "));
    }
    for remark in &surface.remarks {
        text += &format!("note    it {}\n", remark.message);
    }
    text
}

/// Writes a number with up to six digits: many files have no more.
pub fn six_digits(number: f64) -> String {
    shortest(format!("{number:.5e}").parse().unwrap_or(number))
}

/// Guesses the unit of a mesh whose largest side is this long: no file says it.
fn units(largest: f64) -> &'static str {
    match largest {
        10.0..10_000.0 => "not in the file; by its size perhaps millimetres",
        0.01..10.0 => "not in the file; by its size perhaps metres or inches",
        _ => "not in the file, and its size tells nothing",
    }
}
