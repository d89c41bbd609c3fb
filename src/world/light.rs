//! Lights: the trait that a plugin implements.

use crate::any_shape::AnyShape;
use crate::certify::Precise;
use crate::emitter::Emitter;
use crate::geometry::aabb::Aabb;
use crate::material::Rgb;
use glam::DVec3;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::constants;

/// A source of light: a point, a ball with a [`size`](Self::size), or what an [`emitter`](Self::emitter) describes.
pub trait Light: Send + Sync {
    /// Returns the light's position, in world coordinates: its point, or its middle.
    fn location(&self) -> DVec3;

    /// Returns the light sent toward a point, or `None` where the light does not point there (the notes' `vischeck`).
    fn emissivity(&self, toward: DVec3) -> Option<Rgb>;

    /// Returns the light sent toward every point, if [`emissivity`](Self::emissivity) is `Some` and the same
    /// everywhere. Then `emissivity` is not called for each point. `None` is always correct.
    fn uniform(&self) -> Option<Rgb> {
        None
    }

    /// Encloses the light sent toward every point of a box, before any rounding, 0 where the light does not point
    /// there; `None` where it is not known. Proofs of colours ask for it. `None` is always correct.
    fn enclose<F: Precise>(&self, _toward: [Interval<F>; 3]) -> Option<[Interval<F>; 3]>
    where
        Self: Sized,
    {
        self.uniform().map(constants)
    }

    /// Returns the largest magnitude of each channel of [`emissivity`](Self::emissivity) over all points, with either
    /// sign, or `None` where it is not known. `None` is always correct.
    fn brightest(&self) -> Option<Rgb> {
        self.uniform()
    }

    /// Tells whether the light shines on no point of a region, which may be unbounded: [`emissivity`](Self::emissivity)
    /// is `None` there. A scene in which only such regions are seen leaves the light out. `false` is always correct.
    fn is_clear_of(&self, _region: &Aabb) -> bool {
        false
    }

    /// Returns the radius of a spherical light in world units; 0 for a point light, whose shadows have sharp edges. For
    /// a light of another shape, this is the radius of a ball around its [`location`](Self::location) that contains the
    /// whole light.
    fn size(&self) -> f64 {
        0.0
    }

    /// Returns how the light is spread out, if it is neither a point nor a ball. Its samples then determine the light
    /// that it adds, and [`emissivity`](Self::emissivity) is its radiance. [`brightest`](Self::brightest) bounds
    /// `light` of each sample times the cosine of the angle at which it arrives, or, if the light has highlights,
    /// without the cosine.
    fn emitter(&self) -> Option<&dyn Emitter> {
        None
    }

    /// Tells whether the light comes from infinitely far away. Its [`location`](Self::location) then means nothing.
    fn is_far(&self) -> bool {
        false
    }

    /// Returns the visible shape of the light, as bright as its emissivity; `None` for a light that is not visible
    /// itself.
    fn shape(&self) -> Option<AnyShape> {
        None
    }
}
