//! The last proofs of a thread about lines and meshes. After a proof of the hits of a packet's rays, a caller asks for
//! their faces.

use crate::geometry::ray_packet::PACKET_SIZE;
use crate::geometry::sight::Line;
use crate::world::certify::HitEnclosure;
use std::cell::Cell;
use tabray_exact::interval::Interval;

/// A line's first hit, and the hit face.
type Found = (HitEnclosure<f64>, usize);

/// The mesh and the ends of the line's intervals, as bits. No mesh has the number 0.
type Key = [u64; 13];

/// The number of places for a line each. There are more places than rays in a packet, and so few rays share one.
const PLACES: usize = 4 * PACKET_SIZE;

thread_local! {
    static KEPT: Cell<Vec<(Key, Option<Found>)>> = const { Cell::new(Vec::new()) };
}

/// Returns the stored result for exactly the same line and mesh, or finds it.
pub(super) fn found(mesh: u64, line: &Line<Interval>, find: impl FnOnce() -> Option<Found>) -> Option<Found> {
    let mut key = [mesh; 13];
    let ends = line.origin.iter().chain(&line.dir).flat_map(|part| [part.low, part.high]);
    key[1..].iter_mut().zip(ends).for_each(|(bits, end)| *bits = end.to_bits());
    // The high bits of the product depend on all bits of the numbers (Fibonacci hashing).
    let hash =
        key.iter().fold(0_u64, |hash, bits| (hash.rotate_left(5) ^ bits).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    let place = (hash >> 32) as usize % PLACES;
    let mut kept = KEPT.take();
    if kept.is_empty() {
        kept.resize(PLACES, ([0; 13], None));
    }
    let (last, known) = kept[place];
    let found = if last == key { known } else { find() };
    kept[place] = (key, found);
    KEPT.set(kept);
    found
}
