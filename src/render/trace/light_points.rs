//! The points of lights that surfaces see, chosen by the samples of primary rays.

use super::context::Tracer;
use super::draws::{DrawnLight, LightDraws, Numbers};
use super::ray_group::RayGroup;
use super::surface::Surface;
use glam::{DVec2, DVec3};
use tabray_world::packets::light::PacketLight;
use tabray_world::simd::cpu::kernels;
use tabray_world::simd::soa::View;

impl Tracer<'_, '_> {
    /// Returns two numbers from 0 to 1 for each ray of a packet, by which the primary ray's sample chooses a point of
    /// an area of light; `None` where pixels have one sample.
    pub(super) fn draw<'d>(
        &self,
        index: usize,
        group: &RayGroup,
        draws: &'d mut LightDraws,
    ) -> Option<impl Fn(usize) -> DVec2 + use<'d>> {
        let are_probes = self.scratch.are_probes;
        let [x, y, _] = self.drawn(DrawnLight { index, is_ball: false }, group, draws)?;
        Some(move |lane: usize| {
            let numbers = DVec2::new(x[lane], y[lane]);
            if are_probes { on_edge(numbers.y) } else { numbers }
        })
    }

    /// Returns the point of a ball of light that each point of a surface sees. The primary ray's sample chooses it on
    /// the disc around the ball's centre that faces the surface point. `None` where pixels have one sample, which
    /// sees the centre.
    pub(super) fn draw_on_ball<'d>(
        &self,
        light: &dyn PacketLight,
        index: usize,
        group: &RayGroup,
        surface: &Surface,
        draws: &'d mut LightDraws,
    ) -> Option<View<'d>> {
        let count = group.padded();
        self.drawn(DrawnLight { index, is_ball: true }, group, draws)?;
        let LightDraws { numbers: [distance, cos, sin], lights, .. } = draws;
        let points = surface.points.view(count);
        on_ball(self.cpu, light.location(), light.size(), points, distance, cos, sin, lights.resized(count));
        Some(lights.view(count))
    }

    /// Returns the numbers of the rays of a packet, if pixels have several samples.
    fn drawn<'d>(
        &self,
        light: DrawnLight,
        group: &RayGroup,
        draws: &'d mut LightDraws,
    ) -> Option<Numbers<'d>> {
        let samples = (&self.scratch.samples, self.scratch.are_probes);
        let lanes = &group.camera[..group.camera.len().min(group.padded())];
        (!samples.0.is_empty()).then(|| draws.of(self.cpu, samples, light, lanes))
    }
}

kernels! {
    /// Writes a point of a ball of light for each point of a surface. It lies on the disc around the middle that
    /// faces the surface point, at a distance from the middle, in radii, and an angle.
    fn on_ball(
        middle: DVec3, radius: f64, points: View, distance: &[f64], cos: &[f64], sin: &[f64]
    ) => lights {
        let (count, mut lights) = (points.len(), lights.first(points.len()));
        let (distance, cos, sin) = (&distance[..count], &cos[..count], &sin[..count]);
        for lane in 0..count {
            let between = middle - points.get(lane);
            let inverse = between.length_recip();
            let (across, up) = (between * inverse).any_orthonormal_pair();
            let at = middle + radius * distance[lane] * (cos[lane] * across + sin[lane] * up);
            // A point in the middle of the light sees the middle.
            let is_apart = (inverse > 0.0) & (inverse < f64::INFINITY);
            lights.set(lane, if is_apart { at } else { middle });
        }
    }
}

/// Returns a point on the edge of the unit square, by a part of a turn around it.
fn on_edge(turn: f64) -> DVec2 {
    let side = 4.0 * turn.rem_euclid(1.0);
    let along = side.fract();
    match side as u32 {
        0 => DVec2::new(along, 0.0),
        1 => DVec2::new(1.0, along),
        2 => DVec2::new(1.0 - along, 1.0),
        _ => DVec2::new(0.0, 1.0 - along),
    }
}
