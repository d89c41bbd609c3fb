//! How much of a light comes to the places of a surface.

use super::arrays::{VectorList, gather, resized};
use super::context::Tracer;
use super::occlusion::ShadowRays;
use super::ray_group::RayGroup;
use super::scratch::ShadowScratch;
use super::surface::Surface;
use crate::geometry::aabb::Aabb;
use crate::geometry::ray_packet::RayPacket;
use crate::render::observer::{Count, RayKind, TraceObserver};
use crate::simd::cpu::kernels;
use crate::simd::soa::LANES;

/// The ways from the places of a surface to a light.
pub(super) struct LightPaths<'w> {
    /// Where those places are.
    pub from: Aabb,
    /// Where they go.
    pub to: Aabb,
    /// The directions there.
    pub toward: &'w VectorList,
}

/// Of a way that need not be gone, which nothing blocks.
const NOT_GONE: u64 = 2;

impl<W: TraceObserver> Tracer<'_, '_, W> {
    /// What the ends of the ways are short of the light, as a part of how far that is: a surface that the light lies
    /// on is no blocker, however rounding has it.
    pub(super) fn slack(&self) -> f64 {
        if self.is_classic() { 0.0 } else { 16.0 * f64::EPSILON }
    }

    /// Marks the places (1 in `blocked`) from which an object stands in the way of the light, in a scene without glass.
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
        // A ray that has cost as many as it may finds nothing in the way.
        let len = set_out(cpu, group.len, &mut group.ray_budget[..count], t_max, blocked);
        if len == 0 {
            return;
        }
        self.observer.count(Count::Rays(RayKind::Shadow, len));
        if 2 * len > group.len {
            let rays =
                RayPacket { origin: surface.points.view(count), dir: paths.toward.view(count), origin_error };
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
        let theirs = resized(their_blocked, count);
        theirs.fill(0);
        let rays = RayPacket { origin: origin.view(count), dir: dir.view(count), origin_error };
        let (t_max, sides) = (&their_t_max[..count], &sides[..count]);
        let shadow_rays = ShadowRays { rays, len, going: len, t_max, surface, lanes: Some(lanes), sides };
        self.occlude(&shadow_rays, &paths.from, &paths.to, theirs);
        for (lane, is_blocked) in lanes.iter().zip(theirs) {
            blocked[usize::from(*lane)] = *is_blocked;
        }
    }
}

kernels! {
    /// Counts a ray for each way to a light. Those of rays that have cost as many as they may need not be gone. What need
    /// not is marked with [`NOT_GONE`]; tells how many of the first `len` are left.
    fn set_out(len: usize, ray_budget: &mut [u32], t_max: &mut [f64], blocked: &mut [u64]) -> usize {
        let (count, mut left) = (t_max.len(), 0);
        let (ray_budget, blocked) = (&mut ray_budget[..count], &mut blocked[..count]);
        for lane in 0..count {
            let goes = (t_max[lane] > 0.0) & (ray_budget[lane] > 0);
            t_max[lane] = if goes { t_max[lane] } else { 0.0 };
            blocked[lane] = if goes { 0 } else { NOT_GONE };
            ray_budget[lane] -= u32::from(goes);
            left += u64::from(goes & (lane < len));
        }
        left as usize
    }
}
