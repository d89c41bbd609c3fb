//! On which sides of a triangle's edges a ray passes, in plain arithmetic.

use crate::geometry::aabb::larger;
use crate::geometry::ray::{Ray, RayError};
use crate::geometry::ray_packet::RayPacket;
use crate::simd::soa::LANES;
use glam::DVec3;

/// Far more than the loss of products that are too small to have all digits: the sum of a few of 5e-324. A product with
/// such a sum loses as many times more as the other factor is. It is a normal number, as processors take a hundred
/// times longer for products with others.
pub(crate) const UNDERFLOW: f64 = f64::MIN_POSITIVE;

/// Returns the largest magnitude of a component.
#[inline(always)]
pub(crate) fn largest(vector: DVec3) -> f64 {
    let DVec3 { x, y, z } = vector.abs();
    larger(larger(x, y), z)
}

/// Returns the error of a product of two corners, as seen from a ray's origin, and its direction: as a fraction of the
/// product of the corners' largest components, and how much is to be added to each of these first.
#[inline(always)]
pub(crate) fn side_error(drift: RayError) -> (f64, f64) {
    // Units of 2^-53 of the product of the largest components: a component of the cross product is off by 4 of its two
    // terms, the direction of a camera ray by 3 and the product by 4; components of the direction add up to at most 1.74,
    // so that the sum is off by 14 + 6 * 3 + 14 = 46, less than 64.
    // A drift of the direction changes a product by 3 of the drift and of the two largest components, and one of the
    // origin by 2 of it and of their sum.
    let error = 32.0 * f64::EPSILON + 3.0 * drift.dir;
    (error, 2.0 * drift.origin / error)
}

/// Tells whether the lines of all rays within a drift of one, extended both ways, pass every edge on the same side; `None`
/// where that is open, or where rounding could have changed a sign.
///
/// For an edge that two triangles share, both compute the same number except for its sign.
#[inline(always)]
pub(crate) fn passed(corners: [DVec3; 3], ray: &Ray, drift: RayError) -> Option<bool> {
    let [a, b, c] = [corners[0] - ray.origin, corners[1] - ray.origin, corners[2] - ray.origin];
    let (error, more) = side_error(drift);
    let largest = [largest(a) + more, largest(b) + more, largest(c) + more];
    let size = [error * largest[0], error * largest[1], error * largest[2]];
    let one = a.cross(b).dot(ray.dir);
    let two = b.cross(c).dot(ray.dir);
    let three = c.cross(a).dot(ray.dir);
    let errors = [
        size[0] * largest[1] + UNDERFLOW,
        size[1] * largest[2] + UNDERFLOW,
        size[2] * largest[0] + UNDERFLOW,
    ];
    let (plus, minus) = (
        [one > errors[0], two > errors[1], three > errors[2]],
        [one < -errors[0], two < -errors[1], three < -errors[2]],
    );
    let is_inside = (plus[0] & plus[1] & plus[2]) | (minus[0] & minus[1] & minus[2]);
    let is_outside = (plus[0] | plus[1] | plus[2]) & (minus[0] | minus[1] | minus[2]);
    if is_inside | is_outside { Some(is_inside) } else { None }
}

/// Tells which of eight rays certainly miss a triangle, and which certainly pass through it, as [`passed`] does; 1 for
/// those.
#[inline(always)]
pub(crate) fn passed_by_eight(
    corners: [DVec3; 3],
    rays: RayPacket,
    drift: RayError,
) -> ([u64; LANES], [u64; LANES]) {
    let (error, more) = side_error(drift);
    let (mut missed, mut inside) = ([0; LANES], [0; LANES]);
    for lane in 0..LANES {
        let Ray { origin, dir } = rays.get(lane);
        let [a, b, c] = [corners[0] - origin, corners[1] - origin, corners[2] - origin];
        let [one, two, three] = [largest(a) + more, largest(b) + more, largest(c) + more];
        let sides = [a.cross(b).dot(dir), b.cross(c).dot(dir), c.cross(a).dot(dir)];
        let errors =
            [error * one * two + UNDERFLOW, error * two * three + UNDERFLOW, error * three * one + UNDERFLOW];
        // Signs of differences, not comparisons, which the compiler would take one by one. Nothing is NaN, as
        // coordinates are at most 1e152.
        let plus = |side: usize| (errors[side] - sides[side]).to_bits();
        let minus = |side: usize| (errors[side] + sides[side]).to_bits();
        let any = (plus(0) | plus(1) | plus(2)) & (minus(0) | minus(1) | minus(2));
        let all = (plus(0) & plus(1) & plus(2)) | (minus(0) & minus(1) & minus(2));
        missed[lane] = any >> 63;
        inside[lane] = all >> 63;
    }
    (missed, inside)
}
