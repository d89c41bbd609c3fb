//! How the [trees](super::tree) of a packet of primary rays grow, wave by wave.

use super::arrays::VectorList;
use super::context::{ShadingScratch, Tracer};
use super::ray_group::RayGroup;
use super::scatter::CountedLight;
use super::tree::{Budget, End, Ends, OpenRay, Tree};
use super::wave::{TreeScratch, Wave};
use crate::limits::MAX_RAYS;
use crate::observer::{Count, Event, RayKind, RayPurpose};
use crate::plan::depth::Depth;
use glam::DVec3;
use std::f64::consts::PI;
use std::mem::take;
use tabray_world::geometry::ray::Side;
use tabray_world::geometry::ray_packet::PACKET_SIZE;
use tabray_world::interface::Crossing;
use tabray_world::material::Rgb;

/// The number of trees that grow together: few, so their open rays take little memory.
const TOGETHER: usize = 64;

/// The minimum weight of rays whose hits are recorded to tell the samples of a pixel apart.
const HEAVY: f64 = 1.0 / 16.0;

impl Tracer<'_, '_> {
    /// Computes the colours that primary rays return under the free rules.
    pub(super) fn grow(&mut self, depth: &Depth, group: &mut RayGroup, colours: &mut VectorList) {
        let (len, ends) = (group.len, Ends::of(&self.plan.camera));
        let mut scratch = self.scratch.trees.take().unwrap_or_default();
        // A budget that differs from the usual one was set for this ray.
        let most = |own: u32| match own == MAX_RAYS as u32 {
            true => ends.budget,
            false => Budget { rays: own, work: own },
        };
        let mut budgets = take(&mut scratch.budgets);
        budgets.clear();
        budgets.extend(group.ray_budget[..len].iter().copied().map(most));
        group.ray_budget.fill(MAX_RAYS as u32);
        group.places.clear();
        group.places.extend(0..len as u32);
        scratch.begin_primary(len);
        self.scratch.trees = Some(scratch);
        self.scratch.path_hashes.is_mixed = true;
        self.trace(group, colours);
        let mut scratch = self.scratch.trees.take().unwrap_or_default();
        scratch.swap_primary();
        // Where no ray continues, the colour is known.
        let goes_on = |lane: &u8| !scratch.primary.outcomes[usize::from(*lane)].onward.is_empty();
        let mut lanes = take(&mut scratch.lanes);
        lanes.clear();
        lanes.extend((0..len).map(|lane| lane as u8).filter(goes_on));
        for lanes in lanes.chunks(TOGETHER) {
            let TreeScratch { trees, numbers, primary, wave, .. } = &mut *scratch;
            trees.resize_with(trees.len().max(lanes.len()), Tree::default);
            numbers.resize(len.max(numbers.len()), 0);
            wave.rays.clear();
            for ((tree, lane), number) in trees.iter_mut().zip(lanes).zip(0..) {
                let lane = usize::from(*lane);
                numbers[lane] = number;
                let outcome = &mut primary.outcomes[lane];
                outcome.light = colours.get(lane);
                outcome.cost = MAX_RAYS as u32 - group.ray_budget[lane];
                tree.begin(budgets[lane]);
                primary.add(lane, tree, depth, &ends);
                tree.next(&ends, depth, &mut wave.rays);
            }
            while !scratch.wave.rays.is_empty() {
                scratch = self.follow(scratch);
                scratch.add(depth, &ends);
                let TreeScratch { trees, wave, .. } = &mut *scratch;
                wave.rays.clear();
                trees[..lanes.len()].iter_mut().for_each(|tree| tree.next(&ends, depth, &mut wave.rays));
            }
            for (tree, lane) in scratch.trees.iter().zip(lanes) {
                let (End { colour, apart }, lane) = (tree.end(&ends), usize::from(*lane));
                colours.set(lane, colour);
                if self.sees_events
                    && let Some(reason) = tree.drops()
                {
                    self.observer.see(Event::Dropped(reason));
                }
                if apart > 0.0 {
                    self.miss_levels(lane, apart);
                }
            }
        }
        (scratch.lanes, scratch.budgets) = (lanes, budgets);
        self.scratch.trees = Some(scratch);
    }

    /// Follows the rays of a wave.
    fn follow(&mut self, mut scratch: Box<TreeScratch>) -> Box<TreeScratch> {
        scratch.wave.begin(scratch.wave.rays.len());
        let (mut group, mut seen) = (take(&mut scratch.group), take(&mut scratch.seen));
        let mut order = take(&mut scratch.order);
        order.clear();
        order.extend(0..scratch.wave.rays.len() as u32);
        // The hits of rays of little weight are not recorded, as another sample's tree may have ended before them.
        let records = self.scratch.path_hashes.is_on;
        let kind = |place: u32| {
            let OpenRay { object, weight, counted, .. } = scratch.wave.rays[place as usize];
            (object, counted, records && weight.abs().max_element() >= HEAVY)
        };
        order.sort_by_key(|place| kind(*place));
        let kinds: Vec<_> = order.iter().map(|place| kind(*place)).collect();
        // An observer sees one ray after the other.
        let together = if self.sees_events { 1 } else { PACKET_SIZE };
        self.depth += 1;
        let mut start = 0;
        while let Some(kind) = kinds.get(start).copied() {
            let same = kinds[start..].iter().take(together).take_while(|other| **other == kind);
            let (_, counted, is_heavy) = kind;
            let places = &order[start..start + same.count()];
            start += places.len();
            self.scratch.path_hashes.is_on = is_heavy;
            scratch.gather(places, &mut group);
            self.begin_open(&scratch.wave.rays, places);
            self.scratch.trees = Some(scratch);
            self.counted = counted;
            self.trace(&mut group, &mut seen);
            scratch = self.scratch.trees.take().unwrap_or_default();
            scratch.note(&group, &seen);
        }
        self.depth -= 1;
        self.counted = CountedLight::All;
        self.scratch.path_hashes.is_on = records;
        (scratch.group, scratch.seen, scratch.order) = (group, seen, order);
        scratch
    }

    /// Reports rays that are followed together.
    fn begin_open(&mut self, wave: &[OpenRay], places: &[u32]) {
        let of_kind =
            |kind: RayKind| places.iter().filter(|place| wave[**place as usize].kind == kind).count();
        for kind in [RayKind::Reflected, RayKind::Transmitted, RayKind::Scattered] {
            self.observer.count(Count::Rays(kind, of_kind(kind)));
        }
        if self.sees_events {
            let OpenRay { kind, weight, .. } = wave[places[0] as usize];
            self.observer.see(Event::Begin(match kind {
                RayKind::Transmitted => RayPurpose::Transmitted { tint: weight, kept: 1.0 },
                RayKind::Scattered => RayPurpose::Scattered { diffuse: weight },
                _ => RayPurpose::Reflected { specular: weight },
            }));
        }
    }

    /// Opens the rays that continue from a packet's hits on an object, and leaves the points' own light in `colours`.
    pub(super) fn branch(
        &mut self,
        group: &RayGroup,
        shading: &mut ShadingScratch,
        colours: &mut VectorList,
    ) {
        let scatters = self.scatters(group, shading);
        let ShadingScratch { surface, dir, diffuse, .. } = shading;
        let object = &self.model.objects[surface.index];
        let transparency = object.material.transparency;
        let covers_all = surface.coverage.is_empty();
        if covers_all
            && transparency == 0.0
            && !surface.is_mirror
            && object.material.interface.is_none()
            && !scatters
        {
            return;
        }
        let Some(mut scratch) = self.scratch.trees.take() else { return };
        let Wave { rays, outcomes, onward: continued } = &mut scratch.wave;
        let aims = self.aims();
        let (count, kept, is_flat) = (group.padded(), 1.0 - transparency, object.is_flat_mirror());
        let crossings = object.material.interface.as_deref();
        let crossings = crossings.map(|interface| surface.crossings(interface, group.dir.view(count)));
        surface.mirror_rays(group.dir.view(count), dir);
        for lane in 0..group.len {
            let side = surface.sides[lane];
            let tint = || surface.tint(object, lane);
            let covered = surface.coverage.get(lane).copied().unwrap_or(1.0);
            let beyond = Rgb::splat(1.0 - covered);
            let (through, onward, reflected, beyond) = match &crossings {
                Some(crossings) => {
                    let Crossing { reflected, onward } = crossings[lane];
                    let through = onward.map_or(Rgb::ZERO, |_| covered * tint() * (Rgb::ONE - reflected));
                    (through, onward, reflected, beyond)
                }
                // What is transmitted unbent and what is not covered are one ray.
                None => {
                    let through = if transparency == 0.0 { Rgb::ZERO } else { covered * tint() };
                    (through + beyond, Some(group.dir.get(lane)), surface.mirror(lane), Rgb::ZERO)
                }
            };
            colours.set(lane, kept * colours.get(lane));
            let place = group.places[lane] as usize;
            let before = &rays[place];
            if before.depth as usize >= self.plan.max_depth {
                continue;
            }
            let passed_here = surface.passed.get(lane).copied();
            let passed = passed_here.map_or(before.weight, |passed| before.weight * passed);
            let clear = match self.plan.camera.alpha {
                true => before.clear * (1.0 - covered) * passed_here.map_or(1.0, Rgb::min_element),
                false => 0.0,
            };
            let ray = surface.open_ray(lane, before);
            let open = |weight: Rgb, dir: DVec3, side: Side, kind: RayKind| {
                let keeps = match kind {
                    RayKind::Transmitted => dir == group.dir.get(lane),
                    RayKind::Scattered => false,
                    _ => is_flat,
                };
                let (weight, shows_patches) = (passed * weight, before.shows_patches && keeps);
                let is_unbent = kind == RayKind::Transmitted && !object.bends_light();
                let counted = before.counted.after(kind, is_unbent);
                let density = match kind {
                    RayKind::Transmitted if is_unbent => Some(before.density),
                    RayKind::Reflected if aims && !surface.is_in_medium(object, lane) => {
                        surface.facets.get(lane).map(|facets| facets.density_of(dir))
                    }
                    RayKind::Scattered => Some(dir.dot(surface.smooth_normal(lane)) / PI),
                    _ => None,
                };
                let density = density.unwrap_or(f64::INFINITY);
                let (chosen, since) = match is_unbent {
                    true => (before.chosen, before.since + (ray.travelled - before.travelled)),
                    false => (ray.object, 0.0),
                };
                let ray = OpenRay {
                    weight,
                    dir,
                    side,
                    kind,
                    shows_patches,
                    counted,
                    density,
                    chosen,
                    since,
                    clear: 0.0,
                    ..ray
                };
                (weight != Rgb::ZERO).then_some(ray)
            };
            let goes_on = scatters && before.bounces < self.plan.camera.bounces;
            let scattered = if goes_on { self.scattered(group, surface, lane, before.depth) } else { None };
            let scattered = scattered
                .and_then(|dir| {
                    let passed = surface.passed_by_coat(&object.material, lane, group.dir.get(lane), dir);
                    open(covered * kept * passed * diffuse.get(lane), dir, side, RayKind::Scattered)
                })
                .map(|ray| OpenRay { bounces: before.bounces + 1, ..ray });
            let mut past = match covers_all {
                true => None,
                false => open(beyond, group.dir.get(lane), side.opposite(), RayKind::Transmitted),
            };
            let mut through =
                onward.and_then(|dir| open(through, dir, side.opposite(), RayKind::Transmitted));
            // What is not covered goes on alone, or with what is transmitted unbent.
            let uncovered = if crossings.is_some() { &mut past } else { &mut through };
            uncovered.iter_mut().for_each(|ray| ray.clear = clear);
            let reflected = open(covered * reflected, dir.get(lane), side, RayKind::Reflected);
            let mut branches = [through, reflected, scattered, past];
            if self.plan.camera.bounces != 0 {
                self.choose(before, &mut branches);
            }
            let first = continued.len();
            continued.extend(branches.into_iter().flatten());
            outcomes[place].onward = first..continued.len();
        }
        self.scratch.trees = Some(scratch);
    }
}
