//! Rectangles in planes: the arithmetic behind shapes with a rectangle.

use crate::plane::Plane;
use glam::{DMat3, DVec2, DVec3};
use tabray_exact::double_double::vectors::{cross, product, unit};
use tabray_exact::double_double::{DoubleDouble, power_of_two, scaled};
use tabray_exact::interval::Wide;
use tabray_exact::scalar::{self, Scalar, constants, dot, per_axis};
use tabray_world::accuracy::AccuracyTag;
use tabray_world::geometry::aabb::{Aabb, larger, smaller};
use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayBall, RayRange};
use tabray_world::number::{Known, Number, plain};

/// The position and the size of a rectangle.
#[derive(Clone, Copy, Debug)]
pub struct Rectangle {
    /// The lower left corner, in world coordinates.
    pub corner: DVec3,
    /// The lengths of the sides, in world units.
    pub dimensions: DVec2,
    /// The directions of the sides from the corner, as rounded unit vectors.
    pub sides: [DVec3; 2],
}

/// A rectangle as a part of a plane.
#[derive(Clone, Copy, Debug)]
pub struct FinitePlane<A> {
    /// The plane. Its point is the rectangle's corner.
    pub plane: Plane<A>,
    /// The rectangle in the plane.
    pub rectangle: Rectangle,
    /// The directions of the sides, as double-doubles.
    pub exact_sides: [[DoubleDouble; 3]; 2],
    /// A vector of the scene, of any length. The first side is along its projection onto the plane.
    pub given_xdir: DVec3,
    /// A bound of the rectangle's coordinates, in world units.
    pub reach: f64,
}

impl Rectangle {
    /// Returns the coordinates of a point of the plane along the two sides, in world units from the corner.
    #[inline(always)]
    pub fn coordinates(&self, at: DVec3) -> DVec2 {
        let from_corner = at - self.corner;
        DVec2::new(self.sides[0].dot(from_corner), self.sides[1].dot(from_corner))
    }

    /// See [`FinitePlane::inside_of`]. It is compiled once for all accuracies.
    fn inside_of<N: Scalar>(&self, normal: [N; 3], xdir: DVec3, from_corner: [N; 3]) -> N {
        let xdir = constants(xdir);
        // The first side is along the projection of `xdir`, which differs from `xdir` by a multiple of the normal. The
        // normal is perpendicular to all vectors in the plane.
        let ydir = scalar::cross(normal, xdir);
        let (x, y, square) = (dot(xdir, from_corner), dot(ydir, from_corner), dot(ydir, ydir));
        let inside = |along: N, part: N, length: f64| along.min(N::constant(length).powi(2) * square - part);
        let [width, height] = self.dimensions.to_array();
        inside(x, dot(normal, normal) * x.powi(2), width).min(inside(y, y.powi(2), height))
    }

    /// Returns the bounding box.
    pub fn around(&self) -> Aabb {
        let corner = |x: f64, y: f64| self.corner + x * self.sides[0] + y * self.sides[1];
        let DVec2 { x, y } = self.dimensions;
        Aabb::around(&[corner(0.0, 0.0), corner(x, 0.0), corner(0.0, y), corner(x, y)])
    }
}

/// Returns the coordinates of a vector along the sides of a rectangle with this normal, in the unit of the vector. The
/// first side is along the projection of `xdir`. The normal and `xdir` may have any length.
pub fn along_sides<N: Scalar>(normal: [N; 3], xdir: [N; 3], vector: [N; 3]) -> [N; 2] {
    let (square, across) = (dot(normal, normal), dot(normal, xdir));
    let first = per_axis(|axis| square * xdir[axis] - across * normal[axis]);
    let along = |side: [N; 3]| dot(side, vector) / dot(side, side).sqrt();
    [along(first), along(scalar::cross(normal, xdir))]
}

/// Returns the directions of the sides of such a rectangle, which are rounded to these.
pub fn known_sides(normal: DVec3, xdir: DVec3, rounded: [DVec3; 2]) -> [[Known; 3]; 2] {
    let (normal, xdir): ([Wide; 3], _) = (constants(normal), constants(xdir));
    let (square, across) = (dot(normal, normal), dot(normal, xdir));
    let first = per_axis(|axis| square * xdir[axis] - across * normal[axis]);
    let unit = |side: [Wide; 3]| side.map(|along| along / dot(side, side).sqrt());
    let sides = [unit(first), unit(scalar::cross(normal, xdir))];
    [0, 1].map(|side| Known::each(rounded[side].to_array(), sides[side]))
}

impl<A> FinitePlane<A> {
    /// Returns the part of a plane with a corner at the plane's point, and sides with these lengths, in world units,
    /// and directions. The first side is along the projection of `given_xdir`.
    pub fn cut_from(plane: Plane<A>, dimensions: DVec2, given_xdir: DVec3, sides: [DVec3; 2]) -> Self {
        let reach = plane.point.abs().max_element() + dimensions.element_sum();
        let exact_sides = exact_sides(plane.upright, given_xdir);
        let rectangle = Rectangle { corner: plane.point, dimensions, sides };
        Self { plane, rectangle, exact_sides, given_xdir, reach }
    }

    /// Returns a number that is positive for a point of the plane inside the four sides, and negative outside. Its unit
    /// differs from side to side. Squares replace lengths and unit vectors, because square roots are expensive with
    /// many bits.
    pub fn inside_of<N: Scalar>(&self, at: [N; 3]) -> N {
        let from_corner = per_axis(|axis| at[axis] - N::constant(self.plane.point[axis]));
        self.rectangle.inside_of(self.plane.given_normal(), self.given_xdir, from_corner)
    }

    /// Returns a bound of the rounding error, along a side, of the point where a ray crosses the plane, in world units.
    ///
    /// In units of 2^-53, along a side with components that add up to at most 1.74: the error of the distance is 14,
    /// and its product with the direction adds 1. The point adds 1 of its distance from the world's origin, at most
    /// that of the ray's origin plus the distance, and 1 of its distance from the corner. A side's components add 1, a
    /// product 1, and the sum of three 2. Each component thus has an error of less than 16 of the distance, 2 of the
    /// origin and 5 of `reach`, or 28 in total.
    #[inline(always)]
    pub fn slack(&self, ray: &Ray, distance: f64) -> f64 {
        let origin = ray.origin.abs();
        let farthest = larger(larger(origin.x, origin.y), origin.z);
        16.0 * f64::EPSILON * (farthest + distance.abs() + self.reach)
    }

    /// Returns the distance between a ray's crossing of the plane and the rectangle's nearest side, in world units. It
    /// is negative outside, and NaN for a ray without a crossing.
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
        // The error of a camera ray's direction, 3 units of 2^-53 in each component, is less than half of the slack.
        let slack = rough.error + rough.aside + 2.0 * self.slack(ray, rough.distance);
        let Bracket { near, far } = self.plane.t_bounds(&rough, ray, range);
        Bracket {
            near: if inside < -slack { MISS } else { near },
            far: if inside > slack { far } else { MISS },
        }
    }

    /// Returns the distance in world units at which a ray crosses the rectangle ahead, or `None`.
    #[inline(always)]
    pub fn crossing(&self, ray: &Ray) -> Option<f64> {
        let distance = self.plane.crossing(ray);
        (distance > 0.0 && self.has_crossing(ray, distance)).then_some(distance)
    }

    /// Returns where the line from a point to a light passes through the rectangle, and a number above 0 if it does; `None`
    /// if it certainly does not.
    #[inline(always)]
    pub fn passed<N: Number>(&self, from: [N; 3], light: DVec3) -> Option<([N; 3], N)> {
        let n = N::constant;
        if let Some(origin) = plain(from) {
            let ray = Ray { origin, dir: (light - origin).normalize() };
            return Some((constants(ray.at(self.crossing(&ray)?)), n(1.0)));
        }
        let (away, normal) = (per_axis(|axis| n(light[axis]) - from[axis]), self.plane.given_normal());
        let (height, slope) = (per_axis(|axis| n(self.plane.point[axis]) - from[axis]), dot(normal, away));
        let crossing = dot(normal, height) / slope;
        let at = per_axis(|axis| from[axis] + crossing * away[axis]);
        let inside = crossing.min(self.inside_of(at));
        (inside.bounds()[1] >= 0.0 && !slope.is_zero()).then_some((at, inside))
    }

    /// Returns whether the rectangle, including its sides, contains the point where a ray crosses its plane.
    #[inline(always)]
    pub(crate) fn has_crossing(&self, ray: &Ray, distance: f64) -> bool {
        if A::IS_CLASSIC {
            return self.inside(ray, distance) >= 0.0;
        }
        self.quickly_has_crossing(ray, distance).unwrap_or_else(|| self.precisely_has_crossing(ray))
    }

    /// Computes [`has_crossing`](Self::has_crossing), or `None` if the point is on a side up to rounding.
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
            // The error of each of about ten operations is at most 2^-102 of its terms, which are at most `size`.
            let size = from.iter().map(|part| part.high.abs()).sum::<f64>() + distance.high.abs();
            let lowest = -power_of_two(-97) * (size + self.rectangle.dimensions[side]);
            along.high >= lowest && past.high >= lowest
        })
    }
}

/// Returns the unit vectors along a rectangle's two sides and its normal, as columns. They are the rows of the course
/// notes' rotation matrix.
pub fn frame(normal: DVec3, xdir: DVec3) -> DMat3 {
    let (normal, xdir) = (scaled(normal).normalize(), scaled(xdir));
    let x = (xdir - normal.dot(xdir) * normal).normalize();
    DMat3::from_cols(x, normal.cross(x), normal)
}

/// Returns the rounded results of `exact_sides`.
pub fn rounded_sides(upright: [DoubleDouble; 3], xdir: DVec3) -> [DVec3; 2] {
    exact_sides(upright, xdir).map(|side| DVec3::from(side.map(|part| part.high)))
}

/// Returns the directions of the two sides of a rectangle with this normal, as double-double unit vectors. The first is
/// along the projection of `xdir` onto the plane.
pub(crate) fn exact_sides(upright: [DoubleDouble; 3], xdir: DVec3) -> [[DoubleDouble; 3]; 2] {
    let xdir = scaled(xdir).to_array().map(DoubleDouble::from);
    let second = cross(upright, xdir);
    [unit(cross(second, upright)), unit(second)]
}
