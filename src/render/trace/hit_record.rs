//! What the rays of a packet have met so far.

use super::arrays::resized;
use crate::geometry::ray::MISS;
use crate::geometry::ray_packet::Nearest;
use crate::simd::cpu::{Cpu, kernels};
use std::ops::Range;

/// What each ray of a packet meets first, and between which distances.
#[derive(Default)]
pub(super) struct HitRecord {
    pub near: Vec<f64>,
    pub far: Vec<f64>,
    /// The object's index and 1; 0 for none.
    pub met: Vec<u64>,
    pub doubt: Vec<u64>,
}

impl HitRecord {
    /// Nothing yet, before these ends, and counts the rays. Those that have cost as many as they may end where they
    /// begin; tells whether any has.
    pub fn begin(&mut self, cpu: Cpu, ray_budget: &mut [u32], count: usize, t_max: Option<&[f64]>) -> bool {
        let (near, far) = (resized(&mut self.near, count), resized(&mut self.far, count));
        // What is in doubt is written by each shape that is looked at.
        resized(&mut self.doubt, count);
        begin(cpu, &mut ray_budget[..count], t_max, near, far, resized(&mut self.met, count))
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
        ray_budget: &mut [u32], t_max: Option<&[f64]>, near: &mut [f64], far: &mut [f64], met: &mut [u64]
    ) -> bool {
        let (count, mut any_over) = (ray_budget.len(), 0);
        let (near, far, met) = (&mut near[..count], &mut far[..count], &mut met[..count]);
        match t_max {
            Some(t_max) => far.copy_from_slice(&t_max[..count]),
            None => far.fill(MISS),
        }
        for lane in 0..count {
            let is_over = ray_budget[lane] == 0;
            let end = if is_over { 0.0 } else { far[lane] };
            (near[lane], far[lane], met[lane]) = (end, end, 0);
            ray_budget[lane] -= u32::from(!is_over);
            any_over |= u32::from(is_over);
        }
        any_over != 0
    }
}
