//! Lights: the trait that a plugin implements.

use crate::world::material::Rgb;
use glam::DVec3;

/// A source of light.
pub trait Light: Send + Sync {
    /// Where it is, in world coordinates.
    fn location(&self) -> DVec3;

    /// The light that it sends toward a point, or nothing where it does not point there (the notes' `vischeck`).
    fn emissivity(&self, toward: DVec3) -> Option<Rgb>;

    /// What [`emissivity`](Self::emissivity) gives toward every point, if that is the same and never nothing: then it is
    /// not asked for each. `None` is never wrong.
    fn uniform(&self) -> Option<Rgb> {
        None
    }

    /// The largest that [`emissivity`](Self::emissivity) gives toward any point, whatever the sign; nothing where that is
    /// not known. `None` is never wrong.
    fn brightest(&self) -> Option<Rgb> {
        self.uniform()
    }

    /// The radius of a ball that shines; 0 for a point, whose shadows have sharp edges.
    fn size(&self) -> f64 {
        0.0
    }
}
