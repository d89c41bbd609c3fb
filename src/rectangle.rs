//! A rectangle cut out of a plane: the arithmetic behind those shapes that have one.

use crate::accuracy::Accuracy;
use crate::bounds::{Bounds, larger, smaller};
use crate::flat::Plane;
use crate::geometry::Ray;
use glam::{DVec2, DVec3};

/// A part of a plane. Other rectangles hold one.
#[derive(Clone, Copy, Debug)]
pub struct FinitePlane {
    /// The plane, whose point is the rectangle's corner.
    pub plane: Plane,
    /// How long its sides are, in world units.
    pub dimensions: DVec2,
    /// Where they go from the corner, unit vectors.
    pub sides: [DVec3; 2],
    /// The vector right above the first of them that the scene gives, of any length.
    pub given_xdir: DVec3,
    /// How far from the world's origin it reaches, about, in world units.
    pub reach: f64,
}

impl FinitePlane {
    /// How far along its two sides a point of its plane is, from its corner.
    #[inline(always)]
    pub fn coordinates(&self, at: DVec3) -> DVec2 {
        let from_corner = at - self.plane.point;
        DVec2::new(self.sides[0].dot(from_corner), self.sides[1].dot(from_corner))
    }

    /// Whether it has the point of its plane where a ray crosses that, its sides included.
    ///
    /// A side is as wide as rounding makes the point, so that nothing falls through between two rectangles.
    #[inline(always)]
    pub fn has_crossing(&self, ray: &Ray, distance: f64) -> bool {
        let slack = match self.plane.accuracy {
            Accuracy::Classic => 0.0,
            _ => self.slack(ray, distance),
        };
        self.inside(ray, distance) >= -slack
    }

    /// What rounding may make of the place where a ray crosses its plane.
    #[inline(always)]
    pub fn slack(&self, ray: &Ray, distance: f64) -> f64 {
        let origin = ray.origin.abs();
        let farthest = larger(larger(origin.x, origin.y), origin.z);
        4.0 * f64::EPSILON * (farthest + distance + self.reach)
    }

    /// How far inside of its nearest side a ray crosses its plane; below 0 outside, NaN for none.
    #[inline(always)]
    pub fn inside(&self, ray: &Ray, distance: f64) -> f64 {
        let at = self.coordinates(ray.at(distance));
        let past = self.dimensions - at;
        smaller(smaller(at.x, past.x), smaller(at.y, past.y))
    }

    /// The box around it.
    pub fn around(&self) -> Bounds {
        let corner = |x: f64, y: f64| self.plane.point + x * self.sides[0] + y * self.sides[1];
        let DVec2 { x, y } = self.dimensions;
        Bounds::around(&[corner(0.0, 0.0), corner(x, 0.0), corner(0.0, y), corner(x, y)])
    }
}
