//! Packets of rays that may hit a copy. They are mapped to object space together, and the shape is tested against
//! packets there, too.

use super::object_space::{
    end_in, in_object_space, keep_brackets, object_hits, take_out, take_out_distances, take_out_normals,
    to_world,
};
use super::shape::{Placed, entered};
use glam::DVec3;
use tabray_world::geometry::aabb::{self, Aabb};
use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayBall, RayError, RayRange, Side};
use tabray_world::geometry::ray_packet::{RayPacket, SurfaceInteraction, split};
use tabray_world::hittable::Hittable;
use tabray_world::packets::brackets;
use tabray_world::packets::shape::{self, PacketIntersect};
use tabray_world::simd::cpu::Cpu;
use tabray_world::simd::soa::{LANES, Vectors};

/// The number of rays that are mapped to object space together, if there are more than [`LANES`].
pub(super) const PART: usize = 64;

impl Placed {
    fn few_brackets<const N: usize>(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        ends: &[f64],
        (near, far): (&mut [f64], &mut [f64]),
    ) {
        let (count, shape) = (near.len(), self.body.shape.packets());
        let is_from_camera = rays.leaving.is_none() && rays.origin_error == 0.0;
        if shape.is_of_the_notes() {
            for lane in 0..count {
                let range = RayRange { far: ends[lane], origin_side: rays.side(lane), ..RayRange::ALL };
                near[lane] = self.distance(&rays.get(lane), &range);
                far[lane] = near[lane];
            }
            return;
        }
        // Rays that continue from a surface count as exact.
        let mut drift = RayError::NONE;
        if is_from_camera {
            match self.object_drift(&aabb::around(cpu, rays.origin.first(count)), rays.drift) {
                Some(own) => drift = own,
                None => {
                    near.fill(0.0);
                    far.fill(MISS);
                    return;
                }
            }
        }
        let ends = &ends[..count];
        in_object_space::<N, _>((cpu, self), (rays, ends), drift, |own, own_ends, lengths| {
            shape.brackets(cpu, own, own_ends, (&mut *near, &mut *far));
            to_world(cpu, drift.dir, lengths, rays, ends, near, far);
        });
        if self.max_z.0.is_some() {
            keep_brackets(cpu, self.max_z, rays, near, far);
        }
        if is_from_camera && rays.drift.is_none() && self.bounds.is_some() {
            for lane in 0..count {
                let bracket = Bracket { near: near[lane], far: far[lane] };
                let entry = || Self::entry(self.bounds, &rays.get(lane));
                Bracket { near: near[lane], far: far[lane] } = entered(bracket, entry);
            }
        }
    }

    /// Searches again in object space, as for a single ray. A root depends on its bracket in the last bits, and a
    /// bracket mapped to world space depends on the drift.
    fn few_refine(&self, cpu: Cpu, rays: RayPacket, (near, far): (&[f64], &[f64]), out: &mut [f64]) {
        let (count, shape) = (out.len(), self.body.shape.packets());
        in_object_space::<PART, _>(
            (cpu, self),
            (rays, &[MISS; PART][..count]),
            RayError::NONE,
            |own, ends, lengths| {
                let (mut low, mut high) = ([MISS; PART], [MISS; PART]);
                let (low, high) = (&mut low[..count], &mut high[..count]);
                shape.brackets(cpu, own, ends, (&mut *low, &mut *high));
                // A single ray decides doubtful hits.
                let (mut ends, mut distances) = ([MISS; PART], [MISS; PART]);
                let (ends, distances) = (&mut ends[..count], &mut distances[..count]);
                for lane in 0..count {
                    ends[lane] = if high[lane] == MISS { low[lane] } else { high[lane] };
                }
                distances.copy_from_slice(low);
                shape.refine(cpu, own, (&*low, &*ends), distances);
                let (given, own) = ((near, far), (&*low, &*high));
                take_out_distances(cpu, self.max_z, rays, lengths, given, own, distances, out);
            },
        );
    }

    fn few_occluded<const N: usize>(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        (t_max, bounds): (&[f64], &Aabb),
        blocked: &mut [u64],
        doubt: &mut [u64],
    ) -> bool {
        let (count, shape) = (t_max.len(), self.body.shape.packets());
        in_object_space::<N, _>((cpu, self), (rays, t_max), RayError::NONE, |own, own_ends, _| {
            // If a ray ends in the copy's box, rounding may decide whether it is blocked before its end.
            let ends_within = end_in(cpu, bounds, rays, t_max, own_ends);
            let any = shape.occluded(cpu, own, own_ends, blocked, doubt);
            if ends_within {
                for lane in 0..count {
                    let is_open = own_ends[lane] < 0.0 && t_max[lane] > 0.0 && blocked[lane] == 0;
                    doubt[lane] |= u64::from(is_open);
                }
            }
            any || ends_within
        })
    }

    fn few_interact<const N: usize>(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        distances: &[f64],
        interaction: SurfaceInteraction,
    ) {
        let SurfaceInteraction { mut points, mut normals, mut geometric_normals, sides, cosines, travelled } =
            interaction;
        let (count, shape) = (travelled.len(), self.body.shape.packets());
        let own_interaction = SurfaceInteraction {
            points: points.first(count),
            normals: normals.first(count),
            geometric_normals: geometric_normals.first(count),
            sides: &mut *sides,
            cosines: &mut *cosines,
            travelled: &mut [0.0; N][..count],
        };
        if shape.finds_normals_by_rays() {
            let distances = &distances[..count];
            in_object_space::<N, _>((cpu, self), (rays, distances), RayError::NONE, |own, _, lengths| {
                let mut own_distances = [0.0; N];
                for lane in 0..count {
                    own_distances[lane] = distances[lane] * lengths[lane];
                }
                shape.interact(cpu, own.leaving(None), &own_distances[..count], own_interaction);
            });
            return take_out(
                cpu,
                self,
                rays,
                distances,
                cosines,
                travelled,
                points,
                normals,
                geometric_normals,
            );
        }
        // Rays of no length at the hits, along a direction of positive parts: adding -0 changes no number.
        let mut own_points = Vectors::<N>::ZERO;
        object_hits(cpu, self, rays, &distances[..count], own_points.view_mut(count));
        let along = Vectors::<N>::of(DVec3::ONE.normalize());
        let own = RayPacket::new(own_points.view(count), along.view(count), 0.0);
        shape.interact(cpu, own, &[-0.0; N][..count], own_interaction);
        take_out_normals(cpu, self, rays, distances, sides, cosines, travelled, points, normals);
    }
}

impl PacketIntersect for Placed {
    fn brackets(&self, cpu: Cpu, rays: RayPacket, ends: &[f64], (near, far): (&mut [f64], &mut [f64])) {
        if near.len() <= LANES {
            return self.few_brackets::<LANES>(cpu, rays, ends, (near, far));
        }
        for part in split(near.len(), PART) {
            let brackets = (&mut near[part.clone()], &mut far[part.clone()]);
            self.few_brackets::<PART>(cpu, rays.part(part.clone()), &ends[part], brackets);
        }
    }

    fn occluded(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        t_max: &[f64],
        blocked: &mut [u64],
        doubt: &mut [u64],
    ) -> bool {
        let (placed, count) = (self, t_max.len());
        // The shape does not know the end of its copy.
        let is_whole = placed.max_z.0.is_none() && !placed.body.shape.packets().is_of_the_notes();
        let Some(bounds) = placed.bounds.filter(|_| is_whole) else {
            let rays = rays.first(t_max.len());
            return brackets::occluded_by_brackets(cpu, t_max, blocked, doubt, |brackets| {
                self.brackets(cpu, rays, t_max, brackets);
            });
        };
        if count <= LANES {
            return placed.few_occluded::<LANES>(cpu, rays, (t_max, &bounds), blocked, doubt);
        }
        split(count, PART).fold(false, |any, part| {
            let (blocked, doubt) = (&mut blocked[part.clone()], &mut doubt[part.clone()]);
            let (rays, t_max) = (rays.part(part.clone()), &t_max[part]);
            placed.few_occluded::<PART>(cpu, rays, (t_max, &bounds), blocked, doubt) | any
        })
    }

    fn refine(&self, cpu: Cpu, rays: RayPacket, (near, far): (&[f64], &[f64]), out: &mut [f64]) {
        for part in split(out.len(), PART) {
            let brackets = (&near[part.clone()], &far[part.clone()]);
            self.few_refine(cpu, rays.part(part.clone()), brackets, &mut out[part]);
        }
    }

    fn interact(&self, cpu: Cpu, rays: RayPacket, distances: &[f64], interaction: SurfaceInteraction) {
        let shape = self.body.shape.packets();
        let is_shaded_otherwise = self.body.shape.is_smooth() && !shape.finds_normals_by_rays();
        if shape.is_of_the_notes() || is_shaded_otherwise {
            return shape::interact_each(cpu, self, rays, distances, interaction);
        }
        let SurfaceInteraction { mut points, mut normals, mut geometric_normals, sides, cosines, travelled } =
            interaction;
        for part in split(travelled.len(), PART) {
            let interaction = SurfaceInteraction {
                points: points.part(part.clone()),
                normals: normals.part(part.clone()),
                geometric_normals: geometric_normals.part(part.clone()),
                sides: &mut sides[part.clone()],
                cosines: &mut cosines[part.clone()],
                travelled: &mut travelled[part.clone()],
            };
            let rays = rays.part(part.clone());
            self.few_interact::<PART>(cpu, rays, &distances[part], interaction);
        }
    }

    fn finds_normals_by_rays(&self) -> bool {
        self.body.shape.packets().finds_normals_by_rays()
    }

    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        self.t_bounds(ray, range)
    }

    fn refine_one(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        self.distance(ray, &RayRange { origin_side, ..RayRange::ALL })
    }
}
