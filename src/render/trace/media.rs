//! The absorption of light in media.
//!
//! The medium of a path belongs to the object that its ray leaves on the inside, or otherwise to the object that it
//! hits on the inside. So a viewer may be in glass, and objects may be in it. Between two other objects in glass,
//! light passes freely.

use super::arrays::VectorList;
use super::context::Tracer;
use super::ray_group::RayGroup;
use super::surface::Surface;
use tabray_world::geometry::ray::Side;
use tabray_world::interface::Medium;
use tabray_world::material::Rgb;

impl Tracer<'_, '_> {
    /// Computes the fractions of light that pass from the points of a surface to the starts of a packet's rays.
    #[inline]
    pub(super) fn pass_media(&self, group: &RayGroup, distances: &[f64], surface: &mut Surface) {
        surface.passed.clear();
        if self.plan.has_media {
            let Surface { index, sides, passed, .. } = surface;
            let pass = |lane: usize| self.passed(group, lane, distances[lane], Some((*index, sides[lane])));
            passed.extend((0..distances.len()).map(|lane| pass(lane).unwrap_or(Rgb::ONE)));
        }
    }

    /// Absorbs the light of rays that hit nothing, where they leave an object on the inside.
    #[inline]
    pub(super) fn absorb_endlessly(&self, group: &RayGroup, lanes: &[u8], colours: &mut VectorList) {
        for lane in lanes.iter().map(|lane| usize::from(*lane)) {
            if let Some(passed) = self.passed(group, lane, f64::INFINITY, None) {
                colours.set(lane, colours.get(lane) * passed);
            }
        }
    }

    /// Returns the fraction of light that passes along a ray of this length, in world units; `None` if all light
    /// passes. `met` is the index of the object that the ray hits, if any, and the side.
    #[inline]
    pub(super) fn passed(
        &self,
        group: &RayGroup,
        lane: usize,
        length: f64,
        met: Option<(usize, Side)>,
    ) -> Option<Rgb> {
        if !self.plan.has_media {
            return None;
        }
        let left = group.origin_object.map(|object| (object, group.sides[lane]));
        let inside = |of: Option<(usize, Side)>| -> Option<Medium> {
            let (object, _) = of.filter(|(_, side)| *side == Side::Inside)?;
            self.model.objects[object].material.medium()
        };
        inside(left).or_else(|| inside(met)).map(|medium| medium.passed(length).into())
    }
}
