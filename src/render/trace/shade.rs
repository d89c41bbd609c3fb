//! The colours of the points where a packet's rays hit objects.

use super::arrays::{VectorList, compact, gather, resized};
use super::closest_hit;
use super::context::{HitScratch, ShadingScratch, Tracer};
use super::light;
use super::mixed;
use super::ray_group::RayGroup;
use super::scatter::CountedLight;
use super::surface::{SeenPatches, Surface};
use crate::observer::{Count, DropReason, Event, Hit, RayKind, RayPurpose};
use crate::plan::depth::{Branch, STEPS, step};
use glam::DVec3;
use std::mem::swap;
use tabray_world::background::EnclosedBackground;
use tabray_world::geometry::ray_packet::SurfaceInteraction;
use tabray_world::interface::{Crossing, Interface};
use tabray_world::material::Rgb;
use tabray_world::packets::shader::SurfacePoints;
use tabray_world::rules::{self, Rules};
use tabray_world::scene::model::Object;

impl Tracer<'_, '_> {
    /// Computes the light that returns along the rays of a packet.
    pub(super) fn trace(&mut self, group: &mut RayGroup, colours: &mut VectorList) {
        let mut level = self.scratch.levels.pop().unwrap_or_default();
        let HitScratch { hits, parts, part, looks, near, far, shading, seen } = &mut *level;
        self.closest(group, None, hits);
        let hit_ids = &hits.hit_ids[..group.len];
        shading.surface.objects.clear();
        if hit_ids[0] != 0 && closest_hit::is_one(self.cpu, hit_ids) {
            self.shade(group, (&hits.near, &hits.far), hit_ids[0] as usize - 1, shading, colours);
        } else {
            colours.resized(group.padded());
            let same_look = self.plan.same_look.as_ref();
            let same_look =
                same_look.filter(|_| !self.scratch.path_hashes.is_on && mixed::are_short(hit_ids));
            match same_look {
                Some(same_look) => {
                    looks.clear();
                    looks.extend(hit_ids.iter().map(|id| same_look.look_up(*id)));
                    parts.begin(looks);
                }
                None => parts.begin(hit_ids),
            }
            while let Some((id, lanes)) = parts.next() {
                if id == 0 {
                    match self.model.background.as_ref().filter(|_| self.sees_background()) {
                        None => lanes.iter().for_each(|lane| colours.set(usize::from(*lane), Rgb::ZERO)),
                        Some(background) => {
                            see_background(&*background.value, group, &hits.far, lanes, colours);
                            self.absorb_endlessly(group, lanes, colours);
                        }
                    }
                    if self.plan.camera.alpha {
                        self.show_through(group, &hits.far, lanes, colours);
                    }
                    continue;
                }
                let object = hit_ids[usize::from(lanes[0])] as usize - 1;
                if same_look.is_some() {
                    mixed::list(hit_ids, lanes, &mut shading.surface.objects);
                }
                part.gather(group, lanes);
                gather(near, &hits.near, lanes, part.padded());
                gather(far, &hits.far, lanes, part.padded());
                self.shade(part, (near, far), object, shading, seen);
                colours.scatter(seen, lanes);
                group.charge(part, lanes);
            }
        }
        if self.sees_events {
            self.observer.see(Event::Colour(colours.get(0)));
        }
        self.scratch.levels.push(level);
    }

    /// Computes the colours of rays that all hit the object of this index, at distances in these brackets.
    fn shade(
        &mut self,
        group: &mut RayGroup,
        brackets: (&[f64], &[f64]),
        index: usize,
        shading: &mut ShadingScratch,
        colours: &mut VectorList,
    ) {
        let (cpu, count) = (self.cpu, group.padded());
        if shading.surface.objects.is_empty() {
            self.refine(group, brackets, index, &mut shading.distances);
        } else {
            self.refine_mixed(group, brackets, &shading.surface.objects, &mut shading.distances);
        }
        let (distances, surface) = (&shading.distances[..count], &mut shading.surface);
        let object = &self.model.objects[index];
        let material = &object.material;
        self.find_surface(group, distances, index, surface, colours);
        let is_free = self.plan.camera.rules == Rules::Free;
        surface.coverage.clear();
        if is_free {
            surface.cover(object, count);
        }
        surface.polish(object, count);
        let (glints, roughness) = (material.glints(), material.roughness());
        let gleams = is_free && roughness != 0.0 && self.aims();
        match glints {
            true => self.glint(group, surface, &mut shading.glints),
            false if gleams => shading.glints.fill(count, Rgb::ZERO),
            false => {}
        }
        if let Some(interface) = material.interface.as_deref().filter(|_| gleams) {
            self.gleam(group, surface, interface, &mut shading.glints);
        }
        // Where a surface keeps no light of its own, lamps make no difference.
        if !is_free || material.transparency != 1.0 {
            self.illuminate(group, surface, colours);
            self.glow(group, shading, colours);
        }
        let surface = &mut shading.surface;
        if !is_free {
            light::fade(cpu, &surface.travelled[..count], colours.resized(count));
        }
        if self.sees_events {
            let (point, travelled) = (surface.points.get(0), surface.travelled[0]);
            let hit = Hit { index, object, distance: shading.distances[0], point };
            self.observer.see(Event::Shaded { hit: &hit, travelled, colour: colours.get(0) });
        }
        if let Some(interface) = material.interface.as_deref().filter(|_| roughness != 0.0) {
            self.draw_facets(group, surface, interface);
        }
        match &material.interface {
            _ if is_free => self.branch(group, shading, colours),
            Some(interface) => self.add_split(&**interface, group, shading, colours),
            None => {
                if material.transparency != 0.0 {
                    self.add_transmitted(group, shading, colours);
                    self.keep_first_reflections(group);
                }
                if shading.surface.is_mirror {
                    self.add_reflected(group, shading, colours);
                }
            }
        }
        if glints || gleams {
            (0..count).for_each(|lane| colours.set(lane, colours.get(lane) + shading.glints.get(lane)));
        }
        for (lane, covered) in shading.surface.coverage.iter().enumerate() {
            colours.set(lane, *covered * colours.get(lane));
        }
        for (lane, passed) in shading.surface.passed.iter().enumerate() {
            colours.set(lane, colours.get(lane) * *passed);
        }
    }

    /// Computes the points at these distances, where the rays of a packet hit an object, with their looks and errors,
    /// and sets the colours to their ambient light.
    #[inline]
    fn find_surface(
        &mut self,
        group: &RayGroup,
        distances: &[f64],
        index: usize,
        surface: &mut Surface,
        colours: &mut VectorList,
    ) {
        let (cpu, count) = (self.cpu, group.padded());
        let object = &self.model.objects[index];
        let Object { material, shape, shader, .. } = object;
        surface.index = index;
        surface.facets.clear();
        let travelled = resized(&mut surface.travelled, count);
        travelled.copy_from_slice(&group.travelled[..count]);
        if surface.objects.is_empty() {
            let interaction = SurfaceInteraction {
                points: surface.points.resized(count),
                normals: surface.normals.resized(count),
                geometric_normals: surface.geometric_normals.resized(count),
                sides: resized(&mut surface.sides, count),
                cosines: resized(&mut surface.cosines, count),
                travelled,
            };
            shape.packets().interact(cpu, group.rays(), distances, interaction);
        } else {
            self.interact_mixed(group, distances, surface);
        }
        self.pass_media(group, distances, surface);
        let window = if shader.sees().patch { self.plan.camera.window() } else { None };
        // Rays that continue from others are those of a wave.
        let open = self.scratch.trees.as_ref().filter(|_| self.depth != 0);
        let are_shown = |lane: usize| match open {
            None => self.depth == 0,
            Some(trees) => trees.wave.rays[group.places[lane.min(group.len - 1)] as usize].shows_patches,
        };
        let patches =
            window.map(|window| SeenPatches { dir: group.dir.view(count), window, are_shown: &are_shown });
        surface.see(object, count, patches);
        surface.look = shader.uniform(material).map(|look| material.coated(look));
        surface.is_mirror = match surface.look {
            Some(look) => {
                colours.fill(count, look.ambient);
                look.specular != Rgb::ZERO
            }
            None => {
                let (points, seen) = (surface.points.view(count), &surface.seen);
                let points = SurfacePoints { positions: points, seen };
                let (ambients, speculars) = (colours.resized(count), surface.specular.resized(count));
                shader.ambient_and_specular(cpu, material, points, ambients, speculars)
            }
        };
        let shares_light = self.depth != 0 && self.is_aimed_at(index);
        if self.counted != CountedLight::All || material.emission != Rgb::ZERO || shares_light {
            self.emit(group, surface, distances, colours);
        }
        if self.scratch.path_hashes.is_on {
            let nearest = (self.depth == 0).then_some(distances);
            let shader = surface.look.is_none().then_some((&**shader, surface.points(count)));
            self.scratch.path_hashes.meet(cpu, &group.camera[..group.len], index, nearest, shader);
        }
        let goes_on = !self.plan.needs.lights.is_empty()
            || surface.is_mirror
            || material.transparency != 0.0
            || self.plan.camera.bounces != 0;
        if surface.objects.is_empty() {
            let Surface { travelled, cosines, errors, .. } = surface;
            match goes_on {
                true => self.bound_errors(&**shape, &travelled[..count], &cosines[..count], errors),
                false => errors.clear(),
            }
        }
        if self.sees_events {
            self.observer.see(Event::Surface { normal: surface.normals.get(0), ambient: colours.get(0) });
        }
    }

    /// Adds transmitted light.
    fn add_transmitted(
        &mut self,
        group: &mut RayGroup,
        shading: &mut ShadingScratch,
        colours: &mut VectorList,
    ) {
        let (count, surface) = (group.padded(), &mut shading.surface);
        let object = &self.model.objects[surface.index];
        let kept = 1.0 - object.material.transparency;
        if self.sees_events {
            let tint = surface.tint(object, 0);
            self.observer.see(Event::Begin(RayPurpose::Transmitted { tint, kept }));
        }
        let branch = self.plan.continuation(surface.index).through;
        let (travelled, continue_mask) =
            (&surface.travelled[..count], resized(&mut shading.continue_mask, count));
        light::reach(self.cpu, travelled, continue_mask);
        group.cull_faint(self.cpu, &branch, travelled, continue_mask);
        self.end_deep(continue_mask);
        shading.dir.copy(group.dir.view(count));
        surface.flip_sides(count);
        self.trace_secondary(group, shading, RayKind::Transmitted, branch);
        let surface = &mut shading.surface;
        surface.flip_sides(count);
        for lane in 0..group.len {
            let (own, incoming) = (colours.get(lane), shading.incoming.get(lane));
            let tint = surface.tint(object, lane);
            colours.set(lane, rules::transmitted(own, Rgb::splat(kept), incoming, tint));
        }
    }

    /// Ends all rays where a measurement limits their depth.
    fn end_deep(&self, continue_mask: &mut [u64]) {
        if self.depth >= self.plan.max_depth {
            continue_mask.fill(0);
        }
    }

    /// Adds reflected light.
    fn add_reflected(
        &mut self,
        group: &mut RayGroup,
        shading: &mut ShadingScratch,
        colours: &mut VectorList,
    ) {
        let ShadingScratch { surface, continue_mask, dir, .. } = shading;
        if self.sees_events {
            let specular = match surface.look {
                Some(look) => look.specular,
                None => surface.specular.get(0),
            };
            self.observer.see(Event::Begin(RayPurpose::Reflected { specular }));
        }
        let (cpu, count) = (self.cpu, group.padded());
        let (normals, specular) = (surface.normals.view(count), surface.mirrors(count));
        let (travelled, continue_mask) = (&surface.travelled[..count], resized(continue_mask, count));
        let dir = dir.resized(count);
        let branch = self.plan.continuation(surface.index).mirrored;
        light::mirror(cpu, group.dir.view(count), normals, specular, travelled, continue_mask, dir);
        if surface.is_bent {
            surface.keep_before(group.dir.view(count), &mut shading.dir);
        }
        group.cull_faint(cpu, &branch, travelled, continue_mask);
        self.end_deep(continue_mask);
        let do_all = continue_mask[0] != 0 && closest_hit::is_one(cpu, continue_mask);
        if do_all && group.len <= self.max_packet() {
            self.trace_all_secondary(group, shading, branch);
        } else {
            self.trace_secondary(group, shading, RayKind::Reflected, branch);
        }
        let specular = shading.surface.mirrors(count);
        light::reflect(cpu, specular, shading.incoming.view(count), colours.resized(count));
    }

    /// Adds transmitted and reflected light, in the fractions that an interface decides.
    ///
    /// The largest reflected fraction of a ray, rounded up to a power of two, decides how deep the ray is followed.
    /// So the other rays of the packet make no difference.
    fn add_split(
        &mut self,
        interface: &dyn Interface,
        group: &mut RayGroup,
        shading: &mut ShadingScratch,
        colours: &mut VectorList,
    ) {
        let (count, surface) = (group.padded(), &mut shading.surface);
        let (object, branches) = (&self.model.objects[surface.index], self.plan.continuation(surface.index));
        let kept = 1.0 - object.material.transparency;
        let crossings = surface.crossings(interface, group.dir.view(count));
        let tint = |lane| surface.tint(object, lane) * (Rgb::ONE - crossings[lane].reflected);
        let tints: Vec<Rgb> = (0..group.len).map(tint).collect();
        (0..group.len).for_each(|lane| colours.set(lane, kept * colours.get(lane)));

        let is_through = |lane: usize| crossings[lane].onward.is_some();
        if (0..group.len).any(is_through) {
            if self.sees_events {
                self.observer.see(Event::Begin(RayPurpose::Transmitted { tint: tints[0], kept }));
            }
            surface.flip_sides(count);
            let mut dir = shading.dir.resized(count);
            for lane in 0..count {
                dir.set(lane, crossings[lane].onward.unwrap_or(DVec3::NEG_Z));
            }
            self.trace_selected(group, shading, RayKind::Transmitted, branches.through, is_through);
            shading.surface.flip_sides(count);
            for lane in 0..group.len {
                colours.set(lane, colours.get(lane) + tints[lane] * shading.incoming.get(lane));
            }
        }

        self.keep_first_reflections(group);
        self.add_split_reflected(&crossings, branches.mirrored, group, shading, colours);
    }

    /// Adds the reflected light of [`add_split`](Self::add_split).
    fn add_split_reflected(
        &mut self,
        crossings: &[Crossing],
        branch: Branch,
        group: &mut RayGroup,
        shading: &mut ShadingScratch,
        colours: &mut VectorList,
    ) {
        let steps: Vec<_> = crossings.iter().map(|crossing| step(crossing.reflected.max_element())).collect();
        for number in 0..=STEPS {
            let is_its = |lane: usize| steps[lane] == Some(number);
            if !(0..group.len).any(is_its) {
                continue;
            }
            if self.sees_events {
                let specular = crossings[0].reflected;
                self.observer.see(Event::Begin(RayPurpose::Reflected { specular }));
            }
            shading.surface.mirror_rays(group.dir.view(group.padded()), &mut shading.dir);
            self.trace_selected(group, shading, RayKind::Reflected, branch.reduced(number), is_its);
            for lane in (0..group.len).filter(|lane| is_its(*lane)) {
                let seen = crossings[lane].reflected * shading.incoming.get(lane);
                colours.set(lane, colours.get(lane) + seen);
            }
        }
    }

    /// Computes the light that returns along the rays that are chosen.
    fn trace_selected(
        &mut self,
        group: &mut RayGroup,
        shading: &mut ShadingScratch,
        kind: RayKind,
        branch: Branch,
        is_chosen: impl Fn(usize) -> bool,
    ) {
        let count = group.padded();
        let (travelled, continue_mask) =
            (&shading.surface.travelled[..count], resized(&mut shading.continue_mask, count));
        light::reach(self.cpu, travelled, continue_mask);
        for (lane, mask) in continue_mask.iter_mut().enumerate() {
            *mask &= u64::from(is_chosen(lane));
        }
        group.cull_faint(self.cpu, &branch, travelled, continue_mask);
        self.end_deep(continue_mask);
        self.trace_secondary(group, shading, kind, branch);
    }

    /// Computes the light that returns along the rays that continue from a surface. It is black for points from which
    /// no ray continues: those that are too far away, or whose ray can return too little.
    fn trace_secondary(
        &mut self,
        group: &mut RayGroup,
        shading: &mut ShadingScratch,
        kind: RayKind,
        branch: Branch,
    ) {
        let ShadingScratch { surface, dir, continue_mask, lanes, secondary, seen, incoming, .. } = shading;
        let lanes = compact(&continue_mask[..group.len], lanes);
        if lanes.len() < group.len {
            self.end_far(group, surface, continue_mask, kind, &branch);
        }
        if self.sees_events && lanes.is_empty() {
            let is_far = rules::path_left(surface.travelled[0]) < 0.0;
            self.observer.see(Event::Dropped(if is_far { DropReason::TooFar } else { DropReason::TooFaint }));
            self.observer.see(Event::Colour(DVec3::ZERO));
        }
        self.observer.count(Count::Rays(kind, lanes.len()));
        let rays = surface.secondary_rays(dir);
        incoming.fill(group.padded(), DVec3::ZERO);
        let max_packet = self.max_packet();
        self.depth += 1;
        for lanes in lanes.chunks(max_packet) {
            secondary.continue_from(group, &rays, lanes);
            secondary.branch(&branch);
            self.trace(secondary, seen);
            incoming.scatter(seen, lanes);
            group.charge(secondary, lanes);
        }
        self.depth -= 1;
    }

    /// Implements [`trace_secondary`](Self::trace_secondary) where all rays of the group are reflected. The rays are
    /// not needed here afterwards, so their arrays are swapped, not copied.
    fn trace_all_secondary(&mut self, group: &mut RayGroup, shading: &mut ShadingScratch, branch: Branch) {
        let ShadingScratch { surface, dir, secondary, incoming, .. } = shading;
        self.observer.count(Count::Rays(RayKind::Reflected, group.len));
        self.depth += 1;
        secondary.take(group, surface, dir);
        secondary.branch(&branch);
        self.trace(secondary, incoming);
        swap(&mut group.ray_budget, &mut secondary.ray_budget);
        self.depth -= 1;
    }
}

/// Sets the colours of rays that hit nothing. Those whose budget is used up end at a distance of 0, and are black.
fn see_background(
    background: &dyn EnclosedBackground,
    group: &RayGroup,
    far: &[f64],
    lanes: &[u8],
    colours: &mut VectorList,
) {
    for lane in lanes.iter().map(|lane| usize::from(*lane)) {
        let is_over = far[lane] == 0.0;
        colours.set(lane, if is_over { Rgb::ZERO } else { background.colour_toward(group.dir.get(lane)) });
    }
}
