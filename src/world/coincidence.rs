//! Several surfaces through one point: which of them a ray sees, and which it leaves when it starts there.
//!
//! A point where a ray comes to a surface is rounded. A surface that lies no farther from it than that holds it, too, and
//! what starts there leaves both: a rug on a floor has no shadow of the floor on it, and a floor and a wall have no dots
//! where they meet. How far off the point is follows from the numbers that it was computed from; nothing is chosen.

use crate::geometry::aabb::larger;
use crate::geometry::ray::Ray;
use crate::geometry::sight::{Line, Sight};
use crate::numeric::double_double::DoubleDouble;
use crate::numeric::dual::Dual;
use crate::numeric::interval::Interval;
use crate::numeric::scalar::Scalar;
use crate::simd::cpu::kernels;
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

/// A bound of the error of a point that a ray comes to, as [`error`] has it, from the cosine of its angle with the normal.
/// `reach` is that of the shape and of the viewer together: no ray starts farther from the viewer than its light has
/// `travelled`.
#[inline(always)]
pub(crate) fn error_after(travelled: f64, reach: f64, cosine: f64) -> f64 {
    // A division of single precision takes a third of the time, and what it rounds is nothing to a bound.
    ROUNDING * (travelled + reach) * f64::from(1.0 / larger(cosine.abs(), LEAST_COSINE) as f32)
}

kernels! {
    /// No less than [`error_after`] of any of some points: it rises with the way, and falls as the cosine rises, after
    /// rounding as before.
    pub(crate) fn most_error(travelled: &[f64], reach: f64, cosines: &[f64]) -> f64 {
        let travelled = &travelled[..cosines.len()];
        let (mut most, mut least) = (0, i64::MAX);
        for lane in 0..cosines.len() {
            // None of these is below 0, and so their bits are in their order.
            most = most.max(travelled[lane].to_bits() as i64);
            least = least.min(larger(cosines[lane].abs(), LEAST_COSINE).to_bits() as i64);
        }
        error_after(f64::from_bits(most as u64), reach, f64::from_bits(least as u64))
    }
}

/// Whether a surface comes into the box of so many world units around a point:
/// [`Certified::touches`](crate::world::hittable::Certified::touches) of a shape that has
/// an equation.
pub fn touches(shape: &(impl Equation + ?Sized), at: DVec3, error: f64) -> bool {
    let origin = at.to_array().map(|place| Interval { low: place - error, high: place + error });
    let point = Line { origin, dir: [Interval::constant(0.0); 3] };
    shape.value(shape.own(point).origin).has_zero()
}

/// The distance of a hit by Newton's method in twice the precision:
/// [`Certified::fine_distance`](crate::world::hittable::Certified::fine_distance) of a shape that has an equation. Nothing
/// where that does not settle, as at a graze.
pub fn distance(shape: &(impl Equation + ?Sized), ray: &Ray, near: f64) -> Option<DoubleDouble> {
    let (mut at, mut moved) = (DoubleDouble::from(near), f64::INFINITY);
    let line = shape.own(Sight::along(ray).line::<DoubleDouble>());
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::cpu::Cpu;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_most_error_is_no_less_than_any(
            points in prop::collection::vec((0.0..1e3, prop_oneof![-1.0..1.0, -1e-7..1e-7, Just(0.0), Just(f64::NAN)]), 1..20),
            reach in 0.0..1e3,
        ) {
            let (travelled, cosines): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
            for cpu in Cpu::all() {
                let most = most_error(cpu, &travelled, reach, &cosines);
                for (travelled, cosine) in travelled.iter().zip(&cosines) {
                    prop_assert!(error_after(*travelled, reach, *cosine) <= most, "{} {} {}", travelled, cosine, cpu);
                }
            }
        }
    }
}
