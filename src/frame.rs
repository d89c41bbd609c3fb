//! Where a shape's own coordinates lie in the world.

use crate::bounds::Bounds;
use crate::dual::Dual;
use crate::geometry::Ray;
use crate::number::Number;
use crate::twofold::{Twofold, offset};
use glam::{DMat3, DVec3};

/// How far rounding moves each coordinate of a point that is turned into a frame, as a part of its distance from the
/// frame's origin: by 3 units of EPSILON in the axes, 3/2 in the turning and 1 in the way from the origin; and of a
/// direction, less.
pub const BLUR: f64 = 6.0 * f64::EPSILON;

/// An origin, and three unit vectors upright on each other.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// The shape's own origin, in the world.
    pub origin: DVec3,
    /// The directions in the world of its own x, y and z.
    pub axes: DMat3,
    /// Its own y as the scene has it, of any length.
    pub axis: DVec3,
}

impl Frame {
    /// As the world's, from another origin.
    pub fn at(origin: DVec3) -> Self {
        Self { origin, axes: DMat3::IDENTITY, axis: DVec3::Y }
    }

    /// With its y along a vector that is not 0. Around that axis it is turned anyhow: for shapes that are round.
    pub fn around(origin: DVec3, axis: DVec3) -> Self {
        let up = axis.normalize();
        let (across, away) = up.any_orthonormal_pair();
        Self { origin, axes: DMat3::from_cols(away, up, across), axis }
    }

    /// A direction of the world in the shape's own coordinates.
    #[inline(always)]
    pub fn direction(&self, dir: DVec3) -> DVec3 {
        DVec3::new(self.axes.x_axis.dot(dir), self.axes.y_axis.dot(dir), self.axes.z_axis.dot(dir))
    }

    /// A point of the world likewise.
    #[inline(always)]
    pub fn point(&self, at: DVec3) -> DVec3 {
        self.direction(at - self.origin)
    }

    /// A ray of the world likewise.
    #[inline(always)]
    pub fn ray(&self, ray: &Ray) -> Ray {
        Ray { origin: self.point(ray.origin), dir: self.direction(ray.dir) }
    }

    /// The way from the frame's origin to the point at a distance along a ray, in the world: rounded about once, however
    /// far away the ray's origin is.
    #[inline(always)]
    pub fn from_origin(&self, ray: &Ray, distance: f64) -> DVec3 {
        let along = |axis: usize| offset(ray.origin[axis], distance, ray.dir[axis], self.origin[axis]);
        DVec3::new(along(0), along(1), along(2))
    }

    /// A ray in the shape's own coordinates in twice the precision, from the point at a distance along it.
    pub fn exactly(&self, ray: &Ray, distance: f64) -> ExactRay {
        let axes = self.exact_axes();
        let wide = |vector: DVec3| vector.to_array().map(Twofold::from);
        let (start, from) = (wide(ray.origin), wide(self.origin));
        let dir = wide(ray.dir);
        let moved = [0, 1, 2].map(|axis| (start[axis] - from[axis]) + Twofold::from(distance) * dir[axis]);
        ExactRay { origin: axes.map(|axis| dot(axis, moved)), dir: axes.map(|axis| dot(axis, dir)) }
    }

    /// The axes in twice the precision: y along the axis as the scene has it, x and z upright on that.
    fn exact_axes(&self) -> [[Twofold; 3]; 3] {
        let wide = |vector: DVec3| vector.to_array().map(Twofold::from);
        // A power of two: no digit is lost.
        let scale = 2.0_f64.powi(-(self.axis.abs().max_element().log2() as i32).clamp(-1000, 1000));
        let up = unit(wide(self.axis * scale));
        let away = wide(self.axes.x_axis);
        let along = dot(away, up);
        let away = unit([0, 1, 2].map(|axis| away[axis] - along * up[axis]));
        [away, up, cross(away, up)]
    }

    /// The box in the world around one in the shape's own coordinates.
    pub fn bounds(&self, own: &Bounds) -> Bounds {
        let DMat3 { x_axis, y_axis, z_axis } = self.axes;
        let middle = self.origin + self.axes * own.middle();
        let reach = DMat3::from_cols(x_axis.abs(), y_axis.abs(), z_axis.abs()) * own.half_size();
        Bounds { low: middle - reach, high: middle + reach }
    }
}

/// A ray in a shape's own coordinates, in twice the precision.
pub struct ExactRay {
    origin: [Twofold; 3],
    dir: [Twofold; 3],
}

impl ExactRay {
    /// The point at a distance.
    pub fn at(&self, distance: Dual<Twofold>) -> [Dual<Twofold>; 3] {
        let constant = |value: Twofold| Dual { value, slope: Twofold::constant(0.0) };
        [0, 1, 2].map(|axis| constant(self.origin[axis]) + constant(self.dir[axis]) * distance)
    }
}

fn dot(a: [Twofold; 3], b: [Twofold; 3]) -> Twofold {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [Twofold; 3], b: [Twofold; 3]) -> [Twofold; 3] {
    let part = |one: usize, other: usize| a[one] * b[other] - a[other] * b[one];
    [part(1, 2), part(2, 0), part(0, 1)]
}

fn unit(vector: [Twofold; 3]) -> [Twofold; 3] {
    let length = dot(vector, vector).sqrt();
    vector.map(|part| part / length)
}
