//! Runs of slabs. A ray that passes outside of a run skips all of its slabs at once.
//!
//! A profile with thousands of waves has tens of thousands of slabs, and testing each ray against all of them would be
//! slow.

use super::slab::Slab;
use std::ops::Range;

/// The number of slabs in a run of each level.
const LENGTHS: [usize; 3] = [16, 256, 4096];

/// The runs of slabs, on levels of increasing lengths.
pub(super) struct Runs([Vec<Slab>; LENGTHS.len()]);

impl Runs {
    /// Returns the runs of slabs. Slabs that do not fill a run are in none.
    pub fn new(slabs: &[Slab]) -> Self {
        Self(LENGTHS.map(|length| slabs.chunks_exact(length).map(around).collect()))
    }

    /// Returns the runs that start at a slab, upward or downward, and lie within a range, shortest first. Each has the
    /// indices of its slabs, their heights and their maximum square.
    #[inline(always)]
    pub fn starting(
        &self,
        index: usize,
        is_upward: bool,
        within: Range<usize>,
    ) -> impl Iterator<Item = (Range<usize>, &Slab)> {
        let levels = LENGTHS.into_iter().zip(&self.0);
        levels.map_while(move |(length, runs)| {
            let boundary = if is_upward { index } else { index + 1 };
            let start = index - index % length;
            let slabs = start..start + length;
            let is_within =
                boundary.is_multiple_of(length) && within.start <= slabs.start && slabs.end <= within.end;
            is_within.then(|| runs.get(index / length).map(|run| (slabs, run))).flatten()
        })
    }
}

/// Returns the heights and the maximum square of a run of slabs.
fn around(slabs: &[Slab]) -> Slab {
    let max_square = slabs.iter().map(|slab| slab.max_square).fold(0.0, f64::max);
    Slab { max_square, is_void: false, ..Slab::void(slabs[0].from, slabs[slabs.len() - 1].to) }
}
