//! Files of meshes, outside of scenes.

use crate::process::failure::Failure;
use glam::DVec3;
use std::mem;
use std::path::Path;
use tabray_core::geometry::Rotation;
use tabray_core::shapes::mesh::read::staging::Staging;
use tabray_core::shapes::mesh::read::{self, Attributes, Model, Remark, Wanted};
use tabray_core::shapes::mesh::{Look, Surface, ToWorld};
use tabray_core::text::{self, count, shortest};
use tabray_core::world::sensor::Sensor;

/// Reads the surface of a file as a mesh of a scene is read, in the file's own coordinates, and what the file says
/// beside it.
pub fn read(path: &Path, wanted: Wanted) -> Result<(Surface, Staging), Failure> {
    let mut model = model(path, wanted)?;
    let staging = mem::take(&mut model.staging);
    Ok((surface(path, model)?, staging))
}

fn model(path: &Path, wanted: Wanted) -> Result<Model, Failure> {
    read::read(path, wanted, u64::MAX).map_err(|error| {
        let place = error.at.map_or(String::new(), |at| format!("{at}: "));
        refused(path, &format!("{place}{}", error.message))
    })
}

fn refused(path: &Path, what: &str) -> Failure {
    let help = "a mesh is an OBJ, PLY, STL or glTF file".to_owned();
    Failure::usage(format!("cannot read `{}` as a mesh: {what}", text::shown(path))).help(help)
}

fn surface(path: &Path, model: Model) -> Result<Surface, Failure> {
    let placement = ToWorld::new(DVec3::ONE, Rotation::NONE, DVec3::ZERO);
    let look = Look { crease: None, is_two_sided: true };
    Surface::new(model, &placement, look).map_err(|error| refused(path, &format!("it {}", error.message().0)))
}

/// The endings of the names of files of meshes.
const ENDINGS: [&str; 5] = ["glb", "gltf", "obj", "ply", "stl"];

/// Tells by its name whether a file holds a mesh.
pub fn is_one(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ENDINGS.iter().any(|known| ending.eq_ignore_ascii_case(known)))
}

/// Describes what a file holds: a line for each fact.
///
/// # Errors
/// If it cannot be read.
pub fn described(path: &Path) -> Result<String, Failure> {
    let model = model(path, Wanted { normals: true, materials: Some(Sensor::default().display()) })?;
    let looks = looks(&model);
    let surface = surface(path, model)?;
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
    text += &looks;
    // The lines say so.
    let is_said = |remark: &&Remark| [read::NO_NORMALS, read::NO_LOOKS].contains(&&remark.message[..]);
    for remark in surface.remarks.iter().filter(|remark| !is_said(remark)) {
        text += &format!("note    it {}\n", remark.message);
    }
    Ok(text)
}

/// Describes what a file holds beside its faces.
fn looks(model: &Model) -> String {
    let Attributes { normals, uv, colours } = &model.attributes;
    let all = 3 * model.faces.len();
    let corners = |some: usize| match some {
        0 => "none".to_owned(),
        _ if some == all => "at all corners".to_owned(),
        _ => format!("at {some} of {}", count(all, "corner")),
    };
    let looks = model.finishes.iter().flatten();
    let images: usize = looks.clone().map(|finish| finish.maps().count()).sum();
    let materials = match model.materials.len() {
        0 => "none".to_owned(),
        names => {
            format!("{} of {}, with {}", looks.count(), count(names, "material"), count(images, "image"))
        }
    };
    let mut text = format!(
        "normals {}\nuv      {}\ncolours {}\nlooks   {materials}\n",
        corners(normals.count()),
        corners(uv.count()),
        corners(colours.count()),
    );
    if !model.materials.is_empty() {
        text += &format!("names   {}\n", model.materials.join(", "));
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
        10.0..10_000.0 => "not in the file; perhaps millimetres, by its size",
        0.01..10.0 => "not in the file; perhaps metres or inches, by its size",
        _ => "not in the file, and its size gives no hint",
    }
}
