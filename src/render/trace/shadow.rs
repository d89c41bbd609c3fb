//! How much of a light comes to the places of a surface.

use super::arrays::{Vectors, pick, room};
use super::block::Leaving;
use super::context::Tracer;
use super::group::Group;
use super::scratch::Shadows;
use super::surface::Surface;
use crate::geometry::bounds::Bounds;
use crate::geometry::packet::Rays;
use crate::render::watch::{Count, Kind, Watch};
use crate::simd::cpu::kernels;
use crate::simd::soa::STEP;

/// The ways from the places of a surface to a light.
pub(super) struct Ways<'w> {
    /// Where those places are.
    pub from: Bounds,
    /// Where they go.
    pub to: Bounds,
    /// The directions there.
    pub toward: &'w Vectors,
}

/// Of a way that need not be gone, which nothing blocks.
const NOT_GONE: u64 = 2;

impl<W: Watch> Tracer<'_, '_, W> {
    /// What the ends of the ways are short of the light, as a part of how far that is: a surface that the light lies
    /// on is no blocker, however rounding has it.
    pub(super) fn slack(&self) -> f64 {
        if self.is_classic() { 0.0 } else { 16.0 * f64::EPSILON }
    }

    /// Marks the places (1 in `blocked`) from which an object stands in the way of the light, in a scene without glass.
    pub(super) fn shadow(
        &mut self,
        group: &mut Group,
        surface: &Surface,
        ways: &Ways,
        ends: &mut [f64],
        shadows: &mut Shadows,
        blocked: &mut [u64],
    ) {
        let (cpu, count) = (self.cpu, group.padded());
        let Shadows { lanes, origin, dir, their_ends, their_blocked, sides } = shadows;
        let origin_error = surface.errors.most;
        // A ray that has cost as many as it may finds nothing in the way.
        let len = set_out(cpu, group.len, &mut group.budget[..count], ends, blocked);
        if len == 0 {
            return;
        }
        self.watch.count(Count::Rays(Kind::Shadow, len));
        if 2 * len > group.len {
            let rays =
                Rays { origin: surface.points.view(count), dir: ways.toward.view(count), origin_error };
            let sides = &surface.sides[..count];
            let leaving = Leaving { rays, len: group.len, going: len, ends, surface, lanes: None, sides };
            self.block(&leaving, &ways.from, &ways.to, blocked);
            return;
        }
        lanes.clear();
        lanes.extend((0..group.len).filter(|lane| ends[*lane] > 0.0).map(|lane| lane as u8));
        let count = len.next_multiple_of(STEP);
        origin.pick(&surface.points, lanes, count);
        dir.pick(ways.toward, lanes, count);
        pick(their_ends, ends, lanes, count);
        pick(sides, &surface.sides, lanes, count);
        let theirs = room(their_blocked, count);
        theirs.fill(0);
        let rays = Rays { origin: origin.view(count), dir: dir.view(count), origin_error };
        let (ends, sides) = (&their_ends[..count], &sides[..count]);
        let leaving = Leaving { rays, len, going: len, ends, surface, lanes: Some(lanes), sides };
        self.block(&leaving, &ways.from, &ways.to, theirs);
        for (lane, is_blocked) in lanes.iter().zip(theirs) {
            blocked[usize::from(*lane)] = *is_blocked;
        }
    }
}

kernels! {
    /// Counts a ray for each way to a light. Those of rays that have cost as many as they may need not be gone. What need
    /// not is marked with [`NOT_GONE`]; tells how many of the first `len` are left.
    fn set_out(len: usize, budget: &mut [u32], ends: &mut [f64], blocked: &mut [u64]) -> usize {
        let (count, mut left) = (ends.len(), 0);
        let (budget, blocked) = (&mut budget[..count], &mut blocked[..count]);
        for lane in 0..count {
            let goes = (ends[lane] > 0.0) & (budget[lane] > 0);
            ends[lane] = if goes { ends[lane] } else { 0.0 };
            blocked[lane] = if goes { 0 } else { NOT_GONE };
            budget[lane] -= u32::from(goes);
            left += u64::from(goes & (lane < len));
        }
        left as usize
    }
}
