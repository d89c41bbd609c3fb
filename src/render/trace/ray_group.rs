//! Rays that go together.

use super::arrays::{VectorList, gather, resized};
use super::light::{self, Worth};
use super::surface::{Errors, Onward, Surface};
use crate::geometry::ray::Side;
use crate::geometry::ray_packet::{PACKET_SIZE, RayPacket};
use crate::geometry::sight::Sight;
use crate::render::limits::MAX_RAYS;
use crate::render::plan::depth::{Branch, Depth};
use crate::simd::cpu::Cpu;
use crate::simd::soa::LANES;
use crate::world::camera::{self, Camera};
use glam::DVec3;
use std::array;
use std::mem::swap;
use std::ops::Range;

/// The lanes of a packet, in their order.
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
    pub len: usize,
    pub origin: VectorList,
    pub dir: VectorList,
    /// How far the light of each has come already.
    pub travelled: Vec<f64>,
    /// The rays that each may still cost.
    pub ray_budget: Vec<u32>,
    /// The one ray from the viewer, before anything was rounded.
    pub sight: Option<Sight>,
    /// Whether they look through the places that are under way, each through its own.
    pub looks: bool,
    /// What they are worth; nothing where no ray goes on, or nothing bounds what that can bring back.
    pub worth: Option<Worth>,
    /// The camera ray that each comes from; empty where none goes on and no pixel has more than one.
    pub camera: Vec<u8>,
    /// The object that they leave, by its index, and on which side of it each goes.
    pub origin_object: Option<usize>,
    pub sides: Vec<Side>,
    /// The cosines of the angles at which those came there from which they go on, and how far the origin of any may be from
    /// the point that it stands for.
    pub cosines: Vec<f64>,
    pub errors: Errors,
}

impl RayGroup {
    /// One ray from the viewer.
    pub fn primary(sight: &Sight, depth: Option<&Depth>) -> Self {
        let (mut group, ray) = (Self::default(), sight.ray());
        group.begin(ray.origin, 1, true, depth);
        group.dir.fill(LANES, ray.dir);
        group.sight = Some(*sight);
        group
    }

    /// The rays that look through so many places, in pixels from the left and from the bottom.
    pub fn look(
        &mut self,
        cpu: Cpu,
        camera: &Camera,
        depth: Option<&Depth>,
        [x, y]: &mut [Vec<f64>; 2],
        len: usize,
    ) {
        self.begin(camera.viewpoint, len, camera.samples > 1, depth);
        let count = self.padded();
        let last = (x[len - 1], y[len - 1]);
        x[len..count].fill(last.0);
        y[len..count].fill(last.1);
        camera::look(cpu, camera, &x[..count], &y[..count], self.dir.resized(count));
        self.looks = true;
    }

    /// Rays from a viewpoint, with their directions yet to be given.
    fn begin(&mut self, viewpoint: DVec3, len: usize, is_sampled: bool, depth: Option<&Depth>) {
        self.len = len;
        let count = self.padded();
        self.origin.fill(count, viewpoint);
        resized(&mut self.travelled, count).fill(0.0);
        // Where no ray goes on, each costs one and those to the lights.
        resized(&mut self.ray_budget, count).fill(if depth.is_some() { MAX_RAYS as u32 } else { u32::MAX });
        let is_bounded = depth.is_some_and(|depth| depth.most.is_finite());
        self.worth = is_bounded.then_some(Worth { weight: 1.0, share: 1.0 });
        if is_sampled || depth.is_some() {
            // The copies that fill the arrays up are of the last ray, its sample of a light too.
            let (cameras, copies) = resized(&mut self.camera, count).split_at_mut(len);
            cameras.copy_from_slice(&LANE_INDICES[..len]);
            copies.fill(LANE_INDICES[len - 1]);
        } else {
            self.camera.clear();
        }
        self.origin_object = None;
        self.errors = Errors::NONE;
    }

    /// For rays whose numbers are only known as they are.
    fn forget_sights(&mut self) {
        (self.sight, self.looks) = (None, false);
    }

    /// Takes the mark from those that would bring back too little to be seen, so far from the viewer.
    pub fn leave_out(&self, cpu: Cpu, branch: &Branch, travelled: &[f64], goes: &mut [u64]) {
        let Some(worth) = self.worth.filter(|_| branch.faint_alone != f64::INFINITY) else { return };
        let ray_budget = &self.ray_budget[..goes.len()];
        let ray_budget = (light::fewest(cpu, ray_budget) < light::FEW).then_some(ray_budget);
        light::leave_out(cpu, travelled, worth, branch, ray_budget, goes);
    }

    /// What its rays are worth from here on, which go on in one of the ways of a surface.
    pub fn branch(&mut self, branch: &Branch) {
        if let Some(Worth { weight, share }) = &mut self.worth {
            *weight *= branch.weight;
            *share *= branch.share;
        }
    }

    /// How many rays there are with the copies that fill the arrays up.
    #[inline(always)]
    pub fn padded(&self) -> usize {
        self.len.next_multiple_of(LANES)
    }

    #[inline(always)]
    pub fn rays(&self) -> RayPacket<'_> {
        let count = self.padded();
        let origin_error = self.errors.most;
        RayPacket { origin: self.origin.view(count), dir: self.dir.view(count), origin_error }
    }

    /// How far the origin of one may be from the point that it stands for, in world units.
    pub fn error(&self, lane: usize) -> f64 {
        self.errors.of(&self.travelled, &self.cosines, lane)
    }

    /// The object that they leave, and the sides.
    #[inline(always)]
    pub fn left(&self) -> Option<(usize, &[Side])> {
        self.origin_object.map(|object| (object, &self.sides[..self.padded()]))
    }

    /// The sides of an object that they leave, if that is the one.
    #[inline(always)]
    pub fn sides_of(&self, object: usize) -> Option<&[Side]> {
        (self.origin_object == Some(object)).then(|| &self.sides[..self.padded()])
    }

    /// Becomes some rays of another group.
    pub fn gather(&mut self, from: &Self, lanes: &[u8]) {
        self.len = lanes.len();
        self.forget_sights();
        let count = self.padded();
        self.dir.gather(&from.dir, lanes, count);
        gather(&mut self.ray_budget, &from.ray_budget, lanes, count);
        self.worth = from.worth;
        gather(&mut self.camera, &from.camera, lanes, count);
        self.origin_object = from.origin_object;
        self.errors = from.errors;
        if self.origin_object.is_some() {
            self.pick_cosines(&from.cosines, lanes);
            self.origin.gather(&from.origin, lanes, count);
            gather(&mut self.travelled, &from.travelled, lanes, count);
            gather(&mut self.sides, &from.sides, lanes, count);
        } else {
            // They all come from the viewer.
            self.origin.fill(count, from.origin.get(0));
            resized(&mut self.travelled, count).fill(from.travelled[0]);
        }
    }

    /// Becomes rays that go on where those of another group have met an object.
    pub fn go_on(&mut self, from: &Self, onward: &Onward, lanes: &[u8]) {
        self.len = lanes.len();
        self.forget_sights();
        let count = self.padded();
        self.origin.gather(onward.points, lanes, count);
        self.dir.gather(onward.dir, lanes, count);
        gather(&mut self.travelled, onward.travelled, lanes, count);
        gather(&mut self.ray_budget, &from.ray_budget, lanes, count);
        self.worth = from.worth;
        gather(&mut self.camera, &from.camera, lanes, count);
        self.origin_object = Some(onward.origin_object);
        gather(&mut self.sides, onward.sides, lanes, count);
        self.errors = onward.errors;
        self.pick_cosines(onward.cosines, lanes);
    }

    fn pick_cosines(&mut self, from: &[f64], lanes: &[u8]) {
        if self.errors.reach.is_some() {
            let count = self.padded();
            gather(&mut self.cosines, from, lanes, count);
        }
    }

    /// Becomes all the rays that go on, with the arrays of those that they have been until now, and of where they met an
    /// object.
    pub fn take(&mut self, from: &mut Self, surface: &mut Surface, dir: &mut VectorList) {
        self.len = from.len;
        self.forget_sights();
        swap(&mut self.origin, &mut surface.points);
        swap(&mut self.dir, dir);
        swap(&mut self.travelled, &mut surface.travelled);
        swap(&mut self.ray_budget, &mut from.ray_budget);
        self.worth = from.worth;
        swap(&mut self.camera, &mut from.camera);
        self.origin_object = Some(surface.index);
        swap(&mut self.sides, &mut surface.sides);
        swap(&mut self.cosines, &mut surface.cosines);
        self.errors = surface.errors;
    }

    /// What some of its rays, which have gone on as others, have cost.
    pub fn charge(&mut self, part: &Self, lanes: &[u8]) {
        for (lane, ray_budget) in lanes.iter().zip(&part.ray_budget) {
            self.ray_budget[usize::from(*lane)] = *ray_budget;
        }
    }
}

/// Sorts rays by what they met: the rays of one object after those of another.
#[derive(Default)]
pub(super) struct HitGroups {
    /// What neighbours met, and which those are; none where they are done.
    runs: Vec<(u64, Range<usize>)>,
    lanes: Vec<u8>,
    next: usize,
}

impl HitGroups {
    /// Begins with rays that met these.
    pub fn begin(&mut self, met: &[u64]) {
        self.runs.clear();
        let mut start = 0;
        for run in met.chunk_by(|one, other| one == other) {
            self.runs.push((run[0], start..start + run.len()));
            start += run.len();
        }
        // Lanes are written by eights.
        resized(&mut self.lanes, met.len() + LANES);
        self.next = 0;
    }

    /// What some rays met, and which rays those are.
    pub fn next(&mut self) -> Option<(u64, &[u8])> {
        while self.runs.get(self.next)?.1.is_empty() {
            self.next += 1;
        }
        let (id, mut count) = (self.runs[self.next].0, 0);
        for (other, run) in &mut self.runs[self.next..] {
            if *other == id {
                for first in run.clone().step_by(LANES) {
                    let eight: [u8; LANES] = array::from_fn(|lane| (first + lane) as u8);
                    self.lanes[count + first - run.start..][..LANES].copy_from_slice(&eight);
                }
                count += run.len();
                run.end = run.start;
            }
        }
        Some((id, &self.lanes[..count]))
    }
}
