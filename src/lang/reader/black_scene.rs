//! Warnings about images that are certainly black, or show no plane, with the reason.

use super::fault::Fault;
use glam::{DVec2, DVec3};
use tabray_core::geometry::aabb::Aabb;
use tabray_core::scene::model::{Model, Object};
use tabray_core::text::shortest;
use tabray_core::world::material::Rgb;

/// The margin by which the image is enlarged, as a fraction of it.
const MARGIN: f64 = 0.01;

/// Returns a warning if nothing in a scene is visible, or no plane.
pub fn warning(model: &Model) -> Option<Fault> {
    if model.background.is_some() {
        return None;
    }
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
    // Rays with different origins are not judged.
    let corners = camera.camera.corners(camera.pixels, MARGIN)?;
    let (viewer, screen) = (camera.origins().middle, camera.camera.screen());
    let ahead: DVec3 = corners.iter().sum();
    let place = |at: DVec3| at.to_array().map(shortest).join(" ");
    let looks = |how: String| format!("the viewer at {} looks {how}", place(viewer));
    if all_are(model, |bounds| is_behind(viewer, ahead, bounds)) {
        let (along, side) = if viewer.z > 0.0 { ("-z", "below") } else { ("+z", "above") };
        let seen = || format!("along {along}: what can be seen has a z {side} {}", shortest(viewer.z));
        let how = screen.map_or_else(|| "the other way".to_owned(), |_| seen());
        return black("all objects are behind the viewer", looks(how));
    }
    let is_aside = |bounds: &Aabb| {
        (0..4).any(|edge| {
            let normal = corners[edge].cross(corners[(edge + 1) % 4]);
            is_behind(viewer, normal * normal.dot(ahead).signum(), bounds)
        })
    };
    if all_are(model, is_aside) {
        let through =
            |screen: DVec2| format!("through the rectangle from 0 0 0 to {}", place(screen.extend(0.0)));
        let how = screen.map_or_else(|| "past them".to_owned(), through);
        return black("all objects are outside the image", looks(how));
    }
    // For such a viewer, planes end before the image plane.
    let is_endless = |object: &Object| object.shape.bounds().is_none();
    let ends =
        camera.camera.planes_end_at().filter(|_| viewer.z < 0.0 && model.objects.iter().any(is_endless))?;
    Some(
        Fault::warning(None, "the viewer is behind the image plane, and planes are not seen beyond it").help(
            format!(
                "a viewer at a z below 0 looks along +z, and planes are not hit where z is above {}",
                shortest(ends)
            ),
        ),
    )
}

/// Tells whether an object is black without light.
fn is_dark(object: &Object) -> bool {
    let is_dark = object.shader.brightest(&object.material).is_some_and(|look| look.ambient == Rgb::ZERO);
    is_dark && object.material.emission == Rgb::ZERO
}

/// Tells whether all objects have bounds that meet a condition. The search ends at the first object that does not.
fn all_are(model: &Model, is_so: impl Fn(&Aabb) -> bool) -> bool {
    model.objects.iter().all(|object| object.shape.bounds().is_some_and(|bounds| is_so(&bounds)))
}

/// Tells whether a whole box lies behind the plane through a point with this normal.
fn is_behind(viewer: DVec3, normal: DVec3, bounds: &Aabb) -> bool {
    let nearest = DVec3::select(normal.cmpgt(DVec3::ZERO), bounds.high, bounds.low);
    normal.dot(nearest - viewer) < 0.0
}
