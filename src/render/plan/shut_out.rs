//! Lights that a closed object hides from all visible points, because either the viewer or the light is inside of it.
//!
//! Each path from such a light to the viewer crosses the object, which is opaque. Shadow rays find that out one by
//! one, except those that start at an edge: they leave all faces there, and pass to the other side.

use super::depth::clearance;
use glam::DVec3;
use tabray_world::accuracy::Accuracy;
use tabray_world::geometry::aabb::Aabb;
use tabray_world::geometry::bvh::Bvh;
use tabray_world::scene::model::{Model, Object};

/// The least distance of the viewer and of a light from an object, as a fraction of their coordinates and of the
/// object's: far more than their rounding. A light nearer to the object counts as being on the surface.
const MARGIN: f64 = 1e-9;

/// The objects of a plan, for searches.
pub(super) struct Objects<'p> {
    pub unbounded: &'p [usize],
    pub bounded: &'p [(usize, Aabb)],
    pub tree: Option<&'p Bvh>,
}

impl Objects<'_> {
    /// Returns the indices of the objects that may contain a point.
    fn around(&self, at: DVec3) -> Vec<usize> {
        let is_around = |(_, bounds): &&(usize, Aabb)| bounds.overlaps(&Aabb { low: at, high: at });
        let bounded = self.bounded.iter().filter(is_around).map(|(index, _)| *index);
        let mut around: Vec<_> = self.unbounded.iter().copied().chain(bounded).collect();
        if let Some(tree) = self.tree {
            tree.around(at, 0.0, &mut |index| {
                around.push(index);
                0.0
            });
        }
        around
    }
}

/// The indices of a hidden light and of the object that hides it.
pub(crate) struct ShutOut {
    pub light: usize,
    pub object: usize,
}

/// Returns the lights that are hidden from all visible points.
pub(super) fn shut_out(model: &Model, objects: &Objects) -> Vec<ShutOut> {
    if model.lights.is_empty() || model.camera.value.accuracy == Accuracy::Classic {
        return Vec::new();
    }
    let viewer = model.camera.value.origins();
    let around_viewer = objects.around(viewer.middle);
    let separates = |index: &usize, at: DVec3, size: f64| {
        let object = &model.objects[*index];
        let is_inside = is_inside(object, viewer.middle, viewer.radius);
        // Whether a mesh is closed may take long to find out.
        object.is_opaque()
            && !is_behind_glass(model, *index)
            && is_inside.is_some_and(|is_inside| self::is_inside(object, at, size) == Some(!is_inside))
            && object.shape.why_not_closed().is_none()
    };
    let lights = model.lights.iter().enumerate().filter(|(_, item)| !item.value.is_far());
    let by = lights.filter_map(|(light, item)| {
        let (at, size) = (item.value.location(), item.value.size());
        let around = objects.around(at);
        let candidates = around_viewer.iter().chain(&around);
        let object = *candidates.filter(|index| separates(index, at, size)).min()?;
        Some(ShutOut { light, object })
    });
    by.collect()
}

/// Tells whether an earlier object of glass may coincide with a part of an object's surface. There the glass is hit,
/// and the object is not.
fn is_behind_glass(model: &Model, index: usize) -> bool {
    let object = &model.objects[index];
    let may_touch = |other: &Object| match (object.shape.bounds(), other.shape.bounds()) {
        (Some(bounds), Some(of_other)) => bounds.overlaps(&of_other),
        _ => true,
    };
    model.objects[..index].iter().any(|other| !other.is_opaque() && may_touch(other))
}

/// Tells whether a ball lies inside of a closed object, rather than outside; `None` where that is not certain.
fn is_inside(object: &Object, middle: DVec3, radius: f64) -> Option<bool> {
    let margin = MARGIN * (middle.abs().max_element() + object.shape.facts().max_coordinate);
    let is_clear = radius == 0.0 || clearance(object, middle) > radius + margin;
    if is_clear { object.shape.contains(middle, margin) } else { None }
}
