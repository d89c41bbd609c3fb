//! The interface between a plugin and its parametric surface, and parts of the surface.

use glam::DVec3;
use tabray_exact::gradient::Gradient;
use tabray_exact::interval::{Float, Fraction, Interval};
use tabray_exact::scalar::Scalar;

/// A surface given by two parameters.
pub trait Parametric: Send + Sync {
    /// Returns the point at u and v, in world coordinates.
    fn point<N: Scalar>(&self, uv: [N; 2]) -> [N; 3];

    /// Encloses the points of a rectangle of u and v, by the formulas as they were written, with which a hit is checked;
    /// `None` where one of them is certainly not defined. By default, these are what [`point`](Self::point) evaluates.
    fn as_written<F: Float>(&self, uv: [Interval<F>; 2]) -> Option<[Interval<F>; 3]> {
        Some(self.point(uv))
    }

    /// Returns the minimum and the maximum of u and of v.
    fn ends(&self) -> [[f64; 2]; 2];
}

/// A part of the rectangle of u and v.
pub(super) type Rectangle<F> = [Interval<F>; 2];

/// The points of a part of a surface, and their derivatives with respect to u and to v.
pub(super) struct Patch<F> {
    pub at: [Interval<F>; 3],
    pub along: [[Interval<F>; 3]; 2],
}

/// A surface in one precision.
pub(super) trait PatchesIn<F: Float> {
    /// Encloses a part of the surface.
    fn patch(&self, part: &Rectangle<F>) -> Patch<F>;

    /// Encloses the points of a part, without derivatives.
    fn points(&self, part: &Rectangle<F>) -> [Interval<F>; 3];

    /// Encloses them as [`Parametric::as_written`] does.
    fn as_written(&self, part: &Rectangle<F>) -> Option<[Interval<F>; 3]>;
}

impl<T: Parametric, F: Float> PatchesIn<F> for T {
    fn patch(&self, part: &Rectangle<F>) -> Patch<F> {
        let point = self.point(Gradient::point(*part));
        Patch {
            at: point.map(|axis| axis.value),
            along: [0, 1].map(|side| point.map(|axis| axis.slopes[side])),
        }
    }

    fn points(&self, part: &Rectangle<F>) -> [Interval<F>; 3] {
        self.point(*part)
    }

    fn as_written(&self, part: &Rectangle<F>) -> Option<[Interval<F>; 3]> {
        Parametric::as_written(self, *part)
    }
}

/// A surface in both precisions, and at single points.
pub(super) trait Patches: PatchesIn<f64> + PatchesIn<Fraction> + Send + Sync {
    /// Returns a point, and its derivatives with respect to u and to v.
    fn at(&self, uv: [f64; 2]) -> [DVec3; 3];
}

impl<T: Parametric> Patches for T {
    fn at(&self, [u, v]: [f64; 2]) -> [DVec3; 3] {
        let point = self.point(Gradient::<f64, 2>::point([u, v]));
        let along = |side: usize| DVec3::from(point.map(|axis| axis.slopes[side]));
        [DVec3::from(point.map(|axis| axis.value)), along(0), along(1)]
    }
}

/// Returns the unit normal at u and v: along the cross product of the directions in which u and v grow. At a pole,
/// which has no normal, returns the normal of a point beside it.
pub(super) fn normal(patches: &dyn Patches, [u, v]: [f64; 2]) -> DVec3 {
    let beside = [0.0, 1e-7, -1e-7].into_iter().map(|step| {
        let [_, along_u, along_v] = patches.at([u + step, v + step]);
        along_u.normalize_or_zero().cross(along_v.normalize_or_zero())
    });
    beside.filter(|normal| normal.length_squared() > 1e-20).map(DVec3::normalize).next().unwrap_or(DVec3::Y)
}
