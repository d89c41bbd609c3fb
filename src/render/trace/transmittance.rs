//! How much of a light passes through glass.

use super::arrays::{VectorList, compact, gather, resized};
use super::context::{Tracer, Transmittance};
use super::occlusion::LightPaths;
use super::ray_group::RayGroup;
use super::surface::Surface;
use crate::observer::{Count, Event, RayKind, RayPurpose};
use tabray_world::geometry::ray::{Ray, Side};
use tabray_world::geometry::ray_packet::PACKET_SIZE;
use tabray_world::material::Rgb;

impl Tracer<'_, '_> {
    /// Multiplies the light on some points by the fraction that passes through the glass on the way, and clears
    /// `shines` where an opaque object blocks it. Returns, for the first point, the index of the opaque object that
    /// blocks the light, if any, and the fraction of each channel that passes.
    pub(super) fn pass(
        &mut self,
        group: &mut RayGroup,
        surface: &Surface,
        paths: &LightPaths,
        t_max: &[f64],
        shines: &mut [u64],
        emissivity: &mut VectorList,
    ) -> (Option<usize>, Rgb) {
        let mut transmittance = self.scratch.transmittances.pop().unwrap_or_default();
        let mut lanes = Vec::new();
        let lanes = compact(&shines[..group.len], &mut lanes);
        let Transmittance { group: part, t_max: far, tint, blocker, .. } = &mut *transmittance;
        part.continue_from(group, &surface.secondary_rays(paths.toward), lanes);
        let count = part.padded();
        gather(far, t_max, lanes, count);
        tint.fill(count, Rgb::ONE);
        resized(blocker, count).fill(0);
        self.walk(&mut transmittance);
        for (index, lane) in lanes.iter().enumerate() {
            let lane = usize::from(*lane);
            shines[lane] = u64::from(transmittance.blocker[index] == 0);
            emissivity.set(lane, emissivity.get(lane) * transmittance.tint.get(index));
        }
        group.charge(&transmittance.group, lanes);
        let first = ((transmittance.blocker[0] as usize).checked_sub(1), transmittance.tint.get(0));
        self.scratch.transmittances.push(transmittance);
        first
    }

    /// Follows shadow rays toward a light, through glass, until they reach the light or an opaque object.
    fn walk(&mut self, transmittance: &mut Transmittance) {
        let Transmittance { group, t_max, tint, blocker, hits, parts, .. } = transmittance;
        self.observer.count(Count::Rays(RayKind::Shadow, group.len));
        if self.sees_events {
            self.observer.see(Event::Begin(RayPurpose::Shadow { distance: t_max[0] }));
        }
        self.closest(group, Some(t_max), hits);
        parts.begin(&hits.hit_ids[..group.len]);
        while let Some((id, lanes)) = parts.next() {
            let Some(index) = (id as usize).checked_sub(1) else {
                for lane in lanes.iter().map(|lane| usize::from(*lane)) {
                    if let Some(passed) = self.passed(group, lane, t_max[lane], None) {
                        tint.set(lane, tint.get(lane) * passed);
                    }
                }
                continue;
            };
            let object = &self.model.objects[index];
            if object.is_opaque() || self.scratch.unbent && object.bends_light() {
                lanes.iter().for_each(|lane| blocker[usize::from(*lane)] = id);
                continue;
            }
            let mut onward = self.scratch.transmittances.pop().unwrap_or_default();
            for lanes in lanes.chunks(self.max_packet()) {
                onward.group.gather(group, lanes);
                let count = onward.group.padded();
                gather(&mut onward.near, &hits.near, lanes, count);
                gather(&mut onward.far, &hits.far, lanes, count);
                gather(&mut onward.t_max, t_max, lanes, count);
                onward.tint.gather(tint, lanes, count);
                resized(&mut onward.blocker, count).fill(0);
                self.pane(index, &mut onward);
                tint.scatter(&onward.tint, lanes);
                for (lane, id) in lanes.iter().zip(&onward.blocker) {
                    blocker[usize::from(*lane)] = *id;
                }
                group.charge(&onward.group, lanes);
            }
            self.scratch.transmittances.push(onward);
        }
    }

    /// Passes through one transparent object, and follows the shadow rays from there.
    fn pane(&mut self, index: usize, transmittance: &mut Transmittance) {
        let Transmittance { group, t_max, tint, near, far, distances, .. } = transmittance;
        self.refine(group, (near, far), index, distances);
        let object = &self.model.objects[index];
        let count = group.padded();
        resized(&mut group.sides, count);
        let mut cosines = [0.0; PACKET_SIZE];
        for lane in 0..count {
            let ray = Ray { origin: group.origin.get(lane), dir: group.dir.get(lane) };
            let point = ray.at(distances[lane]);
            let normal = object.shape.normal(point);
            let side = Side::seen_along(ray.dir, normal);
            let passed = self.passed(group, lane, distances[lane], Some((index, side)));
            let tint_here = object.passed(&object.surface_point(point, side)) * passed.unwrap_or(Rgb::ONE);
            group.sides[lane] = side.opposite();
            cosines[lane] = ray.dir.dot(normal);
            group.travelled[lane] += distances[lane];
            group.origin.set(lane, point);
            tint.set(lane, tint.get(lane) * tint_here);
            t_max[lane] -= distances[lane];
        }
        self.bound_errors(&*object.shape, &group.travelled[..count], &cosines[..count], &mut group.errors);
        group.origin_object = Some(index);
        self.depth += 1;
        self.walk(transmittance);
        self.depth -= 1;
    }
}
