//! One face of a mesh: what plain arithmetic tells of a ray's hit, and its equation.

use super::tree::LEAF;
use crate::geometry::aabb::{Aabb, larger};
use crate::geometry::ray::{Bracket, Drift, MISS, Ray, RayRange};
use crate::numeric::double_double::{exponent_to_one, times_power_of_two};
use crate::numeric::scalar::{Scalar, dot, per_axis};
use crate::shapes::triangle::Triangle;
use crate::simd::cpu::kernels;
use crate::world::accuracy::Exact;
use crate::world::certify::Equation;
use glam::DVec3;

/// A bound of the error of the dot product of a face's normal and the vector from a ray's origin to a corner, as a
/// fraction of the product of the largest components of two edges and of that vector.
///
/// Units of 2^-53: a component of the normal is off by 9 of the product of the edges, so that the dot product is off by
/// 10 + 2 * 4 of that product and the sum of the vector's components, which is at most 3 times the largest: 54, less
/// than 64.
const AWAY_ERROR: f64 = 32.0 * f64::EPSILON;

/// A bound on the rounding error of the dot product with the ray's direction, as a fraction of the product of the edges: a camera ray's
/// direction is off by 3, and components of a direction add up to at most 1.74: 1.74 * (10 + 2 * 6) = 39, less than 48.
const TOWARD_ERROR: f64 = 24.0 * f64::EPSILON;

/// Far more than what products lose that are too small for all digits: the sum of a few of 5e-324. A product with such a
/// sum loses as many times more as the other factor is.
const UNDERFLOW: f64 = 1e-320;

/// What a ray may leave: bounds on the distance of its origin from the point that it stands for, in world units. The
/// ray leaves the faces within that distance.
#[derive(Clone, Copy)]
pub(super) struct Leaving {
    /// It is at least this.
    pub least: f64,
    /// It is at most this; negative where the ray leaves nothing.
    pub most: f64,
}

/// Returns bounds of the distance at which a ray hits a face; with a drift, of all rays within it.
#[inline(always)]
pub(super) fn t_bounds(
    corners: [DVec3; 3],
    ray: &Ray,
    range: &RayRange,
    leaving: Leaving,
    drift: Option<Drift>,
) -> Bracket {
    let passed = passed(corners, ray, drift);
    if passed == Some(false) {
        return Bracket::MISS;
    }
    let [a, b, c] = corners;
    let (one, other, between) = (b - a, c - a, a - ray.origin);
    let normal = one.cross(other);
    let edges = one.abs().max_element() * other.abs().max_element();
    let (away, toward) = (normal.dot(between), normal.dot(ray.dir));
    let largest = between.abs().max_element();
    let (away_error, toward_error) =
        (AWAY_ERROR * edges * largest + UNDERFLOW * (1.0 + largest), TOWARD_ERROR * edges + UNDERFLOW);
    // A normal is no longer than 3 times that product, as an edge is no longer than the root of 3 of its components.
    let (away_error, toward_error) = match drift {
        None => (away_error, toward_error),
        Some(drift) => (away_error + 3.0 * edges * drift.origin, toward_error + 3.0 * edges * drift.dir),
    };
    if leaving.most >= 0.0 {
        let size = normal.length();
        // The length is off by less than an error of a direction.
        let offset = |error: f64| error * (size - toward_error);
        let bounds = Aabb::around(&corners);
        let holds = |error: f64| {
            let error = error + 4.0 * f64::EPSILON * ray.origin.abs().max_element();
            (bounds.low - error).cmple(ray.origin).all() && ray.origin.cmple(bounds.high + error).all()
        };
        if away.abs() + away_error <= offset(leaving.least) && holds(leaving.least) {
            return Bracket::MISS;
        }
        let farthest =
            (leaving.most + 4.0 * f64::EPSILON * 3.0 * between.abs().max_element()) * (size + toward_error);
        if away.abs() - away_error <= farthest && holds(leaving.most) {
            return Bracket { near: range.near, far: MISS };
        }
    }
    let distance = away / toward;
    let least = toward.abs() - toward_error;
    let error = (away_error + distance.abs() * toward_error + larger(leaving.most, 0.0) * normal.length())
        / least
        + 2.0 * f64::EPSILON * distance.abs();
    // All comparisons are false where the distance is NaN, as that of a ray in the plane.
    let is_known = least > toward_error && error < MISS;
    if !is_known {
        return Bracket { near: range.near, far: MISS };
    }
    let (low, high) = (distance - error, distance + error);
    if high <= range.near || low >= range.far {
        return Bracket::MISS;
    }
    let is_there = passed == Some(true) && low > range.near;
    Bracket { near: larger(low, range.near), far: if is_there { high } else { MISS } }
}

/// Tells whether the line of a ray passes every edge on the same side; `None` where rounding could have changed a sign.
///
/// It computes the same numbers as [`Triangle::passed`], whose comment derives the error.
#[inline(always)]
pub(super) fn passed(corners: [DVec3; 3], ray: &Ray, drift: Option<Drift>) -> Option<bool> {
    let [a, b, c] = corners.map(|corner| corner - ray.origin);
    let largest = [a, b, c].map(|corner| corner.abs().max_element());
    // A drift of the direction changes a product by 3 of the drift and of the two largest components, and one of the
    // origin by 2 of it and of their sum.
    let (error, largest) = match drift {
        None => (32.0 * f64::EPSILON, largest),
        Some(Drift { origin, dir }) => {
            let error = 32.0 * f64::EPSILON + 3.0 * dir;
            (error, largest.map(|largest| largest + 2.0 * origin / error))
        }
    };
    let size = largest.map(|largest| error * largest);
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

/// The x, y and z of each corner of a leaf's faces, in world coordinates.
pub(super) type Corners = [[[f64; LEAF]; 3]; 3];

kernels! {
    /// Returns a bit for each of a leaf's faces, the lowest one for the first: 0 where [`passed`] tells that the line of
    /// a ray without a drift passes outside of the face, and else 1. It takes all faces at once, and computes the same numbers.
    ///
    /// A kernel of its own, as the compiler does not reliably take the faces at a time where it is inlined.
    pub(super) fn not_missed(corners: &Corners, ray: &Ray) -> u64 {
        let (mut sides, mut errors) = ([[0.0; LEAF]; 3], [[0.0; LEAF]; 3]);
        for lane in 0..LEAF {
            let corner = |corner: usize| {
                let [x, y, z] = &corners[corner];
                DVec3::new(x[lane], y[lane], z[lane]) - ray.origin
            };
            let corners = [corner(0), corner(1), corner(2)];
            let largest = |corner: DVec3| {
                let DVec3 { x, y, z } = corner.abs();
                larger(larger(x, y), z)
            };
            let largest = [largest(corners[0]), largest(corners[1]), largest(corners[2])];
            for (side, (one, other)) in [(0, 1), (1, 2), (2, 0)].into_iter().enumerate() {
                sides[side][lane] = corners[one].cross(corners[other]).dot(ray.dir);
                errors[side][lane] = 32.0 * f64::EPSILON * largest[one] * largest[other] + UNDERFLOW;
            }
        }
        let mut signs = [0; LEAF];
        for lane in 0..LEAF {
            // Signs of differences, not comparisons, which the compiler would take one by one. Nothing is NaN, as
            // coordinates are at most 1e152.
            let (mut plus, mut minus) = (0, 0);
            for side in 0..3 {
                plus |= (errors[side][lane] - sides[side][lane]).to_bits();
                minus |= (errors[side][lane] + sides[side][lane]).to_bits();
            }
            signs[lane] = plus & minus;
        }
        let missed = signs.iter().enumerate().fold(0, |bits, (lane, sign)| bits | (sign >> 63) << lane);
        !missed & ((1 << LEAF) - 1)
    }
}

/// Tells whether the corners of a face do not lie on one line.
pub(super) fn has_area(corners: [DVec3; 3]) -> bool {
    let [a, b, c] = corners;
    let (one, other) = (b - a, c - a);
    let edges = one.abs().max_element() * other.abs().max_element();
    // Ten times the error of a component. The product may underflow, but not where this holds.
    one.cross(other).abs().max_element() > 100.0 * f64::EPSILON * edges + f64::MIN_POSITIVE
        || Triangle::<Exact>::new(corners).is_some()
}

/// A face as the solution of an equation, for proofs. Unlike a [`Triangle`] of its own, it is not cut off in front of
/// the image plane.
pub(super) struct Face<A>(pub Triangle<A>);

impl<A> Equation for Face<A> {
    const IS_QUADRATIC: bool = true;

    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        let corner = self.0.corners[0].to_array();
        dot(self.0.upright(), per_axis(|axis| at[axis] - N::constant(corner[axis])))
    }

    fn kept<N: Scalar>(&self, at: [N; 3]) -> N {
        self.0.inside(at)
    }
}

/// Returns the point of a triangle that is nearest to a point (Ericson, "Real-Time Collision Detection", 2005).
pub(super) fn nearest_point([a, b, c]: [DVec3; 3], at: DVec3) -> DVec3 {
    let size = (a - at).abs().max((b - at).abs()).max((c - at).abs()).max_element();
    if !(1e-70..1e70).contains(&size) && size > 0.0 && size < MISS {
        // Its fourth power would underflow or overflow.
        let scale = times_power_of_two(1.0, exponent_to_one(size));
        let corners = [a, b, c].map(|corner| (corner - at) * scale);
        return at + nearest_point(corners, DVec3::ZERO) / scale;
    }
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (ab.dot(at - a), ac.dot(at - a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let (d3, d4) = (ab.dot(at - b), ac.dot(at - b));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + d1 / (d1 - d3) * ab;
    }
    let (d5, d6) = (ab.dot(at - c), ac.dot(at - c));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + d2 / (d2 - d6) * ac;
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
    }
    let sum = va + vb + vc;
    a + vb / sum * ab + vc / sum * ac
}
