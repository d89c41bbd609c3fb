//! Where a shape's own coordinates lie in the world.

use crate::bounds::Bounds;
use crate::geometry::Ray;
use crate::number::Number;
use glam::{DMat3, DVec3};

/// An origin, and three unit vectors upright on each other.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// The shape's own origin, in the world.
    pub origin: DVec3,
    /// The directions in the world of its own x, y and z.
    pub axes: DMat3,
}

impl Frame {
    /// As the world's, from another origin.
    pub fn at(origin: DVec3) -> Self {
        Self { origin, axes: DMat3::IDENTITY }
    }

    /// With its y along a vector that is not 0. Around that axis it is turned anyhow: for shapes that are round.
    pub fn around(origin: DVec3, axis: DVec3) -> Self {
        let up = axis.normalize();
        let (across, away) = up.any_orthonormal_pair();
        Self { origin, axes: DMat3::from_cols(away, up, across) }
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

    /// Likewise, with any number type.
    pub fn point_of<N: Number>(&self, at: [N; 3]) -> [N; 3] {
        let from_origin = [0, 1, 2].map(|axis| at[axis] - N::constant(self.origin[axis]));
        [0, 1, 2].map(|axis| {
            let part = |world: usize| from_origin[world] * N::constant(self.axes.col(axis)[world]);
            part(0) + part(1) + part(2)
        })
    }

    /// A ray of the world likewise.
    #[inline(always)]
    pub fn ray(&self, ray: &Ray) -> Ray {
        Ray { origin: self.point(ray.origin), dir: self.direction(ray.dir) }
    }

    /// The box in the world around one in the shape's own coordinates.
    pub fn bounds(&self, own: &Bounds) -> Bounds {
        let DMat3 { x_axis, y_axis, z_axis } = self.axes;
        let middle = self.origin + self.axes * own.middle();
        let reach = DMat3::from_cols(x_axis.abs(), y_axis.abs(), z_axis.abs()) * own.half_size();
        Bounds { low: middle - reach, high: middle + reach }
    }
}
