//! Groups of rays that are traced together, and their hits.

use super::arrays::{VectorList, gather, resized};
use super::light::{self, PathWeight};
use super::surface::{PointErrors, SecondaryRays, Surface};
use super::tree::OpenRay;
use crate::limits::MAX_RAYS;
use crate::plan::depth::{Branch, Depth};
use glam::DVec3;
use std::mem::swap;
use std::ops::Range;
use tabray_world::geometry::ray::{MISS, Ray, Side};
use tabray_world::geometry::ray_packet::{HitRecordMut, PACKET_SIZE, RayPacket};
use tabray_world::geometry::sight::Sight;
use tabray_world::sensor::Sensor;
use tabray_world::simd::cpu::{Cpu, kernels};
use tabray_world::simd::soa::LANES;

/// The lanes of a packet, in ascending order.
const LANE_INDICES: [u8; PACKET_SIZE] = {
    let (mut lanes, mut lane) = ([0; PACKET_SIZE], 0);
    while lane < PACKET_SIZE {
        lanes[lane] = lane as u8;
        lane += 1;
    }
    lanes
};

/// A packet of rays that leave the same object, or none.
#[derive(Default)]
pub(super) struct RayGroup {
    /// The number of rays, without the copies that pad the arrays.
    pub len: usize,
    pub origin: VectorList,
    pub dir: VectorList,
    /// The path length from the viewer to each ray's origin, in world units.
    pub travelled: Vec<f64>,
    /// The number of rays that each ray may still cost, itself included.
    pub ray_budget: Vec<u32>,
    /// The unrounded rays, where these are known and the rays are not the camera's.
    pub sights: Vec<Sight>,
    /// Whether these are the current primary rays, each through its position in [`Scratch::places`].
    ///
    /// [`Scratch::places`]: super::context::Scratch::places
    pub looks: bool,
    /// The light that the rays can add to a pixel; `None` where no ray continues, or where it has no bound.
    pub path_weight: Option<PathWeight>,
    /// The lane of the primary ray that each ray descends from; empty where no ray continues and pixels have one
    /// sample.
    pub camera: Vec<u8>,
    /// Under the free rules, the number of each ray in its wave; empty under the notes' rules.
    pub places: Vec<u32>,
    /// The index of the object that the rays leave.
    pub origin_object: Option<usize>,
    /// Whether all rays start at one point: the primary rays of most cameras do.
    pub is_from_one: bool,
    /// The side of the object that each ray leaves.
    pub sides: Vec<Side>,
    /// Bounds on the errors of the origins.
    pub errors: PointErrors,
}

impl RayGroup {
    /// Becomes these rays, at least one.
    pub fn become_sights(&mut self, sights: &[Sight], depth: Option<&Depth>) {
        let mut last = sights[0].ray();
        self.begin(last.origin, sights.len(), true, depth);
        let count = self.padded();
        let (mut origins, mut dirs) = (self.origin.resized(count), self.dir.resized(count));
        for lane in 0..count {
            // The last ray fills the rest of the arrays.
            if 0 < lane && lane < sights.len() {
                last = sights[lane].ray();
            }
            let Ray { origin, dir } = last;
            self.is_from_one &= origin == origins.get(0) || lane == 0;
            origins.set(lane, origin);
            dirs.set(lane, dir);
        }
        self.sights.clear();
        self.sights.extend_from_slice(sights);
        self.looks = false;
    }

    /// Becomes the primary rays through the first `len` image positions, in pixels from the left and from the bottom,
    /// and through as many points of the lens, in its radius, if there are any. `is_sampled` tells whether each has a
    /// sample.
    pub fn fill_primary(
        &mut self,
        cpu: Cpu,
        (camera, is_sampled): (&Sensor, bool),
        depth: Option<&Depth>,
        places: &mut [Vec<f64>; 2],
        lens: &mut [Vec<f64>; 2],
        len: usize,
    ) {
        let origins = camera.origins();
        self.begin(origins.middle, len, is_sampled, depth);
        self.is_from_one = origins.radius == 0.0;
        let count = self.padded();
        for each in places.iter_mut().chain(lens.iter_mut().filter(|each| !each.is_empty())) {
            let last = each[len - 1];
            each[len..count].fill(last);
        }
        let lens = lens.each_ref().map(|each| if each.is_empty() { &[][..] } else { &each[..count] });
        let places = camera.places_of(places.each_ref().map(|each| &each[..count]), lens);
        if self.is_from_one {
            camera.camera.fill_directions(cpu, &places, self.dir.resized(count));
        } else {
            camera.camera.fill_rays(cpu, &places, self.origin.resized(count), self.dir.resized(count));
        }
        self.looks = true;
    }

    /// Starts rays from a viewpoint. Their directions are yet to be set.
    fn begin(&mut self, viewpoint: DVec3, len: usize, is_sampled: bool, depth: Option<&Depth>) {
        self.len = len;
        let count = self.padded();
        self.origin.fill(count, viewpoint);
        resized(&mut self.travelled, count).fill(0.0);
        // Where no ray continues, a primary ray costs itself and one shadow ray for each light, so it needs no budget.
        resized(&mut self.ray_budget, count).fill(if depth.is_some() { MAX_RAYS as u32 } else { u32::MAX });
        let is_bounded = depth.is_some_and(|depth| depth.most.is_finite());
        self.path_weight = is_bounded.then_some(PathWeight { weight: 1.0, share: 1.0 });
        if is_sampled || depth.is_some() {
            // The copies that pad the arrays are of the last ray, so they use its sample.
            let (cameras, copies) = resized(&mut self.camera, count).split_at_mut(len);
            cameras.copy_from_slice(&LANE_INDICES[..len]);
            copies.fill(LANE_INDICES[len - 1]);
        } else {
            self.camera.clear();
        }
        self.origin_object = None;
        self.is_from_one = true;
        self.errors.clear();
    }

    /// Marks the rays as known only by their rounded numbers.
    pub fn forget_sights(&mut self) {
        self.sights.clear();
        self.looks = false;
    }

    /// Clears `continue_mask` for the rays that would return too little to be seen at their path lengths.
    pub fn cull_faint(&self, cpu: Cpu, branch: &Branch, travelled: &[f64], continue_mask: &mut [u64]) {
        let Some(path_weight) = self.path_weight.filter(|_| branch.faint_alone != f64::INFINITY) else {
            return;
        };
        let ray_budget = &self.ray_budget[..continue_mask.len()];
        let ray_budget = (light::fewest(cpu, ray_budget) < light::FEW).then_some(ray_budget);
        light::cull_faint(cpu, travelled, path_weight, branch, ray_budget, continue_mask);
    }

    /// Updates the light that the rays can add to a pixel when they continue along a branch of a surface.
    pub fn branch(&mut self, branch: &Branch) {
        if let Some(PathWeight { weight, share }) = &mut self.path_weight {
            *weight *= branch.weight;
            *share *= branch.share;
        }
    }

    /// Returns the number of rays with the copies that pad the arrays.
    #[inline(always)]
    pub fn padded(&self) -> usize {
        self.len.next_multiple_of(LANES)
    }

    /// Returns the rays as a packet, with the copies that pad the arrays.
    #[inline(always)]
    pub fn rays(&self) -> RayPacket<'_> {
        let count = self.padded();
        self.errors.rays(self.origin.view(count), self.dir.view(count))
    }

    /// Returns the index of the object that the rays leave, and the sides that they leave.
    #[inline(always)]
    pub fn left(&self) -> Option<(usize, &[Side])> {
        self.origin_object.map(|object| (object, &self.sides[..self.padded()]))
    }

    /// Returns the sides of an object that the rays leave, if this is the object that they leave.
    #[inline(always)]
    pub fn sides_of(&self, object: usize) -> Option<&[Side]> {
        (self.origin_object == Some(object)).then(|| &self.sides[..self.padded()])
    }

    /// Becomes the rays of some lanes of another group.
    pub fn gather(&mut self, from: &Self, lanes: &[u8]) {
        self.len = lanes.len();
        self.forget_sights();
        let count = self.padded();
        self.dir.gather(&from.dir, lanes, count);
        gather(&mut self.ray_budget, &from.ray_budget, lanes, count);
        self.path_weight = from.path_weight;
        gather(&mut self.camera, &from.camera, lanes, count);
        gather(&mut self.places, &from.places, lanes, count);
        self.origin_object = from.origin_object;
        self.is_from_one = from.is_from_one;
        self.errors.gather(&from.errors, lanes, count);
        if self.origin_object.is_some() {
            self.origin.gather(&from.origin, lanes, count);
            gather(&mut self.travelled, &from.travelled, lanes, count);
            gather(&mut self.sides, &from.sides, lanes, count);
        } else {
            if from.is_from_one {
                self.origin.fill(count, from.origin.get(0));
            } else {
                self.origin.gather(&from.origin, lanes, count);
            }
            resized(&mut self.travelled, count).fill(from.travelled[0]);
        }
    }

    /// Becomes the rays that continue from another group's hits on an object, in some lanes.
    pub fn continue_from(&mut self, from: &Self, rays: &SecondaryRays, lanes: &[u8]) {
        self.len = lanes.len();
        self.forget_sights();
        let count = self.padded();
        self.origin.gather(rays.points, lanes, count);
        self.dir.gather(rays.dir, lanes, count);
        gather(&mut self.travelled, rays.travelled, lanes, count);
        gather(&mut self.ray_budget, &from.ray_budget, lanes, count);
        self.path_weight = from.path_weight;
        gather(&mut self.camera, &from.camera, lanes, count);
        self.origin_object = Some(rays.origin_object);
        self.is_from_one = false;
        gather(&mut self.sides, rays.sides, lanes, count);
        self.errors.gather(rays.errors, lanes, count);
    }

    /// Becomes open rays that leave the same object, with these ray budgets.
    pub fn open<'r>(
        &mut self,
        rays: impl ExactSizeIterator<Item = &'r OpenRay> + Clone,
        budgets: impl Iterator<Item = u32>,
    ) {
        self.len = rays.len();
        self.forget_sights();
        let count = self.padded();
        (self.path_weight, self.is_from_one) = (None, false);
        let (mut origin, mut dir) = (self.origin.resized(count), self.dir.resized(count));
        let travelled = resized(&mut self.travelled, count);
        self.errors.fill(count, rays.clone().map(|ray| ray.error));
        self.sides.resize(count.max(self.sides.len()), Side::Outside);
        let (camera, budget) = (resized(&mut self.camera, count), resized(&mut self.ray_budget, count));
        for (lane, (ray, left)) in rays.zip(budgets).enumerate() {
            // The last ray fills the rest of the arrays.
            let end = if lane + 1 == self.len { count } else { lane + 1 };
            for lane in lane..end {
                origin.set(lane, ray.origin);
                dir.set(lane, ray.dir);
                travelled[lane] = ray.travelled;
                (camera[lane], budget[lane], self.sides[lane]) = (ray.camera, left, ray.side);
            }
            self.origin_object = Some(ray.object as usize);
        }
    }

    /// Becomes the rays that continue from all lanes of another group. Arrays are swapped with those of that group and
    /// of the surface, not copied.
    pub fn take(&mut self, from: &mut Self, surface: &mut Surface, dir: &mut VectorList) {
        self.len = from.len;
        self.forget_sights();
        swap(&mut self.origin, &mut surface.points);
        swap(&mut self.dir, dir);
        swap(&mut self.travelled, &mut surface.travelled);
        swap(&mut self.ray_budget, &mut from.ray_budget);
        self.path_weight = from.path_weight;
        swap(&mut self.camera, &mut from.camera);
        self.origin_object = Some(surface.index);
        self.is_from_one = false;
        swap(&mut self.sides, &mut surface.sides);
        swap(&mut self.errors, &mut surface.errors);
    }

    /// Takes over the remaining ray budgets of some lanes, which were traced as another group.
    pub fn charge(&mut self, part: &Self, lanes: &[u8]) {
        for (lane, ray_budget) in lanes.iter().zip(&part.ray_budget) {
            self.ray_budget[usize::from(*lane)] = *ray_budget;
        }
    }
}

/// The maximum number of runs that are not sorted by objects: going through few runs takes less time.
const SOME: usize = 48;

/// Groups a packet's rays by the object that they hit.
#[derive(Default)]
pub(super) struct HitGroups {
    /// Runs of neighbouring lanes that hit the same object: its index plus 1 (0 for a miss), and the lanes. The lanes
    /// of a run that has been returned are empty.
    runs: Vec<(u64, Range<usize>)>,
    /// The lanes of the current group.
    lanes: Vec<u8>,
    /// The index of the first run that may not have been returned.
    next: usize,
}

impl HitGroups {
    /// Starts with the hits of a packet, each an object's index plus 1, or 0 for a miss.
    pub fn begin(&mut self, hit_ids: &[u64]) {
        self.runs.clear();
        let mut start = 0;
        for run in hit_ids.chunk_by(|one, other| one == other) {
            self.runs.push((run[0], start..start + run.len()));
            start += run.len();
        }
        if self.runs.len() > SOME {
            // Runs of the same object become neighbours, in the order of their lanes.
            self.runs.sort_unstable_by_key(|(id, run)| (*id, run.start));
        }
        // Lanes are written eight at a time, beyond the end of a run.
        resized(&mut self.lanes, hit_ids.len() + LANES);
        self.next = 0;
    }

    /// Returns the next object that was hit, by its index plus 1 (0 for a miss), and the lanes that hit it.
    pub fn next(&mut self) -> Option<(u64, &[u8])> {
        while self.runs.get(self.next)?.1.is_empty() {
            self.next += 1;
        }
        let (id, mut count) = (self.runs[self.next].0, 0);
        let is_sorted = self.runs.len() > SOME;
        for (other, run) in &mut self.runs[self.next..] {
            if *other == id {
                for first in run.clone().step_by(LANES) {
                    let eight = &mut self.lanes[count + first - run.start..][..LANES];
                    for lane in 0..LANES {
                        eight[lane] = (first + lane) as u8;
                    }
                }
                count += run.len();
                run.end = run.start;
            } else if is_sorted {
                break;
            }
        }
        Some((id, &self.lanes[..count]))
    }
}

/// The object that each ray of a packet hits first, and a bracket of the distance.
#[derive(Default)]
pub(super) struct HitRecord {
    /// The lower bounds of the distances, in world units.
    pub near: Vec<f64>,
    /// The upper bounds of the distances, in world units.
    pub far: Vec<f64>,
    /// The object's index plus 1; 0 for no object.
    pub hit_ids: Vec<u64>,
    /// Not 0 where the last tested object's bracket overlaps that of another one.
    pub doubt: Vec<u64>,
}

impl HitRecord {
    /// Starts with no hits before `t_max`, and charges each ray to its budget. Rays whose budget is used up end at 0.
    /// Returns whether there are any such rays.
    pub fn begin(&mut self, cpu: Cpu, ray_budget: &mut [u32], count: usize, t_max: Option<&[f64]>) -> bool {
        let (near, far) = (resized(&mut self.near, count), resized(&mut self.far, count));
        // Each shape that is tested overwrites `doubt`.
        resized(&mut self.doubt, count);
        begin(cpu, &mut ray_budget[..count], t_max, near, far, resized(&mut self.hit_ids, count))
    }

    /// Borrows the hits of some of the rays.
    pub fn part(&mut self, range: Range<usize>) -> HitRecordMut<'_> {
        HitRecordMut {
            near: &mut self.near[range.clone()],
            far: &mut self.far[range.clone()],
            hit_ids: &mut self.hit_ids[range.clone()],
            doubt: &mut self.doubt[range],
        }
    }
}

kernels! {
    /// Starts rays with no hits and charges each to its budget. Returns whether the budget of any is used up.
    fn begin(
        ray_budget: &mut [u32], t_max: Option<&[f64]>, near: &mut [f64], far: &mut [f64], hit_ids: &mut [u64]
    ) -> bool {
        let (count, mut any_over) = (ray_budget.len(), 0);
        let (near, far, hit_ids) = (&mut near[..count], &mut far[..count], &mut hit_ids[..count]);
        match t_max {
            Some(t_max) => far.copy_from_slice(&t_max[..count]),
            None => far.fill(MISS),
        }
        for lane in 0..count {
            let is_over = ray_budget[lane] == 0;
            let end = if is_over { 0.0 } else { far[lane] };
            (near[lane], far[lane], hit_ids[lane]) = (end, end, 0);
            ray_budget[lane] -= u32::from(!is_over);
            any_over |= u32::from(is_over);
        }
        any_over != 0
    }
}
