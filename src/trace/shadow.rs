//! How much of a light comes to the places of a surface.

use super::Tracer;
use super::block::Leaving;
use super::group::{Group, Onward};
use super::room::{Vectors, pick, room};
use super::shade::Surface;
use crate::accuracy::Accuracy;
use crate::bounds::Bounds;
use crate::cpu::kernels;
use crate::geometry::Side;
use crate::packet::{Rays, STEP};
use crate::watch::{Count, Kind, Watch};

/// The ways from the places of a surface to a light.
pub(super) struct Ways<'w> {
    /// Where those places are.
    pub from: Bounds,
    /// Where they go.
    pub to: Bounds,
    /// The directions there.
    pub toward: &'w Vectors,
}

impl<'w> Ways<'w> {
    /// As ways on from a surface.
    pub fn onward(&self, surface: &'w Surface) -> Onward<'w> {
        let Surface { index, points, sides, travelled, .. } = surface;
        Onward { points, dir: self.toward, travelled, leaves: *index, sides }
    }
}

/// Room for the shadows of a packet.
#[derive(Default)]
pub(super) struct Shadows {
    blocked: Vec<u64>,
    /// Those that remain of a packet.
    lanes: Vec<u8>,
    origin: Vectors,
    dir: Vectors,
    their_ends: Vec<f64>,
    sides: Vec<Side>,
}

impl<W: Watch> Tracer<'_, '_, W> {
    /// What the ends of the ways are short of the light, as a part of how far that is: a surface that the light lies
    /// on is no blocker, however rounding has it.
    pub(super) fn slack(&self) -> f64 {
        match self.model.camera.value.accuracy {
            Accuracy::Classic => 0.0,
            _ => 16.0 * f64::EPSILON,
        }
    }

    /// Takes the light away (0 in `shines`) where an object stands in its way, in a scene without glass.
    pub(super) fn shadow(
        &mut self,
        group: &mut Group,
        surface: &Surface,
        ways: &Ways,
        ends: &mut [f64],
        shadows: &mut Shadows,
        shines: &mut [u64],
    ) {
        let (cpu, count) = (self.cpu, group.padded());
        let Shadows { blocked, lanes, origin, dir, their_ends, sides } = shadows;
        let blocked = room(blocked, count);
        // A ray that has cost as many as it may finds nothing in the way.
        let len = set_out(cpu, group.len, &mut group.budget[..count], ends, blocked);
        if len == 0 {
            return;
        }
        self.watch.count(Count::Rays(Kind::Shadow, len));
        if 2 * len > group.len {
            let rays = Rays { origin: surface.points.view(count), dir: ways.toward.view(count) };
            let sides = &surface.sides[..count];
            let leaving = Leaving { rays, len: group.len, ends, object: surface.index, sides };
            self.block(&leaving, &ways.from, &ways.to, blocked);
            darken(cpu, blocked, ends, shines);
            return;
        }
        lanes.clear();
        lanes.extend((0..group.len).filter(|lane| ends[*lane] > 0.0).map(|lane| lane as u8));
        let count = len.next_multiple_of(STEP);
        origin.pick(&surface.points, lanes, count);
        dir.pick(ways.toward, lanes, count);
        pick(their_ends, ends, lanes, count);
        pick(sides, &surface.sides, lanes, count);
        let blocked = &mut blocked[..count];
        blocked.fill(0);
        let rays = Rays { origin: origin.view(count), dir: dir.view(count) };
        let (ends, sides) = (&their_ends[..count], &sides[..count]);
        let leaving = Leaving { rays, len, ends, object: surface.index, sides };
        self.block(&leaving, &ways.from, &ways.to, blocked);
        for (lane, blocked) in lanes.iter().zip(blocked) {
            shines[usize::from(*lane)] &= u64::from(*blocked == 0);
        }
    }
}

kernels! {
    /// Takes the light away where it is blocked on a way that had to be gone.
    fn darken(blocked: &[u64], ends: &[f64], shines: &mut [u64]) {
        let count = blocked.len();
        let (ends, shines) = (&ends[..count], &mut shines[..count]);
        for lane in 0..count {
            shines[lane] &= u64::from((blocked[lane] == 0) | (ends[lane] == 0.0));
        }
    }

    /// Counts a ray for each way to a light. Those of rays that have cost as many as they may need not be gone. What need
    /// not is blocked; tells how many of the first `len` are left.
    fn set_out(len: usize, budget: &mut [u32], ends: &mut [f64], blocked: &mut [u64]) -> usize {
        let (count, mut left) = (ends.len(), 0);
        let (budget, blocked) = (&mut budget[..count], &mut blocked[..count]);
        for lane in 0..count {
            let goes = (ends[lane] > 0.0) & (budget[lane] > 0);
            ends[lane] = if goes { ends[lane] } else { 0.0 };
            blocked[lane] = u64::from(!goes);
            budget[lane] -= u32::from(goes);
            left += u64::from(goes & (lane < len));
        }
        left as usize
    }
}
