//! Rays mapped to a copy's object space, and hits mapped back to world space.

use super::shape::{Placed, in_world};
use crate::geometry::ray::{Bracket, RayRange};
use crate::geometry::ray_packet::RayPacket;
use crate::simd::cpu::{Cpu, kernels};
use crate::simd::soa::Vectors;
use crate::world::coincidence::CLOSE;
use glam::DVec3;

/// Rays in object space.
pub struct ObjectSpaceRays<const N: usize> {
    /// The origins.
    pub origin: Vectors<N>,
    /// The directions.
    pub dir: Vectors<N>,
    /// The length of a world unit along each ray.
    pub lengths: [f64; N],
    /// The ends of the rays, as distances in object space.
    pub ends: [f64; N],
    /// A bound of the error of the origins.
    pub origin_error: f64,
}

impl<const N: usize> ObjectSpaceRays<N> {
    /// Rays before [`set`](Self::set).
    pub const NONE: Self = Self {
        origin: Vectors::ZERO,
        dir: Vectors::ZERO,
        lengths: [0.0; N],
        ends: [0.0; N],
        origin_error: 0.0,
    };

    /// Sets at most `N` rays in object space, with ends given as distances in world units. The rays are not returned,
    /// because returning large values may copy them.
    #[inline(always)]
    pub fn set(&mut self, cpu: Cpu, placed: &Placed, rays: RayPacket, ends: &[f64]) {
        let count = ends.len();
        let (lengths, own_ends) = (&mut self.lengths[..count], &mut self.ends[..count]);
        let (origins, dirs) = (self.origin.view_mut(count), self.dir.view_mut(count));
        let largest = take_in(cpu, placed, rays, ends, lengths, own_ends, origins, dirs);
        if rays.origin_error > 0.0 {
            self.origin_error = placed.object_error(DVec3::splat(largest), rays.origin_error);
        }
    }

    /// Returns the first `count` rays.
    #[inline(always)]
    pub fn rays(&self, count: usize) -> RayPacket<'_> {
        RayPacket::new(self.origin.view(count), self.dir.view(count), self.origin_error)
    }
}

kernels! {
    /// Maps rays and their ends to object space. Returns the largest coordinate of their origins in world space.
    fn take_in(
        placed: &Placed, rays: RayPacket, ends: &[f64], lengths: &mut [f64], own_ends: &mut [f64]
    ) => origins, dirs -> f64 {
        let count = ends.len();
        let rays = rays.first(count);
        let (lengths, own_ends) = (&mut lengths[..count], &mut own_ends[..count]);
        let (mut origins, mut dirs) = (origins.first(count), dirs.first(count));
        let mut largest = 0.0_f64;
        for lane in 0..count {
            let ray = rays.get(lane);
            let (own, length) = placed.object_ray(&ray);
            origins.set(lane, own.origin);
            dirs.set(lane, own.dir);
            lengths[lane] = length;
            own_ends[lane] = ends[lane] * length * (1.0 + CLOSE);
            largest = largest.max(ray.origin.abs().max_element());
        }
        largest
    }

    /// Maps brackets to world units, like [`in_world`].
    pub fn to_world(
        error: f64, lengths: &[f64], rays: RayPacket, ends: &[f64], near: &mut [f64], far: &mut [f64]
    ) {
        let count = near.len();
        let rays = rays.first(count);
        let (lengths, ends, far) = (&lengths[..count], &ends[..count], &mut far[..count]);
        for lane in 0..count {
            let range = RayRange { far: ends[lane], ..RayRange::ALL };
            let bracket = in_world(Bracket { near: near[lane], far: far[lane] }, lengths[lane], error, &rays.get(lane), &range);
            (near[lane], far[lane]) = (bracket.near, bracket.far);
        }
    }

    /// Maps hits to world space.
    pub fn take_out(
        placed: &Placed, rays: RayPacket, distances: &[f64], cosines: &mut [f64], travelled: &mut [f64]
    ) => points, normals, geometric_normals {
        let (count, to_world) = (travelled.len(), placed.to_object_space.transpose());
        let (is_two_sided, is_smooth) = (placed.body.shape.is_two_sided(), placed.body.shape.is_smooth());
        let (rays, distances, cosines) = (rays.first(count), &distances[..count], &mut cosines[..count]);
        let (mut points, mut normals) = (points.first(count), normals.first(count));
        let mut geometric_normals = geometric_normals.first(count);
        for lane in 0..count {
            let is_turned = is_two_sided && cosines[lane] >= 0.0;
            let turned = |normal: DVec3| if is_turned { -normal } else { normal };
            // The normal is turned after it is mapped to world space, as for single rays. This gives even zeros the
            // same sign.
            let there = |normal: DVec3| (to_world * turned(normal)).normalize();
            let shaded = normals.get(lane);
            let normal = there(if is_smooth { geometric_normals.get(lane) } else { shaded });
            cosines[lane] = rays.dir.get(lane).dot(normal);
            points.set(lane, rays.get(lane).at(distances[lane]));
            normals.set(lane, turned(if is_smooth { there(shaded) } else { normal }));
            if is_smooth {
                geometric_normals.set(lane, turned(normal));
            }
            travelled[lane] += distances[lane];
        }
    }
}
