//! Shadow rays in a scene without glass: from which points of a surface a light is occluded.

use super::arrays::{VectorList, gather, resized};
use super::context::{ShadowScratch, Tracer};
use super::occlusion::ShadowRays;
use super::ray_group::RayGroup;
use super::surface::Surface;
use crate::geometry::aabb::Aabb;
use crate::geometry::ray_packet::RayPacket;
use crate::render::observer::{Count, RayKind, TraceObserver};
use crate::simd::cpu::kernels;
use crate::simd::soa::LANES;

/// The paths from the points of a surface to a light.
pub(super) struct LightPaths<'w> {
    /// A bounding box of the points.
    pub from: Aabb,
    /// A bounding box of the light's points.
    pub to: Aabb,
    /// The unit vectors toward the light.
    pub toward: &'w VectorList,
}

/// The mark in `blocked` of a shadow ray that is not cast, which is not blocked.
const NOT_CAST: u64 = 2;

impl<W: TraceObserver> Tracer<'_, '_, W> {
    /// Returns how far short of the light shadow rays end, as a fraction of the sizes at [`ShadingPoints::slack`]: a
    /// surface on which the light lies must not block it, however the distances are rounded.
    ///
    /// The fraction is that of the error of a hit point, [`ROUNDING`]; the test
    /// `a_light_on_a_wall_lights_the_floor_evenly` holds it.
    ///
    /// [`ShadingPoints::slack`]: crate::world::light_samples::ShadingPoints::slack
    /// [`ROUNDING`]: crate::world::coincidence::ROUNDING
    pub(super) fn slack(&self) -> f64 {
        if self.is_classic() { 0.0 } else { 16.0 * f64::EPSILON }
    }

    /// Marks with 1 in `blocked` the points from which an object blocks the light, in a scene without glass.
    pub(super) fn shadow(
        &mut self,
        group: &mut RayGroup,
        surface: &Surface,
        paths: &LightPaths,
        t_max: &mut [f64],
        shadows: &mut ShadowScratch,
        blocked: &mut [u64],
    ) {
        let (cpu, count) = (self.cpu, group.padded());
        let ShadowScratch { lanes, origin, dir, their_t_max, their_blocked, sides } = shadows;
        let origin_error = surface.errors.most;
        // A ray whose budget is used up counts as not blocked.
        let len = charge_shadow_rays(cpu, group.len, &mut group.ray_budget[..count], t_max, blocked);
        if len == 0 {
            return;
        }
        self.observer.count(Count::Rays(RayKind::Shadow, len));
        let rays = RayPacket::new(surface.points.view(count), paths.toward.view(count), origin_error);
        let cast = (0..group.len).filter(|lane| t_max[*lane] > 0.0);
        self.charge_searches(rays, Some((surface.index, &surface.sides)), cast, &mut group.ray_budget);
        if 2 * len > group.len {
            let sides = &surface.sides[..count];
            let shadow_rays =
                ShadowRays { rays, len: group.len, going: len, t_max, surface, lanes: None, sides };
            self.occlude(&shadow_rays, &paths.from, &paths.to, blocked);
            return;
        }
        lanes.clear();
        lanes.extend((0..group.len).filter(|lane| t_max[*lane] > 0.0).map(|lane| lane as u8));
        let count = len.next_multiple_of(LANES);
        origin.gather(&surface.points, lanes, count);
        dir.gather(paths.toward, lanes, count);
        gather(their_t_max, t_max, lanes, count);
        gather(sides, &surface.sides, lanes, count);
        let their_blocked = resized(their_blocked, count);
        their_blocked.fill(0);
        let rays = RayPacket::new(origin.view(count), dir.view(count), origin_error);
        let (t_max, sides) = (&their_t_max[..count], &sides[..count]);
        let shadow_rays = ShadowRays { rays, len, going: len, t_max, surface, lanes: Some(lanes), sides };
        self.occlude(&shadow_rays, &paths.from, &paths.to, their_blocked);
        for (lane, is_blocked) in lanes.iter().zip(their_blocked) {
            blocked[usize::from(*lane)] = *is_blocked;
        }
    }
}

kernels! {
    /// Charges each shadow ray to its ray budget. Shadow rays with a `t_max` of 0 or whose budget is used up are marked
    /// with [`NOT_CAST`]. Returns how many of the first `len` are cast.
    fn charge_shadow_rays(len: usize, ray_budget: &mut [u32], t_max: &mut [f64], blocked: &mut [u64]) -> usize {
        let count = t_max.len();
        let (ray_budget, blocked) = (&mut ray_budget[..count], &mut blocked[..count]);
        // Loops over numbers of one size each have vector instructions.
        let mut any_used_up = false;
        for lane in 0..count {
            any_used_up |= ray_budget[lane] == 0;
        }
        if any_used_up {
            for lane in 0..count {
                t_max[lane] = if ray_budget[lane] == 0 { 0.0 } else { t_max[lane] };
            }
        }
        for lane in 0..count {
            let goes = t_max[lane] > 0.0;
            t_max[lane] = if goes { t_max[lane] } else { 0.0 };
            blocked[lane] = if goes { 0 } else { NOT_CAST };
        }
        for lane in 0..count {
            ray_budget[lane] -= u32::from(t_max[lane] > 0.0);
        }
        let mut left = 0;
        for t_max in &t_max[..len] {
            left += u64::from(*t_max > 0.0);
        }
        left as usize
    }
}
