//! Highlights of lamps in glass: what its outside mirrors of them, whatever it transmits.

use super::arrays::VectorList;
use super::context::Tracer;
use super::light;
use super::ray_group::RayGroup;
use super::surface::Surface;
use crate::geometry::ray::Side;
use crate::render::observer::TraceObserver;
use crate::world::material::{Look, Rgb};
use crate::world::rules::Rules;

impl<W: TraceObserver> Tracer<'_, '_, W> {
    /// Computes the highlights at the points of a surface that glints, as rays return them.
    pub(super) fn glint(&mut self, group: &mut RayGroup, surface: &mut Surface, glints: &mut VectorList) {
        let count = group.padded();
        glints.fill(count, Rgb::ZERO);
        let mirror = Look { ambient: Rgb::ZERO, diffuse: Rgb::ZERO, specular: Rgb::ONE };
        let own = (surface.look.replace(mirror), surface.is_mirror);
        surface.is_mirror = true;
        self.illuminate(group, surface, glints);
        (surface.look, surface.is_mirror) = own;
        if self.plan.camera.rules == Rules::Notes {
            light::fade(self.cpu, &surface.travelled[..count], glints.resized(count));
        }
        for lane in (0..count).filter(|lane| surface.sides[*lane] == Side::Inside) {
            glints.set(lane, Rgb::ZERO);
        }
    }
}
