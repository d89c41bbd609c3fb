//! The faces hit by a thread's last rays. When a hit is shaded, its face need not be searched for again.
//!
//! A noted face is only used for exactly the same ray, distance and mesh, and so results do not depend on earlier rays.

use std::cell::Cell;
use tabray_world::geometry::ray::Ray;
use tabray_world::simd::soa::LANES;

/// The number of kept hits, enough for the rays of a packet with several meshes.
const SIZE: usize = 1024;

/// Faces by the rays that hit them, in the order of their notes.
pub(super) struct Memo {
    /// The distances, as bits.
    distances: Box<[u64; SIZE]>,
    entries: Box<[Entry]>,
    /// The place of the next note.
    next: usize,
    /// The place after the last hit that was found here. Hits are shaded in the order of their notes.
    after_last: usize,
}

/// A ray's first hit.
#[derive(Clone, Copy, Default)]
struct Entry {
    /// The mesh and the ray, as bits. No mesh has the number 0.
    key: [u64; 7],
    face: usize,
}

thread_local! {
    static MEMO: Cell<Option<Memo>> = const { Cell::new(None) };
}

impl Memo {
    /// Calls a function with this thread's memo.
    pub fn with<R>(call: impl FnOnce(&mut Self) -> R) -> R {
        let new = || Self {
            distances: Box::new([0; SIZE]),
            entries: vec![Entry::default(); SIZE].into_boxed_slice(),
            next: 0,
            after_last: 0,
        };
        let mut memo = MEMO.take().unwrap_or_else(new);
        let result = call(&mut memo);
        MEMO.set(Some(memo));
        result
    }

    /// Notes the face that a ray hits first, at a distance in world units.
    #[inline(always)]
    pub fn note(&mut self, mesh: u64, ray: &Ray, distance: f64, face: usize) {
        self.distances[self.next] = distance.to_bits();
        self.entries[self.next] = Entry { key: key(mesh, ray), face };
        self.next = (self.next + 1) % SIZE;
    }

    /// Returns the face that a ray hits at a distance in world units, if it was noted.
    #[inline(always)]
    pub fn face(&mut self, mesh: u64, ray: &Ray, distance: f64) -> Option<usize> {
        let (key, distance) = (key(mesh, ray), distance.to_bits());
        let is_at = |place: &usize| self.distances[*place] == distance && self.entries[*place].key == key;
        let place = Some(self.after_last).filter(is_at).or_else(|| {
            // Eight distances are compared at a time.
            let eights = self.distances.chunks_exact(LANES).zip((0..).step_by(LANES));
            let holds = |eight: &[u64]| eight.iter().fold(false, |any, other| any | (*other == distance));
            eights.filter(|(eight, _)| holds(eight)).find_map(|(_, first)| (first..first + LANES).find(is_at))
        })?;
        self.after_last = (place + 1) % SIZE;
        Some(self.entries[place].face)
    }
}

#[inline(always)]
fn key(mesh: u64, Ray { origin, dir }: &Ray) -> [u64; 7] {
    let bits = f64::to_bits;
    [mesh, bits(origin.x), bits(origin.y), bits(origin.z), bits(dir.x), bits(dir.y), bits(dir.z)]
}
