//! Occlusion: which rays of a packet an object blocks, and from which points of a surface a light is occluded.

use super::arrays::{VectorList, gather, resized};
use super::context::{ShadowScratch, Tracer};
use super::exact::{RoundedRay, exact};
use super::ray_group::RayGroup;
use super::surface::Surface;
use crate::observer::{Count, RayKind};
use std::mem::take;
use std::ops::Range;
use tabray_world::geometry::aabb::Aabb;
use tabray_world::geometry::bvh::{self, Order, PacketVisitor, Stack};
use tabray_world::geometry::ray::{RayError, Side};
use tabray_world::geometry::ray_packet::{PACKET_SIZE, RayPacket};
use tabray_world::simd::cpu::kernels;
use tabray_world::simd::soa::LANES;

/// Shadow rays that leave the same object.
pub(super) struct ShadowRays<'r> {
    pub rays: RayPacket<'r>,
    /// The number of rays, without the copies that pad the arrays.
    pub len: usize,
    /// The number of those rays that are cast.
    pub going: usize,
    /// The distances at which the rays end, in world units; 0 for a ray that is not cast.
    pub t_max: &'r [f64],
    /// The surface from which the rays start.
    pub surface: &'r Surface,
    /// The lanes of the surface's points from which the rays start; `None` for all lanes.
    pub lanes: Option<&'r [u8]>,
    /// The sides of the surface that the rays leave.
    pub sides: &'r [Side],
}

impl ShadowRays<'_> {
    /// Returns how many rays of a sub-packet are cast.
    fn count(&self, part: &Range<usize>) -> usize {
        if part.len() == self.t_max.len() {
            return self.going;
        }
        let part = part.start..part.end.min(self.len);
        self.t_max[part].iter().filter(|t_max| **t_max > 0.0).count()
    }

    /// Returns the lane of the surface's point from which a ray starts.
    fn start(&self, lane: usize) -> usize {
        let lane = lane.min(self.len - 1);
        self.lanes.map_or(lane, |lanes| usize::from(lanes[lane]))
    }

    /// Tells whether a ray leaves an object, where rays of several objects are cast together.
    fn leaves(&self, lane: usize, object: usize) -> bool {
        self.surface.objects.get(self.start(lane)).is_some_and(|left| *left as usize == object)
    }
}

impl Tracer<'_, '_> {
    /// Marks the rays that an object blocks before their ends. The rays go from points in the box `from` to points in
    /// the box `to`.
    pub(super) fn occlude(&mut self, shadow_rays: &ShadowRays, from: &Aabb, to: &Aabb, blocked: &mut [u64]) {
        let mut stack = take(&mut self.scratch.stack);
        let (mut doubt, mut ends) = (take(&mut self.scratch.doubt), take(&mut self.scratch.ends));
        let part = 0..shadow_rays.t_max.len();
        let doubted = resized(&mut doubt, part.len());
        let region = from.and(to).with_slack(0.0);
        Occlusion { tracer: self, shadow_rays, part, region, blocked, doubt: doubted }
            .run(&mut stack, &mut ends);
        (self.scratch.stack, self.scratch.doubt, self.scratch.ends) = (stack, doubt, ends);
    }
}

/// The search for objects that block the rays of a packet.
struct Occlusion<'s, 'm, 'w> {
    tracer: &'s mut Tracer<'m, 'w>,
    shadow_rays: &'s ShadowRays<'s>,
    /// The lanes of the current sub-packet.
    part: Range<usize>,
    /// A box that contains the rays.
    region: Aabb,
    blocked: &'s mut [u64],
    doubt: &'s mut [u64],
}

impl Occlusion<'_, '_, '_> {
    /// Tests all objects. `ends` is scratch space.
    fn run(mut self, stack: &mut Stack, ends: &mut Vec<f64>) {
        let plan = self.tracer.plan;
        let unbounded = plan.unbounded.iter().map(|index| (index, None));
        for (index, bounds) in
            unbounded.chain(plan.bounded.iter().map(|(index, bounds)| (index, Some(bounds))))
        {
            if !self.tracer.may_meet(self.left(), *index) {
                continue;
            }
            let object = &self.tracer.model.objects[*index];
            if bounds.is_some_and(|bounds| !bounds.overlaps(&self.region))
                || object.shape.is_culled_in(&self.region)
            {
                self.tracer.observer.count(Count::Culled(*index, self.shadow_rays.going));
                continue;
            }
            self.test_part(*index);
            if self.blocked.iter().all(|blocked| *blocked != 0) {
                return;
            }
        }
        if let Some(tree) = &plan.tree {
            let t_max = self.shadow_rays.t_max;
            ends.clear();
            ends.extend_from_slice(t_max);
            self.end_blocked(0..t_max.len(), ends);
            bvh::visit(self.tracer.cpu, tree, stack, self.shadow_rays.rays, RayError::NONE, ends, &mut self);
        }
    }

    /// Ends the blocked rays of some lanes: the BVH is searched for them no more.
    fn end_blocked(&self, lanes: Range<usize>, ends: &mut [f64]) {
        for (end, blocked) in ends[lanes.clone()].iter_mut().zip(&self.blocked[lanes]) {
            *end = if *blocked == 0 { *end } else { 0.0 };
        }
    }

    /// Returns the index of the object that the rays leave, and the sides that they leave; `None` where they leave
    /// several.
    fn left(&self) -> Option<(usize, &[Side])> {
        let ShadowRays { surface, sides, .. } = self.shadow_rays;
        surface.objects.is_empty().then_some((surface.index, *sides))
    }

    /// Tests the current sub-packet against an object.
    fn test_part(&mut self, index: usize) {
        let ShadowRays { t_max, surface, sides, .. } = *self.shadow_rays;
        let part = self.part.clone();
        if surface.objects.is_empty() {
            let left = (index == surface.index).then(|| &sides[part.clone()]);
            let count = self.shadow_rays.count(&part);
            self.test_leaving(index, count, &t_max[part], left);
            return;
        }
        let own = part.clone().filter(|lane| self.shadow_rays.leaves(*lane, index)).count();
        if own == 0 {
            self.test_leaving(index, self.shadow_rays.count(&part), &t_max[part], None);
            return;
        }
        // First the rays that do not leave the object, then those that do.
        let mut ends = [0.0; PACKET_SIZE];
        for leaves in [false, true] {
            let shape = &self.tracer.model.objects[index].shape;
            let mut count = 0;
            for (lane, end) in part.clone().zip(&mut ends) {
                let is_its = self.shadow_rays.leaves(lane, index) == leaves;
                let is_tested = is_its && (!leaves || shape.can_hit_itself(sides[lane]));
                *end = if is_tested { t_max[lane] } else { 0.0 };
                count += usize::from(*end > 0.0 && lane < self.shadow_rays.len);
            }
            if count > 0 {
                let left = leaves.then(|| &sides[part.clone()]);
                self.test_leaving(index, count, &ends[..part.len()], left);
            }
        }
    }

    /// Tests the current sub-packet against an object. `count` of its rays are cast, and end at `t_max`. `left` has
    /// the sides of the object that they leave, if they leave it.
    fn test_leaving(&mut self, index: usize, count: usize, t_max: &[f64], left: Option<&[Side]>) {
        let rays = self.shadow_rays.rays.part(self.part.clone()).leaving(left);
        let shape = &self.tracer.model.objects[index].shape;
        self.tracer.observer.count(Count::Tested(index, count));
        let (blocked, doubt) = (&mut self.blocked[self.part.clone()], &mut self.doubt[self.part.clone()]);
        if shape.packets().occluded(self.tracer.cpu, rays, t_max, blocked, doubt) {
            for lane in 0..t_max.len() {
                if doubt[lane] != 0 {
                    let origin_side = rays.side(lane);
                    let start = RoundedRay { ray: rays.get(lane), error: rays.error(lane), sight: None };
                    let distance = exact(shape, &start, origin_side, t_max[lane]);
                    blocked[lane] |= u64::from(distance < t_max[lane]);
                }
            }
        }
    }
}

impl PacketVisitor for Occlusion<'_, '_, '_> {
    fn test(&mut self, index: usize, lanes: Range<usize>, t_max: &mut [f64]) {
        if self.tracer.may_meet(self.left(), index) {
            self.part = lanes.clone();
            self.test_part(index);
            self.end_blocked(lanes, t_max);
        }
    }

    fn test_one(&mut self, index: usize, lane: usize, t_max: &mut [f64]) {
        // Eight rays take no longer than one, and none is blocked by what it is tested against twice.
        let first = lane / LANES * LANES;
        self.test(index, first..first + LANES, t_max);
    }

    fn order(&self) -> Order {
        Order::Farthest
    }
}

/// The paths from the points of a surface to a light.
pub(super) struct LightPaths<'w> {
    /// A bounding box of the points.
    pub from: Aabb,
    /// A bounding box of the light's points.
    pub to: Aabb,
    /// The unit vectors toward the light.
    pub toward: &'w VectorList,
}

/// The mark in `blocked` of a shadow ray that is not cast. Such a ray is not blocked.
const NOT_CAST: u64 = 2;

impl Tracer<'_, '_> {
    /// Returns how far before the light shadow rays end, as a fraction of the sizes at [`ShadingPoints::slack`]: a
    /// surface on which the light lies must not block it, however the distances are rounded.
    ///
    /// The fraction is that of the error of a hit point, [`ROUNDING`]; `a_light_on_a_wall_lights_the_floor_evenly`
    /// tests it.
    ///
    /// [`ShadingPoints::slack`]: tabray_world::packets::light::ShadingPoints::slack
    /// [`ROUNDING`]: tabray_world::coincidence::ROUNDING
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
        let ShadowScratch { lanes, origin, dir, errors, their_t_max, their_blocked, sides } = shadows;
        // A ray whose budget is used up counts as not blocked.
        let len = charge_shadow_rays(cpu, group.len, &mut group.ray_budget[..count], t_max, blocked);
        if len == 0 {
            return;
        }
        self.observer.count(Count::Rays(RayKind::Shadow, len));
        let rays = surface.errors.rays(surface.points.view(count), paths.toward.view(count));
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
        errors.gather(&surface.errors, lanes, count);
        gather(their_t_max, t_max, lanes, count);
        gather(sides, &surface.sides, lanes, count);
        let their_blocked = resized(their_blocked, count);
        their_blocked.fill(0);
        let rays = errors.rays(origin.view(count), dir.view(count));
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
            let is_cast = t_max[lane] > 0.0;
            t_max[lane] = if is_cast { t_max[lane] } else { 0.0 };
            blocked[lane] = if is_cast { 0 } else { NOT_CAST };
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
