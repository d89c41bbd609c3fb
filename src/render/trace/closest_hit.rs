//! The closest hits of a packet's rays.

use super::arrays::resized;
use super::context::{Tracer, UndecidedRay};
use super::exact::{Located, RoundedRay, certain_order, exact, is_before, is_unclear, located};
use super::ray_group::{HitRecord, RayGroup};
use crate::frusta::{self, PART};
use crate::observer::{Count, DropReason, Event, Hit};
use glam::DVec2;
use std::cmp::Ordering;
use std::mem::take;
use std::ops::Range;
use tabray_world::geometry::bvh::{self, PacketVisitor, Stack};
use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayError, Side};
use tabray_world::geometry::ray_packet::{HitRecordMut, RayPacket};
use tabray_world::simd::cpu::kernels;
use tabray_world::simd::soa::{LANES, Vectors};

impl<'m> Tracer<'m, '_> {
    /// Finds each ray's closest hit, before `t_max` where it is given, in world units. A ray whose budget is used up
    /// hits nothing.
    pub(super) fn closest(&mut self, group: &mut RayGroup, t_max: Option<&[f64]>, hits: &mut HitRecord) {
        let (is_over, count) = (group.ray_budget[0] == 0, group.padded());
        if hits.begin(self.cpu, &mut group.ray_budget, count, t_max) && t_max.is_none() {
            self.miss_beyond(group, hits);
        }
        let mut ray_budget = take(&mut group.ray_budget);
        self.charge_searches(group.rays(), group.left(), 0..group.len, &mut ray_budget);
        group.ray_budget = ray_budget;
        if self.sees_events {
            if is_over {
                self.observer.see(Event::Dropped(DropReason::TooMany));
                return;
            }
            self.closest_seen(group, hits);
            return;
        }
        let (mut stack, mut ends) = (take(&mut self.scratch.stack), take(&mut self.scratch.ends));
        let part = 0..group.padded();
        ClosestHitSearch { tracer: self, group, hits, part, single: None }.run(&mut stack, &mut ends);
        (self.scratch.stack, self.scratch.ends) = (stack, ends);
        if !self.scratch.undecided.rays.is_empty() {
            self.note_undecided(group, hits);
        }
    }

    /// Finds one ray's closest hit and reports each step to the observer.
    fn closest_seen(&mut self, group: &RayGroup, hits: &mut HitRecord) {
        let start = self.start(group, 0);
        let mut nearest = hits.far[0];
        self.observer.see(Event::Search(&start.ray));
        for index in 0..self.model.objects.len() {
            let shape = &self.model.objects[index].shape;
            let origin_side = start.leaves(shape, group.sides_of(index).map(|sides| sides[0]));
            if origin_side.is_some_and(|side| !shape.can_hit_itself(side)) {
                self.observer.see(Event::Tested(index, None));
                continue;
            }
            let Located { distance, bracket, .. } = located(shape, &start, origin_side, MISS);
            let is_first = self.is_first(&start, (index, distance), (hits.hit_ids[0], nearest));
            self.observer.see(Event::Tested(index, Some(if is_first { distance } else { MISS })));
            if is_first {
                // As in a packet, so that the hit is refined in the same way.
                (hits.near[0], hits.far[0], hits.hit_ids[0]) = (bracket.near, bracket.far, index as u64 + 1);
                nearest = distance;
            }
        }
        let hit = (hits.hit_ids[0] as usize).checked_sub(1).map(|index| Hit {
            index,
            object: &self.model.objects[index],
            distance: nearest,
            point: start.ray.at(nearest),
        });
        self.observer.see(Event::FirstHit(hit.as_ref()));
    }

    /// Returns one ray of a group, with the bounds of its errors.
    pub(super) fn start(&self, group: &RayGroup, lane: usize) -> RoundedRay {
        let [x, y] = &self.scratch.places;
        let lens = |side: usize| self.scratch.lens[side].get(lane).copied().unwrap_or_default();
        let sight = || self.plan.camera.sight_through(x[lane], y[lane], DVec2::new(lens(0), lens(1)));
        let sight = group.looks.then(sight).or_else(|| group.sights.get(lane).cloned());
        RoundedRay { ray: group.rays().get(lane), error: group.errors.of(lane), sight }
    }

    /// Tells whether any ray may hit an object at all: most shapes cannot be hit by rays that leave them.
    pub(super) fn may_meet(&self, left: Option<(usize, &[Side])>, index: usize) -> bool {
        let Some((_, sides)) = left.filter(|(object, _)| *object == index) else { return true };
        let shape = &self.model.objects[index].shape;
        match [Side::Outside, Side::Inside].map(|side| shape.can_hit_itself(side)) {
            [true, true] => true,
            [false, false] => false,
            [from_outside, _] => sides.contains(if from_outside { &Side::Outside } else { &Side::Inside }),
        }
    }

    /// Tells whether a ray hits an object before its closest hit so far, given by the object's index plus 1 (0 for
    /// none) and the distance. Of coincident objects, the earlier one in the scene is first.
    fn is_first(
        &self,
        start: &RoundedRay,
        (index, distance): (usize, f64),
        (hit_id, far): (u64, f64),
    ) -> bool {
        let Some(rival) = (hit_id as usize).checked_sub(1) else { return distance < far };
        if distance == MISS {
            return false;
        }
        let shape = |index: usize| &self.model.objects[index].shape;
        let (one, other) = ((shape(index), distance), (shape(rival), far));
        let certain = || {
            let sight = start.sight.as_ref()?;
            // A proof of equal distances needs all available digits, and for some shapes milliseconds.
            match self.model.objects[index].is_shaped_as(&self.model.objects[rival]) {
                true => Some(Ordering::Equal),
                false => certain_order(one.0, other.0, sight),
            }
        };
        if is_unclear(&start.ray, one, other)
            && let Some(order) = certain()
        {
            return order.then(index.cmp(&rival)) == Ordering::Less;
        }
        let is_before = is_before(&start.ray, start.error, one, other);
        let is_before = is_before.map(|is_before| if is_before { Ordering::Less } else { Ordering::Greater });
        let order = is_before.or_else(certain).unwrap_or(Ordering::Equal);
        order.then(index.cmp(&rival)) == Ordering::Less
    }

    /// Computes the distances, in world units, at which the rays of a group hit an object. Each lies between `near` and
    /// `far`.
    pub(super) fn refine(
        &mut self,
        group: &RayGroup,
        (near, far): (&[f64], &[f64]),
        object: usize,
        distances: &mut Vec<f64>,
    ) {
        let (len, count) = (group.len, group.padded());
        let (near, far, distances) = (&near[..count], &far[..count], resized(distances, count));
        distances.copy_from_slice(near);
        if near[..len] != far[..len] {
            let shape = &self.model.objects[object].shape;
            let rays = group.rays().leaving(group.sides_of(object));
            shape.packets().refine(self.cpu, rays, (near, far), distances);
            if clamp_to_brackets(self.cpu, near, far, distances) {
                for lane in 0..len {
                    if distances[lane].is_nan() {
                        let origin_side = rays.side(lane);
                        let distance = exact(shape, &self.start(group, lane), origin_side, MISS);
                        distances[lane] = distance.max(near[lane]).min(far[lane]);
                    }
                }
            }
        }
        // Lanes beyond the last ray continue as copies of it. Plain arithmetic may have left NaNs there, which would
        // spoil the bounding box of the points.
        let last = distances[len - 1];
        distances[len..].fill(last);
    }
}

kernels! {
    /// Tells whether all elements are the same.
    pub(super) fn is_one(of: &[u64]) -> bool {
        of.iter().fold(0, |other, one| other | (one ^ of[0])) == 0
    }

    /// Clamps distances to their brackets, which have width 0 where the distance is known. Returns whether any distance
    /// is NaN.
    pub(super) fn clamp_to_brackets(near: &[f64], far: &[f64], distances: &mut [f64]) -> bool {
        let count = distances.len();
        let (near, far) = (&near[..count], &far[..count]);
        let mut any = 0;
        for lane in 0..count {
            // The rounded ray may miss what the true one hits, or hit it elsewhere.
            let (low, high) = (near[lane], far[lane]);
            let raised = if distances[lane] < low { low } else { distances[lane] };
            distances[lane] = if raised > high { high } else { raised };
            any |= u64::from(distances[lane].is_nan());
        }
        any != 0
    }
}

/// The search for the closest hits of a packet.
struct ClosestHitSearch<'s, 'm, 'w> {
    tracer: &'s mut Tracer<'m, 'w>,
    group: &'s RayGroup,
    hits: &'s mut HitRecord,
    /// The lanes of the current sub-packets.
    part: Range<usize>,
    /// The ray that was last tested alone.
    single: Option<RepeatedRay>,
}

/// Copies of one ray, which fill the lanes that shapes take at a time.
struct RepeatedRay {
    lane: usize,
    origin: Vectors<LANES>,
    dir: Vectors<LANES>,
}

impl ClosestHitSearch<'_, '_, '_> {
    /// Tests all objects. `ends` is scratch space.
    fn run(mut self, stack: &mut Stack, ends: &mut Vec<f64>) {
        let plan = self.tracer.plan;
        if !plan.unbounded.is_empty() || !plan.bounded.is_empty() {
            self.listed();
        }
        if let Some(tree) = &plan.tree {
            ends.clear();
            ends.extend_from_slice(&self.hits.far[..self.group.padded()]);
            bvh::visit(self.tracer.cpu, tree, stack, self.group.rays(), RayError::NONE, ends, &mut self);
        }
    }

    /// Tests the objects outside of the BVH, each against the sub-packets that may hit it.
    fn listed(&mut self) {
        let (cpu, plan) = (self.tracer.cpu, self.tracer.plan);
        let frusta = frusta::around(cpu, self.group.rays(), self.group.is_from_one);
        for index in &plan.unbounded {
            let object = &self.tracer.model.objects[*index];
            if self.tracer.may_meet(self.group.left(), *index) {
                self.in_parts(*index, frusta.which(|region| !object.shape.is_culled_in(region)));
            }
        }
        let mut parts = take(&mut self.tracer.scratch.parts);
        frusta::meet(cpu, &frusta, &plan.bounded, resized(&mut parts, plan.bounded.len()));
        for ((index, _), parts) in plan.bounded.iter().zip(&parts) {
            if self.tracer.may_meet(self.group.left(), *index) {
                self.in_parts(*index, *parts);
            }
        }
        self.tracer.scratch.parts = parts;
    }

    /// Tests an object against the sub-packets whose bits are 1.
    fn in_parts(&mut self, index: usize, mut parts: u32) {
        let (mut start, mut tested) = (0, 0);
        while parts != 0 {
            // Neighbouring sub-packets are tested together.
            start += PART * parts.trailing_zeros() as usize;
            parts >>= parts.trailing_zeros();
            let end = start + PART * parts.trailing_ones() as usize;
            parts >>= parts.trailing_ones();
            self.part = start..end.min(self.group.padded());
            tested += self.len();
            self.test_part(index);
            start = end;
        }
        if tested < self.group.len {
            self.tracer.observer.count(Count::Culled(index, self.group.len - tested));
        }
    }

    /// Returns the number of current rays, without the copies that pad the arrays.
    fn len(&self) -> usize {
        self.part.end.min(self.group.len) - self.part.start
    }

    /// Decides whether one ray hits an object before its closest hit so far, where the brackets overlap.
    fn decide(&mut self, lane: usize, index: usize, origin_side: Option<Side>) {
        let objects = &self.tracer.model.objects;
        let start = self.tracer.start(self.group, lane);
        let Located { distance, bracket: own, open } =
            located(&objects[index].shape, &start, origin_side, MISS);
        if let Some(from) = open {
            self.tracer.scratch.undecided.rays.push(UndecidedRay { lane, object: index, from });
        }
        if distance == MISS {
            return;
        }
        let (near, far, hit_id) =
            (&mut self.hits.near[lane], &mut self.hits.far[lane], &mut self.hits.hit_ids[lane]);
        let rival_distance = if near == far {
            *far
        } else {
            let rival = *hit_id as usize - 1;
            let rival_leaves = self.group.sides_of(rival).map(|sides| sides[lane]);
            exact(&objects[rival].shape, &start, rival_leaves, MISS)
        };
        let is_first = self.tracer.is_first(&start, (index, distance), (*hit_id, rival_distance));
        let nearest = if is_first { distance } else { rival_distance };
        // The unrounded primary ray hits the object anywhere in its bracket, and may hit other objects there.
        let bracket = match start.sight {
            Some(_) if is_first => own,
            Some(_) => Bracket { near: *near, far: *far },
            None => Bracket::exactly(nearest),
        };
        let is_known = bracket.near <= nearest && nearest <= bracket.far && bracket.far < MISS;
        (*near, *far) = if is_known { (bracket.near, bracket.far) } else { (nearest, nearest) };
        if is_first {
            *hit_id = index as u64 + 1;
        }
    }

    /// Tests an object against the current sub-packets.
    fn test_part(&mut self, index: usize) {
        let shape = &self.tracer.model.objects[index].shape;
        self.tracer.observer.count(Count::Tested(index, self.len()));
        let rays = self.group.rays().leaving(self.group.sides_of(index)).part(self.part.clone());
        let nearest = self.hits.part(self.part.clone());
        if shape.closest_hits(self.tracer.cpu, rays, index as u64 + 1, nearest) {
            for lane in 0..self.len() {
                if self.hits.doubt[self.part.start + lane] != 0 {
                    self.decide(self.part.start + lane, index, rays.side(lane));
                }
            }
        }
    }
}

impl PacketVisitor for ClosestHitSearch<'_, '_, '_> {
    fn test(&mut self, index: usize, lanes: Range<usize>, t_max: &mut [f64]) {
        if self.tracer.may_meet(self.group.left(), index) {
            self.part = lanes.clone();
            self.test_part(index);
            t_max[lanes.clone()].copy_from_slice(&self.hits.far[lanes]);
        }
    }

    fn test_one(&mut self, index: usize, lane: usize, t_max: &mut [f64]) {
        if !self.tracer.may_meet(self.group.left(), index) {
            return;
        }
        let (group, id) = (self.group, index as u64 + 1);
        let single = match &mut self.single {
            Some(single) if single.lane == lane => single,
            single => single.insert(RepeatedRay::new(group, lane)),
        };
        let shape = &self.tracer.model.objects[index].shape;
        let side = group.sides_of(index).map(|sides| sides[lane]);
        self.tracer.observer.count(Count::Tested(index, 1));
        let hits = &mut *self.hits;
        let (mut near, mut far) = ([hits.near[lane]; LANES], [hits.far[lane]; LANES]);
        let (mut hit_ids, mut doubt) = ([hits.hit_ids[lane]; LANES], [0; LANES]);
        let nearest =
            HitRecordMut { near: &mut near, far: &mut far, hit_ids: &mut hit_ids, doubt: &mut doubt };
        let sides = side.map(|side| [side; LANES]);
        let rays = single.rays(group).leaving(sides.as_ref().map(|sides| &sides[..]));
        let is_open = shape.closest_hits(self.tracer.cpu, rays, id, nearest);
        (hits.near[lane], hits.far[lane], hits.hit_ids[lane]) = (near[0], far[0], hit_ids[0]);
        if is_open && doubt[0] != 0 {
            self.decide(lane, index, side);
        }
        t_max[lane] = self.hits.far[lane];
    }
}

impl RepeatedRay {
    /// Copies the ray in a lane of a group.
    fn new(group: &RayGroup, lane: usize) -> Self {
        let Ray { origin, dir } = group.rays().get(lane);
        Self { lane, origin: Vectors::of(origin), dir: Vectors::of(dir) }
    }

    /// Returns the copies as a packet.
    fn rays(&self, group: &RayGroup) -> RayPacket<'_> {
        RayPacket::new(self.origin.view(LANES), self.dir.view(LANES), group.errors.of(self.lane))
    }
}
