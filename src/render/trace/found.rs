//! What the rays of a packet have met so far.

use super::arrays::room;
use crate::geometry::packet::Nearest;
use crate::geometry::ray::MISS;
use crate::simd::cpu::{Cpu, kernels};
use std::ops::Range;

/// What each ray of a packet meets first, and between which distances.
#[derive(Default)]
pub(super) struct Found {
    pub near: Vec<f64>,
    pub far: Vec<f64>,
    /// The object's index and 1; 0 for none.
    pub met: Vec<u64>,
    pub doubt: Vec<u64>,
}

impl Found {
    /// Nothing yet, before these ends, and counts the rays. Those that have cost as many as they may end where they
    /// begin; tells whether any has.
    pub fn begin(&mut self, cpu: Cpu, budget: &mut [u32], count: usize, ends: Option<&[f64]>) -> bool {
        let (near, far) = (room(&mut self.near, count), room(&mut self.far, count));
        // What is in doubt is written by each shape that is looked at.
        room(&mut self.doubt, count);
        begin(cpu, &mut budget[..count], ends, near, far, room(&mut self.met, count))
    }

    /// Of some of the rays.
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
    /// Counts rays, which have met nothing yet. Tells whether any has cost as many as it may.
    fn begin(
        budget: &mut [u32], ends: Option<&[f64]>, near: &mut [f64], far: &mut [f64], met: &mut [u64]
    ) -> bool {
        let (count, mut any_over) = (budget.len(), 0);
        let (near, far, met) = (&mut near[..count], &mut far[..count], &mut met[..count]);
        match ends {
            Some(ends) => far.copy_from_slice(&ends[..count]),
            None => far.fill(MISS),
        }
        for lane in 0..count {
            let is_over = budget[lane] == 0;
            let end = if is_over { 0.0 } else { far[lane] };
            (near[lane], far[lane], met[lane]) = (end, end, 0);
            budget[lane] -= u32::from(!is_over);
            any_over |= u32::from(is_over);
        }
        any_over != 0
    }
}
