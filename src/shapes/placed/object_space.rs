//! Rays mapped to a copy's object space, and hits mapped back to world space.

use super::image_plane::MaxZ;
use super::shape::{Placed, in_world};
use glam::DVec3;
use tabray_world::coincidence::CLOSE;
use tabray_world::geometry::aabb::{self, Aabb};
use tabray_world::geometry::ray::{Bracket, MISS, RayError, RayRange, Side};
use tabray_world::geometry::ray_packet::{RayPacket, turned};
use tabray_world::simd::cpu::{Cpu, kernels};
use tabray_world::simd::soa::{Vectors, View};

/// Calls a function with at most `N` rays in object space, their ends there, and the length of a world unit along each.
/// `ends` are distances in world units, and `drift` is that of the rays in object space.
#[inline(always)]
pub fn in_object_space<const N: usize, T>(
    (cpu, placed): (Cpu, &Placed),
    (rays, ends): (RayPacket, &[f64]),
    drift: RayError,
    act: impl FnOnce(RayPacket, &mut [f64], &[f64]) -> T,
) -> T {
    let count = ends.len();
    // Separate arrays: a large one would be cleared byte by byte.
    let (mut origin, mut dir) = (Vectors::<N>::ZERO, Vectors::<N>::ZERO);
    let (mut lengths, mut own_ends) = ([0.0; N], [0.0; N]);
    let (lengths, own_ends) = (&mut lengths[..count], &mut own_ends[..count]);
    take_in(cpu, placed, rays, ends, lengths, own_ends, origin.view_mut(count), dir.view_mut(count));
    let origin_error = if rays.origin_error > 0.0 {
        let reach = aabb::reach(cpu, rays.origin.first(count));
        placed.object_error(DVec3::splat(reach), rays.origin_error)
    } else {
        0.0
    };
    let mut errors = [0.0; N];
    let errors = match rays.origin_errors {
        [] => &[],
        _ => {
            for lane in 0..count {
                errors[lane] = placed.object_error(rays.origin.get(lane), rays.error(lane));
            }
            &errors[..count]
        }
    };
    let own = RayPacket::new(origin.view(count), dir.view(count), origin_error)
        .with_errors(errors)
        .leaving(rays.leaving);
    act(RayPacket { drift, ..own }, own_ends, lengths)
}

kernels! {
    /// Maps rays and their ends to object space.
    fn take_in(
        placed: &Placed, rays: RayPacket, ends: &[f64], lengths: &mut [f64], own_ends: &mut [f64]
    ) => origins, dirs {
        let count = ends.len();
        let rays = rays.first(count);
        let (lengths, own_ends) = (&mut lengths[..count], &mut own_ends[..count]);
        let (mut origins, mut dirs) = (origins.first(count), dirs.first(count));
        for lane in 0..count {
            let (own, length) = placed.object_ray(&rays.get(lane));
            origins.set(lane, own.origin);
            dirs.set(lane, own.dir);
            lengths[lane] = length;
            own_ends[lane] = ends[lane] * length * (1.0 + CLOSE);
        }
    }

    /// Maps points to object space.
    pub fn object_points(placed: &Placed, points: View) => out {
        let (count, mut out) = (points.len(), out.first(points.len()));
        for lane in 0..count {
            out.set(lane, placed.object_point(points.get(lane)));
        }
    }

    /// Maps the points at these distances of rays to object space.
    pub fn object_hits(placed: &Placed, rays: RayPacket, distances: &[f64]) => out {
        let (count, rays, mut out) = (distances.len(), rays.first(distances.len()), out.first(distances.len()));
        for lane in 0..count {
            out.set(lane, placed.object_point(rays.get(lane).at(distances[lane])));
        }
    }

    /// Cuts brackets off where a copy ends, like [`MaxZ::kept_bracket`].
    pub fn keep_brackets(max_z: MaxZ, rays: RayPacket, near: &mut [f64], far: &mut [f64]) {
        let (count, rays) = (near.len(), rays.first(near.len()));
        let far = &mut far[..count];
        for lane in 0..count {
            let bracket = Bracket { near: near[lane], far: far[lane] };
            let Bracket { near: low, far: high } = max_z.kept_bracket(&rays.get(lane), bracket, rays.origin_error);
            (near[lane], far[lane]) = (low, high);
        }
    }

    /// Ends rays that end in a box before they begin. Tells whether that ends any.
    pub fn end_in(bounds: &Aabb, rays: RayPacket, t_max: &[f64], own_ends: &mut [f64]) -> bool {
        let (count, rays, own_ends) = (t_max.len(), rays.first(t_max.len()), &mut own_ends[..t_max.len()]);
        let mut any = 0;
        for lane in 0..count {
            let end = rays.get(lane).at(t_max[lane]);
            let is_in = (bounds.low.x <= end.x) & (end.x <= bounds.high.x)
                & (bounds.low.y <= end.y) & (end.y <= bounds.high.y)
                & (bounds.low.z <= end.z) & (end.z <= bounds.high.z);
            own_ends[lane] = if is_in { -1.0 } else { own_ends[lane] };
            any |= u64::from(is_in & (t_max[lane] > 0.0));
        }
        any != 0
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

    /// Maps distances that were found in object space to world units, for rays whose brackets in world units are open.
    /// `own` are brackets in object space. NaN stands for what a single ray decides.
    pub fn take_out_distances(
        max_z: MaxZ, rays: RayPacket, lengths: &[f64], brackets: (&[f64], &[f64]), own: (&[f64], &[f64]),
        distances: &[f64], out: &mut [f64]
    ) {
        let (count, rays) = (out.len(), rays.first(out.len()));
        let (near, far) = (&brackets.0[..count], &brackets.1[..count]);
        let (low, high) = (&own.0[..count], &own.1[..count]);
        let (lengths, distances) = (&lengths[..count], &distances[..count]);
        for lane in 0..count {
            let distance = if low[lane] == high[lane] { low[lane] } else { distances[lane] };
            let kept = RayRange::ALL.keep(distance / lengths[lane]);
            let kept = if max_z.cuts_off(&rays.get(lane), kept) { MISS } else { kept };
            let is_open = distance.is_nan() | ((low[lane] < MISS) & (high[lane] == MISS));
            let kept = if is_open { f64::NAN } else { kept };
            out[lane] = if near[lane] == far[lane] { out[lane] } else { kept };
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

    /// Maps normals to world space that [`object_hits`] have, seen along any direction with these cosines.
    pub fn take_out_normals(
        placed: &Placed, rays: RayPacket, distances: &[f64], sides: &mut [Side], cosines: &mut [f64], travelled: &mut [f64]
    ) => points, normals {
        let (count, to_world) = (travelled.len(), placed.to_object_space.transpose());
        let is_two_sided = placed.body.shape.is_two_sided();
        let (rays, distances) = (rays.first(count), &distances[..count]);
        let (sides, cosines) = (&mut sides[..count], &mut cosines[..count]);
        let (mut points, mut normals) = (points.first(count), normals.first(count));
        for lane in 0..count {
            let (ray, own) = (rays.get(lane), normals.get(lane));
            let own = if is_two_sided & (cosines[lane] >= 0.0) { -own } else { own };
            let normal;
            (sides[lane], cosines[lane], normal) = turned(ray.dir, (to_world * own).normalize(), is_two_sided);
            points.set(lane, ray.at(distances[lane]));
            normals.set(lane, normal);
            travelled[lane] += distances[lane];
        }
    }
}
