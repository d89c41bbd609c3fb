//! The facets of rough surfaces: for each ray, the normal of the facet that it hits.
//!
//! Facets are [drawn](facet) in proportion to their visible area, from the distribution of Trowbridge and Reitz, also known
//! as GGX. All light that a facet reflects or
//! transmits counts, even light that other facets would catch, and what a facet mirrors into the surface is turned
//! back out of it. So rough surfaces keep all light that smooth ones keep, and the same bounds hold for them.

use super::context::Tracer;
use super::draws::RIM_POINTS;
use super::ray_group::RayGroup;
use super::surface::{Surface, crossing, facing};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;
use tabray_world::directions::facet;
use tabray_world::geometry::ray::Side;
use tabray_world::interface::Interface;
use tabray_world::material::Rgb;

/// The number that chooses the facets of probes: half of the disc of facets lies nearer to the middle.
const PROBED: f64 = 0.5;

impl Tracer<'_, '_> {
    /// Bends the normals at points of a surface to those of facets, which the samples of the primary rays draw. Where
    /// pixels have one sample, the surface is smooth.
    pub(super) fn draw_facets(&mut self, group: &RayGroup, surface: &mut Surface, interface: &dyn Interface) {
        if self.scratch.samples.is_empty() {
            return;
        }
        let count = group.padded();
        if !surface.is_bent {
            surface.geometric_normals.copy(surface.normals.view(count));
            surface.is_bent = true;
        }
        for lane in 0..count {
            let camera = group.camera[lane.min(group.len - 1)];
            let Some(sample) = self.scratch.samples.get(usize::from(camera)) else { continue };
            let depth = match (group.places.get(lane), &self.scratch.trees) {
                (Some(place), Some(trees)) => trees.wave.rays[*place as usize].depth,
                _ => self.depth as u32,
            };
            let draw = if self.scratch.are_probes {
                DVec2::new(PROBED, f64::from(sample.pixel) / RIM_POINTS)
            } else {
                sample.on_facet(depth)
            };
            let facets = Facets::seen(surface, lane, group.dir.get(lane), interface);
            surface.facets.push(facets);
            surface.normals.set(lane, facets.choose(draw));
            if lane < group.len && self.scratch.path_hashes.is_on {
                self.scratch.path_hashes.see_facet(camera, draw);
            }
        }
    }
}

/// The facets of a rough surface that are seen at a point.
#[derive(Clone, Copy)]
pub(super) struct Facets {
    /// The unit normal of the surface with which the point is shaded, on the side that is seen.
    normal: DVec3,
    /// The unit normal of the surface itself, on that side.
    geometric: DVec3,
    /// The unit vector toward the viewer.
    toward: DVec3,
    /// The parameter alpha of the distribution; 0 where the surface is smooth.
    width: f64,
}

impl Facets {
    /// Returns the facets of a surface at the hit of a ray along `dir`, given the interface of its material.
    pub fn seen(surface: &Surface, lane: usize, dir: DVec3, interface: &dyn Interface) -> Self {
        let roughness = surface.interface(lane, interface).roughness();
        let normal = surface.normals.get(lane);
        let geometric = surface.bent_from(lane).unwrap_or(normal);
        let [normal, geometric] = [normal, geometric].map(|normal| facing(normal, dir));
        Self { normal, geometric, toward: -dir, width: roughness * roughness }
    }

    /// Returns the unit normal of the surface with which the point is shaded, on the side that is seen.
    pub fn normal(&self) -> DVec3 {
        self.normal
    }

    /// Returns the normal of the facet that two numbers from 0 to 1 choose.
    fn choose(&self, numbers: DVec2) -> DVec3 {
        let chosen = facet(self.normal.to_array(), self.toward.to_array(), self.width, numbers);
        chosen.map_or(self.normal, DVec3::from)
    }

    /// Returns the density of a unit direction, per unit of solid angle, if lamps are met there by aim, too; infinite
    /// otherwise.
    pub fn density_of(&self, dir: DVec3) -> f64 {
        let is_above = dir.dot(self.normal) > 0.0 && dir.dot(self.geometric) > 0.0;
        let is_aimed_at = is_above && self.width * self.width != 0.0;
        if is_aimed_at { self.toward(dir).iter().map(|(_, density)| density).sum() } else { f64::INFINITY }
    }

    /// Returns the fraction of the light from a direction that facets mirror toward the viewer, times the density of that
    /// direction, and the density itself.
    pub fn mirrored(&self, interface: &dyn Interface, side: Side, from: DVec3) -> (Rgb, f64) {
        let (mut mirrored, mut whole) = (Rgb::ZERO, 0.0);
        for (facet, density) in self.toward(from).into_iter().filter(|(_, density)| *density > 0.0) {
            let normals = [facet, self.geometric];
            mirrored += density * crossing(interface, -self.toward, normals, side).reflected;
            whole += density;
        }
        (mirrored, whole)
    }

    /// Returns the facets that mirror the viewer's rays in a unit direction, each with the density, per unit of solid
    /// angle, of the direction by this facet. The second mirrors them into the surface, from where they are turned back.
    /// There are none for directions below the surface.
    pub fn toward(&self, dir: DVec3) -> [(DVec3, f64); 2] {
        let height = dir.dot(self.geometric);
        let below = dir - 2.0 * height * self.geometric;
        [dir, below].map(|dir| {
            let facet = (self.toward + dir).try_normalize().unwrap_or(self.normal);
            let density = if height > 0.0 { self.density(facet) } else { 0.0 };
            (facet, density)
        })
    }

    /// Returns the density, per unit of solid angle, of the direction in which a facet mirrors the viewer's rays: a
    /// quarter of G1 D / cos, with the names of the paper.
    fn density(&self, facet: DVec3) -> f64 {
        let Self { normal, toward, width, .. } = *self;
        let (cosine, seen, square) = (facet.dot(normal), toward.dot(normal).max(0.0), width * width);
        if cosine <= 0.0 {
            return 0.0;
        }
        let spread = facet.cross(normal).length_squared() + square * cosine * cosine;
        let distribution = square / (PI * spread * spread);
        0.5 * distribution / (seen + (square + (1.0 - square) * seen * seen).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tabray_world::directions::in_cone;

    /// Sums over facets that are chosen, and over directions by their density, agree.
    #[test]
    fn facets_are_chosen_with_the_density_of_their_mirrored_directions() {
        let count = 400;
        let numbers = |index: u32| {
            let part = |part: u32| (f64::from(part) + 0.5) / f64::from(count);
            DVec2::new(part(index % count), part(index / count))
        };
        for (roughness, angle) in [(0.5, 0.0_f64), (0.6, 1.2), (0.9, 1.5), (1.0, 0.8)] {
            let normal = DVec3::new(0.6, 0.0, 0.8);
            let toward = angle.cos() * normal + angle.sin() * DVec3::new(0.8, 0.0, -0.6);
            let facets = Facets { normal, geometric: normal, toward, width: roughness * roughness };
            let (mut chosen, mut summed) = ([DVec3::ZERO; 2], [DVec3::ZERO; 2]);
            for index in 0..count * count {
                let facet = facets.choose(numbers(index));
                let dir = 2.0 * toward.dot(facet) * facet - toward;
                let dir = dir - 2.0 * dir.dot(normal).min(0.0) * normal;
                chosen[0] += dir;
                chosen[1] += dir * dir;
                let dir = DVec3::from(in_cone(normal.to_array(), 1.0, numbers(index)).expect("a direction"));
                let density: f64 = facets.toward(dir).iter().map(|(_, density)| density).sum();
                summed[0] += 2.0 * PI * density * dir;
                summed[1] += 2.0 * PI * density * dir * dir;
            }
            for (chosen, summed) in chosen.iter().zip(summed) {
                let off = (*chosen - summed).abs().max_element() / f64::from(count * count);
                assert!(off < 2e-3, "{roughness}, {angle}: {chosen} and {summed}, {off}");
            }
        }
    }
}
