//! Several surfaces through one point: which surface a ray hits first, and which ones are left by a ray that starts
//! there.
//!
//! The point where a ray hits a surface is rounded. Another surface within the rounding error of the point counts as
//! passing through it, and a ray that starts there leaves both: a floor casts no shadow on a rug that lies on it, and
//! the edge where a floor meets a wall shows no dots. The size of the error follows from the numbers that the point was
//! computed from.

use crate::certify::Equation;
use crate::geometry::aabb::larger;
use crate::geometry::ray::Ray;
use crate::geometry::sight::{Line, Sight};
use crate::simd::cpu::kernels;
use glam::DVec3;
use tabray_exact::double_double::DoubleDouble;
use tabray_exact::dual::Dual;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::Scalar;

/// A bound on the rounding error of a hit point, as a fraction of the coordinates that it is computed from: 8 ulps for
/// the distance along the ray and 1.5 ulps for each of the two operations that follow, together 11, rounded up to 16.
pub const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The least cosine by which an error is divided: the square root of `f64::EPSILON`. At a grazing hit, the distance to
/// a curved surface is off by about the square root of the rounding error, however small the cosine is.
pub const MIN_COSINE: f64 = 1.0 / (1 << 26) as f64;

/// The relative difference below which two distances may be equal up to rounding: [`ROUNDING`] divided by a cosine of
/// 2^-18. `a_rug_on_a_floor_of_any_tilt_looks_as_the_floor_does` in `tests/shapes` tests it.
pub const CLOSE: f64 = 1.0 / (1 << 30) as f64;

/// Returns the difference up to which two distances along a ray may be equal up to rounding, in world units:
/// [`CLOSE`] of the numbers that they are computed from.
#[inline(always)]
pub fn close(ray: &Ray, distance: f64) -> f64 {
    let origin = ray.origin.abs();
    CLOSE * (larger(larger(origin.x, origin.y), origin.z) + distance)
}

/// A bound on the computed difference of two equal distances in double-double arithmetic, as a fraction of the
/// coordinates: about 8000 times its unit of rounding, 2^-106. The test named at [`CLOSE`] checks it.
pub const SAME: f64 = 1e-28;

/// Returns a bound on the distance between the computed and the true point of a hit, in world units: the error along
/// the ray is the error along the normal, divided by the cosine between them. `distance` is in world units;
/// `max_coordinate` is that of the [facts](crate::hittable::Facts::max_coordinate).
#[inline(always)]
pub fn error(ray: &Ray, distance: f64, normal: DVec3, max_coordinate: f64) -> f64 {
    let origin = ray.origin.abs();
    let size = larger(larger(origin.x, origin.y), origin.z) + distance + max_coordinate;
    ROUNDING * size / larger(ray.dir.dot(normal).abs(), MIN_COSINE)
}

/// Returns the bound that [`error`] gives for a hit point, or a larger one, in world units, from the cosine of the
/// angle between the ray and the normal. `travelled` is the length of the whole path from the viewer, and
/// `max_coordinate` is that of the shape and of the viewer together: no ray starts farther from the viewer than
/// `travelled`.
#[inline(always)]
pub fn error_after(travelled: f64, max_coordinate: f64, cosine: f64) -> f64 {
    // A division in single precision takes a third of the time, and its relative error of 2^-24 or so does not matter
    // to a bound that is rounded up from 11 to 16 ulps.
    ROUNDING * (travelled + max_coordinate) * f64::from(1.0 / larger(cosine.abs(), MIN_COSINE) as f32)
}

kernels! {
    /// Writes [`error_after`] for each of some points, and returns the largest.
    pub fn errors_after(travelled: &[f64], max_coordinate: f64, cosines: &[f64], errors: &mut [f64]) -> f64 {
        let count = errors.len();
        let (travelled, cosines) = (&travelled[..count], &cosines[..count]);
        for lane in 0..count {
            errors[lane] = error_after(travelled[lane], max_coordinate, cosines[lane]);
        }
        // No error is negative, so their bits compare as they do.
        f64::from_bits(errors.iter().fold(0, |most: i64, error| most.max(error.to_bits() as i64)) as u64)
    }
}

/// Tells whether a surface may pass through the box that extends `error` world units from a point along each axis:
/// [`Certified::is_on_surface`](crate::hittable::Certified::is_on_surface) of a shape that has an equation.
pub fn is_on_surface(shape: &(impl Equation + ?Sized), at: DVec3, error: f64) -> bool {
    let origin = at.to_array().map(|place| Interval { low: place - error, high: place + error });
    let point = Line { origin, dir: [Interval::constant(0.0); 3] };
    shape.value(shape.to_local(point).origin).has_zero()
}

/// Returns the distance of a hit by Newton's method in double-double arithmetic, starting from `near`:
/// [`Certified::fine_distance`](crate::hittable::Certified::fine_distance) of a shape that has an equation.
/// Returns `None` where the iteration does not converge, as for a grazing ray.
pub fn distance(shape: &(impl Equation + ?Sized), ray: &Ray, near: f64) -> Option<DoubleDouble> {
    let (mut at, mut last_step) = (DoubleDouble::from(near), f64::INFINITY);
    let line = shape.to_local(Sight::along(ray).line::<DoubleDouble>());
    for _ in 0..4 {
        let Dual { value, slope } = shape.value(line.along(Dual::variable(at)));
        let step = value / slope;
        at = at - step;
        last_step = step.high.abs();
    }
    let size = ray.origin.abs().max_element() + near;
    let has_converged = last_step <= SAME * size && (at.high - near).abs() <= CLOSE * size;
    has_converged.then_some(at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::cpu::Cpu;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(crate::properties())]

        #[test]
        fn the_errors_of_a_packet_are_those_of_its_points(
            points in prop::collection::vec((0.0..1e3, prop_oneof![-1.0..1.0, -1e-7..1e-7, Just(0.0), Just(f64::NAN)]), 1..20),
            max_coordinate in 0.0..1e3,
        ) {
            let (travelled, cosines): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
            let alone: Vec<_> = travelled
                .iter()
                .zip(&cosines)
                .map(|(travelled, cosine)| error_after(*travelled, max_coordinate, *cosine))
                .collect();
            for cpu in Cpu::all() {
                let mut errors = vec![0.0; alone.len()];
                let most = errors_after(cpu, &travelled, max_coordinate, &cosines, &mut errors);
                prop_assert_eq!(&errors, &alone, "{}", cpu);
                prop_assert_eq!(most, alone.iter().copied().fold(0.0, f64::max), "{}", cpu);
            }
        }
    }
}
