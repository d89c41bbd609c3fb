//! Warns of images that are black for certain, with the reason.

use super::fault::Fault;
use crate::geometry::aabb::Aabb;
use crate::scene::model::{Model, Object};
use crate::text::shortest;
use crate::world::camera::Camera;
use crate::world::material::Rgb;
use glam::{DVec2, DVec3};

/// Returns a warning if nothing in a scene can be seen.
pub fn warning(model: &Model) -> Option<Fault> {
    let camera = &model.camera.value;
    let black = |why: &str, help: String| {
        Some(Fault::warning(None, format!("the image will be black: {why}")).help(help))
    };
    if model.objects.is_empty() {
        return black("the scene has no objects", "`tabray list` lists the types of objects".to_owned());
    }
    if model.lights.is_empty() && model.objects.iter().all(is_dark) {
        return black(
            "the scene has no light, and no material has `ambient`",
            "add a light, or give the materials `ambient`, a colour that needs no light".to_owned(),
        );
    }
    let is_behind = |bounds: &Aabb| bounds.low.z >= camera.viewpoint.z;
    let place = |at: DVec3| at.to_array().map(shortest).join(" ");
    if all_are(model, is_behind) {
        return black(
            "all objects are behind the viewer",
            format!(
                "the viewer at {} looks along -z: what can be seen has a z below {}",
                place(camera.viewpoint),
                shortest(camera.viewpoint.z)
            ),
        );
    }
    if all_are(model, |bounds| is_aside(camera, bounds)) {
        return black(
            "all objects are outside of the picture",
            format!(
                "the viewer at {} looks through the rectangle from 0 0 0 to {}",
                place(camera.viewpoint),
                place(camera.screen.extend(0.0))
            ),
        );
    }
    None
}

/// Tells whether an object is black where no light is.
fn is_dark(object: &Object) -> bool {
    object.shader.brightest(&object.material).is_some_and(|look| look.ambient == Rgb::ZERO)
}

/// Tells whether all objects have bounds of which this is so. At the first other one, no more are asked for.
fn all_are(model: &Model, is_so: impl Fn(&Aabb) -> bool) -> bool {
    model.objects.iter().all(|object| object.shape.bounds().is_some_and(|bounds| is_so(&bounds)))
}

/// Tells whether a box lies beyond one of the four planes through the viewer and an edge of the image, which is taken to
/// be a pixel wider.
fn is_aside(camera: &Camera, bounds: &Aabb) -> bool {
    let viewer = camera.viewpoint;
    let [width, height] = camera.pixels.map(|pixels| (pixels as f64 - 1.0).max(1.0));
    let pixel = camera.screen / DVec2::new(width, height);
    let (low, high) = (-pixel, camera.screen + pixel);
    // How far a point is inside of the plane through an edge, as a multiple of its depth.
    let inside = |axis: usize, edge: f64, side: f64, at: DVec3| {
        side * ((at[axis] - viewer[axis]) * viewer.z - (edge - viewer[axis]) * (viewer.z - at.z))
    };
    let corners = (0..8).map(|corner| {
        let end = |axis: usize| if corner >> axis & 1 == 0 { bounds.low[axis] } else { bounds.high[axis] };
        DVec3::new(end(0), end(1), end(2))
    });
    let corners: Vec<_> = corners.collect();
    let is_beyond = |axis, edge, side| corners.iter().all(|corner| inside(axis, edge, side, *corner) < 0.0);
    (0..2).any(|axis| is_beyond(axis, low[axis], 1.0) || is_beyond(axis, high[axis], -1.0))
}
