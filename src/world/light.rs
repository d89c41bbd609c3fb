//! Lights: the trait that a plugin implements.

use crate::any_shape::AnyShape;
use crate::emitter::EnclosedEmitter;
use crate::geometry::aabb::Aabb;
use crate::material::Rgb;
use crate::number::Number;
use glam::DVec3;

/// A source of light: a point, a ball with a [`size`](Self::size), or what an [`emitter`](Self::emitter) describes.
pub trait Light: Send + Sync {
    /// Returns the light's position, in world coordinates: its point, or its middle.
    fn location(&self) -> DVec3;

    /// Returns the light sent toward a point, 0 where the light does not point there (the notes' `vischeck`). Pictures
    /// ask in plain numbers, and proofs of colours in numbers that enclose all points of a box.
    fn sent<N: Number>(&self, toward: [N; 3]) -> [N; 3]
    where
        Self: Sized;

    /// Returns the light sent toward every point, if it is the same everywhere. Then [`sent`](Self::sent) is not called
    /// for each point. `None` is always correct.
    fn uniform(&self) -> Option<Rgb> {
        None
    }

    /// Returns the largest magnitude of each channel of what is [`sent`](Self::sent) toward all points, with either sign,
    /// or `None` where it is not known. `None` is always correct.
    fn brightest(&self) -> Option<Rgb> {
        self.uniform()
    }

    /// Tells whether the light shines on no point of a region, which may be unbounded: [`sent`](Self::sent) is
    /// 0 there. A scene in which only such regions are seen leaves the light out. `false` is always correct.
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
    /// that it adds, and what is [`sent`](Self::sent) is its radiance. [`brightest`](Self::brightest) bounds `light` of
    /// each sample times the cosine of the angle at which it arrives, or, if the light has highlights, without the
    /// cosine.
    fn emitter(&self) -> Option<&dyn EnclosedEmitter> {
        None
    }

    /// Tells whether the light comes from infinitely far away. Its [`location`](Self::location) then means nothing.
    fn is_far(&self) -> bool {
        false
    }

    /// Returns the visible shape of the light, as bright as what is sent; `None` for a light that is not visible
    /// itself.
    fn shape(&self) -> Option<AnyShape> {
        None
    }
}
