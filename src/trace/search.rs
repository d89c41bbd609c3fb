//! What the rays of a packet meet first.

use super::Tracer;
use super::group::Group;
use crate::bounds::{self, Bounds, Bundle};
use crate::geometry::{MISS, Ray, Side, Span};
use crate::packet::{Nearest, Rays, Vectors, WIDE};
use crate::tree::Visitor;
use crate::watch::{Count, Event, Hit, Reason, Watch};

/// What each ray of a packet meets first, and between which distances.
pub(super) struct Found<const N: usize> {
    pub near: [f64; N],
    pub far: [f64; N],
    /// The object's index and 1; 0 for none.
    pub met: [u64; N],
}

impl<'m, W: Watch> Tracer<'m, '_, W> {
    /// What each ray meets first before its end, if it has one. A ray that has cost as many as it may meets nothing.
    pub(super) fn closest<const N: usize>(
        &mut self,
        group: &mut Group<N>,
        ends: Option<&[f64; N]>,
    ) -> Found<N> {
        let ends = ends.unwrap_or(&[MISS; N]);
        let mut found = Found { near: *ends, far: *ends, met: [0; N] };
        if W::SEES && group.budget[0] == 0 {
            self.watch.see(Event::Dropped(Reason::TooMany));
            return found;
        }
        for lane in 0..group.len {
            found.near[lane] = if group.budget[lane] == 0 { 0.0 } else { found.near[lane] };
            group.budget[lane] = group.budget[lane].saturating_sub(1);
        }
        found.far = found.near;
        if W::SEES {
            self.closest_seen(group, &mut found);
            return found;
        }
        let doubt = [0; N];
        let mut ahead = std::mem::take(&mut self.ahead);
        let mut search = Closest { tracer: self, group, found: &mut found, doubt, inverse: Vectors::ZERO };
        search.run(&mut ahead);
        self.ahead = ahead;
        found
    }

    /// What one ray meets first, with all that leads to it told.
    fn closest_seen<const N: usize>(&mut self, group: &Group<N>, found: &mut Found<N>) {
        let ray = group.rays().get(0);
        self.watch.see(Event::Search(&ray));
        for index in 0..self.model.objects.len() {
            let shape = &*self.model.objects[index].shape;
            let leaves = group.sides_of(index).map(|sides| sides[0]);
            if leaves.is_some() && shape.is_convex() {
                self.watch.see(Event::Tested(index, None));
                continue;
            }
            let distance = shape.distance(&ray, &Span { far: found.far[0], leaves, ..Span::RAY });
            self.watch.see(Event::Tested(index, Some(distance)));
            if distance < found.far[0] {
                (found.near[0], found.far[0], found.met[0]) = (distance, distance, index as u64 + 1);
            }
        }
        let hit = (found.met[0] as usize).checked_sub(1).map(|index| Hit {
            index,
            object: &self.model.objects[index],
            distance: found.far[0],
            point: ray.at(found.far[0]),
        });
        self.watch.see(Event::Met(hit.as_ref()));
    }

    /// The distances at which the rays of a packet meet an object, known to lie between `near` and `far`.
    pub(super) fn settle<const N: usize>(
        &mut self,
        group: &Group<N>,
        near: &[f64; N],
        far: &[f64; N],
        object: usize,
    ) -> [f64; N] {
        let (len, count) = (group.len, group.padded());
        let mut distances = *near;
        if near[..len] != far[..len] {
            let shape = &*self.model.objects[object].shape;
            let sides = group.sides_of(object);
            let brackets = (&near[..count], &far[..count]);
            shape.distances(self.cpu, group.rays(), sides, brackets, &mut distances[..count]);
            for lane in 0..len {
                if near[lane] == far[lane] {
                    distances[lane] = near[lane];
                } else if distances[lane].is_nan() {
                    let leaves = sides.map(|sides| sides[lane]);
                    distances[lane] = exact(shape, &group.rays().get(lane), leaves, MISS);
                }
                debug_assert!(
                    near[lane] <= distances[lane] && distances[lane] <= far[lane],
                    "the bracket {} to {} of `{}` does not hold {}",
                    near[lane],
                    far[lane],
                    self.model.objects[object].args.entity.name,
                    distances[lane]
                );
            }
        }
        // What is beyond the last ray goes on as a copy of it: what plain arithmetic left open there is no number, and
        // would make no box of the places.
        let last = distances[len - 1];
        distances[len..count].fill(last);
        distances
    }

    /// Marks the rays that an object blocks before their ends: so many, and copies that fill the arrays up. All leave the
    /// same object, or none.
    pub(super) fn blocked(
        &mut self,
        rays: Rays,
        len: usize,
        ends: &[f64],
        (leaves, sides): (usize, &[Side]),
        region: &Bounds,
        blocked: &mut [u64],
    ) {
        let mut ahead = std::mem::take(&mut self.ahead);
        let mut search = Blocked {
            tracer: self,
            rays,
            len,
            ends,
            leaves,
            sides,
            region: region.with_slack(0.0),
            inverse: Vectors::ZERO,
            blocked,
        };
        search.run(&mut ahead);
        self.ahead = ahead;
    }
}

/// A shape's exact distance on one ray.
fn exact(shape: &dyn crate::geometry::Hittable, ray: &Ray, leaves: Option<Side>, far: f64) -> f64 {
    shape.distance(ray, &Span { far, leaves, ..Span::RAY })
}

struct Closest<'s, 'm, 'w, W, const N: usize> {
    tracer: &'s mut Tracer<'m, 'w, W>,
    group: &'s Group<N>,
    found: &'s mut Found<N>,
    doubt: [u64; N],
    /// The reciprocals of the rays' directions, for a tree.
    inverse: Vectors<N>,
}

impl<W: Watch, const N: usize> Closest<'_, '_, '_, W, N> {
    fn run(&mut self, ahead: &mut Vec<usize>) {
        let plan = self.tracer.plan;
        let cpu = self.tracer.cpu;
        let bundle = plan.has_bounds.then(|| {
            let rays = self.group.rays();
            Bundle::new(bounds::around(cpu, rays.origin), bounds::around(cpu, rays.dir))
        });
        for index in &plan.listed {
            match (&plan.bounds[*index], &bundle) {
                (Some(bounds), Some(bundle)) if !bundle.may_meet(bounds) => {
                    self.tracer.watch.count(Count::Culled(*index, self.group.len));
                }
                _ => self.object(*index),
            }
        }
        if let Some(tree) = &plan.tree {
            for lane in 0..self.group.padded() {
                self.inverse.set(lane, self.group.dir.get(lane).recip());
            }
            tree.visit(self.group.dir.get(0), ahead, self);
        }
    }

    /// Which of two objects one ray meets first, where brackets do not tell.
    fn decide(&mut self, lane: usize, index: usize, leaves: Option<Side>) {
        let objects = &self.tracer.model.objects;
        let ray = self.group.rays().get(lane);
        let (near, far, met) =
            (&mut self.found.near[lane], &mut self.found.far[lane], &mut self.found.met[lane]);
        if near != far {
            let rival = *met as usize - 1;
            let rival_leaves = self.group.sides_of(rival).map(|sides| sides[lane]);
            *near = exact(&*objects[rival].shape, &ray, rival_leaves, MISS);
            *far = *near;
        }
        // Of two at the same distance the earlier one in the scene wins.
        let id = index as u64 + 1;
        let end = if *met > id { far.next_up() } else { *far };
        let distance = exact(&*objects[index].shape, &ray, leaves, end);
        if distance < end {
            (*near, *far, *met) = (distance, distance, id);
        }
    }
}

impl<W: Watch, const N: usize> Visitor for Closest<'_, '_, '_, W, N> {
    fn enters(&mut self, bounds: &Bounds) -> bool {
        let count = self.group.padded();
        let ends = &self.found.far[..count];
        bounds::any_meets(self.tracer.cpu, self.group.rays(), self.inverse.view(count), ends, bounds)
    }

    fn object(&mut self, index: usize) {
        let shape = &*self.tracer.model.objects[index].shape;
        let sides = self.group.sides_of(index);
        if sides.is_some() && shape.is_convex() {
            return;
        }
        self.tracer.watch.count(Count::Tested(index, self.group.len));
        let nearest = Nearest {
            near: &mut self.found.near,
            far: &mut self.found.far,
            met: &mut self.found.met,
            doubt: &mut self.doubt,
        };
        if shape.meet(self.tracer.cpu, self.group.rays(), sides, index as u64 + 1, nearest) {
            for lane in 0..self.group.len {
                if self.doubt[lane] != 0 {
                    self.decide(lane, index, sides.map(|sides| sides[lane]));
                }
            }
        }
    }
}

struct Blocked<'s, 'm, 'w, W> {
    tracer: &'s mut Tracer<'m, 'w, W>,
    rays: Rays<'s>,
    /// How many of them are no copies.
    len: usize,
    ends: &'s [f64],
    leaves: usize,
    sides: &'s [Side],
    /// Where the rays go.
    region: Bounds,
    /// The reciprocals of their directions, for a tree.
    inverse: Vectors<WIDE>,
    blocked: &'s mut [u64],
}

impl<W: Watch> Blocked<'_, '_, '_, W> {
    fn run(&mut self, ahead: &mut Vec<usize>) {
        let plan = self.tracer.plan;
        for index in &plan.listed {
            if self.tracer.model.objects[*index].shape.is_clear_of(&self.region) {
                self.tracer.watch.count(Count::Culled(*index, self.len));
                continue;
            }
            self.object(*index);
            if self.blocked.iter().all(|blocked| *blocked != 0) {
                return;
            }
        }
        if let Some(tree) = &plan.tree {
            for lane in 0..self.ends.len() {
                self.inverse.set(lane, self.rays.dir.get(lane).recip());
            }
            tree.visit(self.rays.dir.get(0), ahead, self);
        }
    }
}

impl<W: Watch> Visitor for Blocked<'_, '_, '_, W> {
    fn enters(&mut self, bounds: &Bounds) -> bool {
        let inverse = self.inverse.view(self.ends.len());
        bounds.overlaps(&self.region)
            && bounds::any_meets(self.tracer.cpu, self.rays, inverse, self.ends, bounds)
    }

    fn object(&mut self, index: usize) {
        let shape = &*self.tracer.model.objects[index].shape;
        let sides = (index == self.leaves).then_some(self.sides);
        if sides.is_some() && shape.is_convex() {
            return;
        }
        self.tracer.watch.count(Count::Tested(index, self.len));
        let mut doubt = [0; WIDE];
        if shape.block(self.tracer.cpu, self.rays, sides, self.ends, self.blocked, &mut doubt) {
            for lane in 0..self.ends.len() {
                if doubt[lane] != 0 {
                    let leaves = sides.map(|sides| sides[lane]);
                    let distance = exact(shape, &self.rays.get(lane), leaves, self.ends[lane]);
                    self.blocked[lane] |= u64::from(distance < self.ends[lane]);
                }
            }
        }
    }
}
