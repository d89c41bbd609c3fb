//! Which objects say that they are not in a ray's way, where that is heeded: the notes' program tests every ray against each
//! of its shapes, and loses none of them.

use crate::geometry::aabb::Aabb;
use crate::scene::model::Object;

/// The box around an object.
pub(super) fn bounds(object: &Object) -> Option<Aabb> {
    object.shape.bounds().filter(|_| !object.shape.packets().is_of_the_notes())
}

/// Whether an object is not in a region.
pub(super) fn is_clear_of(object: &Object, region: &Aabb) -> bool {
    object.shape.is_clear_of(region) && !object.shape.packets().is_of_the_notes()
}
