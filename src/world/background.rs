//! Backgrounds: the trait that a plugin implements for the colour of rays that hit no object.

use crate::material::Rgb;
use glam::DVec3;
use tabray_exact::interval::Interval;

/// Any [`Background`].
pub type AnyBackground = Box<dyn Background>;

/// The colour of rays that hit nothing: primary, reflected and transmitted ones.
///
/// Its light comes from infinitely far away, so it is not divided by the distance. With `lights yes` in a scene, it
/// lights surfaces as well.
pub trait Background: Send + Sync {
    /// Returns the colour in a direction, given by a unit vector. Every channel is finite and 0 or more.
    fn colour(&self, toward: DVec3) -> Rgb;

    /// Returns an upper bound of all colours, per channel. The bound decides how deep rays are followed into mirrors
    /// and glass.
    fn brightest(&self) -> Rgb;

    /// Returns the numbers of columns and rows of an equirectangular map in whose cells the colours vary little;
    /// `None` if the colours vary slowly everywhere. The map decides in which directions light is sampled, and
    /// changes no mean.
    fn detail(&self) -> Option<[u32; 2]> {
        None
    }

    /// Encloses the true colours, before any rounding, in all directions of a box, per channel. Proofs of colours ask
    /// for them. The default is always correct.
    fn enclose(&self, _toward: [Interval; 3]) -> [Interval; 3] {
        self.brightest().to_array().map(|high| Interval { low: 0.0, high })
    }
}
