//! Backgrounds: the trait that a plugin implements for what is seen where there is no object.

use crate::numeric::interval::Interval;
use crate::world::material::Rgb;
use glam::DVec3;

/// Any [`Background`].
pub type AnyBackground = Box<dyn Background>;

/// The light that rays return which hit nothing: primary, reflected and transmitted ones.
///
/// It comes from infinitely far away, so it is not divided by the distance. It is seen, but lights no surface.
pub trait Background: Send + Sync {
    /// Returns the colour in a direction, given by a unit vector. Every channel is finite and 0 or more.
    fn colour(&self, toward: DVec3) -> Rgb;

    /// Returns an upper bound of all colours, per channel. It decides how deep rays are followed into mirrors and glass.
    fn brightest(&self) -> Rgb;

    /// Encloses the colours, as mathematics has them, in all directions of a box, per channel. Proofs of colours ask for
    /// them. The default is always correct.
    fn enclose(&self, _toward: [Interval; 3]) -> [Interval; 3] {
        self.brightest().to_array().map(|high| Interval { low: 0.0, high })
    }
}
