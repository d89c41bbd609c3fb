//! Packets: rays by the dozen, an array for each coordinate, so that one call of a shape serves all of them and the
//! processor takes several at a time.
//!
//! A plugin is written for one ray. Loops over packets take its functions in and are compiled for each level of
//! instructions ([`cpu`](crate::simd::cpu)). Arrays are as long as a multiple of [`LANES`](crate::simd::soa::LANES); what
//! is beyond the last ray is a copy of it, and is computed and ignored.

use crate::geometry::ray::{Bracket, MISS, Ray};
use crate::simd::cpu::kernels;
use crate::simd::soa::View;
use std::ops::Range;

/// The most rays of a packet.
pub const PACKET_SIZE: usize = 256;

/// The lanes of so many rays in parts of at most so many, neighbours together.
pub fn split(count: usize, most: usize) -> impl Iterator<Item = Range<usize>> {
    (0..count).step_by(most).map(move |first| first..count.min(first + most))
}

/// Rays. A packet's rays all leave the same object, or none.
#[derive(Clone, Copy)]
pub struct RayPacket<'r> {
    /// Where each starts.
    pub origin: View<'r>,
    /// Where each goes, a unit vector.
    pub dir: View<'r>,
    /// How far at most any origin is from the point that it stands for, in world units; 0 for rays from the viewer.
    pub origin_error: f64,
}

impl RayPacket<'_> {
    /// How many there are.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.origin.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.origin.is_empty()
    }

    /// The one of this index.
    #[inline(always)]
    pub fn get(&self, index: usize) -> Ray {
        Ray { origin: self.origin.get(index), dir: self.dir.get(index) }
    }

    /// The first of them, so many.
    #[inline(always)]
    pub fn first(&self, count: usize) -> Self {
        Self { origin: self.origin.first(count), dir: self.dir.first(count), ..*self }
    }

    /// Some of them.
    #[inline(always)]
    pub fn part(&self, range: Range<usize>) -> Self {
        Self { origin: self.origin.part(range.clone()), dir: self.dir.part(range), ..*self }
    }
}

/// What the rays of a packet meet first, as far as it is known.
pub struct Nearest<'n> {
    /// The hit of the object in `met` is no nearer than this.
    pub near: &'n mut [f64],
    /// And no farther than this. Both are the same where it is known exactly, and the end of the search where nothing
    /// is met.
    pub far: &'n mut [f64],
    /// The object's index and 1; 0 for none.
    pub met: &'n mut [u64],
    /// Not 0 where brackets overlap: the nearer one of two is not known yet.
    pub doubt: &'n mut [u64],
}

impl Nearest<'_> {
    /// What is known of some of the rays.
    pub fn part(&mut self, range: Range<usize>) -> Nearest<'_> {
        Nearest {
            near: &mut self.near[range.clone()],
            far: &mut self.far[range.clone()],
            met: &mut self.met[range.clone()],
            doubt: &mut self.doubt[range],
        }
    }
}

kernels! {
    /// Compares brackets with the nearest so far. Tells whether any is in doubt.
    pub(crate) fn closest_of_brackets(near: &[f64], far: &[f64], id: u64, nearest: Nearest) -> bool {
        let count = nearest.near.len().min(near.len());
        let (near, far) = (&near[..count], &far[..count]);
        let known = Known { near, far };
        merge_nearest(count, &known, id, nearest.near, nearest.far, nearest.met, nearest.doubt)
    }

    /// Marks the rays that brackets say are blocked before their ends. Tells whether any is in doubt.
    pub(crate) fn occluded_by_brackets(
        near: &[f64], far: &[f64], t_max: &[f64], blocked: &mut [u64], doubt: &mut [u64]
    ) -> bool {
        let (near, far) = (&near[..t_max.len()], &far[..t_max.len()]);
        mark_occluded(&Known { near, far }, t_max, blocked, doubt)
    }
}

/// The brackets of rays, by lane. No closures: those are taken in only where it pleases the compiler.
pub(crate) trait Brackets {
    /// That of a hit before `far`.
    fn get(&self, lane: usize, far: f64) -> Bracket;
}

/// Brackets that are known.
struct Known<'b> {
    near: &'b [f64],
    far: &'b [f64],
}

impl Brackets for Known<'_> {
    #[inline(always)]
    fn get(&self, lane: usize, _far: f64) -> Bracket {
        Bracket { near: self.near[lane], far: self.far[lane] }
    }
}

/// Compares the brackets of so many rays with the nearest so far. Tells whether any is in doubt.
///
/// The arrays are arguments of their own, not a [`Nearest`], for the compiler to know that they are not the same: else it
/// looks at that each time, and takes single rays where there are few.
#[inline(always)]
pub(crate) fn merge_nearest(
    count: usize,
    brackets: &impl Brackets,
    id: u64,
    near: &mut [f64],
    far: &mut [f64],
    met: &mut [u64],
    doubt: &mut [u64],
) -> bool {
    let (near, far) = (&mut near[..count], &mut far[..count]);
    let (met, doubt) = (&mut met[..count], &mut doubt[..count]);
    let mut any = 0;
    for lane in 0..count {
        let Bracket { near: low, far: high } = brackets.get(lane, far[lane]);
        let is_nearer = high < near[lane];
        // Of two at the same distance the earlier one in the scene wins.
        let is_earlier = (low == far[lane]) & (met[lane] > id);
        let is_farther = (low >= far[lane]) & !is_earlier;
        // As the lesser of two, not as one or the other: of that the compiler would make stores that leave some lanes
        // out, which are slow where there is no AVX-512.
        let (low, high) = if is_nearer { (low, high) } else { (MISS, MISS) };
        near[lane] = if low < near[lane] { low } else { near[lane] };
        far[lane] = if high < far[lane] { high } else { far[lane] };
        met[lane] ^= if is_nearer { met[lane] ^ id } else { 0 };
        doubt[lane] = u64::from(!(is_nearer | is_farther));
        any |= doubt[lane];
    }
    any != 0
}

/// Marks the rays that brackets say are blocked before their ends. Tells whether any is in doubt.
#[inline(always)]
pub(crate) fn mark_occluded(
    brackets: &impl Brackets,
    t_max: &[f64],
    blocked: &mut [u64],
    doubt: &mut [u64],
) -> bool {
    let count = t_max.len();
    let (blocked, doubt) = (&mut blocked[..count], &mut doubt[..count]);
    let mut any = 0;
    for lane in 0..count {
        let Bracket { near: low, far: high } = brackets.get(lane, t_max[lane]);
        let (is_before, is_behind) = (high < t_max[lane], low >= t_max[lane]);
        blocked[lane] |= u64::from(is_before);
        doubt[lane] = u64::from(!(is_before | is_behind)) & !blocked[lane];
        any |= doubt[lane];
    }
    any != 0
}
