//! The search for the first hits of a packet's rays.

use super::face::{Flat, Leaving, t_bounds};
use super::known::Eight;
use super::surface::Surface;
use crate::triangle::passed_by_eight;
use glam::DVec3;
use std::cell::Cell;
use std::ops::Range;
use tabray_world::geometry::bvh::{self, Order, PacketVisitor, Stack};
use tabray_world::geometry::ray::{Bracket, MISS, RayError};
use tabray_world::geometry::ray_packet::RayPacket;
use tabray_world::simd::cpu::{Cpu, kernels};
use tabray_world::simd::soa::LANES;

/// The scratch space of searches.
#[derive(Default)]
pub(super) struct Scratch {
    pub stack: Stack,
    /// The ends of a packet's rays, as distances in world units.
    t_max: Vec<f64>,
    found: Vec<Eight>,
}

thread_local! {
    static SCRATCH: Cell<Option<Scratch>> = const { Cell::new(None) };
}

impl Scratch {
    /// Calls a function with this thread's scratch space.
    #[inline(always)]
    pub fn with<R>(call: impl FnOnce(&mut Self) -> R) -> R {
        let mut scratch = SCRATCH.take().unwrap_or_default();
        let result = call(&mut scratch);
        SCRATCH.set(Some(scratch));
        result
    }
}

/// Properties that the rays of a packet share.
#[derive(Clone, Copy)]
pub(super) struct Aims {
    pub leaving: Leaving,
    pub drift: RayError,
    /// Whether any certain hit of a ray is enough.
    pub is_any: bool,
}

/// The search for the hits of a packet's rays.
struct Search<'s> {
    cpu: Cpu,
    surface: &'s Surface,
    rays: RayPacket<'s>,
    /// The ends of the rays, as distances in world units.
    ends: &'s [f64],
    aims: Aims,
    found: &'s mut [Eight],
}

impl Surface {
    /// Searches for the first hits of a packet's rays before their ends. Calls a function for each eight rays, with the
    /// first lane and the hits.
    #[inline(always)]
    pub(super) fn search(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        ends: &[f64],
        aims: Aims,
        mut each: impl FnMut(usize, &Eight),
    ) {
        Scratch::with(|Scratch { stack, t_max, found }| {
            t_max.clear();
            t_max.extend_from_slice(ends);
            found.clear();
            found.resize(ends.len() / LANES, Eight::NONE);
            let mut search = Search { cpu, surface: self, rays, ends, aims, found };
            bvh::visit(cpu, &self.tree, stack, rays, aims.drift, t_max, &mut search);
            found.iter().zip((0..).step_by(LANES)).for_each(|(found, first)| each(first, found));
        });
    }
}

impl PacketVisitor for Search<'_> {
    fn test(&mut self, face: usize, lanes: Range<usize>, t_max: &mut [f64]) {
        let Self { cpu, surface, rays, ends, aims, .. } = *self;
        test(cpu, face as u64, surface.corners(face), rays, lanes, ends, &aims, self.found, t_max);
    }

    fn few(&self) -> u32 {
        2
    }

    fn order(&self) -> Order {
        if self.aims.is_any { Order::Farthest } else { Order::Nearest }
    }

    fn test_one(&mut self, face: usize, lane: usize, t_max: &mut [f64]) {
        let Aims { leaving, drift, is_any } = self.aims;
        let ray = self.rays.get(lane);
        let bracket = t_bounds(self.surface.corners(face), &ray, self.ends[lane], leaving, drift);
        if bracket.near < MISS {
            let eight = &mut self.found[lane / LANES];
            let mut nearest = eight.get(lane % LANES);
            nearest.add(face as u64, bracket);
            eight.set(lane % LANES, nearest);
            t_max[lane] = nearest.end(&ray, t_max[lane], is_any);
        }
    }
}

kernels! {
    /// Tests the rays of some lanes against a face.
    fn test(
        face: u64, corners: [DVec3; 3], rays: RayPacket, lanes: Range<usize>, ends: &[f64], aims: &Aims,
        found: &mut [Eight], t_max: &mut [f64]
    ) {
        let flat = Flat::of(corners);
        for first in lanes.step_by(LANES) {
            let of = first..first + LANES;
            let rays = rays.part(of.clone()).first(LANES);
            let (missed, inside) = passed_by_eight(corners, rays, aims.drift);
            if missed != [1; LANES] {
                let left = if aims.leaving.most >= 0.0 { left(&flat, rays, aims, &missed) } else { None };
                let (ends, t_max) = (&ends[of.clone()][..LANES], &mut t_max[of][..LANES]);
                add(face, &flat, rays, ends, aims, (&missed, &inside, left.as_ref()), &mut found[first / LANES], t_max);
            }
        }
    }
}

/// The brackets of eight rays with a face that they leave or may leave, or `None` for other rays.
type Left = [Option<Bracket>; LANES];

/// Returns the brackets of the rays that leave a face or may leave it, except for rays that miss it.
#[inline(never)]
fn left(
    flat: &Flat,
    rays: RayPacket,
    aims: &Aims,
    missed: &[u64; LANES],
) -> Option<[Option<Bracket>; LANES]> {
    let mut left = [None; LANES];
    for lane in (0..LANES).filter(|lane| missed[*lane] == 0) {
        left[lane] = flat.left(&rays.get(lane), aims.leaving, aims.drift);
    }
    left.iter().any(Option::is_some).then_some(left)
}

/// Adds the hits of eight rays with a face.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "they are arrays")]
fn add(
    face: u64,
    flat: &Flat,
    rays: RayPacket,
    ends: &[f64],
    aims: &Aims,
    (missed, inside, left): (&[u64; LANES], &[u64; LANES], Option<&Left>),
    found: &mut Eight,
    t_max: &mut [f64],
) {
    let (mut near, mut far) = ([MISS; LANES], [MISS; LANES]);
    for lane in 0..LANES {
        let bracket = flat.t_bounds(&rays.get(lane), ends[lane], aims.leaving, aims.drift, inside[lane] != 0);
        near[lane] = if missed[lane] != 0 { MISS } else { bracket.near };
        far[lane] = if missed[lane] != 0 { MISS } else { bracket.far };
    }
    for lane in 0..LANES {
        if let Some(bracket) = left.and_then(|left| left[lane]) {
            (near[lane], far[lane]) = (bracket.near, bracket.far);
        }
    }
    for lane in 0..LANES {
        let mut nearest = found.get(lane);
        nearest.add(face, Bracket { near: near[lane], far: far[lane] });
        found.set(lane, nearest);
        t_max[lane] = nearest.end(&rays.get(lane), t_max[lane], aims.is_any);
    }
}
