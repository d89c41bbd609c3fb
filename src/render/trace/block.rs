//! Which rays of a packet something blocks.

use super::arrays::{Vectors, room};
use super::context::Tracer;
use super::search::{Start, exact, invert};
use super::surface::Surface;
use crate::geometry::bounds::{self, Bounds};
use crate::geometry::packet::{Rays, parts};
use crate::geometry::ray::Side;
use crate::render::bundles::PART;
use crate::render::culling;
use crate::render::tree::Visitor;
use crate::render::watch::{Count, Watch};
use std::mem::take;
use std::ops::Range;

/// Rays that leave the same object.
pub(super) struct Leaving<'r> {
    pub rays: Rays<'r>,
    /// How many of them are no copies that fill the arrays up, and how many of those need to be gone.
    pub len: usize,
    pub going: usize,
    /// Where they end; 0 for one that need not be gone.
    pub ends: &'r [f64],
    /// Where they start: at places of this surface, of those in these lanes if not at all.
    pub surface: &'r Surface,
    pub lanes: Option<&'r [u8]>,
    /// The sides of it that they leave.
    pub sides: &'r [Side],
}

impl Leaving<'_> {
    /// How many of some there are.
    fn count(&self, part: &Range<usize>) -> usize {
        let part = part.start..part.end.min(self.len);
        self.ends[part].iter().filter(|end| **end > 0.0).count()
    }

    /// How far the origin of one may be from the point that it stands for, in world units.
    fn error(&self, lane: usize) -> f64 {
        let lane = lane.min(self.len - 1);
        self.surface.error(self.lanes.map_or(lane, |lanes| usize::from(lanes[lane])))
    }
}

impl<W: Watch> Tracer<'_, '_, W> {
    /// Marks the rays that an object blocks before their ends, on their ways from these places to those.
    pub(super) fn block(&mut self, leaving: &Leaving, from: &Bounds, to: &Bounds, blocked: &mut [u64]) {
        let (mut ahead, mut inverse) = (take(&mut self.rooms.ahead), take(&mut self.rooms.inverse));
        let mut doubt = take(&mut self.rooms.doubt);
        let (part, doubted) = (0..leaving.ends.len(), room(&mut doubt, leaving.ends.len()));
        let (len, region) = (leaving.going, from.and(to).with_slack(0.0));
        Block { tracer: self, leaving, part, len, region, inverse: &mut inverse, blocked, doubt: doubted }
            .run(to, &mut ahead);
        (self.rooms.ahead, self.rooms.inverse, self.rooms.doubt) = (ahead, inverse, doubt);
    }
}

struct Block<'s, 'm, 'w, W> {
    tracer: &'s mut Tracer<'m, 'w, W>,
    leaving: &'s Leaving<'s>,
    /// Which of the rays are looked after.
    part: Range<usize>,
    /// How many of those there are.
    len: usize,
    /// Where they go.
    region: Bounds,
    /// The reciprocals of their directions, for a tree.
    inverse: &'s mut Vectors,
    blocked: &'s mut [u64],
    doubt: &'s mut [u64],
}

impl<W: Watch> Block<'_, '_, '_, W> {
    fn run(mut self, to: &Bounds, ahead: &mut Vec<usize>) {
        let plan = self.tracer.plan;
        let unbounded = plan.unbounded.iter().map(|index| (index, None));
        for (index, bounds) in
            unbounded.chain(plan.bounded.iter().map(|(index, bounds)| (index, Some(bounds))))
        {
            if !self.tracer.may_meet(self.left(), *index) {
                continue;
            }
            let object = &self.tracer.model.objects[*index];
            if bounds.is_some_and(|bounds| !bounds.overlaps(&self.region))
                || culling::is_clear_of(object, &self.region)
            {
                self.tracer.watch.count(Count::Culled(*index, self.len));
                continue;
            }
            self.test(*index);
            if self.blocked.iter().all(|blocked| *blocked != 0) {
                return;
            }
        }
        let Some(tree) = &plan.tree else { return };
        for part in parts(self.leaving.ends.len(), PART) {
            let rays = self.leaving.rays.part(part.clone());
            self.len = self.leaving.count(&part);
            self.part = part;
            self.region = bounds::around(self.tracer.cpu, rays.origin).and(to).with_slack(0.0);
            invert(rays, self.inverse);
            tree.visit(rays.dir.get(0), ahead, &mut self);
        }
    }

    /// The object that the rays leave, and the sides.
    fn left(&self) -> Option<(usize, &[Side])> {
        Some((self.leaving.surface.index, self.leaving.sides))
    }

    /// Looks at an object.
    fn test(&mut self, index: usize) {
        let Leaving { rays, ends, surface, sides, .. } = *self.leaving;
        let (rays, ends) = (rays.part(self.part.clone()), &ends[self.part.clone()]);
        let shape = &self.tracer.model.objects[index].shape;
        let sides = (index == surface.index).then(|| &sides[self.part.clone()]);
        self.tracer.watch.count(Count::Tested(index, self.len));
        let (blocked, doubt) = (&mut self.blocked[self.part.clone()], &mut self.doubt[self.part.clone()]);
        if shape.packets().occluded(self.tracer.cpu, rays, sides, ends, blocked, doubt) {
            for lane in 0..ends.len() {
                if doubt[lane] != 0 {
                    let leaves = sides.map(|sides| sides[lane]);
                    let error = self.leaving.error(self.part.start + lane);
                    let distance =
                        exact(shape, &Start { ray: rays.get(lane), error, sight: None }, leaves, ends[lane]);
                    blocked[lane] |= u64::from(distance < ends[lane]);
                }
            }
        }
    }
}

impl<W: Watch> Visitor for Block<'_, '_, '_, W> {
    fn enters(&mut self, bounds: &Bounds) -> bool {
        let (rays, ends) = (self.leaving.rays.part(self.part.clone()), &self.leaving.ends[self.part.clone()]);
        bounds.overlaps(&self.region)
            && bounds::any_meets(self.tracer.cpu, rays, self.inverse.view(ends.len()), ends, bounds)
    }

    fn object(&mut self, index: usize) {
        if self.tracer.may_meet(self.left(), index) {
            self.test(index);
        }
    }
}
