//! Rectangles cut out of planes: the arithmetic behind the shapes that have one.

use crate::geometry::aabb::{Aabb, larger, smaller};
use crate::geometry::ray::{Bracket, MISS, Ray, RayBall, RayRange};
use crate::shapes::plane::Plane;
use crate::world::accuracy::AccuracyTag;
use glam::{DMat3, DVec2, DVec3};
use tabray_exact::double_double::vectors::{cross, product, unit};
use tabray_exact::double_double::{DoubleDouble, power_of_two, scaled};
use tabray_exact::scalar::{self, Scalar, constants, dot, per_axis};

/// The place and the size of a rectangle.
#[derive(Clone, Copy, Debug)]
pub struct Rectangle {
    /// The lower left corner, in world coordinates.
    pub corner: DVec3,
    /// The lengths of the sides, in world units.
    pub dimensions: DVec2,
    /// The directions of the sides from the corner: unit vectors, rounded.
    pub sides: [DVec3; 2],
}

/// A rectangle as a part of a plane.
#[derive(Clone, Copy, Debug)]
pub struct FinitePlane<A> {
    /// The plane, whose point is the rectangle's corner.
    pub plane: Plane<A>,
    /// The part of the plane.
    pub rectangle: Rectangle,
    /// The directions of the sides, as double-doubles.
    pub exact_sides: [[DoubleDouble; 3]; 2],
    /// The vector that the scene gives, of any length, whose projection onto the plane is along the first side.
    pub given_xdir: DVec3,
    /// A bound of the rectangle's coordinates, in world units.
    pub reach: f64,
}

impl Rectangle {
    /// Returns the coordinates along the two sides of a point of the plane, in world units from the corner.
    #[inline(always)]
    pub fn coordinates(&self, at: DVec3) -> DVec2 {
        let from_corner = at - self.corner;
        DVec2::new(self.sides[0].dot(from_corner), self.sides[1].dot(from_corner))
    }

    /// Returns the bounding box.
    pub fn around(&self) -> Aabb {
        let corner = |x: f64, y: f64| self.corner + x * self.sides[0] + y * self.sides[1];
        let DVec2 { x, y } = self.dimensions;
        Aabb::around(&[corner(0.0, 0.0), corner(x, 0.0), corner(0.0, y), corner(x, y)])
    }
}

/// Returns the coordinates of a vector along the sides of a rectangle with this normal, whose first side is along the
/// projection of `xdir`, in the unit of the vector. The normal and `xdir` may have any length.
pub fn along_sides<N: Scalar>(normal: [N; 3], xdir: [N; 3], vector: [N; 3]) -> [N; 2] {
    let (square, across) = (dot(normal, normal), dot(normal, xdir));
    let first = per_axis(|axis| square * xdir[axis] - across * normal[axis]);
    let along = |side: [N; 3]| dot(side, vector) / dot(side, side).sqrt();
    [along(first), along(scalar::cross(normal, xdir))]
}

impl<A> FinitePlane<A> {
    /// Returns the part of a plane with a corner at the plane's point, sides of these lengths (in world units) and
    /// directions; the first side is along the projection of `given_xdir`.
    pub fn cut_from(plane: Plane<A>, dimensions: DVec2, given_xdir: DVec3, sides: [DVec3; 2]) -> Self {
        let reach = plane.point.abs().max_element() + dimensions.element_sum();
        let exact_sides = exact_sides(plane.upright, given_xdir);
        let rectangle = Rectangle { corner: plane.point, dimensions, sides };
        Self { plane, rectangle, exact_sides, given_xdir, reach }
    }

    /// Returns a number above 0 for a point of the plane inside the four sides, and below 0 outside; its unit differs
    /// from side to side. Works with squares: lengths and unit vectors would need square roots, which are expensive
    /// with many bits.
    pub fn inside_of<N: Scalar>(&self, at: [N; 3]) -> N {
        let (normal, xdir) = (self.plane.given_normal(), constants(self.given_xdir));
        let from_corner = per_axis(|axis| at[axis] - N::constant(self.plane.point[axis]));
        // The first side is along the projection of `xdir`, from which it differs by a multiple of the normal; the
        // normal is perpendicular to all vectors in the plane.
        let ydir = scalar::cross(normal, xdir);
        let (x, y, square) = (dot(xdir, from_corner), dot(ydir, from_corner), dot(ydir, ydir));
        let inside = |along: N, part: N, length: f64| along.min(N::constant(length).powi(2) * square - part);
        let [width, height] = self.rectangle.dimensions.to_array();
        inside(x, dot(normal, normal) * x.powi(2), width).min(inside(y, y.powi(2), height))
    }

    /// Returns a bound of the rounding error of the point where a ray intersects the plane, along a side, in world
    /// units.
    ///
    /// Units of 2^-53, along a side, whose components add up to at most 1.74: a distance is off by 14, its product with
    /// the direction by 1; the point by 1 of its distance from the world's origin, which is at most that of the ray's
    /// origin plus the distance, and by 1 of its distance from the corner; a side's components by 1, a product by 1,
    /// the sum of three by 2. In all, less than 16 of the distance, 2 of the origin and 5 of `reach` in each component,
    /// or 28 in sum.
    #[inline(always)]
    pub fn slack(&self, ray: &Ray, distance: f64) -> f64 {
        let origin = ray.origin.abs();
        let farthest = larger(larger(origin.x, origin.y), origin.z);
        16.0 * f64::EPSILON * (farthest + distance.abs() + self.reach)
    }

    /// Returns the distance from the rectangle's nearest side at which a ray intersects the plane, in world units:
    /// below 0 outside, NaN for a ray that does not.
    #[inline(always)]
    pub fn inside(&self, ray: &Ray, distance: f64) -> f64 {
        let at = self.rectangle.coordinates(ray.at(distance));
        let past = self.rectangle.dimensions - at;
        smaller(smaller(at.x, past.x), smaller(at.y, past.y))
    }
}

impl<A: AccuracyTag> FinitePlane<A> {
    /// Returns bounds of the distance of a hit in a range.
    #[inline(always)]
    pub fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        let rough = self.plane.rough_crossing(ray, range.origin_error);
        let inside = self.inside(ray, rough.distance);
        // A camera ray's direction is off by 3 units of 2^-53 in each component, which is less than half of the slack.
        let slack = rough.error + rough.aside + 2.0 * self.slack(ray, rough.distance);
        let Bracket { near, far } = self.plane.t_bounds(&rough, ray, range);
        Bracket {
            near: if inside < -slack { MISS } else { near },
            far: if inside > slack { far } else { MISS },
        }
    }

    /// Returns the distance in world units at which a ray passes through the rectangle ahead, or `None`.
    #[inline(always)]
    pub fn crossing(&self, ray: &Ray) -> Option<f64> {
        let distance = self.plane.crossing(ray);
        (distance > 0.0 && self.has_crossing(ray, distance)).then_some(distance)
    }

    /// Returns whether the rectangle contains the point where a ray intersects its plane; the sides belong to it.
    #[inline(always)]
    pub(crate) fn has_crossing(&self, ray: &Ray, distance: f64) -> bool {
        if A::IS_CLASSIC {
            return self.inside(ray, distance) >= 0.0;
        }
        self.quickly_has_crossing(ray, distance).unwrap_or_else(|| self.precisely_has_crossing(ray))
    }

    /// Computes [`has_crossing`](Self::has_crossing), or `None` where the point is on a side to within rounding.
    #[inline(always)]
    pub(crate) fn quickly_has_crossing(&self, ray: &Ray, distance: f64) -> Option<bool> {
        let slack = self.slack(ray, distance);
        let inside = self.inside(ray, distance);
        let is_doubtful = (inside.abs() <= slack) & (slack > 0.0) & (distance < MISS);
        if is_doubtful { None } else { Some(inside >= 0.0) }
    }

    /// Computes [`has_crossing`](Self::has_crossing) in double-double arithmetic. A point within the rounding error of
    /// a side counts as on the side.
    #[inline(never)]
    fn precisely_has_crossing(&self, ray: &Ray) -> bool {
        let distance = self.plane.exact_crossing(ray);
        let from = per_axis(|axis| DoubleDouble::difference(ray.origin[axis], self.plane.point[axis]));
        let dir = ray.dir.to_array().map(DoubleDouble::from);
        (0..2).all(|side| {
            let (start, onward) =
                (product(self.exact_sides[side], from), distance * product(self.exact_sides[side], dir));
            let along = start + onward;
            let past = DoubleDouble::from(self.rectangle.dimensions[side]) - along;
            // Each of about ten operations is off by at most 2^-102 of its terms, which are no larger than `size`.
            let size = from.iter().map(|part| part.high.abs()).sum::<f64>() + distance.high.abs();
            let lowest = -power_of_two(-97) * (size + self.rectangle.dimensions[side]);
            along.high >= lowest && past.high >= lowest
        })
    }
}

/// Returns the directions of a rectangle's two sides and its normal as columns, all unit vectors: the rows of the
/// course notes' rotation matrix.
pub fn frame(normal: DVec3, xdir: DVec3) -> DMat3 {
    let (normal, xdir) = (scaled(normal).normalize(), scaled(xdir));
    let x = (xdir - normal.dot(xdir) * normal).normalize();
    DMat3::from_cols(x, normal.cross(x), normal)
}

/// Returns the sides of `exact_sides`, rounded.
pub fn rounded_sides(upright: [DoubleDouble; 3], xdir: DVec3) -> [DVec3; 2] {
    exact_sides(upright, xdir).map(|side| DVec3::from(side.map(|part| part.high)))
}

/// Returns the directions of the two sides of a rectangle with this normal, as double-double unit vectors; the first is
/// along the projection of `xdir` onto the plane.
pub(crate) fn exact_sides(upright: [DoubleDouble; 3], xdir: DVec3) -> [[DoubleDouble; 3]; 2] {
    let xdir = scaled(xdir).to_array().map(DoubleDouble::from);
    let second = cross(upright, xdir);
    [unit(cross(second, upright)), unit(second)]
}
