//! Direct light: what a scene's lights contribute at the points of a surface.

use super::arrays::{VectorList, resized};
use super::context::{LightScratch, Tracer};
use super::draws::LightDraws;
use super::light::{self, Colours, LitPoints};
use super::occlusion::LightPaths;
use super::ray_group::RayGroup;
use super::surface::Surface;
use crate::observer::{Event, LightOutcome};
use crate::plan::ShutOut;
use glam::{DVec2, DVec3};
use tabray_world::emitter::{EnclosedEmitter, LightSample};
use tabray_world::geometry::aabb::{self, Aabb};
use tabray_world::geometry::ray::Side;
use tabray_world::lamp::Lamp;
use tabray_world::material::{Look, Rgb};
use tabray_world::packets::light::{AnyLit, LightSamples, ShadingPoints};
use tabray_world::rules::{Falloff, Rules};
use tabray_world::scene::model::Object;

impl Tracer<'_, '_> {
    /// Adds the contributions of all lights.
    pub(super) fn illuminate(&mut self, group: &mut RayGroup, surface: &Surface, colours: &mut VectorList) {
        if self.sees_events {
            for ShutOut { light, object } in &self.plan.shut_out {
                self.observer.see(Event::Light(*light, LightOutcome::Blocked(*object)));
            }
        }
        if self.plan.needs.lights.is_empty() {
            return;
        }
        let mut lighting = self.scratch.lighting.take().unwrap_or_default();
        let (cpu, count) = (self.cpu, group.padded());
        let material = &self.model.objects[surface.index].material;
        let points = surface.points.view(count);
        let is_matt = match surface.look {
            Some(look) => look.diffuse != Rgb::ZERO,
            None => self.diffuses(surface, count, &mut lighting.diffuse),
        };
        let glances = surface.is_mirror || material.highlight != Rgb::ZERO;
        let scatters = is_matt || material.shininess != 0.0 && glances;
        let ray_budget = group.ray_budget[0];
        // Where nothing is scattered, lights make no difference, but they are still reported to an observer.
        if scatters || self.sees_events {
            let around = aabb::around(cpu, points);
            for index in &self.plan.needs.lights {
                self.add_lamp(*index, group, surface, &around, &mut lighting, colours);
            }
            if scatters {
                self.miss_shadows(group, surface);
            }
        }
        if !scatters {
            // Observed or not, a ray costs the same.
            group.ray_budget[0] = ray_budget;
        }
        self.scratch.lighting = Some(lighting);
    }

    /// Computes the diffuse reflectivities at the points of a surface where they differ. Returns whether any is not 0.
    pub(super) fn diffuses(&self, surface: &Surface, count: usize, diffuse: &mut VectorList) -> bool {
        let Object { material, shader, .. } = &self.model.objects[surface.index];
        let any = shader.diffuses(self.cpu, material, surface.points(count), diffuse.resized(count));
        if material.coat().is_some() {
            (0..count).for_each(|lane| diffuse.set(lane, material.under_coat(diffuse.get(lane))));
        }
        any
    }

    /// Computes the highlights at the points of a surface that glints, as rays return them.
    pub(super) fn glint(&mut self, group: &mut RayGroup, surface: &mut Surface, glints: &mut VectorList) {
        let count = group.padded();
        glints.fill(count, Rgb::ZERO);
        let mirror = Look { ambient: Rgb::ZERO, diffuse: Rgb::ZERO, specular: Rgb::ONE };
        let own = (surface.look.replace(mirror), surface.is_mirror);
        surface.is_mirror = true;
        self.illuminate(group, surface, glints);
        (surface.look, surface.is_mirror) = own;
        if self.plan.camera.rules == Rules::Notes {
            light::fade(self.cpu, &surface.travelled[..count], glints.resized(count));
        }
        for lane in (0..count).filter(|lane| surface.sides[*lane] == Side::Inside) {
            glints.set(lane, Rgb::ZERO);
        }
    }

    /// Adds the contribution of one light.
    fn add_lamp(
        &mut self,
        index: usize,
        group: &mut RayGroup,
        surface: &Surface,
        around: &Aabb,
        lighting: &mut LightScratch,
        colours: &mut VectorList,
    ) {
        let (cpu, count) = (self.cpu, group.padded());
        let light = &self.model.lights[index].value;
        let (faced, source) = self.sample_light(index, group, surface, lighting);
        let LightScratch { diffuse, toward, strengths, t_max, emissivity, speculars, .. } = lighting;
        let LightScratch { shines, blocked, shadows, .. } = lighting;
        let material = &self.model.objects[surface.index].material;
        if material.coat().is_some() {
            for (lane, strength) in strengths[..count].iter_mut().enumerate() {
                *strength *= surface.passed_by_coat(material, lane, group.dir.get(lane), toward.get(lane));
            }
        }
        if !faced.any_shines {
            if self.sees_events {
                self.observer.see(Event::Light(
                    index,
                    if faced.any_faces { LightOutcome::Aside } else { LightOutcome::Behind },
                ));
            }
            return;
        }
        let (t_max, shines, blocked) =
            (resized(t_max, count), resized(shines, count), resized(blocked, count));
        let paths = LightPaths { from: *around, to: source, toward };
        let uniform = light.uniform().filter(|_| !self.fades(light));
        let are_mirrored = light.emitter().is_none_or(|emitter| emitter.has_highlights());
        let mut tint = Rgb::ONE;
        let passes = self.sees_events || self.plan.has_glass;
        if passes {
            if let Some(sent) = uniform {
                emissivity.fill(count, sent);
            }
            // Where light goes on, rays meet what is bent on the way by chance, if they can see it.
            self.scratch.unbent = self.plan.camera.bounces != 0 && !are_mirrored;
            let (blocker, passed) = self.pass(group, surface, &paths, t_max, shines, emissivity);
            self.scratch.unbent = false;
            if self.sees_events
                && let Some(blocker) = blocker
            {
                self.observer.see(Event::Light(index, LightOutcome::Blocked(blocker)));
                return;
            }
            tint = passed;
            blocked.fill(0);
        } else {
            self.shadow(group, surface, &paths, t_max, shadows, blocked);
        }
        let lit = LitPoints {
            toward: toward.view(count),
            seen: group.dir.view(count),
            normals: surface.normals.view(count),
            strengths: &strengths[..count],
            shines,
            blocked,
            emissivity: match uniform {
                Some(sent) if !passes => Colours::Uniform(sent),
                _ => Colours::Each(emissivity.view(count)),
            },
            exponents: &surface.exponents,
            looks: surface.lit_by_lamp(diffuse, count, (material.highlight, are_mirrored), speculars),
        };
        let shows_highlights = are_mirrored || material.highlight != Rgb::ZERO;
        let shininess = if shows_highlights { material.shininess } else { 0.0 };
        light::add_glints(cpu, &lit, shininess, colours.resized(count));
        if self.scratch.path_hashes.is_on {
            let (is_shiny, has_tints) = (shininess != 0.0, uniform.is_some());
            self.scratch.path_hashes.see_light(&group.camera[..group.len], index, &lit, is_shiny, has_tints);
        }
        if self.sees_events {
            let mut alone = VectorList::default();
            alone.fill(count, Rgb::ZERO);
            light::add_glints(cpu, &lit, shininess, alone.resized(count));
            self.observer
                .see(Event::Light(index, LightOutcome::Shines { passed: tint, colour: alone.get(0) }));
        }
    }

    /// Samples a light from the points of a surface, into the scratch space. Returns which of them are lit, and a box
    /// around the ends of the shadow rays.
    fn sample_light(
        &self,
        index: usize,
        group: &RayGroup,
        surface: &Surface,
        lighting: &mut LightScratch,
    ) -> (AnyLit, Aabb) {
        let (cpu, count) = (self.cpu, group.padded());
        let light = &self.model.lights[index].value;
        let LightScratch { draws, toward, strengths, t_max, emissivity, shines, .. } = lighting;
        let mut source = Aabb { low: light.location(), high: light.location() };
        let (t_max, shines) = (resized(t_max, count), resized(shines, count));
        let samples = LightSamples {
            toward: toward.resized(count),
            emissivity: emissivity.resized(count),
            strengths: resized(strengths, count),
            t_max,
            shines,
        };
        let (points, normals) = (surface.points.view(count), surface.normals.view(count));
        let (rules, slack) = (self.plan.camera.rules, self.slack());
        let shading = ShadingPoints { points, normals, lights: None, rules, slack };
        let (mut faced, lights) = match light.emitter() {
            Some(emitter) => {
                let index = (emitter, index);
                (self.sample_emitter(index, group, &shading, draws, samples, &mut source), None)
            }
            None => {
                let lights = match light.size() {
                    0.0 => None,
                    _ => self.draw_on_ball(&**light, index, group, surface, draws),
                };
                if let Some(lights) = lights {
                    source = aabb::around(cpu, lights);
                }
                (light.sample(cpu, &ShadingPoints { lights, ..shading }, samples), lights)
            }
        };
        if surface.is_bent {
            faced.any_shines = surface.hide_from_behind(toward.view(count), shines, t_max);
        }
        if faced.any_shines && self.fades(light) {
            if let Some(sent) = light.uniform() {
                emissivity.fill(count, sent);
            }
            for lane in 0..count {
                let from = lights.map_or(light.location(), |lights| lights.get(lane));
                let factor = light.fading.factor((from - points.get(lane)).length());
                emissivity.set(lane, factor * emissivity.get(lane));
            }
        }
        (faced, source)
    }

    /// Tells whether the light of a lamp grows weaker with the distance.
    fn fades(&self, light: &Lamp) -> bool {
        self.plan.camera.rules == Rules::Free && light.fading.falloff != Falloff::None
    }

    /// Samples a point of a light for each point of a surface: the one that the primary ray's sample chooses, or the
    /// one of the middle numbers where pixels have one sample. Sets `source` to a box around the ends of the shadow
    /// rays.
    pub(super) fn sample_emitter(
        &self,
        (emitter, index): (&dyn EnclosedEmitter, usize),
        group: &RayGroup,
        shading: &ShadingPoints,
        draws: &mut LightDraws,
        mut samples: LightSamples,
        source: &mut Aabb,
    ) -> AnyLit {
        let drawn = self.draw(index, group, draws);
        let numbers = |lane: usize| drawn.as_ref().map_or(DVec2::splat(0.5), |numbers| numbers(lane));
        let mut any_shines = false;
        *source = Aabb::EMPTY;
        for lane in 0..shading.points.len() {
            let (at, normal) = (shading.points.get(lane), shading.normals.get(lane));
            let chosen = emitter.sample_at(at, normal, numbers(lane));
            let chosen = chosen.filter(|sample| sample.toward.dot(normal) > 0.0);
            let none = LightSample { toward: normal, distance: 0.0, light: Rgb::ZERO };
            let LightSample { toward, distance, light } = chosen.unwrap_or(none);
            samples.toward.set(lane, toward);
            samples.emissivity.set(lane, light);
            samples.strengths[lane] = toward.dot(normal);
            samples.shines[lane] = u64::from(chosen.is_some());
            samples.t_max[lane] = match distance.is_finite() {
                true => (distance - shading.slack * (distance + at.abs().max_element())).max(0.0),
                false => f64::INFINITY,
            };
            if chosen.is_some() {
                any_shines = true;
                let end = end(at, toward, distance);
                *source = source.and(&Aabb { low: end, high: end });
            }
        }
        AnyLit { any_faces: any_shines, any_shines }
    }
}

/// Returns the end of a ray, which may be infinitely far away.
fn end(from: DVec3, dir: DVec3, distance: f64) -> DVec3 {
    // 0 times infinity is NaN.
    let along = |axis: usize| if dir[axis] == 0.0 { 0.0 } else { distance * dir[axis] };
    from + DVec3::new(along(0), along(1), along(2))
}
