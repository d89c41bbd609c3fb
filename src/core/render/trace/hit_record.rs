//! The closest hits of a packet's rays so far.

use super::arrays::resized;
use crate::geometry::ray::MISS;
use crate::geometry::ray_packet::Nearest;
use crate::simd::cpu::{Cpu, kernels};
use std::ops::Range;

/// The object that each ray of a packet hits first, and a bracket of the distance.
#[derive(Default)]
pub(super) struct HitRecord {
    /// The lower bounds of the distances, in world units.
    pub near: Vec<f64>,
    /// The upper bounds of the distances, in world units.
    pub far: Vec<f64>,
    /// The object's index plus 1; 0 for no object.
    pub met: Vec<u64>,
    /// Not 0 where the last tested object's bracket overlaps that of another one.
    pub doubt: Vec<u64>,
}

impl HitRecord {
    /// Starts with no hits before `t_max`, and charges each ray to its budget. Rays whose budget is used up end at 0.
    /// Returns whether there are any such rays.
    pub fn begin(&mut self, cpu: Cpu, ray_budget: &mut [u32], count: usize, t_max: Option<&[f64]>) -> bool {
        let (near, far) = (resized(&mut self.near, count), resized(&mut self.far, count));
        // Each shape that is tested overwrites `doubt`.
        resized(&mut self.doubt, count);
        begin(cpu, &mut ray_budget[..count], t_max, near, far, resized(&mut self.met, count))
    }

    /// Borrows the hits of some of the rays.
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
    /// Starts rays with no hits and charges each to its budget. Returns whether the budget of any is used up.
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
