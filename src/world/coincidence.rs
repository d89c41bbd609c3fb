//! Several surfaces through one point: which of them a ray sees, and which it leaves when it starts there.
//!
//! A point where a ray comes to a surface is rounded. A surface that lies no farther from it than that holds it, too, and
//! what starts there leaves both: a rug on a floor has no shadow of the floor on it, and a floor and a wall have no dots
//! where they meet. How far off the point is follows from the numbers that it was computed from; nothing is chosen.

use crate::geometry::bounds::larger;
use crate::geometry::ray::Ray;
use crate::geometry::sight::{Line, Sight};
use crate::numeric::dual::Dual;
use crate::numeric::interval::Interval;
use crate::numeric::number::Number;
use crate::numeric::twofold::Twofold;
use crate::simd::cpu::kernels;
use crate::simd::soa::View;
use crate::world::certify::Equation;
use glam::DVec3;

/// What rounding may make of a point, as a part of the coordinates that it is computed from: 8 units in the last place
/// for its distance along the ray, and one and a half for each of the two operations that lead there, each way.
pub(crate) const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The least cosine that counts: at the square root of the rounding, a curved surface is met within that of where it is.
pub(crate) const LEAST_COSINE: f64 = 1.0 / (1 << 26) as f64;

/// Distances that differ by less than this part of them may be the same but for rounding.
pub(crate) const CLOSE: f64 = 1.0 / (1 << 30) as f64;

/// What is left of the difference of two distances in twice the precision where they are the same, as a part of the
/// coordinates: a few thousand of its last places.
pub(crate) const SAME: f64 = 1e-28;

/// How far the computed point of a hit may be from the true one, in world units: the error of a distance is that of a
/// place upright on the surface, divided by the cosine. `reach` is [`Hittable::reach`](crate::world::hittable::Hittable::reach).
#[inline(always)]
pub fn error(ray: &Ray, distance: f64, normal: DVec3, reach: f64) -> f64 {
    let origin = ray.origin.abs();
    let size = larger(larger(origin.x, origin.y), origin.z) + distance + reach;
    ROUNDING * size / larger(ray.dir.dot(normal).abs(), LEAST_COSINE)
}

kernels! {
    /// Bounds of the errors of points that rays come to, as [`error`] has them, and the greatest of them. `reach` is that
    /// of the shape and of the viewer together: no ray starts farther from the viewer than its light has `travelled`.
    pub(crate) fn errors(dir: View, normals: View, travelled: &[f64], reach: f64, out: &mut [f64]) -> f64 {
        let count = out.len();
        let (dir, normals, travelled) = (dir.first(count), normals.first(count), &travelled[..count]);
        let mut most = 0;
        for lane in 0..count {
            let cosine = larger(dir.get(lane).dot(normals.get(lane)).abs(), LEAST_COSINE);
            // A division of single precision takes a third of the time, and what it rounds is nothing to a bound.
            out[lane] = ROUNDING * (travelled[lane] + reach) * f64::from(1.0 / cosine as f32);
            // None is below 0, and so their bits are in their order.
            most = most.max(out[lane].to_bits() as i64);
        }
        f64::from_bits(most as u64)
    }
}

/// Whether a surface comes into the box of so many world units around a point: [`Certified::touches`](crate::world::hittable::Certified::touches) of a shape that has
/// an equation.
pub fn touches(shape: &(impl Equation + ?Sized), at: DVec3, error: f64) -> bool {
    let origin = at.to_array().map(|place| Interval { low: place - error, high: place + error });
    let point = Line { origin, dir: [Interval::constant(0.0); 3] };
    shape.value(shape.own(point).origin).has_zero()
}

/// The distance of a hit by Newton's method in twice the precision: [`Certified::fine_distance`](crate::world::hittable::Certified::fine_distance) of a shape that has an
/// equation. Nothing where that does not settle, as at a graze.
pub fn distance(shape: &(impl Equation + ?Sized), ray: &Ray, near: f64) -> Option<Twofold> {
    let (mut at, mut moved) = (Twofold::from(near), f64::INFINITY);
    let line = shape.own(Sight::along(ray).line::<Twofold>());
    for _ in 0..4 {
        let Dual { value, slope } = shape.value(line.along(Dual::variable(at)));
        let step = value / slope;
        at = at - step;
        moved = step.high.abs();
    }
    let size = ray.origin.abs().max_element() + near;
    let is_settled = moved <= SAME * size && (at.high - near).abs() <= CLOSE * size;
    is_settled.then_some(at)
}
