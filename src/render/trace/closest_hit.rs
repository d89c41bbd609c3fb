//! What the rays of a packet meet first.

use super::arrays::{VectorList, resized};
use super::context::Tracer;
use super::hit_record::HitRecord;
use super::order;
use super::ray_group::RayGroup;
use crate::geometry::aabb::{self, Aabb};
use crate::geometry::ray::{Bracket, MISS, Ray, RayRange, Side};
use crate::geometry::ray_packet::{RayPacket, split};
use crate::geometry::sight::Sight;
use crate::numeric::interval::{Interval, Wide};
use crate::render::bvh::Visitor;
use crate::render::culling;
use crate::render::frusta::{self, PART};
use crate::render::observer::{Count, Event, Hit, Reason, TraceObserver};
use crate::simd::cpu::kernels;
use crate::world::any_shape::AnyShape;
use crate::world::certify::{self, Enclosure, Precision};
use crate::world::coincidence::CLOSE;
use std::mem::take;
use std::ops::Range;

impl<'m, W: TraceObserver> Tracer<'m, '_, W> {
    /// What each ray meets first before its end, if it has one. A ray that has cost as many as it may meets nothing.
    pub(super) fn closest(&mut self, group: &mut RayGroup, t_max: Option<&[f64]>, hits: &mut HitRecord) {
        let (is_over, count) = (group.ray_budget[0] == 0, group.padded());
        if hits.begin(self.cpu, &mut group.ray_budget, count, t_max) && t_max.is_none() {
            self.miss_beyond(group, hits);
        }
        if W::SEES {
            if is_over {
                self.observer.see(Event::Dropped(Reason::TooMany));
                return;
            }
            self.closest_seen(group, hits);
            return;
        }
        let (mut ahead, mut inverse) = (take(&mut self.scratch.ahead), take(&mut self.scratch.inverse));
        let part = 0..group.padded();
        Closest { tracer: self, group, hits, part, inverse: &mut inverse }.run(&mut ahead);
        (self.scratch.ahead, self.scratch.inverse) = (ahead, inverse);
    }

    /// What one ray meets first, with all that leads to it told.
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
            let (distance, bracket) = located(shape, &start, origin_side, MISS);
            let is_first = self.is_first(&start, (index, distance), (hits.met[0], nearest));
            self.observer.see(Event::Tested(index, Some(if is_first { distance } else { MISS })));
            if is_first {
                // As a packet has it, for the hit to be finished in the same way.
                (hits.near[0], hits.far[0], hits.met[0]) = (bracket.near, bracket.far, index as u64 + 1);
                nearest = distance;
            }
        }
        let hit = (hits.met[0] as usize).checked_sub(1).map(|index| Hit {
            index,
            object: &self.model.objects[index],
            distance: nearest,
            point: start.ray.at(nearest),
        });
        self.observer.see(Event::Met(hit.as_ref()));
    }

    /// One ray of a packet.
    fn start(&self, group: &RayGroup, lane: usize) -> Start {
        let [x, y] = &self.scratch.places;
        let sight = group.looks.then(|| self.plan.camera.sight(x[lane], y[lane])).or(group.sight);
        Start { ray: group.rays().get(lane), error: group.error(lane), sight }
    }

    /// Whether rays may meet an object at all: to most that they leave they do not come back.
    pub(super) fn may_meet(&self, left: Option<(usize, &[Side])>, index: usize) -> bool {
        let Some((_, sides)) = left.filter(|(object, _)| *object == index) else { return true };
        let shape = &self.model.objects[index].shape;
        match [Side::Outside, Side::Inside].map(|side| shape.can_hit_itself(side)) {
            [true, true] => true,
            [false, false] => false,
            [from_outside, _] => sides.contains(if from_outside { &Side::Outside } else { &Side::Inside }),
        }
    }

    /// Whether a ray meets an object before what it has met so far, by its index and 1, or nothing before the end of the
    /// search. Of two that lie together the earlier one in the scene is first.
    fn is_first(&self, start: &Start, (index, distance): (usize, f64), (met, far): (u64, f64)) -> bool {
        let Some(rival) = (met as usize).checked_sub(1) else { return distance < far };
        if distance == MISS {
            return false;
        }
        let shape = |index: usize| &self.model.objects[index].shape;
        let (one, other) = ((shape(index), distance), (shape(rival), far));
        let is_before = order::is_before(&start.ray, start.error, one, other)
            .or_else(|| order::is_certainly_before(one.0, other.0, start.sight.as_ref()?));
        is_before.unwrap_or(index < rival)
    }

    /// The distances at which the rays of a packet meet an object, known to lie between `near` and `far`.
    pub(super) fn settle(
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
            let sides = group.sides_of(object);
            shape.packets().refine(self.cpu, group.rays(), sides, (near, far), distances);
            if keep_in_brackets(self.cpu, near, far, distances) {
                for lane in 0..len {
                    if distances[lane].is_nan() {
                        let origin_side = sides.map(|sides| sides[lane]);
                        let distance = exact(shape, &self.start(group, lane), origin_side, MISS);
                        distances[lane] = distance.max(near[lane]).min(far[lane]);
                    }
                }
            }
        }
        // What is beyond the last ray goes on as a copy of it: what plain arithmetic left open there is no number, and
        // would make no box of the places.
        let last = distances[len - 1];
        distances[len..].fill(last);
    }
}

/// A ray, and what is known of the one that it stands for.
pub(super) struct Start {
    pub ray: Ray,
    /// How far its origin may be from the point that it stands for, in world units.
    pub error: f64,
    /// The ray before anything was rounded, where it comes from the viewer.
    pub sight: Option<Sight>,
}

impl Start {
    /// The side of a shape that the ray leaves: of its own object's it is known; another one that lies through the same
    /// point is left, too.
    fn leaves(&self, shape: &AnyShape, own: Option<Side>) -> Option<Side> {
        let Ray { origin, dir } = self.ray;
        let touched = || Side::seen_along(dir, shape.normal(origin)).opposite();
        own.or_else(|| (self.error > 0.0 && shape.touches(origin, self.error)).then(touched))
    }
}

/// A shape's exact distance on one ray, which leaves it on a side if it is the object that the packet leaves.
pub(super) fn exact(shape: &AnyShape, start: &Start, origin_side: Option<Side>, far: f64) -> f64 {
    located(shape, start, origin_side, far).0
}

/// A shape's exact distance, as [`exact`] gives it, and a bracket of that and of the distance of the ray before anything
/// was rounded.
fn located(shape: &AnyShape, start: &Start, origin_side: Option<Side>, far: f64) -> (f64, Bracket) {
    let known = |distance| (distance, Bracket::exactly(distance));
    match start.leaves(shape, origin_side) {
        Some(side) if !shape.can_hit_itself(side) => return (MISS, Bracket::MISS),
        None => {}
        origin_side => {
            return known(shape.distance(&start.ray, &RayRange { far, origin_side, ..RayRange::ALL }));
        }
    }
    let range = RayRange { far, ..RayRange::ALL };
    let Some(sight) = &start.sight else { return known(shape.distance(&start.ray, &range)) };
    let bracket = shape.t_bounds(&start.ray, &RayRange::ALL);
    // A bracket that is known exactly has taken the whole search.
    let is_known = bracket.near == bracket.far;
    let distance = if is_known { range.keep(bracket.near) } else { shape.distance(&start.ray, &range) };
    // Where what was rounded of the ray may decide whether it meets the shape, the ray does that was not rounded.
    if bracket.is_doubtful() { decided(shape, sight, distance) } else { (distance, bracket) }
}

/// A distance and a bracket of it, if the ray before anything was rounded has a hit there as far as 237 bits tell, or
/// [`MISS`].
fn decided(shape: &AnyShape, sight: &Sight, distance: f64) -> (f64, Bracket) {
    let enclosure = match shape.certify(sight, Precision::Double) {
        Enclosure::Edge(_) | Enclosure::Doubtful(_) => shape.certify(sight, Precision::Octuple),
        certain => certain,
    };
    match enclosure {
        Enclosure::Misses => (MISS, Bracket::MISS),
        // What has edges has them inclusive.
        Enclosure::Hits(at) | Enclosure::Edge(at) => {
            let Interval { low, high } = certify::bounds_in_world_units(at, sight);
            (distance.clamp(low, high), Bracket { near: low, far: high })
        }
        // As of a plane that the ray runs along but for rounding: what is undecided lies farther on.
        Enclosure::Doubtful(from)
            if certify::in_world_units(Wide::point(from), sight).high * (1.0 - CLOSE) > distance =>
        {
            (MISS, Bracket::MISS)
        }
        Enclosure::Doubtful(_) => (distance, Bracket::exactly(distance)),
    }
}

kernels! {
    /// Whether all is the same.
    pub(super) fn is_one(of: &[u64]) -> bool {
        of.iter().fold(0, |other, one| other | (one ^ of[0])) == 0
    }

    /// Keeps distances in their brackets, which are of no width where they are known. Tells whether any is no number.
    fn keep_in_brackets(near: &[f64], far: &[f64], distances: &mut [f64]) -> bool {
        let count = distances.len();
        let (near, far) = (&near[..count], &far[..count]);
        let mut any = 0;
        for lane in 0..count {
            // A ray that was rounded may miss what the real one touches, or meet it elsewhere.
            let (low, high) = (near[lane], far[lane]);
            let held = if distances[lane] < low { low } else { distances[lane] };
            distances[lane] = if held > high { high } else { held };
            any |= u64::from(distances[lane].is_nan());
        }
        any != 0
    }
}

/// The reciprocals of rays' directions.
pub(super) fn invert(rays: RayPacket, inverse: &mut VectorList) {
    let mut inverse = inverse.resized(rays.len());
    for lane in 0..rays.len() {
        inverse.set(lane, rays.dir.get(lane).recip());
    }
}

struct Closest<'s, 'm, 'w, W> {
    tracer: &'s mut Tracer<'m, 'w, W>,
    group: &'s RayGroup,
    hits: &'s mut HitRecord,
    /// Which of the rays are looked after.
    part: Range<usize>,
    /// The reciprocals of their directions, for a tree.
    inverse: &'s mut VectorList,
}

impl<W: TraceObserver> Closest<'_, '_, '_, W> {
    fn run(mut self, ahead: &mut Vec<usize>) {
        let plan = self.tracer.plan;
        if !plan.unbounded.is_empty() || !plan.bounded.is_empty() {
            self.listed();
        }
        let Some(tree) = &plan.tree else { return };
        for part in split(self.group.padded(), PART) {
            let rays = self.group.rays().part(part.clone());
            self.part = part;
            invert(rays, self.inverse);
            tree.visit(rays.dir.get(0), ahead, &mut self);
        }
    }

    /// Looks at the objects that are listed, each for those parts of the packet that may come there.
    fn listed(&mut self) {
        let (cpu, plan) = (self.tracer.cpu, self.tracer.plan);
        // Those from the viewer all start there.
        let frusta = frusta::around(cpu, self.group.rays(), self.group.origin_object.is_none());
        for index in &plan.unbounded {
            let object = &self.tracer.model.objects[*index];
            if self.tracer.may_meet(self.group.left(), *index) {
                self.in_parts(*index, frusta.which(|paths| !culling::is_clear_of(object, paths)));
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

    /// Looks at an object for some parts of the packet, whose bits are 1.
    fn in_parts(&mut self, index: usize, mut parts: u32) {
        let (mut start, mut tested) = (0, 0);
        while parts != 0 {
            // Neighbours go together.
            start += PART * parts.trailing_zeros() as usize;
            parts >>= parts.trailing_zeros();
            let end = start + PART * parts.trailing_ones() as usize;
            parts >>= parts.trailing_ones();
            self.part = start..end.min(self.group.padded());
            tested += self.len();
            self.test(index);
            start = end;
        }
        if tested < self.group.len {
            self.tracer.observer.count(Count::Culled(index, self.group.len - tested));
        }
    }

    /// How many of the rays are no copies.
    fn len(&self) -> usize {
        self.part.end.min(self.group.len) - self.part.start
    }

    /// Which of two objects one ray meets first, where brackets do not tell.
    fn decide(&mut self, lane: usize, index: usize, origin_side: Option<Side>) {
        let objects = &self.tracer.model.objects;
        let start = self.tracer.start(self.group, lane);
        let (distance, own) = located(&objects[index].shape, &start, origin_side, MISS);
        if distance == MISS {
            return;
        }
        let (near, far, met) =
            (&mut self.hits.near[lane], &mut self.hits.far[lane], &mut self.hits.met[lane]);
        let rival_distance = if near == far {
            *far
        } else {
            let rival = *met as usize - 1;
            let rival_leaves = self.group.sides_of(rival).map(|sides| sides[lane]);
            exact(&objects[rival].shape, &start, rival_leaves, MISS)
        };
        let is_first = self.tracer.is_first(&start, (index, distance), (*met, rival_distance));
        let nearest = if is_first { distance } else { rival_distance };
        // The ray from the viewer that was not rounded meets it anywhere in its bracket, and may meet others there.
        let bracket = match start.sight {
            Some(_) if is_first => own,
            Some(_) => Bracket { near: *near, far: *far },
            None => Bracket::exactly(nearest),
        };
        let is_known = bracket.near <= nearest && nearest <= bracket.far && bracket.far < MISS;
        (*near, *far) = if is_known { (bracket.near, bracket.far) } else { (nearest, nearest) };
        if is_first {
            *met = index as u64 + 1;
        }
    }

    /// Looks at an object.
    fn test(&mut self, index: usize) {
        let shape = &self.tracer.model.objects[index].shape;
        let sides = self.group.sides_of(index).map(|sides| &sides[self.part.clone()]);
        self.tracer.observer.count(Count::Tested(index, self.len()));
        let rays = self.group.rays().part(self.part.clone());
        if shape.closest_hits(
            self.tracer.cpu,
            rays,
            sides,
            index as u64 + 1,
            self.hits.part(self.part.clone()),
        ) {
            for lane in 0..self.len() {
                if self.hits.doubt[self.part.start + lane] != 0 {
                    self.decide(self.part.start + lane, index, sides.map(|sides| sides[lane]));
                }
            }
        }
    }
}

impl<W: TraceObserver> Visitor for Closest<'_, '_, '_, W> {
    fn enters(&mut self, bounds: &Aabb) -> bool {
        let rays = self.group.rays().part(self.part.clone());
        let t_max = &self.hits.far[self.part.clone()];
        aabb::any_meets(self.tracer.cpu, rays, self.inverse.view(rays.len()), t_max, bounds)
    }

    fn object(&mut self, index: usize) {
        if self.tracer.may_meet(self.group.left(), index) {
            self.test(index);
        }
    }
}
