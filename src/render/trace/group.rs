//! Rays that go together.

use super::arrays::{Vectors, pick, room};
use super::light::{self, Worth};
use super::surface::{Errors, Onward, Surface};
use crate::geometry::packet::{Rays, WIDE};
use crate::geometry::ray::Side;
use crate::geometry::sight::Sight;
use crate::render::limits::MAX_RAYS;
use crate::render::plan::depth::{Branch, Depth};
use crate::simd::cpu::Cpu;
use crate::simd::soa::STEP;
use crate::world::camera::{self, Camera};
use glam::DVec3;
use std::array;
use std::mem::swap;
use std::ops::Range;

/// The lanes of a packet, in their order.
const LANES: [u8; WIDE] = {
    let (mut lanes, mut lane) = ([0; WIDE], 0);
    while lane < WIDE {
        lanes[lane] = lane as u8;
        lane += 1;
    }
    lanes
};

/// A packet of rays that leave the same object, or none.
#[derive(Default)]
pub(super) struct Group {
    pub len: usize,
    pub origin: Vectors,
    pub dir: Vectors,
    /// How far the light of each has come already.
    pub travelled: Vec<f64>,
    /// The rays that each may still cost.
    pub budget: Vec<u32>,
    /// The one ray from the viewer, before anything was rounded.
    pub sight: Option<Sight>,
    /// Whether they look through the places that are under way, each through its own.
    pub looks: bool,
    /// What they are worth; nothing where no ray goes on, or nothing bounds what that can bring back.
    pub worth: Option<Worth>,
    /// The camera ray that each comes from; empty where none goes on and no pixel has more than one.
    pub camera: Vec<u8>,
    /// The object that they leave, by its index, and on which side of it each goes.
    pub leaves: Option<usize>,
    pub sides: Vec<Side>,
    /// The cosines of the angles at which those came there from which they go on, and how far the origin of any may be from
    /// the point that it stands for.
    pub cosines: Vec<f64>,
    pub errors: Errors,
}

impl Group {
    /// One ray from the viewer.
    pub fn primary(sight: &Sight, depth: Option<&Depth>) -> Self {
        let (mut group, ray) = (Self::default(), sight.ray());
        group.begin(ray.origin, 1, true, depth);
        group.dir.fill(STEP, ray.dir);
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
        camera::look(cpu, camera, &x[..count], &y[..count], self.dir.room(count));
        self.looks = true;
    }

    /// Rays from a viewpoint, with their directions yet to be given.
    fn begin(&mut self, viewpoint: DVec3, len: usize, is_sampled: bool, depth: Option<&Depth>) {
        self.len = len;
        let count = self.padded();
        self.origin.fill(count, viewpoint);
        room(&mut self.travelled, count).fill(0.0);
        // Where no ray goes on, each costs one and those to the lights.
        room(&mut self.budget, count).fill(if depth.is_some() { MAX_RAYS as u32 } else { u32::MAX });
        let is_bounded = depth.is_some_and(|depth| depth.most.is_finite());
        self.worth = is_bounded.then_some(Worth { weight: 1.0, share: 1.0 });
        if is_sampled || depth.is_some() {
            // The copies that fill the arrays up are of the last ray, its sample of a light too.
            let (cameras, copies) = room(&mut self.camera, count).split_at_mut(len);
            cameras.copy_from_slice(&LANES[..len]);
            copies.fill(LANES[len - 1]);
        } else {
            self.camera.clear();
        }
        self.leaves = None;
        self.errors = Errors::NONE;
    }

    /// For rays whose numbers are only known as they are.
    fn forget_sights(&mut self) {
        (self.sight, self.looks) = (None, false);
    }

    /// Takes the mark from those that would bring back too little to be seen, so far from the viewer.
    pub fn leave_out(&self, cpu: Cpu, branch: &Branch, travelled: &[f64], goes: &mut [u64]) {
        let Some(worth) = self.worth.filter(|_| branch.faint_alone != f64::INFINITY) else { return };
        let budget = &self.budget[..goes.len()];
        let budget = (light::fewest(cpu, budget) < light::FEW).then_some(budget);
        light::leave_out(cpu, travelled, worth, branch, budget, goes);
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
        self.len.next_multiple_of(STEP)
    }

    #[inline(always)]
    pub fn rays(&self) -> Rays<'_> {
        let count = self.padded();
        let origin_error = self.errors.most;
        Rays { origin: self.origin.view(count), dir: self.dir.view(count), origin_error }
    }

    /// How far the origin of one may be from the point that it stands for, in world units.
    pub fn error(&self, lane: usize) -> f64 {
        self.errors.of(&self.travelled, &self.cosines, lane)
    }

    /// The object that they leave, and the sides.
    #[inline(always)]
    pub fn left(&self) -> Option<(usize, &[Side])> {
        self.leaves.map(|object| (object, &self.sides[..self.padded()]))
    }

    /// The sides of an object that they leave, if that is the one.
    #[inline(always)]
    pub fn sides_of(&self, object: usize) -> Option<&[Side]> {
        (self.leaves == Some(object)).then(|| &self.sides[..self.padded()])
    }

    /// Becomes some rays of another group.
    pub fn pick(&mut self, from: &Self, lanes: &[u8]) {
        self.len = lanes.len();
        self.forget_sights();
        let count = self.padded();
        self.dir.pick(&from.dir, lanes, count);
        pick(&mut self.budget, &from.budget, lanes, count);
        self.worth = from.worth;
        pick(&mut self.camera, &from.camera, lanes, count);
        self.leaves = from.leaves;
        self.errors = from.errors;
        if self.leaves.is_some() {
            self.pick_cosines(&from.cosines, lanes);
            self.origin.pick(&from.origin, lanes, count);
            pick(&mut self.travelled, &from.travelled, lanes, count);
            pick(&mut self.sides, &from.sides, lanes, count);
        } else {
            // They all come from the viewer.
            self.origin.fill(count, from.origin.get(0));
            room(&mut self.travelled, count).fill(from.travelled[0]);
        }
    }

    /// Becomes rays that go on where those of another group have met an object.
    pub fn go_on(&mut self, from: &Self, onward: &Onward, lanes: &[u8]) {
        self.len = lanes.len();
        self.forget_sights();
        let count = self.padded();
        self.origin.pick(onward.points, lanes, count);
        self.dir.pick(onward.dir, lanes, count);
        pick(&mut self.travelled, onward.travelled, lanes, count);
        pick(&mut self.budget, &from.budget, lanes, count);
        self.worth = from.worth;
        pick(&mut self.camera, &from.camera, lanes, count);
        self.leaves = Some(onward.leaves);
        pick(&mut self.sides, onward.sides, lanes, count);
        self.errors = onward.errors;
        self.pick_cosines(onward.cosines, lanes);
    }

    fn pick_cosines(&mut self, from: &[f64], lanes: &[u8]) {
        if self.errors.reach.is_some() {
            let count = self.padded();
            pick(&mut self.cosines, from, lanes, count);
        }
    }

    /// Becomes all the rays that go on, with the arrays of those that they have been until now, and of where they met an
    /// object.
    pub fn take(&mut self, from: &mut Self, surface: &mut Surface, dir: &mut Vectors) {
        self.len = from.len;
        self.forget_sights();
        swap(&mut self.origin, &mut surface.points);
        swap(&mut self.dir, dir);
        swap(&mut self.travelled, &mut surface.travelled);
        swap(&mut self.budget, &mut from.budget);
        self.worth = from.worth;
        swap(&mut self.camera, &mut from.camera);
        self.leaves = Some(surface.index);
        swap(&mut self.sides, &mut surface.sides);
        swap(&mut self.cosines, &mut surface.cosines);
        self.errors = surface.errors;
    }

    /// What some of its rays, which have gone on as others, have cost.
    pub fn pay(&mut self, part: &Self, lanes: &[u8]) {
        for (lane, budget) in lanes.iter().zip(&part.budget) {
            self.budget[usize::from(*lane)] = *budget;
        }
    }
}

/// Sorts rays by what they met: the rays of one object after those of another.
#[derive(Default)]
pub(super) struct Parts {
    /// What neighbours met, and which those are; none where they are done.
    runs: Vec<(u64, Range<usize>)>,
    lanes: Vec<u8>,
    next: usize,
}

impl Parts {
    /// Begins with rays that met these.
    pub fn begin(&mut self, met: &[u64]) {
        self.runs.clear();
        let mut start = 0;
        for run in met.chunk_by(|one, other| one == other) {
            self.runs.push((run[0], start..start + run.len()));
            start += run.len();
        }
        // Lanes are written by eights.
        room(&mut self.lanes, met.len() + STEP);
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
                for first in run.clone().step_by(STEP) {
                    let eight: [u8; STEP] = array::from_fn(|lane| (first + lane) as u8);
                    self.lanes[count + first - run.start..][..STEP].copy_from_slice(&eight);
                }
                count += run.len();
                run.end = run.start;
            }
        }
        Some((id, &self.lanes[..count]))
    }
}
