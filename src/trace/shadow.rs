//! How much of a light comes to the places of a surface.

use super::group::{Group, Parts, pick, pick_vectors};
use super::shade::Surface;
use super::{NARROW, Tracer};
use crate::accuracy::Accuracy;
use crate::bounds::Bounds;
use crate::cpu::kernels;
use crate::geometry::Side;
use crate::packet::{Rays, STEP, Vectors, View};
use crate::watch::{Count, Event, Kind, Purpose, Watch};

/// The ways from the places of a surface to a light.
pub(super) struct Ways<'w, const N: usize> {
    /// Where they go.
    pub region: Bounds,
    /// The directions there.
    pub toward: &'w Vectors<N>,
    /// How far it is.
    pub distances: &'w [f64; N],
}

/// What comes of light on its way to a packet's places.
pub(super) struct Passed<const N: usize> {
    /// The part of each channel that gets there.
    pub tint: Vectors<N>,
    /// The opaque object that stands in the way, by its index and 1; 0 where there is none.
    pub blocker: [u64; N],
}

impl<W: Watch> Tracer<'_, '_, W> {
    /// What the ends of the ways are short of the light, as a part of how far that is: a surface that the light lies
    /// on is no blocker, however rounding has it.
    fn slack(&self) -> f64 {
        match self.model.camera.value.accuracy {
            Accuracy::Classic => 0.0,
            _ => 16.0 * f64::EPSILON,
        }
    }

    /// Takes the light away (0 in `shines`) where an object stands in its way, in a scene without glass.
    pub(super) fn shadow<const N: usize>(
        &mut self,
        group: &mut Group<N>,
        surface: &Surface<N>,
        ways: &Ways<N>,
        shines: &mut [u64; N],
    ) {
        let count = group.padded();
        let mut ends = [0.0; N];
        let points = surface.points.view(count);
        aim(
            self.cpu,
            points,
            &ways.distances[..count],
            self.slack(),
            &shines[..],
            &group.budget[..],
            &mut ends,
        );
        // A ray that has cost as many as it may finds nothing in the way.
        let len = ends[..group.len].iter().filter(|end| **end > 0.0).count();
        if len == 0 {
            return;
        }
        for (budget, end) in group.budget[..group.len].iter_mut().zip(&ends) {
            *budget -= u32::from(*end > 0.0);
        }
        self.watch.count(Count::Rays(Kind::Shadow, len));
        let mut blocked = [0; N];
        if 2 * len > group.len {
            let rays = Rays { origin: surface.points.view(count), dir: ways.toward.view(count) };
            let leaves = (surface.index, &surface.sides[..count]);
            self.blocked(rays, len, &ends[..count], leaves, &ways.region, &mut blocked[..count]);
            darken(self.cpu, &blocked[..count], &mut shines[..]);
            return;
        }
        let (mut lanes, mut found) = ([0; N], 0);
        for (lane, end) in ends.iter().enumerate().take(group.len) {
            if *end > 0.0 {
                lanes[found] = lane as u8;
                found += 1;
            }
        }
        let lanes = &lanes[..len];
        let count = len.next_multiple_of(STEP);
        let (origin, dir): (Vectors<N>, Vectors<N>) =
            (pick_vectors(&surface.points, lanes), pick_vectors(ways.toward, lanes));
        let (ends, sides): ([f64; N], [Side; N]) = (pick(&ends, lanes), pick(&surface.sides, lanes));
        let rays = Rays { origin: origin.view(count), dir: dir.view(count) };
        let leaves = (surface.index, &sides[..count]);
        self.blocked(rays, len, &ends[..count], leaves, &ways.region, &mut blocked[..count]);
        for (lane, blocked) in lanes.iter().zip(&blocked) {
            shines[usize::from(*lane)] &= u64::from(*blocked == 0);
        }
    }

    /// What comes through of the light that shines on some places, in a scene with glass.
    pub(super) fn passed<const N: usize>(
        &mut self,
        group: &mut Group<N>,
        surface: &Surface<N>,
        ways: &Ways<N>,
        shines: &[u64; N],
    ) -> Passed<N> {
        let (mut ends, count) = ([0.0; N], group.padded());
        let points = surface.points.view(count);
        // Those that have cost as many as they may go, too: they find nothing.
        let distances = &ways.distances[..count];
        aim(self.cpu, points, distances, self.slack(), &shines[..], &[1; N], &mut ends);
        let (mut lanes, mut len) = ([0; N], 0);
        for lane in 0..group.len {
            lanes[len] = lane as u8;
            len += usize::from(shines[lane] != 0);
        }
        let lanes = &lanes[..len];
        let mut part = Group::<N> {
            len,
            origin: pick_vectors(&surface.points, lanes),
            dir: pick_vectors(ways.toward, lanes),
            travelled: [0.0; N],
            budget: pick(&group.budget, lanes),
            camera: [0; N],
            leaves: Some(surface.index),
            sides: pick(&surface.sides, lanes),
        };
        let open = Passed { tint: Vectors { x: [1.0; N], y: [1.0; N], z: [1.0; N] }, blocker: [0; N] };
        let ways = self.walk(&mut part, &pick(&ends, lanes), open);
        let mut passed = Passed { tint: Vectors::ZERO, blocker: [0; N] };
        for (index, lane) in lanes.iter().enumerate() {
            let lane = usize::from(*lane);
            passed.tint.set(lane, ways.tint.get(index));
            passed.blocker[lane] = ways.blocker[index];
            group.budget[lane] = part.budget[index];
        }
        passed
    }

    /// Goes on toward a light, through glass, from where `passed` has come through.
    fn walk<const N: usize>(
        &mut self,
        group: &mut Group<N>,
        ends: &[f64; N],
        mut passed: Passed<N>,
    ) -> Passed<N> {
        self.watch.count(Count::Rays(Kind::Shadow, group.len));
        if W::SEES {
            self.watch.see(Event::Begin(Purpose::Shadow { distance: ends[0] }));
        }
        let found = self.closest(group, Some(ends));
        let mut parts = Parts::new(&found.met[..group.len]);
        while let Some((id, lanes)) = parts.next() {
            let Some(index) = (id as usize).checked_sub(1) else { continue };
            if self.model.objects[index].material.transparency == 0.0 {
                for lane in lanes {
                    passed.blocker[usize::from(*lane)] = id;
                }
                continue;
            }
            for lanes in lanes.chunks(if lanes.len() > NARROW && self.is_shallow() { N } else { NARROW }) {
                let (near, far) = (&found.near, &found.far);
                if lanes.len() <= NARROW {
                    self.pane::<N, NARROW>(group, (ends, near, far), index, lanes, &mut passed);
                } else {
                    self.pane::<N, N>(group, (ends, near, far), index, lanes, &mut passed);
                }
            }
        }
        passed
    }

    /// Goes through one object of glass.
    fn pane<const N: usize, const M: usize>(
        &mut self,
        group: &mut Group<N>,
        (ends, near, far): (&[f64; N], &[f64; N], &[f64; N]),
        index: usize,
        lanes: &[u8],
        passed: &mut Passed<N>,
    ) {
        let mut part = group.pick::<M>(lanes);
        let distances = self.settle(&part, &pick(near, lanes), &pick(far, lanes), index);
        let object = &self.model.objects[index];
        let mut ends: [f64; M] = pick(ends, lanes);
        let mut tint: Vectors<M> = pick_vectors(&passed.tint, lanes);
        for lane in 0..part.padded() {
            let ray = part.rays().get(lane);
            let point = ray.at(distances[lane]);
            part.sides[lane] = Side::seen_along(ray.dir, object.shape.normal(point)).opposite();
            part.origin.set(lane, point);
            tint.set(lane, tint.get(lane) * object.tint(point));
            ends[lane] -= distances[lane];
        }
        part.leaves = Some(index);
        self.depth += 1;
        let onward = self.walk(&mut part, &ends, Passed { tint, blocker: [0; M] });
        self.depth -= 1;
        for (index, lane) in lanes.iter().enumerate() {
            let lane = usize::from(*lane);
            passed.tint.set(lane, onward.tint.get(index));
            passed.blocker[lane] = onward.blocker[index];
            group.budget[lane] = part.budget[index];
        }
    }
}

kernels! {
    /// Takes the light away where it is blocked.
    fn darken(blocked: &[u64], shines: &mut [u64]) {
        let count = blocked.len();
        let shines = &mut shines[..count];
        for lane in 0..count {
            shines[lane] &= u64::from(blocked[lane] == 0);
        }
    }

    /// Where the ways from points to a light end, as far as its distances go; 0 for those that need not be gone.
    fn aim(points: View, distances: &[f64], slack: f64, shines: &[u64], budget: &[u32], ends: &mut [f64]) {
        let count = distances.len();
        let (points, shines, budget) = (points.first(count), &shines[..count], &budget[..count]);
        let ends = &mut ends[..count];
        for lane in 0..count {
            let reach = points.get(lane).abs();
            let across = if reach.x > reach.y { reach.x } else { reach.y };
            let reach = if across > reach.z { across } else { reach.z };
            let end = distances[lane] - slack * (distances[lane] + reach);
            ends[lane] = if (shines[lane] != 0) & (budget[lane] != 0) { end } else { 0.0 };
        }
    }
}
