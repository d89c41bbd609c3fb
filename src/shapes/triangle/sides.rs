//! The sides on which a ray passes a triangle's edges, in plain arithmetic.

use glam::DVec3;
use tabray_world::geometry::aabb::larger;
use tabray_world::geometry::ray::{Ray, RayError};
use tabray_world::geometry::ray_packet::RayPacket;
use tabray_world::simd::soa::LANES;

/// Far more than the loss of products that are too small to have all digits: the sum of a few of 5e-324. Multiplication
/// by a number scales the loss by the same factor. This is a normal number, because products with subnormal ones take a
/// hundred times longer.
pub(crate) const UNDERFLOW: f64 = f64::MIN_POSITIVE;

/// Returns the largest magnitude of a component.
#[inline(always)]
pub(crate) fn largest(vector: DVec3) -> f64 {
    let DVec3 { x, y, z } = vector.abs();
    larger(larger(x, y), z)
}

/// Returns the error of the triple product of two corners, relative to a ray's origin, and its direction. It is a
/// fraction of the product of the corners' largest components, after the second number is added to each of them.
#[inline(always)]
pub(crate) fn side_error(drift: RayError) -> (f64, f64) {
    // In units of 2^-53 of the product of the largest components: the error of a component of the cross product is 4 of
    // its two terms, of the direction of a camera ray 3 and of the product 4. The components of the direction add up to
    // at most 1.74. The error of the sum is thus 14 + 6 * 3 + 14 = 46, less than 64. A drift of the direction changes a
    // product by 3 times the drift and the two largest components, and a drift of the origin by twice the drift and
    // their sum.
    let error = 32.0 * f64::EPSILON + 3.0 * drift.dir;
    (error, 2.0 * drift.origin / error)
}

/// Tells whether the lines of all rays within a drift of one, extended both ways, pass all edges on the same side, or
/// `None` if that is undecided, or if rounding could have changed a sign.
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

/// Tells which of eight rays certainly miss a triangle, and which certainly cross it, like [`passed`]. 1 stands for
/// such rays.
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
        // Signs of differences replace comparisons, which the compiler would not vectorize. Nothing is NaN, because
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
