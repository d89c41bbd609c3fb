//! A parametric surface and the boxes around its parts.

use super::locate::Located;
use super::patch::{Patches, Rectangle};
use super::tree::Tree;
use crate::geometry::aabb::Aabb;

/// A parametric surface.
pub(super) struct ParametricShape {
    pub patches: Box<dyn Patches>,
    pub tree: Tree,
    pub bounds: Aabb,
}

impl ParametricShape {
    /// Returns the greatest magnitude of a coordinate, in world units.
    pub fn size(&self) -> f64 {
        self.bounds.low.abs().max(self.bounds.high.abs()).max_element()
    }

    /// Returns what finds u and v of a point.
    pub fn located(&self) -> Located<'_> {
        Located { patches: &*self.patches, tree: &self.tree }
    }

    /// Returns the rectangle of u and v.
    pub fn ends(&self) -> &Rectangle<f64> {
        self.tree.ends()
    }
}
