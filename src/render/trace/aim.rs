//! Light that rays meet both by aim and by chance.
//!
//! A facet of a rough surface seldom mirrors a ray toward a small lamp, and a matt surface seldom scatters one toward a
//! small surface that emits: then few samples are very bright. So each sample also aims at a point of each lamp that
//! mirrors show, and at one of all that objects emit. What is found in a direction by either way is weighted by the
//! density of this way among those of both: the balance heuristic (Veach, "Robust Monte Carlo Methods for Light Transport
//! Simulation", 1997, section 9.2). So by aim, no lamp adds more to a sample than a mirror or a white surface would return
//! that sees nothing but the lamp.
//!
//! Nothing is aimed at through glass, or from inside of glass that absorbs light: there, chance alone meets it, and counts
//! it whole.

use super::arrays::{VectorList, resized};
use super::context::{LightScratch, ShadingScratch, Tracer};
use super::facets::Facets;
use super::occlusion::LightPaths;
use super::ray_group::RayGroup;
use super::surface::Surface;
use super::tree::OpenRay;
use crate::plan::Ways;
use crate::plan::glow::Glow;
use crate::plan::lamps::is_aimed_at;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;
use std::mem::take;
use tabray_world::emitter::{EnclosedEmitter, LightSample};
use tabray_world::geometry::aabb::{self, Aabb};
use tabray_world::interface::Interface;
use tabray_world::material::Rgb;

/// What rays aim at.
#[derive(Clone, Copy)]
enum Target<'t> {
    /// The light of this index.
    Lamp(usize, &'t dyn EnclosedEmitter),
    /// What objects emit.
    Glow(&'t Glow),
}

impl Target<'_> {
    /// Chooses a point by two numbers from 0 to 1, as seen from a point with a unit normal on the object of this index,
    /// with the density of the choice per unit of solid angle.
    fn sample(
        &self,
        (from, at): (usize, DVec3),
        normal: DVec3,
        numbers: DVec2,
    ) -> Option<(LightSample, f64)> {
        match self {
            Self::Lamp(_, emitter) => {
                let sample = emitter.sample_at(at, normal, numbers)?;
                Some((sample, emitter.density(at, sample.toward, sample.distance)?))
            }
            Self::Glow(glow) => glow.sample((from, at), normal, numbers),
        }
    }
}

/// A sample of a target that nothing blocks.
pub(super) struct Aimed {
    /// The lane of the ray whose hit it lights.
    lane: usize,
    sample: LightSample,
    /// The density of its choice, per unit of solid angle.
    density: f64,
}

impl Tracer<'_, '_> {
    /// Tells whether rays that continue from rough surfaces meet anything by aim, too.
    pub(super) fn aims(&self) -> bool {
        !self.plan.lamps.is_empty() || self.plan.glow.is_some()
    }

    /// Adds the light that facets mirror toward the viewer, as it is met by aim.
    pub(super) fn gleam(
        &mut self,
        group: &mut RayGroup,
        surface: &Surface,
        interface: &dyn Interface,
        colours: &mut VectorList,
    ) {
        if self.plan.max_depth == 0 {
            return;
        }
        let (model, plan) = (self.model, self.plan);
        let lamps = plan.needs.lights.iter().filter(|_| !plan.lamps.is_empty()).filter_map(|index| {
            let light = &model.lights[*index].value;
            light.emitter().filter(|_| is_aimed_at(light)).map(|emitter| Target::Lamp(*index, emitter))
        });
        for target in lamps.chain(plan.glow.as_ref().map(Target::Glow)) {
            let aimed = self.aim(target, group, surface);
            for Aimed { lane, sample, density } in &aimed {
                let lane = *lane;
                let facets = Facets::seen(surface, lane, group.dir.get(lane), interface);
                let interface = surface.interface(lane, interface);
                let (mirrored, by_chance) = facets.mirrored(interface, surface.sides[lane], sample.toward);
                let light = PI * *density * self.part(*density, by_chance) * sample.light;
                colours.set(lane, colours.get(lane) + light * mirrored);
            }
            self.scratch.aimed = aimed;
        }
        self.miss_shadows(group, surface);
    }

    /// Adds the light that matt surfaces get from objects that emit, as it is met by aim.
    pub(super) fn glow(
        &mut self,
        group: &mut RayGroup,
        shading: &mut ShadingScratch,
        colours: &mut VectorList,
    ) {
        let plan = self.plan;
        let Some(glow) = &plan.glow else { return };
        if !self.scatters(group, shading) {
            return;
        }
        let ShadingScratch { surface, diffuse, .. } = shading;
        let material = &self.model.objects[surface.index].material;
        let aimed = self.aim(Target::Glow(glow), group, surface);
        let Some(trees) = &self.scratch.trees else { return };
        for Aimed { lane, sample: LightSample { toward, light, .. }, density } in &aimed {
            let lane = *lane;
            let before = &trees.wave.rays[group.places[lane] as usize];
            if before.bounces < plan.camera.bounces && (before.depth as usize) < plan.max_depth {
                let cosine = toward.dot(surface.normals.get(lane));
                let passed = surface.passed_by_coat(material, lane, group.dir.get(lane), *toward);
                let weight = passed * cosine * density * self.part(*density, cosine / PI);
                colours.set(lane, colours.get(lane) + weight * diffuse.get(lane) * *light);
            }
        }
        self.scratch.aimed = aimed;
        self.miss_shadows(group, surface);
    }

    /// Aims at points of a target from the points of a surface.
    fn aim(&mut self, target: Target, group: &mut RayGroup, surface: &Surface) -> Vec<Aimed> {
        let mut aimed = take(&mut self.scratch.aimed);
        aimed.clear();
        let mut lighting = self.scratch.lighting.take().unwrap_or_default();
        let LightScratch { draws, toward, t_max, shines, blocked, shadows, emissivity: passed, .. } =
            &mut *lighting;
        let count = group.padded();
        let (t_max, slack) = (resized(t_max, count), self.slack());
        t_max.fill(0.0);
        toward.fill(count, DVec3::Y);
        let mut to = Aabb::EMPTY;
        let index = match target {
            Target::Lamp(index, _) => index,
            Target::Glow(_) => self.model.lights.len(),
        };
        let object = &self.model.objects[surface.index];
        if self.plan.ways != Ways::Chance
            && let Some(numbers) = self.draw(index, group, draws)
        {
            for lane in (0..group.len).filter(|lane| !surface.is_in_medium(object, *lane)) {
                let (at, normal) = (surface.points.get(lane), surface.normals.get(lane));
                let sample = target.sample((surface.index, at), normal, numbers(lane));
                let is_before = |dir: DVec3| {
                    let is_above = |normal: DVec3| dir.dot(normal) > 0.0;
                    is_above(normal) && surface.bent_from(lane).is_none_or(is_above)
                };
                let Some((sample, density)) = sample.filter(|(sample, _)| is_before(sample.toward)) else {
                    continue;
                };
                let LightSample { toward: dir, distance, .. } = sample;
                toward.set(lane, dir);
                t_max[lane] = (distance - slack * (distance + at.abs().max_element())).max(0.0);
                let end = at + distance * dir;
                to = to.and(&Aabb { low: end, high: end });
                aimed.push(Aimed { lane, sample, density });
            }
        }
        if !aimed.is_empty() {
            let from = aabb::around(self.cpu, surface.points.view(count));
            let paths = LightPaths { from, to, toward };
            if self.plan.has_glass {
                let shines = resized(shines, count);
                shines.fill(0);
                aimed.iter().for_each(|aimed| shines[aimed.lane] = 1);
                passed.fill(count, Rgb::ONE);
                // Light that is bent on the way is met by chance.
                self.scratch.unbent = true;
                self.pass(group, surface, &paths, t_max, shines, passed);
                self.scratch.unbent = false;
                aimed.retain(|aimed| shines[aimed.lane] != 0);
                aimed.iter_mut().for_each(|aimed| aimed.sample.light *= passed.get(aimed.lane));
            } else {
                let blocked = resized(blocked, count);
                self.shadow(group, surface, &paths, t_max, shadows, blocked);
                aimed.retain(|aimed| blocked[aimed.lane] != 1);
            }
        }
        self.scratch.lighting = Some(lighting);
        aimed
    }

    /// Returns the part of the light of an object that counts where a ray meets it by chance at a distance, on a surface
    /// with this normal, at which the object's shader gives this light.
    pub(super) fn part_by_chance(
        &self,
        group: &RayGroup,
        lane: usize,
        (object, normal, light): (usize, DVec3, Rgb),
        distance: f64,
    ) -> f64 {
        let place = group.places.get(lane.min(group.len - 1));
        let trees = self.scratch.trees.as_ref().filter(|_| self.depth != 0);
        let Some((trees, place)) = trees.zip(place) else { return 1.0 };
        let OpenRay { density: by_chance, chosen, since, .. } = trees.wave.rays[*place as usize];
        if by_chance == f64::INFINITY {
            return 1.0;
        }
        let dir = group.dir.get(lane);
        let (at, distance) = (group.origin.get(lane) - since * dir, distance + since);
        let lamp = self.plan.lamps.get(object).copied().flatten();
        let emitter = lamp.and_then(|lamp| self.model.lights[lamp].value.emitter());
        let by_aim = match (emitter, &self.plan.glow) {
            (Some(emitter), _) => emitter.density(at, dir, distance),
            (None, Some(glow)) => {
                glow.density((object, normal, light), (Some(chosen as usize), at), dir, distance)
            }
            (None, None) => None,
        };
        match (by_aim, self.plan.ways) {
            (None, _) | (_, Ways::Chance) => 1.0,
            (Some(_), Ways::Aim) => 0.0,
            (Some(by_aim), Ways::Both) => by_chance / (by_chance + by_aim),
        }
    }

    /// Returns the part that counts of what is aimed at, divided by its density, given the density by chance.
    fn part(&self, by_aim: f64, by_chance: f64) -> f64 {
        match self.plan.ways {
            Ways::Aim => 1.0 / by_aim,
            _ => 1.0 / (by_aim + by_chance),
        }
    }

    /// Tells whether rays aim at an object's own light.
    pub(super) fn is_aimed_at(&self, object: usize) -> bool {
        self.plan.lamps.get(object).is_some_and(Option::is_some)
            || self.plan.glow.as_ref().is_some_and(|glow| glow.is_aimed_at(object))
    }
}
