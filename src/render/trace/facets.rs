//! The facets of rough surfaces: for each ray, the normal of the facet that it hits.
//!
//! Facets are drawn in proportion to their visible area, from the distribution of Trowbridge and Reitz, also known as
//! GGX (Heitz, "Sampling the GGX Distribution of Visible Normals", 2018). All light that a facet reflects or
//! transmits counts, even light that other facets would catch. So rough surfaces keep all light that smooth ones
//! keep, and the same bounds hold for them.

use super::context::Tracer;
use super::draws::RIM_POINTS;
use super::ray_group::RayGroup;
use super::surface::{Surface, facing};
use crate::observer::TraceObserver;
use glam::{DVec2, DVec3};
use tabray_world::sample::on_disc;

/// The number that chooses the facets of probes: half of the disc of facets lies nearer to the middle.
const PROBED: f64 = 0.5;

impl<W: TraceObserver> Tracer<'_, '_, W> {
    /// Bends the normals at points of a surface to those of facets, which the samples of the primary rays draw. Where
    /// pixels have one sample, the surface is smooth.
    pub(super) fn draw_facets(&mut self, group: &RayGroup, surface: &mut Surface, roughness: f64) {
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
                (Some(place), Some(trees)) => trees.wave[*place as usize].depth,
                _ => self.depth as u32,
            };
            let draw = if self.scratch.are_probes {
                DVec2::new(PROBED, f64::from(sample.pixel) / RIM_POINTS)
            } else {
                sample.on_facet(depth)
            };
            let dir = group.dir.get(lane);
            let normal = facing(surface.normals.get(lane), dir);
            surface.normals.set(lane, facet(normal, -dir, roughness * roughness, draw));
            if lane < group.len && self.scratch.path_hashes.is_on {
                self.scratch.path_hashes.see_facet(camera, draw);
            }
        }
    }
}

/// Returns the normal of the facet that two numbers from 0 to 1 choose, among the facets that are seen in a direction.
/// `width` is the parameter alpha of the distribution.
fn facet(normal: DVec3, toward: DVec3, width: f64, numbers: DVec2) -> DVec3 {
    let (across, up) = normal.any_orthonormal_pair();
    let seen = DVec3::new(width * toward.dot(across), width * toward.dot(up), toward.dot(normal).max(0.0));
    let Some(seen) = seen.try_normalize() else { return normal };
    let (right, above) = seen.any_orthonormal_pair();
    // The half of the disc that is turned away is squeezed into the part of it that can be seen.
    let DVec2 { x, y } = on_disc(numbers);
    let part = 0.5 * (1.0 + seen.z);
    let y = (1.0 - part) * (1.0 - x * x).max(0.0).sqrt() + part * y;
    let z = (1.0 - x * x - y * y).max(0.0).sqrt();
    let DVec3 { x, y, z } = x * right + y * above + z * seen;
    (width * x * across + width * y * up + z.max(0.0) * normal).try_normalize().unwrap_or(normal)
}
