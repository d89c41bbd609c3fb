//! Rays that go together.

use super::MAX_RAYS;
use crate::camera::{self, Camera};
use crate::cpu::Cpu;
use crate::geometry::{Ray, Side};
use crate::packet::{Rays, STEP, Vectors, WIDE};
use glam::DVec3;

/// A packet of rays that leave the same object, or none.
#[derive(Clone)]
pub(super) struct Group<const N: usize> {
    pub len: usize,
    pub origin: Vectors<N>,
    pub dir: Vectors<N>,
    /// How far the light of each has come already.
    pub travelled: [f64; N],
    /// The rays that each may still cost.
    pub budget: [u32; N],
    /// The camera ray that each comes from.
    pub camera: [u8; N],
    /// The object that they leave, by its index, and on which side of it each goes.
    pub leaves: Option<usize>,
    pub sides: [Side; N],
}

impl<const N: usize> Group<N> {
    /// Rays from a viewpoint, with their directions yet to be given.
    fn from(viewpoint: DVec3, len: usize) -> Self {
        let mut camera = [0; N];
        for (lane, camera) in camera.iter_mut().enumerate() {
            // The copies that fill the arrays up are of the last ray, its sample of a light too.
            *camera = lane.min(len - 1) as u8;
        }
        Self {
            len,
            origin: Vectors { x: [viewpoint.x; N], y: [viewpoint.y; N], z: [viewpoint.z; N] },
            dir: Vectors::ZERO,
            travelled: [0.0; N],
            budget: [MAX_RAYS as u32; N],
            camera,
            leaves: None,
            sides: [Side::Outside; N],
        }
    }

    /// One ray from a viewer.
    pub fn primary(ray: &Ray) -> Self {
        let Ray { origin, dir } = *ray;
        Self { dir: Vectors { x: [dir.x; N], y: [dir.y; N], z: [dir.z; N] }, ..Self::from(origin, 1) }
    }

    /// The rays that look through so many places, in pixels from the left and from the bottom.
    pub fn through(cpu: Cpu, camera: &Camera, x: &mut [f64; N], y: &mut [f64; N], len: usize) -> Self {
        let mut group = Self::from(camera.viewpoint, len);
        let count = group.padded();
        let last = (x[len - 1], y[len - 1]);
        x[len..count].fill(last.0);
        y[len..count].fill(last.1);
        camera::look(cpu, camera, &x[..count], &y[..count], group.dir.view_mut(count));
        group
    }

    /// How many rays there are with the copies that fill the arrays up.
    #[inline(always)]
    pub fn padded(&self) -> usize {
        self.len.next_multiple_of(STEP)
    }

    #[inline(always)]
    pub fn rays(&self) -> Rays<'_> {
        let count = self.padded();
        Rays { origin: self.origin.view(count), dir: self.dir.view(count) }
    }

    /// The sides of an object that they leave, if that is the one.
    #[inline(always)]
    pub fn sides_of(&self, object: usize) -> Option<&[Side]> {
        (self.leaves == Some(object)).then(|| &self.sides[..self.padded()])
    }

    /// Some of them.
    pub fn pick<const M: usize>(&self, lanes: &[u8]) -> Group<M> {
        Group {
            len: lanes.len(),
            origin: pick_vectors(&self.origin, lanes),
            dir: pick_vectors(&self.dir, lanes),
            travelled: pick(&self.travelled, lanes),
            budget: pick(&self.budget, lanes),
            camera: pick(&self.camera, lanes),
            leaves: self.leaves,
            sides: if self.leaves.is_some() { pick(&self.sides, lanes) } else { [Side::Outside; M] },
        }
    }
}

/// Some elements of an array, the last one repeated to fill it up.
#[inline(always)]
pub(super) fn pick<T: Copy, const N: usize, const M: usize>(from: &[T; N], lanes: &[u8]) -> [T; M] {
    let mut picked = [from[usize::from(lanes[lanes.len() - 1])]; M];
    for (place, lane) in picked.iter_mut().zip(lanes) {
        *place = from[usize::from(*lane)];
    }
    picked
}

pub(super) fn pick_vectors<const N: usize, const M: usize>(from: &Vectors<N>, lanes: &[u8]) -> Vectors<M> {
    Vectors { x: pick(&from.x, lanes), y: pick(&from.y, lanes), z: pick(&from.z, lanes) }
}

/// Rays by what they met: the rays of one object after those of another.
pub(super) struct Parts<'m> {
    met: &'m [u64],
    done: [bool; WIDE],
    lanes: [u8; WIDE],
    next: usize,
}

impl<'m> Parts<'m> {
    /// `met` tells of each ray what it met.
    pub fn new(met: &'m [u64]) -> Self {
        Self { met, done: [false; WIDE], lanes: [0; WIDE], next: 0 }
    }

    /// What some rays met, and which rays those are.
    pub fn next(&mut self) -> Option<(u64, &[u8])> {
        while self.done.get(self.next).is_some_and(|done| *done) {
            self.next += 1;
        }
        let id = *self.met.get(self.next)?;
        let mut count = 0;
        for (lane, other) in self.met.iter().enumerate().skip(self.next) {
            if *other == id {
                self.lanes[count] = lane as u8;
                self.done[lane] = true;
                count += 1;
            }
        }
        Some((id, &self.lanes[..count]))
    }
}
