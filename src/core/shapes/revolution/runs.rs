//! Runs of slabs, which a ray that passes outside of them skips at once.
//!
//! A profile with thousands of waves has tens of thousands of slabs, and each ray would be tested against all of them.

use super::slab::Slab;
use std::ops::Range;

/// The number of slabs in the runs of each level.
const LENGTHS: [usize; 3] = [16, 256, 4096];

/// The runs of slabs, on levels of increasing lengths.
pub(super) struct Runs([Vec<Slab>; LENGTHS.len()]);

impl Runs {
    /// Returns the runs of slabs. Slabs that do not fill a run are in none.
    pub fn new(slabs: &[Slab]) -> Self {
        Self(LENGTHS.map(|length| slabs.chunks_exact(length).map(around).collect()))
    }

    /// Returns the runs that begin with a slab upward, or end with it downward, and lie within a range: the slabs of
    /// each, and their heights and largest square. The shortest comes first.
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

/// Returns the heights and the largest square of a run of slabs.
fn around(slabs: &[Slab]) -> Slab {
    let max_square = slabs.iter().map(|slab| slab.max_square).fold(0.0, f64::max);
    Slab { max_square, is_void: false, ..Slab::void(slabs[0].from, slabs[slabs.len() - 1].to) }
}
