//! One face of a mesh: a ray's hit in `f64` arithmetic, and the equation of the face.

use crate::triangle::{Triangle, UNDERFLOW, largest, passed};
use glam::DVec3;
use tabray_exact::double_double::{exponent_to_one, times_power_of_two};
use tabray_exact::scalar::{Scalar, dot, per_axis};
use tabray_world::accuracy::Exact;
use tabray_world::certify::Equation;
use tabray_world::geometry::aabb::{Aabb, larger};
use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayError};

/// A bound of the error of the dot product of a face's normal and the vector from a ray's origin to a corner, as a
/// fraction of the product of the largest components of two edges and of that vector.
///
/// In units of 2^-53: the error of a component of the normal is 9 times the product of the edges. The error of the dot
/// product is 10 + 2 * 4 times this product and the sum of the vector's components, at most 3 times the largest one.
/// This gives 54, less than 64.
const AWAY_ERROR: f64 = 32.0 * f64::EPSILON;

/// A bound of the rounding error of the dot product of the normal and the ray's direction, as a fraction of the product
/// of the edges. In the same units, the error of a camera ray's direction is 3, and its components add up to at most
/// 1.74. This gives 1.74 * (10 + 2 * 6) = 39, less than 48.
const TOWARD_ERROR: f64 = 24.0 * f64::EPSILON;

/// Bounds of the distance between a ray's origin and the exact point that it was rounded from, in world units. The ray
/// leaves the faces within that distance.
#[derive(Clone, Copy)]
pub(super) struct Leaving {
    /// The lower bound.
    pub least: f64,
    /// The upper bound. It is negative if the ray leaves no face.
    pub most: f64,
}

/// Values of a face that do not depend on the ray.
pub(super) struct Flat {
    corners: [DVec3; 3],
    normal: DVec3,
    /// The length of the normal.
    size: f64,
    /// The product of the largest components of two edges.
    edges: f64,
}

impl Flat {
    /// Prepares a face.
    #[inline(always)]
    pub(super) fn of(corners: [DVec3; 3]) -> Self {
        let [a, b, c] = corners;
        let (one, other) = (b - a, c - a);
        let (normal, edges) = (one.cross(other), one.abs().max_element() * other.abs().max_element());
        Self { corners, normal, size: normal.length(), edges }
    }

    /// Returns the dot product of the normal and the vector from a ray's origin to the face, a bound of its error, and
    /// a bound of the error of the dot product with the direction.
    #[inline(always)]
    fn away(&self, ray: &Ray, drift: RayError) -> (f64, f64, f64) {
        let (between, edges) = (self.corners[0] - ray.origin, self.edges);
        let largest = largest(between);
        let (away_error, toward_error) =
            (AWAY_ERROR * edges * largest + UNDERFLOW * (1.0 + largest), TOWARD_ERROR * edges + UNDERFLOW);
        // A normal is at most 3 times as long as the product of the edges' largest components, because an edge is at
        // most √3 times as long as its largest component.
        let (away_error, toward_error) =
            (away_error + 3.0 * edges * drift.origin, toward_error + 3.0 * edges * drift.dir);
        (self.normal.dot(between), away_error, toward_error)
    }

    /// Returns a bound of the error of a point's distance from the plane in `f64` arithmetic, in world units. It is large
    /// for needles, and infinite where products underflow or overflow.
    pub(super) fn offset_error(&self, at: DVec3) -> f64 {
        let error = AWAY_ERROR * self.edges * largest(self.corners[0] - at) / self.size;
        if error < MISS { error } else { MISS }
    }

    /// Returns the bracket of a ray that leaves the face or may leave it, or `None` for any other ray.
    #[inline(always)]
    pub fn left(&self, ray: &Ray, leaving: Leaving, drift: RayError) -> Option<Bracket> {
        let (away, away_error, toward_error) = self.away(ray, drift);
        // The error of the length is less than that of the product with a direction.
        let offset = |error: f64| error * (self.size - toward_error);
        let bounds = Aabb::around(&self.corners);
        let holds = |error: f64| {
            let error = error + 4.0 * f64::EPSILON * ray.origin.abs().max_element();
            (bounds.low - error).cmple(ray.origin).all() && ray.origin.cmple(bounds.high + error).all()
        };
        if away.abs() + away_error <= offset(leaving.least)
            && holds(leaving.least)
            && distance_to(self.corners, ray.origin) <= leaving.least
        {
            return Some(Bracket::MISS);
        }
        let largest = largest(self.corners[0] - ray.origin).max(ray.origin.abs().max_element());
        let farthest = (leaving.most + 4.0 * f64::EPSILON * 3.0 * largest) * (self.size + toward_error);
        (away.abs() - away_error <= farthest && holds(leaving.most)).then_some(Bracket::UNKNOWN)
    }

    /// Returns bounds of the distance, before `end`, at which a ray hits the face. Its line does not certainly miss the
    /// face, and certainly crosses it if `is_passed`. The ray leaves other faces, if any.
    #[inline(always)]
    pub(super) fn t_bounds(
        &self,
        ray: &Ray,
        end: f64,
        leaving: Leaving,
        drift: RayError,
        is_passed: bool,
    ) -> Bracket {
        let (away, away_error, toward_error) = self.away(ray, drift);
        let toward = self.normal.dot(ray.dir);
        let distance = away / toward;
        let least = toward.abs() - toward_error;
        let error = (away_error + distance.abs() * toward_error + larger(leaving.most, 0.0) * self.size)
            / least
            + 2.0 * f64::EPSILON * distance.abs();
        // All comparisons are false for a NaN, the distance of a ray in the plane.
        let is_known = (least > toward_error) & (error < MISS);
        let (low, high) = (distance - error, distance + error);
        let is_out = is_known & ((high <= 0.0) | (low >= end));
        let near = if is_known { larger(low, 0.0) } else { 0.0 };
        let far = if is_known & is_passed & (low > 0.0) { high } else { MISS };
        Bracket { near: if is_out { MISS } else { near }, far: if is_out { MISS } else { far } }
    }
}

/// Returns bounds of the distance before `end` at which a ray, or any ray within its drift, hits a face.
#[inline(always)]
pub(super) fn t_bounds(
    corners: [DVec3; 3],
    ray: &Ray,
    end: f64,
    leaving: Leaving,
    drift: RayError,
) -> Bracket {
    let passed = passed(corners, ray, drift);
    if passed == Some(false) {
        return Bracket::MISS;
    }
    let flat = Flat::of(corners);
    let left = if leaving.most >= 0.0 { flat.left(ray, leaving, drift) } else { None };
    left.unwrap_or_else(|| flat.t_bounds(ray, end, leaving, drift, passed == Some(true)))
}

/// Tells whether a face has an area: its corners do not lie on one line.
pub(super) fn has_area(corners: [DVec3; 3]) -> bool {
    let [a, b, c] = corners;
    let (one, other) = (b - a, c - a);
    let edges = one.abs().max_element() * other.abs().max_element();
    // Ten times the error of a component. The product may underflow, but not where this comparison holds.
    one.cross(other).abs().max_element() > 100.0 * f64::EPSILON * edges + f64::MIN_POSITIVE
        || Triangle::<Exact>::new(corners).is_some()
}

/// The equation of a face, for proofs. Unlike a [`Triangle`] object, it is not cut off in front of the image plane.
pub(super) struct Face<A>(pub Triangle<A>);

impl<A> Equation for Face<A> {
    const IS_QUADRATIC: bool = true;

    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        let corner = self.0.corners[0].to_array();
        dot(self.0.area_normal(), per_axis(|axis| at[axis] - N::constant(corner[axis])))
    }

    fn inside_trim<N: Scalar>(&self, at: [N; 3]) -> N {
        self.0.inside(at)
    }
}

/// Returns the distance from a point to a triangle, in world units.
///
/// This is the distance from the plane if the point's projection is on the same side of all edges, and otherwise the
/// distance from the nearest edge. Coordinates are relative to the point, and the normal comes from the two shortest
/// edges, which keeps the result precise for long, thin triangles.
pub(super) fn distance_to(corners: [DVec3; 3], at: DVec3) -> f64 {
    let corners = [corners[0] - at, corners[1] - at, corners[2] - at];
    let size = larger(larger(largest(corners[0]), largest(corners[1])), largest(corners[2]));
    if !(1e-70..1e70).contains(&size) && size > 0.0 && size < MISS {
        // The fourth power of the size would underflow or overflow.
        let scale = times_power_of_two(1.0, exponent_to_one(size));
        return distance_to(corners.map(|corner| corner * scale), DVec3::ZERO) / scale;
    }
    let [a, b, c] = corners;
    let mut edges = [b - a, c - b, a - c];
    edges.sort_by(|one, other| one.length_squared().total_cmp(&other.length_squared()));
    let normal = edges[0].cross(edges[1]);
    let [one, two, three] = [a.cross(b).dot(normal), b.cross(c).dot(normal), c.cross(a).dot(normal)];
    let is_inside = one >= 0.0 && two >= 0.0 && three >= 0.0 || one <= 0.0 && two <= 0.0 && three <= 0.0;
    if is_inside && normal != DVec3::ZERO {
        let nearer = |one: DVec3, other: DVec3| {
            if other.length_squared() < one.length_squared() { other } else { one }
        };
        return (nearer(nearer(a, b), c).dot(normal) / normal.length()).abs();
    }
    let from_edge = |from: DVec3, to: DVec3| {
        let along = to - from;
        let part = (-from.dot(along) / along.length_squared()).clamp(0.0, 1.0);
        (from + part * along).length()
    };
    from_edge(a, b).min(from_edge(b, c)).min(from_edge(c, a))
}
