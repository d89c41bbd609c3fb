//! A rectangle cut out of a plane: the arithmetic behind those shapes that have one.

use crate::geometry::aabb::{Aabb, larger, smaller};
use crate::geometry::ray::{Bracket, MISS, Ray, RayRange};
use crate::numeric::double_double::{
    DoubleDouble, cross, exponent_to_one, product, times_power_of_two, unit,
};
use crate::numeric::scalar::{self, Scalar, dot};
use crate::shapes::plane::{DRAFT_ERROR, Plane};
use crate::world::accuracy::{Accuracy, Bounded, Classic};
use glam::{DMat3, DVec2, DVec3};

/// Where a rectangle is.
#[derive(Clone, Copy, Debug)]
pub struct Rectangle {
    /// Its lower left corner, in world coordinates.
    pub corner: DVec3,
    /// How long its sides are, in world units.
    pub dimensions: DVec2,
    /// Where they go from the corner, unit vectors, rounded.
    pub sides: [DVec3; 2],
}

/// A rectangle as a part of a plane.
#[derive(Clone, Copy, Debug)]
pub struct FinitePlane<A> {
    /// The plane, whose point is the rectangle's corner.
    pub plane: Plane<A>,
    /// Which part of it that is.
    pub rectangle: Rectangle,
    /// Where its sides go, in twice the precision.
    pub exact_sides: [[DoubleDouble; 3]; 2],
    /// The vector right above the first of them that the scene gives, of any length.
    pub given_xdir: DVec3,
    /// How far from the world's origin it reaches, about, in world units.
    pub reach: f64,
}

impl Rectangle {
    /// How far along its two sides a point of its plane is, from its corner.
    #[inline(always)]
    pub fn coordinates(&self, at: DVec3) -> DVec2 {
        let from_corner = at - self.corner;
        DVec2::new(self.sides[0].dot(from_corner), self.sides[1].dot(from_corner))
    }

    /// The box around it.
    pub fn around(&self) -> Aabb {
        let corner = |x: f64, y: f64| self.corner + x * self.sides[0] + y * self.sides[1];
        let DVec2 { x, y } = self.dimensions;
        Aabb::around(&[corner(0.0, 0.0), corner(x, 0.0), corner(0.0, y), corner(x, y)])
    }
}

impl<A> FinitePlane<A> {
    /// The part of a plane with a corner at its point, so long sides in these directions, and the first of them right below a
    /// vector.
    pub fn cut_from(plane: Plane<A>, dimensions: DVec2, given_xdir: DVec3, sides: [DVec3; 2]) -> Self {
        let reach = plane.point.abs().max_element() + dimensions.element_sum();
        let exact_sides = exact_sides(plane.upright, given_xdir);
        let rectangle = Rectangle { corner: plane.point, dimensions, sides };
        Self { plane, rectangle, exact_sides, given_xdir, reach }
    }

    /// Above 0 inside of the four sides, each in a measure of its own, and below 0 outside, of a point of the plane. By
    /// squares: lengths and unit
    /// vectors would need roots, which are dear with many bits.
    pub fn inside_of<N: Scalar>(&self, at: [N; 3]) -> N {
        let n = |of: DVec3| of.to_array().map(N::constant);
        let (normal, xdir, corner) = (self.plane.given_normal(), n(self.given_xdir), n(self.plane.point));
        let from_corner = [0, 1, 2].map(|axis| at[axis] - corner[axis]);
        // Of the first side, which is right below `xdir`, the normal is upright on all that is on the plane.
        let ydir = scalar::cross(normal, xdir);
        let (x, y, square) = (dot(xdir, from_corner), dot(ydir, from_corner), dot(ydir, ydir));
        let inside = |along: N, part: N, length: f64| along.min(N::constant(length).powi(2) * square - part);
        let [width, height] = self.rectangle.dimensions.to_array();
        inside(x, dot(normal, normal) * x.powi(2), width).min(inside(y, y.powi(2), height))
    }

    /// What rounding may make of the place where a ray crosses its plane.
    ///
    /// Units of 2^-53, along a side, whose components add up to at most 1.74: a distance is off by 14, its product with
    /// the direction by 1, the point by 1 of what it is from the world's origin, which is at most the ray's origin
    /// and the distance, and by 1 of itself from the corner; a side's components by 1, a product by 1, the sum of
    /// three by 2. In all less than 16 of the distance, 2 of the origin and 5 of `reach` in each component, or 28 in sum.
    #[inline(always)]
    pub fn slack(&self, ray: &Ray, distance: f64) -> f64 {
        let origin = ray.origin.abs();
        let farthest = larger(larger(origin.x, origin.y), origin.z);
        16.0 * f64::EPSILON * (farthest + distance.abs() + self.reach)
    }

    /// How far inside of its nearest side a ray crosses its plane; below 0 outside, NaN for none.
    #[inline(always)]
    pub fn inside(&self, ray: &Ray, distance: f64) -> f64 {
        let at = self.rectangle.coordinates(ray.at(distance));
        let past = self.rectangle.dimensions - at;
        smaller(smaller(at.x, past.x), smaller(at.y, past.y))
    }
}

impl<A: Bounded> FinitePlane<A> {
    /// Between which distances a hit within a span is.
    #[inline(always)]
    pub fn t_bounds(&self, ray: &Ray, range: &RayRange) -> Bracket {
        let rough = self.plane.rough(ray, range.origin_error);
        let inside = self.inside(ray, rough.distance);
        // A camera's direction is off by 3 units of 2^-53 in each component, which is less than half of the slack.
        let slack = rough.error + 2.0 * self.slack(ray, rough.distance);
        let Bracket { near, far } = self.plane.t_bounds(&rough, ray, range);
        Bracket {
            near: if inside < -slack { MISS } else { near },
            far: if inside > slack { far } else { MISS },
        }
    }

    /// Whether it has the point of its plane where a ray crosses that, its sides included.
    #[inline(always)]
    pub fn has_crossing(&self, ray: &Ray, distance: f64) -> bool {
        self.quickly_has_crossing(ray, distance).unwrap_or_else(|| self.exactly_has_crossing(ray))
    }

    /// Likewise, or nothing where it is on a side but for rounding.
    #[inline(always)]
    pub fn quickly_has_crossing(&self, ray: &Ray, distance: f64) -> Option<bool> {
        let slack = match A::ACCURACY {
            Accuracy::Draft => self.slack(ray, distance) + DRAFT_ERROR * distance,
            _ => self.slack(ray, distance),
        };
        let inside = self.inside(ray, distance);
        let is_doubtful = (inside.abs() <= slack) & (slack > 0.0) & (distance < MISS);
        if is_doubtful { None } else { Some(inside >= 0.0) }
    }

    /// As [`has_crossing`](Self::has_crossing), in twice the precision. What is as near to a side as its rounding is on it.
    #[inline(never)]
    fn exactly_has_crossing(&self, ray: &Ray) -> bool {
        let distance = self.plane.exact_crossing(ray);
        let from = [0, 1, 2].map(|axis| DoubleDouble::difference(ray.origin[axis], self.plane.point[axis]));
        let dir = ray.dir.to_array().map(DoubleDouble::from);
        (0..2).all(|side| {
            let (start, onward) =
                (product(self.exact_sides[side], from), distance * product(self.exact_sides[side], dir));
            let along = start + onward;
            let past = DoubleDouble::from(self.rectangle.dimensions[side]) - along;
            // Each of some ten operations is off by at most 2^-102 of its parts, which are no larger than this.
            let size = from.iter().map(|part| part.high.abs()).sum::<f64>() + distance.high.abs();
            let least = -(2_f64.powi(-97)) * (size + self.rectangle.dimensions[side]);
            along.high >= least && past.high >= least
        })
    }
}

impl FinitePlane<Classic> {
    /// Whether it has the point of its plane where a ray crosses that, its sides included.
    #[inline(always)]
    pub fn has_crossing(&self, ray: &Ray, distance: f64) -> bool {
        self.inside(ray, distance) >= 0.0
    }
}

/// A rectangle that rays go through.
pub trait Window: Send + Sync {
    /// The distance ahead at which a ray goes through it, if it does.
    fn crossing(&self, ray: &Ray) -> Option<f64>;
}

impl<A: Bounded> Window for FinitePlane<A> {
    #[inline(always)]
    fn crossing(&self, ray: &Ray) -> Option<f64> {
        let distance = self.plane.crossing(ray);
        (distance > 0.0 && self.has_crossing(ray, distance)).then_some(distance)
    }
}

impl Window for FinitePlane<Classic> {
    #[inline(always)]
    fn crossing(&self, ray: &Ray) -> Option<f64> {
        let distance = self.plane.crossing(ray);
        (distance > 0.0 && self.has_crossing(ray, distance)).then_some(distance)
    }
}

/// The directions of a rectangle's two sides and its normal, as columns, all unit vectors: the rows of the notes' rotation
/// matrix.
pub fn frame(normal: DVec3, xdir: DVec3) -> DMat3 {
    let normal = normal.normalize();
    let x = (xdir - normal.dot(xdir) * normal).normalize();
    DMat3::from_cols(x, normal.cross(x), normal)
}

/// What [`exact_sides`] gives, rounded.
pub fn rounded_sides(upright: [DoubleDouble; 3], xdir: DVec3) -> [DVec3; 2] {
    exact_sides(upright, xdir).map(|side| DVec3::from(side.map(|part| part.high)))
}

/// The directions of the two sides of a rectangle with this normal, the first of which is below `xdir`: unit vectors
/// in twice the precision.
pub fn exact_sides(upright: [DoubleDouble; 3], xdir: DVec3) -> [[DoubleDouble; 3]; 2] {
    let exponent = exponent_to_one(xdir.abs().max_element());
    let xdir = xdir.to_array().map(|part| DoubleDouble::from(times_power_of_two(part, exponent)));
    let second = cross(upright, xdir);
    [unit(cross(second, upright)), unit(second)]
}
