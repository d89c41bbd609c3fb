//! Frames: a shape's own coordinate system, and its position in world space.

use crate::geometry::aabb::Aabb;
use crate::geometry::facet::Facet;
use crate::geometry::ray::Ray;
use crate::geometry::sight::{Line, Sight};
use glam::{DMat3, DVec3};
use tabray_exact::double_double::{DoubleDouble, offset, scaled};
use tabray_exact::scalar::{Scalar, constants, dot, per_axis};

pub use tabray_exact::roots::stretch::BLUR;

/// Returns a bound of the rounding error of each coordinate of a point in a frame, at this distance along a ray, in
/// world units. It includes [`BLUR`] and the error of a camera ray's direction, which is less than EPSILON.
#[inline(always)]
pub fn blur(at: DVec3, distance: f64) -> f64 {
    BLUR * at.abs().element_sum() + 2.0 * f64::EPSILON * distance.abs()
}

/// A coordinate system: an origin and three perpendicular unit vectors.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// The origin of the shape's own coordinates, in world coordinates.
    pub origin: DVec3,
    /// The directions of the shape's own x, y and z axes in world space, as columns.
    pub axes: DMat3,
    /// The scene's vector along the y axis, times a power of two, or `None` if the axes are the world's.
    axis: Option<DVec3>,
}

impl Frame {
    /// Returns a frame with the world's axes at another origin.
    pub fn at(origin: DVec3) -> Self {
        Self { origin, axes: DMat3::IDENTITY, axis: None }
    }

    /// Returns a frame with its y axis along a nonzero vector, for surfaces of revolution. Its rotation around that
    /// axis is arbitrary.
    pub fn around(origin: DVec3, axis: DVec3) -> Self {
        let axis = scaled(axis);
        let axes = orthonormal_basis(axis.normalize().to_array(), sign(axis)).map(DVec3::from);
        Self { origin, axes: DMat3::from_cols(axes[0], axes[1], axes[2]), axis: Some(axis) }
    }

    /// Returns the facet at a height on the y axis of a shape that ends there, upward or downward.
    pub fn facet(&self, height: f64, is_upward: bool) -> Facet {
        Facet::above(self.origin, self.axis.unwrap_or(DVec3::Y), height, is_upward)
    }

    /// Transforms a direction from world space to the shape's own coordinates.
    #[inline(always)]
    pub fn direction(&self, dir: DVec3) -> DVec3 {
        DVec3::new(self.axes.x_axis.dot(dir), self.axes.y_axis.dot(dir), self.axes.z_axis.dot(dir))
    }

    /// Transforms a point from world space to the shape's own coordinates.
    #[inline(always)]
    pub fn point(&self, at: DVec3) -> DVec3 {
        self.direction(at - self.origin)
    }

    /// Transforms a ray from world space to the shape's own coordinates.
    #[inline(always)]
    pub fn ray(&self, ray: &Ray) -> Ray {
        Ray { origin: self.point(ray.origin), dir: self.direction(ray.dir) }
    }

    /// Transforms a line from world space to the shape's own coordinates, using the numbers of the scene that define
    /// the frame.
    pub fn line<N: Scalar>(&self, line: Line<N>) -> Line<N> {
        let origin = per_axis(|axis| line.origin[axis] - N::constant(self.origin[axis]));
        let Some(axis) = self.axis else { return Line { origin, dir: line.dir } };
        let given = constants::<N>(axis);
        let length = dot(given, given).sqrt();
        let axes = orthonormal_basis(per_axis(|part| given[part] / length), sign(axis));
        Line {
            origin: per_axis(|axis| dot(axes[axis], origin)),
            dir: per_axis(|axis| dot(axes[axis], line.dir)),
        }
    }

    /// Returns the vector in world space from the frame's origin to the point at a distance along a ray. It is rounded
    /// about once, regardless of the distance of the ray's origin.
    #[inline(always)]
    pub fn from_origin(&self, ray: &Ray, distance: f64) -> DVec3 {
        let along = |axis: usize| offset(ray.origin[axis], distance, ray.dir[axis], self.origin[axis]);
        DVec3::new(along(0), along(1), along(2))
    }

    /// Returns a ray in the shape's own coordinates in double-double arithmetic, starting at the point at a distance
    /// along the ray.
    pub fn exactly(&self, ray: &Ray, distance: f64) -> Line<DoubleDouble> {
        let Line { origin, dir } = Sight::along(ray).line::<DoubleDouble>();
        let start = Line { origin, dir }.at(DoubleDouble::from(distance));
        self.line(Line { origin: start, dir })
    }

    /// Returns the bounding box in world space of a box in the shape's own coordinates.
    pub fn bounds(&self, own: &Aabb) -> Aabb {
        let DMat3 { x_axis, y_axis, z_axis } = self.axes;
        let middle = self.origin + self.axes * own.middle();
        let reach = DMat3::from_cols(x_axis.abs(), y_axis.abs(), z_axis.abs()) * own.half_size();
        Aabb { low: middle - reach, high: middle + reach }
    }
}

/// Returns 1 or -1 with the sign of the vector's z, to avoid cancellation in their sum.
fn sign(axis: DVec3) -> f64 {
    axis.z.signum()
}

/// Returns three perpendicular unit vectors. The second one is `up` (Duff et al., "Building an Orthonormal Basis,
/// Revisited", 2017).
fn orthonormal_basis<N: Scalar>(up: [N; 3], sign: f64) -> [[N; 3]; 3] {
    let ([x, y, z], sign) = (up, N::constant(sign));
    let a = N::constant(-1.0) / (sign + z);
    let b = x * y * a;
    [[b, sign + y * y * a, -y], up, [N::constant(1.0) + sign * x * x * a, sign * b, -sign * x]]
}
