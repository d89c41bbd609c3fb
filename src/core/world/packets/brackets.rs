//! Hits of packets by brackets that are computed first.

use super::shape::{PacketIntersect, ScalarIntersect};
use crate::geometry::ray::{Bracket, MISS, RayRange};
use crate::geometry::ray_packet::{self, BEAM, Nearest, PACKET_SIZE, RayPacket, split};
use crate::simd::cpu::Cpu;
use crate::simd::soa::LANES;
use crate::world::hittable::Hittable;

/// Merges hits as [`PacketIntersect::closest_hits`] does by default.
pub(crate) fn closest_by_brackets(
    shape: &(impl PacketIntersect + ?Sized),
    cpu: Cpu,
    rays: RayPacket,
    id: u64,
    nearest: Nearest,
) -> bool {
    with_brackets(rays.len(), |near, far| {
        shape.brackets(cpu, rays, nearest.far, (&mut *near, &mut *far));
        ray_packet::closest_of_brackets(cpu, near, far, id, nearest)
    })
}

/// Marks rays as [`PacketIntersect::occluded`] does by default.
pub(crate) fn occluded_by_brackets(
    shape: &(impl PacketIntersect + ?Sized),
    cpu: Cpu,
    rays: RayPacket,
    t_max: &[f64],
    blocked: &mut [u64],
    doubt: &mut [u64],
) -> bool {
    let count = t_max.len();
    with_brackets(count, |near, far| {
        shape.brackets(cpu, rays.first(count), t_max, (&mut *near, &mut *far));
        ray_packet::occluded_by_brackets(cpu, near, far, t_max, blocked, doubt)
    })
}

/// Calls a function with arrays for the brackets of `count` rays: no longer than they need to be, as clearing them takes
/// time.
#[inline(always)]
fn with_brackets(count: usize, call: impl FnOnce(&mut [f64], &mut [f64]) -> bool) -> bool {
    if count <= LANES {
        let (mut near, mut far) = ([MISS; LANES], [MISS; LANES]);
        return call(&mut near[..count], &mut far[..count]);
    }
    let (mut near, mut far) = ([MISS; PACKET_SIZE], [MISS; PACKET_SIZE]);
    call(&mut near[..count], &mut far[..count])
}

/// Computes brackets of the first hits of a packet's rays, some of which are searched together.
pub(super) fn of_beams<T: Hittable>(
    shape: &impl ScalarIntersect<Author = T>,
    rays: RayPacket,
    ends: &[f64],
    near: &mut [f64],
    far: &mut [f64],
) {
    let can_hit_itself = shape.author().facts().can_hit_itself;
    for lanes in split(near.len(), BEAM) {
        let (rays, ends) = (rays.part(lanes.clone()), &ends[lanes.clone()]);
        let (mut ranges, mut brackets) = ([RayRange::ALL; BEAM], [Bracket::MISS; BEAM]);
        for (lane, end) in ends.iter().enumerate() {
            let is_missed = rays.side(lane).is_some_and(|side| !can_hit_itself.contain(side));
            // Nothing is hit before 0.
            ranges[lane] = rays.range(lane, if is_missed { 0.0 } else { *end });
        }
        shape.t_bounds_each(rays, &ranges[..ends.len()], &mut brackets[..ends.len()]);
        for (lane, bracket) in lanes.zip(&brackets) {
            (near[lane], far[lane]) = (bracket.near, bracket.far);
        }
    }
}
