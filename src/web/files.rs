//! Files of a scene: the picture, and meshes of its objects.

use crate::painting::{Painting, Whole};
use std::borrow::Cow;
use tabray_core::output::deflate::Compression;
use tabray_core::output::full_range::FullRange;
use tabray_core::output::picture::{About, Format};
use tabray_core::scene::model::Model;
use tabray_core::text::{list, short};
use tabray_rays::surface_mesh::{self, Body, NoBody, NoMesh, mesh};

/// The error of an object's mesh, as a fraction of the object's size: a page has little memory.
const FRACTION: f64 = 1.0 / 50.0;

/// Returns the picture as a PNG.
///
/// # Errors
/// Returns why the file cannot be made.
pub fn png(painting: &Painting) -> Result<Vec<u8>, String> {
    let Whole { size, bytes, .. } = painting.whole()?;
    let mut out = Vec::new();
    let rows = [Ok(bytes.to_vec())];
    let written = Format::Png(Compression::Balanced).write(&mut out, size, rows);
    written.map_err(|error| error.to_string()).map(|()| out)
}

/// Returns the picture as OpenEXR, with colours that are not clamped.
///
/// # Errors
/// Returns why the file cannot be made.
pub fn exr(painting: &Painting) -> Result<Vec<u8>, String> {
    let Whole { size, colours, .. } = painting.whole()?;
    let mut out = Vec::new();
    let written = FullRange::Exr.write(&mut out, size, colours, &About::default());
    written.map_err(|error| error.to_string()).map(|()| out)
}

/// Returns the names of a scene's first objects.
pub fn names(model: &Model) -> Vec<&str> {
    let mut names: Vec<_> = model.objects.iter().take(200).map(|object| object.args.name()).collect();
    names.dedup();
    names
}

/// Returns an object as a closed mesh, in binary STL.
///
/// # Errors
/// Returns why the file cannot be made.
pub fn stl(model: &Model, name: &str) -> Result<Vec<u8>, String> {
    let body = Body::of(model, name).map_err(|fault| match fault {
        NoBody::Unknown(names) => {
            format!("there is no object `{name}`: the objects are {}", list(names.iter().map(String::as_str)))
        }
        NoBody::Open(why) => format!("`{name}` encloses nothing: {why}"),
        NoBody::Unproven => format!("`{name}` has no equation"),
        NoBody::Unbounded => format!("`{name}` has no end: intersect it with a box"),
        NoBody::Mesh => format!("`{name}` is a mesh already, or may be made of one"),
    })?;
    let size = 2.0 * body.bounds.half_size().max_element();
    let error = short(FRACTION * size).parse().unwrap_or(size);
    let made = mesh(&body, error, None, &|_| {}).map_err(|fault| match fault {
        NoMesh::Empty => format!("nothing of `{name}` is larger than {error}"),
        NoMesh::TooMany(_) => format!("a mesh of `{name}` within {error} has too many triangles"),
        NoMesh::TooFine => "the object is too small for the digits of STL".to_owned(),
        NoMesh::Open => format!("the mesh of `{name}` is not closed"),
    })?;
    let mut out = Vec::new();
    let written = surface_mesh::Format::Stl.write(&made, name, &mut out);
    written.map_err(|error| error.to_string()).map(|()| out)
}

/// Returns a part of a path without its escapes: `%20` is a space.
pub fn decoded(part: &str) -> Cow<'_, str> {
    if !part.contains('%') {
        return part.into();
    }
    let (mut bytes, mut rest) = (Vec::new(), part.as_bytes());
    while let [first, others @ ..] = rest {
        let digits = others.get(..2).and_then(|digits| str::from_utf8(digits).ok());
        let byte = digits.and_then(|digits| u8::from_str_radix(digits, 16).ok()).filter(|_| *first == b'%');
        rest = if byte.is_some() { &others[2..] } else { others };
        bytes.push(byte.unwrap_or(*first));
    }
    String::from_utf8_lossy(&bytes).into_owned().into()
}
