//! Which faces a thread's last rays hit: what the search for a hit finds out need not be searched for again where the
//! hit is shaded.
//!
//! A face is taken from here only for the very ray, distance and mesh for which it was found, so that no result depends
//! on what was traced before.

use crate::geometry::ray::Ray;
use std::cell::Cell;

/// The number of faces: a few for each ray of a packet, so that few take the places of others.
const SIZE: usize = 1024;

/// Faces by the rays that hit them.
pub(super) struct Memo {
    entries: Box<[Entry]>,
}

/// A ray's first hit.
#[derive(Clone, Copy)]
struct Entry {
    /// The mesh, the ray and the distance, as bits.
    key: [u64; 8],
    face: usize,
}

thread_local! {
    static MEMO: Cell<Option<Memo>> = const { Cell::new(None) };
}

impl Memo {
    /// Calls a function with this thread's memo.
    pub fn with<R>(call: impl FnOnce(&mut Self) -> R) -> R {
        // No mesh has the number 0.
        let new = || Self { entries: vec![Entry { key: [0; 8], face: 0 }; SIZE].into_boxed_slice() };
        let mut memo = MEMO.take().unwrap_or_else(new);
        let result = call(&mut memo);
        MEMO.set(Some(memo));
        result
    }

    /// Notes the face that a ray hits first, at a distance in world units.
    #[inline(always)]
    pub fn note(&mut self, mesh: u64, ray: &Ray, distance: f64, face: usize) {
        let key = key(mesh, ray, distance);
        self.entries[place(&key)] = Entry { key, face };
    }

    /// Returns the face that a ray hits at a distance in world units, if it was noted.
    #[inline(always)]
    pub fn face(&self, mesh: u64, ray: &Ray, distance: f64) -> Option<usize> {
        let key = key(mesh, ray, distance);
        let entry = &self.entries[place(&key)];
        (entry.key == key).then_some(entry.face)
    }
}

#[inline(always)]
fn key(mesh: u64, Ray { origin, dir }: &Ray, distance: f64) -> [u64; 8] {
    let [x, y, z, u, v, w, distance] =
        [origin.x, origin.y, origin.z, dir.x, dir.y, dir.z, distance].map(f64::to_bits);
    [mesh, x, y, z, u, v, w, distance]
}

/// Returns the place of a key: that of its distance, whose last digits differ from ray to ray.
#[inline(always)]
fn place(key: &[u64; 8]) -> usize {
    // Fibonacci hashing (Knuth, "The Art of Computer Programming", volume 3, 6.4).
    ((key[7] ^ key[4]).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32) as usize % SIZE
}
