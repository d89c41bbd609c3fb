//! Hits of packets by brackets that are computed first.

use crate::geometry::ray::{Bracket, MISS, RayRange};
use crate::geometry::ray_packet::{self, BEAM, HitRecordMut, PACKET_SIZE, RayPacket, split};
use crate::hittable::Sides;
use crate::simd::cpu::Cpu;
use crate::simd::soa::LANES;

/// Merges hits as [`PacketIntersect::closest_hits`] does by default. `find` computes brackets of the hits before some
/// ends.
///
/// [`PacketIntersect::closest_hits`]: super::shape::PacketIntersect::closest_hits
pub fn closest_by_brackets(
    cpu: Cpu,
    count: usize,
    id: u64,
    nearest: HitRecordMut,
    find: impl FnOnce(&[f64], (&mut [f64], &mut [f64])),
) -> bool {
    with_brackets(count, |near, far| {
        find(nearest.far, (&mut *near, &mut *far));
        ray_packet::closest_of_brackets(cpu, near, far, id, nearest)
    })
}

/// Marks rays as [`PacketIntersect::occluded`] does by default. `find` computes brackets of the hits.
///
/// [`PacketIntersect::occluded`]: super::shape::PacketIntersect::occluded
pub fn occluded_by_brackets(
    cpu: Cpu,
    t_max: &[f64],
    blocked: &mut [u64],
    doubt: &mut [u64],
    find: impl FnOnce((&mut [f64], &mut [f64])),
) -> bool {
    with_brackets(t_max.len(), |near, far| {
        find((&mut *near, &mut *far));
        ray_packet::occluded_by_brackets(cpu, near, far, t_max, blocked, doubt)
    })
}

/// Calls a function with arrays for the brackets of `count` rays: no longer than they need to be, as clearing them
/// takes time.
#[inline(always)]
fn with_brackets(count: usize, call: impl FnOnce(&mut [f64], &mut [f64]) -> bool) -> bool {
    if count <= LANES {
        let (mut near, mut far) = ([MISS; LANES], [MISS; LANES]);
        return call(&mut near[..count], &mut far[..count]);
    }
    let (mut near, mut far) = ([MISS; PACKET_SIZE], [MISS; PACKET_SIZE]);
    call(&mut near[..count], &mut far[..count])
}

/// Computes brackets of the first hits of a packet's rays. `find` searches for some of them together, each in its own
/// range.
pub(super) fn of_beams(
    rays: RayPacket,
    ends: &[f64],
    (near, far): (&mut [f64], &mut [f64]),
    can_hit_itself: Sides,
    find: impl Fn(RayPacket, &[RayRange], &mut [Bracket]),
) {
    for lanes in split(near.len(), BEAM) {
        let (rays, ends) = (rays.part(lanes.clone()), &ends[lanes.clone()]);
        let (mut ranges, mut brackets) = ([RayRange::ALL; BEAM], [Bracket::MISS; BEAM]);
        for (lane, end) in ends.iter().enumerate() {
            let is_missed = rays.side(lane).is_some_and(|side| !can_hit_itself.contain(side));
            // A range up to 0 has no hits.
            ranges[lane] = rays.range(lane, if is_missed { 0.0 } else { *end });
        }
        find(rays, &ranges[..ends.len()], &mut brackets[..ends.len()]);
        for (lane, bracket) in lanes.zip(&brackets) {
            (near[lane], far[lane]) = (bracket.near, bracket.far);
        }
    }
}
