//! Light that goes on from surface to surface by matt ones, where the camera lets light bounce.
//!
//! A matt surface of diffuse reflectivity `d` returns `d / pi` times the integral of the light that reaches it, times
//! the cosine of its angle. Lamps and skies that light are met by aim: they are [direct light](super::direct_light).
//! What comes from other surfaces is met by one ray in a direction that the sample draws with a density of the cosine
//! over pi, so that its light counts `d` times. The ray counts neither lamps nor skies again, nor ambient light, which
//! stands in for light from everywhere. What objects emit is met by chance and [by aim](super::aim). After a mirror, or
//! glass that bends light, no aim is possible, and what shines there counts.
//!
//! Behind a matt surface, a path goes on in one way alone, which is chosen by chance in proportion to what each can
//! bring, and a path that can bring little ends by chance (Russian roulette: Arvo and Kirk, "Particle transport and
//! image synthesis", SIGGRAPH 1990). What is chosen counts as much more as it is chosen more rarely, so neither changes
//! the mean.

use super::arrays::VectorList;
use super::context::{ShadingScratch, Tracer};
use super::draws::RIM_POINTS;
use super::ray_group::RayGroup;
use super::surface::Surface;
use super::tree::OpenRay;
use crate::observer::RayKind;
use glam::{DVec2, DVec3};
use tabray_world::directions::by_cosine;
use tabray_world::material::Rgb;
use tabray_world::scene::kind::Kind;
use tabray_world::scene::model::Object;
use tabray_world::surface_point::SurfacePoint;

/// The weight below which paths behind matt surfaces end by chance.
const FAINT: f64 = 0.25;

/// The light that counts where a ray ends, besides what it passes on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum CountedLight {
    /// All: the ray shows what the viewer sees.
    #[default]
    All,
    /// The emission of surfaces: the ray leaves a matt surface, where lamps and skies are met by aim.
    Emission,
    /// Also lamps and skies that light: the ray leaves a matt surface by a mirror, or by glass that bends it.
    EmissionAndLamps,
}

impl CountedLight {
    /// Returns what counts for a ray that continues from one of these, unbent or not.
    pub fn after(self, kind: RayKind, is_unbent: bool) -> Self {
        match (kind, self) {
            (RayKind::Scattered, _) => Self::Emission,
            (_, Self::Emission) if !is_unbent => Self::EmissionAndLamps,
            _ => self,
        }
    }
}

impl Tracer<'_, '_> {
    /// Adds what an object's surface gives by itself to its ambient light, or takes its place where that does not count.
    pub(super) fn emit(
        &self,
        group: &RayGroup,
        surface: &Surface,
        distances: &[f64],
        colours: &mut VectorList,
    ) {
        let object = &self.model.objects[surface.index];
        let Object { material, shader, .. } = object;
        let is_lamp = object.args.entity().kind() == Kind::Light;
        let is_aimed_at = self.is_aimed_at(surface.index);
        let shows_ambient =
            self.counted == CountedLight::All || self.counted == CountedLight::EmissionAndLamps && is_lamp;
        for lane in 0..group.padded() {
            let all = colours.get(lane);
            if shows_ambient && !is_aimed_at {
                colours.set(lane, all + material.emission);
                continue;
            }
            let own = match (surface.look, surface.seen.get(lane)) {
                (Some(_), _) => Rgb::ZERO,
                (None, Some(at)) => shader.emission(at),
                (None, None) => shader.emission(&SurfacePoint::at(surface.points.get(lane))),
            };
            let part = if is_aimed_at {
                let normal = surface.bent_from(lane).unwrap_or(surface.normals.get(lane));
                self.part_by_chance(group, lane, (surface.index, normal, own), distances[lane])
            } else {
                1.0
            };
            // Rays aim at what the material gives, or else at what the shader gives.
            let emitted =
                if material.emission == Rgb::ZERO { part * own } else { part * material.emission + own };
            colours.set(
                lane,
                match shows_ambient {
                    true if is_lamp => part * all,
                    true => all - own + emitted,
                    false => emitted,
                },
            );
        }
    }

    /// Tells whether rays of the current packet that hit nothing see the background.
    pub(super) fn sees_background(&self) -> bool {
        match self.counted {
            CountedLight::All => true,
            CountedLight::Emission => false,
            CountedLight::EmissionAndLamps => {
                // The last light is the background, if it lights.
                self.model.lights.last().is_some_and(|light| light.args.entity().kind() == Kind::Background)
            }
        }
    }

    /// Computes the diffuse reflectivities where light may go on from a packet's hits on an object by its matt surface.
    /// Returns whether any is not 0.
    pub(super) fn scatters(&self, group: &RayGroup, shading: &mut ShadingScratch) -> bool {
        let ShadingScratch { surface, diffuse, .. } = shading;
        let material = &self.model.objects[surface.index].material;
        if self.plan.camera.bounces == 0 || material.transparency == 1.0 || self.scratch.samples.is_empty() {
            return false;
        }
        let count = group.padded();
        match surface.look {
            Some(look) => {
                diffuse.fill(count, look.diffuse);
                look.diffuse != Rgb::ZERO
            }
            None => self.diffuses(surface, count, diffuse),
        }
    }

    /// Chooses among the rays that continue from a hit, after `before` on their path. Behind a matt surface, one of them
    /// remains at most; before it, all but one that leaves a matt surface and is faint.
    pub(super) fn choose(&mut self, before: &OpenRay, onward: &mut [Option<OpenRay>]) {
        let sample = self.scratch.samples.get(usize::from(before.camera));
        let scatters = onward.iter().flatten().any(|ray| ray.kind == RayKind::Scattered);
        let is_by_chance = (before.bounces != 0 || scatters) && !self.scratch.are_probes;
        let Some(sample) = sample.filter(|_| is_by_chance) else { return };
        let draw = sample.on_branching(before.depth);
        if self.scratch.path_hashes.is_on {
            self.scratch.path_hashes.see_facet(before.camera, draw);
        }
        let weight = |ray: &OpenRay| ray.weight.abs().max_element();
        // Goes on along a ray that was chosen with a chance, unless the path ends.
        let follow = |ray: OpenRay, chance: f64, all: f64| {
            let survives = (all / FAINT).min(1.0);
            (draw.y <= survives).then(|| OpenRay { weight: ray.weight / (chance * survives), ..ray })
        };
        if before.bounces == 0 {
            for scattered in onward.iter_mut() {
                *scattered = scattered.and_then(|ray| match ray.kind {
                    RayKind::Scattered => follow(ray, 1.0, weight(&ray)),
                    _ => Some(ray),
                });
            }
            return;
        }
        let total: f64 = onward.iter().flatten().map(weight).sum();
        let mut left = draw.x * total;
        let chosen = onward.iter().flatten().find(|ray| {
            left -= weight(ray);
            left <= 0.0
        });
        // The sum is rounded.
        let chosen = chosen.or_else(|| onward.iter().flatten().last()).copied();
        onward.fill(None);
        onward[0] = chosen.and_then(|ray| follow(ray, weight(&ray) / total, total));
    }

    /// Returns the direction in which the sample of a ray follows the light that reaches its hit, after `depth` rays
    /// of its path; `None` where the surface is seen from a side that no light reaches.
    pub(super) fn scattered(
        &mut self,
        group: &RayGroup,
        surface: &Surface,
        lane: usize,
        depth: u32,
    ) -> Option<DVec3> {
        let normal = surface.smooth_normal(lane);
        if normal.dot(group.dir.get(lane)) >= 0.0 {
            return None;
        }
        let camera = group.camera[lane];
        let sample = self.scratch.samples.get(usize::from(camera))?;
        let draw = if self.scratch.are_probes {
            DVec2::new(0.5, f64::from(sample.pixel) / RIM_POINTS)
        } else {
            sample.on_scattering(depth)
        };
        if self.scratch.path_hashes.is_on {
            self.scratch.path_hashes.see_facet(camera, draw);
        }
        let dir = DVec3::from(by_cosine(normal.to_array(), draw)?);
        surface.bent_from(lane).is_none_or(|geometric| dir.dot(geometric) > 0.0).then_some(dir)
    }
}
