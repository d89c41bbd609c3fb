//! Rays exactly through the edges and the texels' boundaries of rectangles: the course's program, which computed with 80
//! bits, rounded some of them to the other side.

use glam::DVec2;
use tabray_core::scene::model::Object;
use tabray_core::scene::value::Datum;
use tabray_core::world::sensor::Sensor;

/// The fraction of a side or of a texel within which rounding decides on which side of its boundary a ray is.
const NEAR: f64 = 1e-9;

/// Tells whether the ray through the middle of any pixel meets an edge of a rectangle, or the boundary of two of its
/// texels.
pub fn are_met(sensor: &Sensor, object: &Object) -> bool {
    let args = object.args.args();
    let numbers = |attribute: &str| match args.find(attribute) {
        Some(Datum::Numbers(numbers)) => Some(numbers.clone()),
        _ => None,
    };
    let (Some([corner, normal]), Some(sides), Some(xdir), Some(_)) =
        (object.shape.facts().plane, numbers("dimensions"), numbers("xdir"), object.shape.facts().bounds)
    else {
        return false;
    };
    let (&[width, height], &[x, y, z]) = (&sides[..], &xdir[..]) else { return false };
    let sides = DVec2::new(width, height);
    let across = glam::dvec3(x, y, z).reject_from(normal).normalize();
    let up = normal.cross(across);
    let pixels = DVec2::from(sensor.pixels.map(|side| side as f64));
    let texel = match (args.find("texname"), args.find("mode"), sensor.camera.screen()) {
        (_, Some(Datum::Whole(mode)), Some(screen)) if mode[..] == [1] => screen / pixels,
        (Some(Datum::Texture { texture, .. }), ..) => sides / DVec2::from(texture.size().map(f64::from)),
        _ => sides,
    };
    let is_near = |at: DVec2, step: DVec2| {
        let steps = at / step;
        (steps - steps.round()).abs().min_element() < NEAR
    };
    let is_met = |x: usize, y: usize| {
        let ray = sensor.ray(x as f64, y as f64);
        let t = normal.dot(corner - ray.origin) / normal.dot(ray.dir);
        let from_corner = ray.at(t) - corner;
        let at = DVec2::new(across.dot(from_corner), up.dot(from_corner));
        let is_within = at.cmpge(-NEAR * sides).all() && at.cmple((1.0 + NEAR) * sides).all();
        t > 0.0 && is_within && (is_near(at, sides) || is_near(at, texel))
    };
    (0..sensor.pixels[1]).any(|y| (0..sensor.pixels[0]).any(|x| is_met(x, y)))
}
