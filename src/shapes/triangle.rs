//! The tests of a ray against the edges of a triangle: the arithmetic behind triangles.

use crate::geometry::ray::{Bracket, MISS, Ray, RayRange};
use crate::numeric::double_double::{
    self, DoubleDouble, exponent_to_one, rounded_unit, times_power_of_two, triple_product,
};
use crate::numeric::scalar::{Scalar, constants, cross, dot, per_axis};
use crate::shapes::plane::Plane;
use crate::world::accuracy::{Bounded, Classic};
use glam::DVec3;

/// A triangle.
#[derive(Clone, Copy, Debug)]
pub struct Triangle<A> {
    /// The plane of the triangle.
    pub plane: Plane<A>,
    /// The corners in world coordinates, counterclockwise as seen from the lit side.
    pub corners: [DVec3; 3],
}

impl Triangle<Classic> {
    /// Returns the triangle with these corners; `None` where they are collinear as far as `f64` tells.
    pub fn classic(corners: [DVec3; 3]) -> Option<Self> {
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a).try_normalize()?;
        Some(Self { plane: Plane::new(normal, exact_normal(corners), a), corners })
    }
}

impl<A: Bounded> Triangle<A> {
    /// Returns the triangle with these corners; `None` where they are collinear.
    pub fn new(corners: [DVec3; 3]) -> Option<Self> {
        let upright = exact_normal(corners);
        if upright.iter().all(|part| part.high == 0.0) {
            return None;
        }
        let normal = DVec3::from(rounded_unit(upright));
        Some(Self { plane: Plane::new(normal, upright, corners[0]), corners })
    }
}

impl<A: Bounded> Triangle<A> {
    /// Returns a bracket of the distance at which a ray crosses the triangle.
    #[inline(always)]
    pub fn t_bounds(&self, ray: &Ray, range: &RayRange) -> Bracket {
        let rough = self.plane.rough(ray, range.origin_error);
        let Bracket { near, far } = self.plane.t_bounds(&rough, ray, range);
        let passed = self.passed(ray);
        Bracket {
            near: if passed == Some(false) { MISS } else { near },
            far: if passed == Some(true) { far } else { MISS },
        }
    }
}

impl<A> Triangle<A> {
    /// Returns a normal whose length is twice the triangle's area.
    pub fn upright<N: Scalar>(&self) -> [N; 3] {
        let [a, b, c] = self.given_corners();
        let from_a = |corner: [N; 3]| per_axis(|axis| corner[axis] - a[axis]);
        cross(from_a(b), from_a(c))
    }

    fn given_corners<N: Scalar>(&self) -> [[N; 3]; 3] {
        per_axis(|corner| constants(self.corners[corner]))
    }

    /// Returns a number above 0 for a point of the plane inside the three edges, and below 0 outside; its unit differs
    /// from edge to edge.
    pub fn inside<N: Scalar>(&self, at: [N; 3]) -> N {
        let normal = self.upright();
        let [a, b, c] = self.given_corners();
        let inside = |from: [N; 3], to: [N; 3]| {
            // Perpendicular to the edge, in the plane, toward the inside.
            let inward = cross(normal, per_axis(|axis| to[axis] - from[axis]));
            dot(inward, per_axis(|axis| at[axis] - from[axis]))
        };
        inside(a, b).min(inside(b, c)).min(inside(c, a))
    }

    /// Returns whether a point of the plane is to the left of every edge, or on it.
    #[inline(always)]
    pub fn contains(&self, at: DVec3) -> bool {
        let left_of = |from: DVec3, to: DVec3| (to - from).cross(at - from).dot(self.plane.normal) >= 0.0;
        let [a, b, c] = self.corners;
        left_of(a, b) && left_of(b, c) && left_of(c, a)
    }

    /// Returns whether the line of a ray, extended both ways, passes every edge on the same side.
    ///
    /// For an edge that two triangles share, both compute the same number except for its sign, so that no ray falls
    /// through between them (Woop, Benthin and Wald 2013).
    #[inline(always)]
    pub fn is_passed_by(&self, ray: &Ray) -> bool {
        self.passed(ray).unwrap_or_else(|| {
            let [a, b, c] = self.corners;
            let sides = [(a, b), (b, c), (c, a)].map(|(from, to)| exact_side(from, to, ray));
            sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
        })
    }

    /// Returns what [`is_passed_by`](Self::is_passed_by) does, or `None` where rounding could have changed a sign.
    #[inline(always)]
    pub fn passed(&self, ray: &Ray) -> Option<bool> {
        let [a, b, c] = self.corners.map(|corner| corner - ray.origin);
        let side = |from: DVec3, to: DVec3| {
            let side = from.cross(to).dot(ray.dir);
            // Units of 2^-53 of the product of the largest components: a component of the cross product is off by 4 of
            // its two terms, the direction of a camera ray by 3 and the product by 4; components of the direction add
            // up to at most 1.74, so that the sum is off by 14 + 6 * 3 + 14 = 46, less than 64.
            let error = 32.0 * f64::EPSILON * from.abs().max_element() * to.abs().max_element();
            (side > error, side < -error)
        };
        let (one, two, three) = (side(a, b), side(b, c), side(c, a));
        let is_inside = (one.0 & two.0 & three.0) | (one.1 & two.1 & three.1);
        let is_outside = (one.0 | two.0 | three.0) & (one.1 | two.1 | three.1);
        if is_inside | is_outside { Some(is_inside) } else { None }
    }
}

/// Returns a number whose sign tells on which side of the line from one point to another a ray passes; 0 where the
/// ray's line meets it.
#[inline(never)]
fn exact_side(from: DVec3, to: DVec3, ray: &Ray) -> f64 {
    let place =
        |of: DVec3| scaled_to_one(per_axis(|axis| DoubleDouble::difference(of[axis], ray.origin[axis])));
    triple_product(place(from), place(to), ray.dir.to_array()).high
}

/// Returns the plane through the corners of a triangle with an area, for distances only: its unit normal, which takes
/// longer than all else of it, is left 0.
#[inline]
pub fn plane_for_distances<A>(corners: [DVec3; 3]) -> Plane<A> {
    Plane::new(DVec3::ZERO, exact_normal(corners), corners[0])
}

/// Returns a normal of the plane through three points, each component rounded once however thin their triangle is; 0
/// where the points are collinear.
#[inline]
fn exact_normal([a, b, c]: [DVec3; 3]) -> [DoubleDouble; 3] {
    let edge = |to: DVec3| {
        let edge = |axis: usize| DoubleDouble::difference(to[axis], a[axis]);
        scaled_to_one([edge(0), edge(1), edge(2)])
    };
    scaled_to_one(double_double::cross(edge(b), edge(c)))
}

/// Returns a vector scaled by a power of two so that its largest component is between 1/2 and 1.
#[inline]
fn scaled_to_one(vector: [DoubleDouble; 3]) -> [DoubleDouble; 3] {
    let exponent = exponent_to_one(vector.iter().fold(0.0, |largest, part| part.high.abs().max(largest)));
    let scaled = |DoubleDouble { high, low }: DoubleDouble| DoubleDouble {
        high: times_power_of_two(high, exponent),
        low: times_power_of_two(low, exponent),
    };
    [scaled(vector[0]), scaled(vector[1]), scaled(vector[2])]
}
