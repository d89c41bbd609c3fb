//! The light of what is spread out, as the points of a surface see it.

use super::context::LightDraws;
use super::context::Tracer;
use super::ray_group::RayGroup;
use crate::geometry::aabb::Aabb;
use crate::render::observer::TraceObserver;
use crate::world::emitter::{Emitter, LightSample};
use crate::world::light_samples::{AnyLit, LightSamples, ShadingPoints};
use crate::world::material::Rgb;
use glam::{DVec2, DVec3};

impl<W: TraceObserver> Tracer<'_, '_, W> {
    /// Samples the point of a light that each point of a surface sees: where the primary ray's sample chooses, or by the
    /// middle of the numbers where pixels have one sample. Sets `source` to a box around the ends of the shadow rays.
    pub(super) fn sample_emitter(
        &self,
        (emitter, index): (&dyn Emitter, usize),
        group: &RayGroup,
        shading: &ShadingPoints,
        draws: &mut LightDraws,
        mut samples: LightSamples,
        source: &mut Aabb,
    ) -> AnyLit {
        let drawn = (!self.scratch.samples.is_empty()).then(|| self.draw(index, group, draws));
        let numbers = |lane: usize| match &drawn {
            None => DVec2::splat(0.5),
            Some([x, y]) => {
                let lane = lane.min(x.len() - 1);
                if self.scratch.are_probes { on_edge(y[lane]) } else { DVec2::new(x[lane], y[lane]) }
            }
        };
        let mut any_shines = false;
        *source = Aabb::EMPTY;
        for lane in 0..shading.points.len() {
            let (at, normal) = (shading.points.get(lane), shading.normals.get(lane));
            let chosen = emitter.sample(at, normal, numbers(lane));
            let chosen = chosen.filter(|sample| sample.toward.dot(normal) > 0.0);
            let none = LightSample { toward: normal, distance: 0.0, light: Rgb::ZERO };
            let LightSample { toward, distance, light } = chosen.unwrap_or(none);
            samples.toward.set(lane, toward);
            samples.emissivity.set(lane, light);
            samples.strengths[lane] = toward.dot(normal);
            samples.shines[lane] = u64::from(chosen.is_some());
            samples.t_max[lane] = match distance.is_finite() {
                true => (distance - shading.slack * (distance + at.abs().max_element())).max(0.0),
                false => f64::INFINITY,
            };
            if chosen.is_some() {
                any_shines = true;
                let end = end(at, toward, distance);
                *source = source.and(&Aabb { low: end, high: end });
            }
        }
        AnyLit { any_faces: any_shines, any_shines }
    }
}

/// Returns the end of a ray, which may be infinitely far away.
fn end(from: DVec3, dir: DVec3, distance: f64) -> DVec3 {
    // 0 times infinity is no number.
    let along = |axis: usize| if dir[axis] == 0.0 { 0.0 } else { distance * dir[axis] };
    from + DVec3::new(along(0), along(1), along(2))
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
