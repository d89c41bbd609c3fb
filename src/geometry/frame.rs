//! Where a shape's own coordinates lie in the world.

use crate::geometry::aabb::Aabb;
use crate::geometry::ray::Ray;
use crate::geometry::sight::{Line, Sight};
use crate::numeric::double_double::{DoubleDouble, offset};
use crate::numeric::scalar::{Scalar, dot};
use glam::{DMat3, DVec3};

/// How far rounding moves each coordinate of a point that is turned into a frame, as a part of its distance from the
/// frame's origin: by 3 units of EPSILON in the axes, 3/2 in the turning and 1 in the way from the origin; and of a
/// direction, less.
pub const BLUR: f64 = 6.0 * f64::EPSILON;

/// How far rounding moves each coordinate of a point in a frame that is so far along a ray: as [`BLUR`] says, and the
/// direction of a ray from the viewer is rounded by less than EPSILON, too.
#[inline(always)]
pub fn blur(at: DVec3, distance: f64) -> f64 {
    BLUR * at.abs().element_sum() + 2.0 * f64::EPSILON * distance.abs()
}

/// An origin, and three unit vectors upright on each other.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// The shape's own origin, in the world.
    pub origin: DVec3,
    /// The directions in the world of its own x, y and z.
    pub axes: DMat3,
    /// A vector along its y as the scene has it, but for a power of two; nothing where its axes are the world's.
    axis: Option<DVec3>,
}

impl Frame {
    /// As the world's, from another origin.
    pub fn at(origin: DVec3) -> Self {
        Self { origin, axes: DMat3::IDENTITY, axis: None }
    }

    /// With its y along a vector that is not 0. Around that axis it is turned anyhow: for shapes that are round.
    pub fn around(origin: DVec3, axis: DVec3) -> Self {
        let axes = upright(axis.normalize().to_array(), sign(axis)).map(DVec3::from);
        // A power of two: no digit is lost, and no square of it overflows.
        let scale = 2.0_f64.powi(-(axis.abs().max_element().log2() as i32).clamp(-1000, 1000));
        Self { origin, axes: DMat3::from_cols(axes[0], axes[1], axes[2]), axis: Some(axis * scale) }
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

    /// A line of the world likewise, from the numbers that the frame was made from.
    pub fn line<N: Scalar>(&self, line: Line<N>) -> Line<N> {
        let origin = [0, 1, 2].map(|axis| line.origin[axis] - N::constant(self.origin[axis]));
        let Some(axis) = self.axis else { return Line { origin, dir: line.dir } };
        let given = axis.to_array().map(N::constant);
        let length = dot(given, given).sqrt();
        let axes = upright(given.map(|part| part / length), sign(axis));
        Line { origin: axes.map(|axis| dot(axis, origin)), dir: axes.map(|axis| dot(axis, line.dir)) }
    }

    /// The way from the frame's origin to the point at a distance along a ray, in the world: rounded about once, however
    /// far away the ray's origin is.
    #[inline(always)]
    pub fn from_origin(&self, ray: &Ray, distance: f64) -> DVec3 {
        let along = |axis: usize| offset(ray.origin[axis], distance, ray.dir[axis], self.origin[axis]);
        DVec3::new(along(0), along(1), along(2))
    }

    /// A ray in the shape's own coordinates in twice the precision, from the point at a distance along it.
    pub fn exactly(&self, ray: &Ray, distance: f64) -> Line<DoubleDouble> {
        let Line { origin, dir } = Sight::along(ray).line::<DoubleDouble>();
        let start = Line { origin, dir }.at(DoubleDouble::from(distance));
        self.line(Line { origin: start, dir })
    }

    /// The box in the world around one in the shape's own coordinates.
    pub fn bounds(&self, own: &Aabb) -> Aabb {
        let DMat3 { x_axis, y_axis, z_axis } = self.axes;
        let middle = self.origin + self.axes * own.middle();
        let reach = DMat3::from_cols(x_axis.abs(), y_axis.abs(), z_axis.abs()) * own.half_size();
        Aabb { low: middle - reach, high: middle + reach }
    }
}

/// 1 or -1, of whose sum with the vector's z little cancels.
fn sign(axis: DVec3) -> f64 {
    axis.z.signum()
}

/// Three unit vectors upright on each other, the second of which is this one (Duff et al., "Building an Orthonormal Basis,
/// Revisited", 2017).
fn upright<N: Scalar>(up: [N; 3], sign: f64) -> [[N; 3]; 3] {
    let ([x, y, z], sign) = (up, N::constant(sign));
    let a = N::constant(-1.0) / (sign + z);
    let b = x * y * a;
    [[b, sign + y * y * a, -y], up, [N::constant(1.0) + sign * x * x * a, sign * b, -sign * x]]
}
