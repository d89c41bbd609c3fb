//! Rays that hit different objects of one look. They are shaded together, like those of one object: a scene of many
//! small objects has few rays for each.

use super::arrays::resized;
use super::closest_hit::clamp_to_brackets;
use super::context::Tracer;
use super::exact::exact;
use super::ray_group::RayGroup;
use super::surface::Surface;
use std::ops::Range;
use tabray_world::coincidence;
use tabray_world::geometry::ray::{MISS, Side};
use tabray_world::geometry::ray_packet::{RayPacket, SurfaceInteraction};
use tabray_world::simd::soa::{LANES, Vectors};

/// The mean length of runs, which are neighbouring lanes that hit one object, up to which several objects are shaded
/// together. Runs are parts of rows of eight pixels. If they are longer, shading each object by itself takes no
/// longer.
const SHORT: usize = 4;

/// Up to eight rays of a group that hit one object, the last of them repeated.
struct Run {
    lanes: Range<usize>,
    origin: Vectors<LANES>,
    dir: Vectors<LANES>,
}

impl Run {
    fn of(group: &RayGroup, lanes: Range<usize>) -> Self {
        let (mut origin, mut dir) = (Vectors::ZERO, Vectors::ZERO);
        for place in 0..LANES {
            let lane = lanes.start + place.min(lanes.len() - 1);
            origin.set(place, group.origin.get(lane));
            dir.set(place, group.dir.get(lane));
        }
        Self { lanes, origin, dir }
    }

    fn rays(&self, group: &RayGroup) -> RayPacket<'_> {
        RayPacket::new(self.origin.view(LANES), self.dir.view(LANES), group.errors.most)
    }

    /// Returns the numbers of the lanes, the last of them repeated.
    fn gather(&self, of: &[f64]) -> [f64; LANES] {
        let mut all = [0.0; LANES];
        for (place, number) in all.iter_mut().enumerate() {
            *number = of[self.lanes.start + place.min(self.lanes.len() - 1)];
        }
        all
    }
}

/// Calls a function with each run of up to eight neighbouring lanes of the same object.
fn each_run(objects: &[u32], mut call: impl FnMut(usize, Range<usize>)) {
    let mut start = 0;
    for run in objects.chunk_by(|one, other| one == other) {
        for first in (0..run.len()).step_by(LANES) {
            call(run[0] as usize, start + first..start + run.len().min(first + LANES));
        }
        start += run.len();
    }
}

/// Tells whether few neighbouring rays hit the same object, given for each ray by its index plus 1.
pub(super) fn are_short(hit_ids: &[u64]) -> bool {
    hit_ids.chunk_by(|one, other| one == other).count() * SHORT >= hit_ids.len()
}

/// Lists the objects that rays in these lanes hit, given by their indices plus 1, unless all are the same.
pub(super) fn list(hit_ids: &[u64], lanes: &[u8], objects: &mut Vec<u32>) {
    objects.clear();
    objects.extend(lanes.iter().map(|lane| hit_ids[usize::from(*lane)] as u32 - 1));
    if objects.iter().all(|object| *object == objects[0]) {
        objects.clear();
    }
}

impl Tracer<'_, '_> {
    /// Computes the distances, in world units, at which the rays of a group hit their objects. Each lies between
    /// `near` and `far`.
    pub(super) fn refine_mixed(
        &self,
        group: &RayGroup,
        (near, far): (&[f64], &[f64]),
        objects: &[u32],
        distances: &mut Vec<f64>,
    ) {
        let distances = resized(distances, group.padded());
        each_run(objects, |object, lanes| {
            let run = Run::of(group, lanes.clone());
            let (near, far) = (run.gather(near), run.gather(far));
            let mut out = near;
            if near != far {
                let shape = &self.model.objects[object].shape;
                shape.packets().refine(self.cpu, run.rays(group), (&near, &far), &mut out);
                if clamp_to_brackets(self.cpu, &near, &far, &mut out) {
                    for place in (0..lanes.len()).filter(|place| out[*place].is_nan()).collect::<Vec<_>>() {
                        let distance = exact(shape, &self.start(group, lanes.start + place), None, MISS);
                        out[place] = distance.max(near[place]).min(far[place]);
                    }
                }
            }
            distances[lanes.clone()].copy_from_slice(&out[..lanes.len()]);
        });
        let last = distances[group.len - 1];
        distances[group.len..].fill(last);
    }

    /// Computes the points, normals and sides at which the rays of a group hit their objects, and bounds on the
    /// errors of the points.
    pub(super) fn interact_mixed(&self, group: &RayGroup, distances: &[f64], surface: &mut Surface) {
        let count = group.padded();
        let Surface { points, normals, sides, cosines, travelled, objects, errors, .. } = surface;
        let (mut all_points, mut all_normals) = (points.resized(count), normals.resized(count));
        let (all_sides, all_cosines) = (resized(sides, count), resized(cosines, count));
        each_run(objects, |object, lanes| {
            let run = Run::of(group, lanes.clone());
            let shape = &self.model.objects[object].shape;
            let [mut points, mut normals, mut unused] =
                [Vectors::ZERO, Vectors::ZERO, Vectors::<LANES>::ZERO];
            let (mut sides, mut cosines) = ([Side::Outside; LANES], [0.0; LANES]);
            let mut run_travelled = run.gather(travelled);
            let interaction = SurfaceInteraction {
                points: points.view_mut(LANES),
                normals: normals.view_mut(LANES),
                geometric_normals: unused.view_mut(LANES),
                sides: &mut sides,
                cosines: &mut cosines,
                travelled: &mut run_travelled,
            };
            shape.packets().interact(self.cpu, run.rays(group), &run.gather(distances), interaction);
            for (place, lane) in lanes.enumerate() {
                all_points.set(lane, points.get(place));
                all_normals.set(lane, normals.get(place));
                (all_sides[lane], all_cosines[lane]) = (sides[place], cosines[place]);
                travelled[lane] = run_travelled[place];
            }
        });
        let last = group.len - 1;
        for lane in group.len..count {
            all_points.set(lane, all_points.get(last));
            all_normals.set(lane, all_normals.get(last));
            (all_sides[lane], all_cosines[lane]) = (all_sides[last], all_cosines[last]);
            travelled[lane] = travelled[last];
        }
        let error = |(lane, object): (usize, &u32)| {
            let reach = self.model.objects[*object as usize].shape.facts().max_coordinate + self.viewer;
            coincidence::error_after(travelled[lane], reach, all_cosines[lane])
        };
        errors.fill(count, objects[..group.len].iter().enumerate().map(error));
    }
}
