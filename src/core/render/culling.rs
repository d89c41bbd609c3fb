//! The objects that may be culled by their bounds. Shapes of the notes never are, since the notes' program tests every
//! ray against every shape.

use crate::geometry::aabb::Aabb;
use crate::scene::model::Object;

/// Returns the bounding box by which an object may be culled, if there is one.
pub(super) fn bounds(object: &Object) -> Option<Aabb> {
    object.shape.facts().bounds.filter(|_| !object.shape.packets().is_of_the_notes())
}

/// Tells whether an object may be culled because no part of it lies in a region.
pub(super) fn is_clear_of(object: &Object, region: &Aabb) -> bool {
    object.shape.is_clear_of(region) && !object.shape.packets().is_of_the_notes()
}
