//! A parametric surface with the boxes of its parts.

use super::locate::Located;
use super::patch::{Patches, Rectangle};
use super::tree::Tree;
use glam::DVec3;
use tabray_world::geometry::aabb::Aabb;

/// A parametric surface.
pub(super) struct ParametricShape {
    pub patches: Box<dyn Patches>,
    pub tree: Tree,
    pub bounds: Aabb,
}

impl ParametricShape {
    /// Returns the maximum magnitude of a coordinate, in world units.
    pub fn size(&self) -> f64 {
        self.bounds.low.abs().max(self.bounds.high.abs()).max_element()
    }

    /// Returns the search for u and v of a point.
    pub fn located(&self) -> Located<'_> {
        Located { patches: &*self.patches, tree: &self.tree }
    }

    /// Tells whether a point lies on the surface, up to an error in world units.
    pub fn is_near(&self, at: DVec3, error: f64) -> bool {
        self.located().nearest(at, error).is_some_and(|place| place.off <= 2.0 * error)
    }

    /// Returns the rectangle of u and v.
    pub fn ends(&self) -> &Rectangle<f64> {
        self.tree.ends()
    }
}
