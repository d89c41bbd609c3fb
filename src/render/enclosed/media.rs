//! The absorption of light in media, as in the tracer. The medium of a path belongs to the object that the lines
//! leave on its inside, or otherwise to the object that they hit on its inside.

use super::number::Enclosing;
use super::scene::{Colour, EnclosedScene, Path};
use tabray_exact::scalar::constants;
use tabray_world::interface::Medium;

/// Returns the medium that absorbs light between the start of lines and their hit. `met` is the object hit, if any,
/// and whether it is hit on its inside.
pub(super) fn between<N: Enclosing>(
    scene: &EnclosedScene,
    path: &Path<N>,
    met: Option<(usize, bool)>,
) -> Option<Medium> {
    let inside = |object: usize, is_inside: bool| {
        if is_inside { scene.model.objects[object].material.medium() } else { None }
    };
    let left = path.leaves.and_then(|place| inside(place.object, path.is_inside));
    left.or_else(|| met.and_then(|(object, is_inside)| inside(object, is_inside)))
}

/// Encloses the fractions of light that pass through a medium over a length in world units; `None` is endless.
pub(super) fn passed<N: Enclosing>(medium: &Medium, length: Option<N>) -> Colour<N> {
    length.map_or_else(|| constants(medium.passed(f64::INFINITY).into()), |length| medium.passed(length))
}
