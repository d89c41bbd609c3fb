//! Shapes for packets of rays.
//!
//! A [`Shape`] has three interfaces. [`ScalarIntersect`] has the plugin author's functions for one ray, inlined into
//! loops that are compiled for each instruction set. [`PacketIntersect`] takes packets; it is derived from
//! [`ScalarIntersect`], except for shapes that take packets themselves. [`HitQueries`] tells what is certain about
//! hits.

pub use super::proofs::{HitQueries, assumed, queries_by_equation};

use super::brackets::{closest_by_brackets, occluded_by_brackets, of_beams};
use crate::coincidence::close;
use crate::geometry::ray::{Bracket, MISS, Ray, RayBall, RayError, RayRange, Side};
use crate::geometry::ray_packet::{
    Brackets, HitRecordMut, RayPacket, SurfaceInteraction, mark_occluded, merge_nearest, turned,
};
use crate::hittable::{Bracketed, ByBracket, ByDistance, Facts, Hittable, Shape, Sides};
use crate::simd::cpu::{Cpu, kernels};
use crate::simd::soa::LANES;

/// A shape of any type, with its interfaces for packets and proofs.
pub trait PacketShape: PacketIntersect + HitQueries {
    /// Returns the plugin author's shape.
    fn hittable(&self) -> &(dyn Hittable + 'static);
}

impl<T: Hittable + 'static, S, P> PacketShape for Shape<T, S, P>
where
    Self: PacketIntersect + HitQueries,
{
    fn hittable(&self) -> &(dyn Hittable + 'static) {
        &self.shape
    }
}

/// A shape with interfaces of its own.
impl<T: Hittable + PacketIntersect + HitQueries + 'static> PacketShape for T {
    fn hittable(&self) -> &(dyn Hittable + 'static) {
        self
    }
}

/// A shape against which packets of rays are tested.
pub trait PacketIntersect: Send + Sync {
    /// Computes brackets of the first hits, before `ends`, of all rays that each ray of a packet stands for. Hits
    /// beyond an end may be left out.
    fn brackets(&self, cpu: Cpu, rays: RayPacket, ends: &[f64], brackets: (&mut [f64], &mut [f64]));

    /// Merges the hits of a packet's rays with this shape into the nearest hits so far, and tells whether the order of
    /// any is in doubt. `id` is the object's index in the scene plus 1.
    fn closest_hits(&self, cpu: Cpu, rays: RayPacket, id: u64, nearest: HitRecordMut) -> bool {
        closest_by_brackets(cpu, rays.len(), id, nearest, |ends, brackets| {
            self.brackets(cpu, rays, ends, brackets)
        })
    }

    /// Marks in `blocked` the rays that this shape blocks before `t_max`, and in `doubt` the rays for which that is
    /// uncertain. Returns whether any is in doubt.
    fn occluded(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        t_max: &[f64],
        blocked: &mut [u64],
        doubt: &mut [u64],
    ) -> bool {
        let rays = rays.first(t_max.len());
        occluded_by_brackets(cpu, t_max, blocked, doubt, |brackets| self.brackets(cpu, rays, t_max, brackets))
    }

    /// Computes the distances of certain hits that [`closest_hits`](Self::closest_hits) has bracketed; NaN where a
    /// distance takes more than plain arithmetic. Where a bracket has no width, the distance is known, and may be
    /// left out.
    fn refine(&self, cpu: Cpu, rays: RayPacket, brackets: (&[f64], &[f64]), out: &mut [f64]);

    /// Computes the points, normals and sides that the rays of a packet hit at these distances, in world units.
    fn interact(&self, cpu: Cpu, rays: RayPacket, distances: &[f64], interaction: SurfaceInteraction);

    /// Tells whether [`interact`](Self::interact) finds normals from the rays. By default, it finds them from the
    /// points.
    fn finds_normals_by_rays(&self) -> bool {
        false
    }

    /// Returns a bracket of the first hit of all rays that this one stands for.
    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket;

    /// Computes the result of [`t_bounds`](Self::t_bounds) for each of up to
    /// [`BEAM`](crate::geometry::ray_packet::BEAM) rays, each in its own range.
    fn t_bounds_each(&self, rays: RayPacket, ranges: &[RayRange], brackets: &mut [Bracket]) {
        rays.each(ranges, brackets, |ray, range| self.t_bounds(ray, range));
    }

    /// Returns the distance of one ray's hit that [`t_bounds`](Self::t_bounds) has found for certain, or NaN where it
    /// takes more than plain arithmetic.
    fn refine_one(&self, ray: &Ray, origin_side: Option<Side>) -> f64;
}

/// A shape that is tested against one ray at a time.
pub trait ScalarIntersect: Send + Sync {
    /// The type of the plugin author's shape.
    type Author: Hittable;

    /// Whether rays that lie close together are searched together, by [`t_bounds_each`](Self::t_bounds_each).
    const BY_BEAMS: bool = false;

    /// Whether a larger error of a ray's origin only widens its bracket. Where it may move a hit, each ray of a packet
    /// counts with its own error and not with the largest, so that its hit does not depend on the other rays.
    const IS_BRACKET: bool = false;

    /// Computes a bracket of the first hit of each of up to [`BEAM`](crate::geometry::ray_packet::BEAM) rays, each in
    /// its own range.
    fn t_bounds_each(&self, rays: RayPacket, ranges: &[RayRange], brackets: &mut [Bracket]) {
        rays.each(ranges, brackets, |ray, range| self.t_bounds(ray, range));
    }

    /// Returns the plugin author's shape.
    fn author(&self) -> &Self::Author;

    /// Returns a bracket of the first hit of all rays that this one stands for.
    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket;

    /// Returns the distance of a hit that [`t_bounds`](Self::t_bounds) has found for certain, or NaN where it takes
    /// more than plain arithmetic. By default, it is the author's.
    #[inline(always)]
    fn refine(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        self.author().distance(ray, &RayRange { origin_side, ..RayRange::ALL })
    }

    /// Tells whether eight rays certainly miss the shape, where that is known in less time than their brackets.
    #[inline(always)]
    fn is_missed_by(&self, _rays: RayPacket) -> bool {
        false
    }

    /// Writes the result of [`refine`](Self::refine) for each ray of a packet.
    #[inline(always)]
    fn refine_each(&self, rays: RayPacket, out: &mut [f64]) {
        refine_one_by_one(self, rays, out);
    }
}

/// Writes the result of [`ScalarIntersect::refine`] for each ray of a packet. A closure would not be inlined.
#[inline(always)]
fn refine_one_by_one(shape: &(impl ScalarIntersect + ?Sized), rays: RayPacket, out: &mut [f64]) {
    let (count, rays) = (out.len(), rays.first(out.len()));
    match rays.leaving {
        None => {
            for lane in 0..count {
                out[lane] = shape.refine(&rays.get(lane), None);
            }
        }
        Some(sides) => {
            for lane in 0..count {
                out[lane] = shape.refine(&rays.get(lane), Some(sides[lane]));
            }
        }
    }
}

impl<T: Bracketed, P> ScalarIntersect for Shape<T, ByBracket, P> {
    type Author = T;

    const BY_BEAMS: bool = T::BY_BEAMS;

    const IS_BRACKET: bool = true;

    fn t_bounds_each(&self, rays: RayPacket, ranges: &[RayRange], brackets: &mut [Bracket]) {
        self.shape.t_bounds_each(rays, ranges, brackets);
    }

    #[inline(always)]
    fn author(&self) -> &T {
        &self.shape
    }

    #[inline(always)]
    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        self.shape.t_bounds(ray, range)
    }

    #[inline(always)]
    fn refine(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        self.shape.refine(ray, origin_side)
    }

    #[inline(always)]
    fn is_missed_by(&self, rays: RayPacket) -> bool {
        self.shape.is_missed_by(rays)
    }

    #[inline(always)]
    fn refine_each(&self, rays: RayPacket, out: &mut [f64]) {
        if !self.shape.refine_each(rays, out) {
            refine_one_by_one(self, rays, out);
        }
    }
}

/// The bracket follows from the author's distance, and from whether the shape touches the ray's origin. In a copy's
/// coordinates, too, the hit at the author's distance counts.
impl<T: Hittable, P> ScalarIntersect for Shape<T, ByDistance, P>
where
    Self: HitQueries,
{
    type Author = T;

    #[inline(always)]
    fn author(&self) -> &T {
        &self.shape
    }

    #[inline(always)]
    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        if self.is_of_the_notes() {
            return Bracket::exactly(self.shape.distance(ray, range));
        }
        let is_on_surface = || self.is_on_surface(ray.origin, range.origin_error);
        by_distance(ray, range, is_on_surface, |range| Some(self.shape.distance(ray, range)))
    }
}

/// Returns the bracket of a shape that has no quicker one than its distance. The bracket is unknown where rounding
/// decides the distance. `is_on_surface` tells whether the shape touches the ray's origin within the range's
/// `origin_error`.
#[inline(always)]
pub fn by_distance(
    ray: &Ray,
    range: &RayRange,
    is_on_surface: impl FnOnce() -> bool,
    distance: impl FnOnce(&RayRange) -> Option<f64>,
) -> Bracket {
    let RayRange { far, origin_side, origin_error, .. } = *range;
    if origin_side.is_none() && origin_error > 0.0 && is_on_surface() {
        return Bracket::UNKNOWN;
    }
    let close = if far < MISS { close(ray, far) } else { 0.0 };
    let Some(distance) = distance(&RayRange { far: far + close, ..*range }) else { return Bracket::UNKNOWN };
    // At the distance of another surface, the bracket is widened, so that more digits decide which comes first.
    if (distance - far).abs() <= close {
        return Bracket { near: distance - close, far: distance + close };
    }
    Bracket::exactly(distance)
}

/// Tests packets one ray after the other, in loops that the compiler vectorizes.
impl<T: ScalarIntersect> PacketIntersect for T {
    fn brackets(&self, cpu: Cpu, rays: RayPacket, ends: &[f64], (near, far): (&mut [f64], &mut [f64])) {
        if Self::BY_BEAMS {
            let can_hit_itself = self.author().facts().can_hit_itself;
            return of_beams(rays, ends, (near, far), can_hit_itself, |rays, ranges, brackets| {
                ScalarIntersect::t_bounds_each(self, rays, ranges, brackets);
            });
        }
        brackets(cpu, self, rays, ends, near, far);
    }

    fn closest_hits(&self, cpu: Cpu, rays: RayPacket, id: u64, nearest: HitRecordMut) -> bool {
        if Self::BY_BEAMS {
            let rays = RayPacket { drift: RayError::NONE, ..rays };
            return closest_by_brackets(cpu, rays.len(), id, nearest, |ends, brackets| {
                self.brackets(cpu, rays, ends, brackets);
            });
        }
        closest_hits(cpu, self, rays, id, nearest)
    }

    fn occluded(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        t_max: &[f64],
        blocked: &mut [u64],
        doubt: &mut [u64],
    ) -> bool {
        if Self::BY_BEAMS {
            let rays = RayPacket { drift: RayError::NONE, ..rays };
            let rays = rays.first(t_max.len());
            return occluded_by_brackets(cpu, t_max, blocked, doubt, |brackets| {
                self.brackets(cpu, rays, t_max, brackets);
            });
        }
        occluded(cpu, self, rays, t_max, blocked, doubt)
    }

    fn refine(&self, cpu: Cpu, rays: RayPacket, _brackets: (&[f64], &[f64]), out: &mut [f64]) {
        refine(cpu, self, rays, out);
    }

    fn interact(&self, cpu: Cpu, rays: RayPacket, distances: &[f64], interaction: SurfaceInteraction) {
        interact_each(cpu, self.author(), rays, distances, interaction);
    }

    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        ScalarIntersect::t_bounds(self, ray, range)
    }

    fn t_bounds_each(&self, rays: RayPacket, ranges: &[RayRange], brackets: &mut [Bracket]) {
        ScalarIntersect::t_bounds_each(self, rays, ranges, brackets);
    }

    fn refine_one(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        ScalarIntersect::refine(self, ray, origin_side)
    }
}

/// Computes the points, normals and sides that rays hit at these distances, in world units, one ray after the other.
pub fn interact_each<T: Hittable>(
    cpu: Cpu,
    shape: &T,
    rays: RayPacket,
    distances: &[f64],
    interaction: SurfaceInteraction,
) {
    let SurfaceInteraction { points, normals, geometric_normals, sides, cosines, travelled } = interaction;
    interact(cpu, shape, rays, distances, sides, cosines, travelled, points, normals, geometric_normals);
}

kernels! {
    /// Merges a shape's hits into the nearest so far. Returns whether the order of any is in doubt.
    fn closest_hits[T: ScalarIntersect](shape: &T, rays: RayPacket, id: u64, nearest: HitRecordMut) -> bool {
        let (count, rays) = (rays.len(), rays.first(rays.len()));
        let rays = RayPacket { drift: RayError::NONE, ..rays };
        let HitRecordMut { near, far, hit_ids, doubt } = nearest;
        if count == LANES && shape.is_missed_by(rays) {
            doubt.fill(0);
            return false;
        }
        match rays.leaving {
            None => merge_nearest(count, &ShapeBounds { shape, rays }, id, near, far, hit_ids, doubt),
            Some(sides) => merge_nearest(count, &LeavingBounds::new(shape, rays, sides), id, near, far, hit_ids, doubt),
        }
    }

    /// Marks the rays that a shape blocks before `t_max`. Returns whether any is in doubt.
    fn occluded[T: ScalarIntersect](
        shape: &T, rays: RayPacket, t_max: &[f64], blocked: &mut [u64], doubt: &mut [u64]
    ) -> bool {
        let rays = RayPacket { drift: RayError::NONE, ..rays.first(t_max.len()) };
        if t_max.len() == LANES && shape.is_missed_by(rays) {
            doubt.fill(0);
            return false;
        }
        match rays.leaving {
            None => mark_occluded(&ShapeBounds { shape, rays }, t_max, blocked, doubt),
            Some(sides) => mark_occluded(&LeavingBounds::new(shape, rays, sides), t_max, blocked, doubt),
        }
    }

    /// Computes brackets of the first hits of all rays that each ray stands for.
    fn brackets[T: ScalarIntersect](shape: &T, rays: RayPacket, ends: &[f64], near: &mut [f64], far: &mut [f64]) {
        let (ends, rays) = (&ends[..near.len()], rays.first(near.len()));
        match rays.leaving {
            None => write(&ShapeBounds { shape, rays }, ends, near, far),
            Some(sides) => write(&LeavingBounds::new(shape, rays, sides), ends, near, far),
        }
    }

    /// Computes the distances of a shape's hits, as [`ScalarIntersect::refine`] returns them.
    fn refine[T: ScalarIntersect](shape: &T, rays: RayPacket, out: &mut [f64]) {
        shape.refine_each(rays, out);
    }

    /// Computes the arrays of [`interact_each`].
    fn interact[T: Hittable](
        shape: &T, rays: RayPacket, distances: &[f64], sides: &mut [Side], cosines: &mut [f64], travelled: &mut [f64]
    ) => points, normals, geometric_normals {
        let (count, Facts { is_two_sided, is_smooth, .. }) = (travelled.len(), shape.facts());
        let (rays, distances) = (rays.first(count), &distances[..count]);
        let (sides, cosines) = (&mut sides[..count], &mut cosines[..count]);
        let (mut points, mut normals) = (points.first(count), normals.first(count));
        let mut geometric_normals = geometric_normals.first(count);
        for lane in 0..count {
            let ray = rays.get(lane);
            let point = ray.at(distances[lane]);
            let normal;
            (sides[lane], cosines[lane], normal) = turned(ray.dir, shape.normal(point), is_two_sided);
            points.set(lane, point);
            normals.set(lane, if is_smooth { shape.shading_normal(point, normal) } else { normal });
            if is_smooth {
                geometric_normals.set(lane, normal);
            }
            travelled[lane] += distances[lane];
        }
    }
}

/// Writes the brackets of hits before `ends`.
#[inline(always)]
fn write(brackets: &impl Brackets, ends: &[f64], near: &mut [f64], far: &mut [f64]) {
    let far = &mut far[..ends.len()];
    for lane in 0..ends.len() {
        Bracket { near: near[lane], far: far[lane] } = brackets.get(lane, ends[lane]);
    }
}

/// A shape's brackets for rays that do not leave the shape.
struct ShapeBounds<'b, T> {
    shape: &'b T,
    rays: RayPacket<'b>,
}

impl<T: ScalarIntersect> Brackets for ShapeBounds<'_, T> {
    #[inline(always)]
    fn get(&self, lane: usize, far: f64) -> Bracket {
        let origin_error = self.rays.origin_error;
        let ray = RayBall { ray: self.rays.get(lane), drift: self.rays.drift };
        self.shape.t_bounds(&ray, &RayRange { far, origin_error, ..RayRange::ALL })
    }
}

/// A shape's brackets for rays that leave the shape.
struct LeavingBounds<'b, T> {
    shape: &'b T,
    rays: RayPacket<'b>,
    sides: &'b [Side],
    can_hit_itself: Sides,
}

impl<'b, T: ScalarIntersect> LeavingBounds<'b, T> {
    #[inline(always)]
    fn new(shape: &'b T, rays: RayPacket<'b>, sides: &'b [Side]) -> Self {
        Self { shape, rays, sides, can_hit_itself: shape.author().facts().can_hit_itself }
    }
}

impl<T: ScalarIntersect> Brackets for LeavingBounds<'_, T> {
    #[inline(always)]
    fn get(&self, lane: usize, far: f64) -> Bracket {
        let origin_side = self.sides[lane];
        if !self.can_hit_itself.contain(origin_side) {
            return Bracket::MISS;
        }
        let origin_error = if T::IS_BRACKET { self.rays.origin_error } else { self.rays.error(lane) };
        let origin_side = Some(origin_side);
        let ray = RayBall { ray: self.rays.get(lane), drift: self.rays.drift };
        self.shape.t_bounds(&ray, &RayRange { far, origin_side, origin_error, ..RayRange::ALL })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::soa::{LANES, Vectors};
    use glam::DVec3;

    /// A shape whose distance is the error of a ray's origin.
    struct Echo;

    impl Hittable for Echo {
        fn distance(&self, _ray: &Ray, range: &RayRange) -> f64 {
            range.origin_error
        }

        fn normal(&self, _at: DVec3) -> DVec3 {
            DVec3::Z
        }

        fn facts(&self) -> Facts {
            Facts::unbounded(1.0)
        }
    }

    #[test]
    fn a_ray_that_leaves_a_shape_counts_with_its_own_error() {
        let shape = Shape::new(Echo);
        let (origin, dir) = (Vectors::<LANES>::of(DVec3::ZERO), Vectors::<LANES>::of(DVec3::Z));
        let errors: [f64; LANES] = std::array::from_fn(|lane| 1.0 + lane as f64);
        let sides = [Side::Outside; LANES];
        let rays = RayPacket::new(origin.view(LANES), dir.view(LANES), LANES as f64);
        let rays = rays.with_errors(&errors).leaving(Some(&sides));
        let (mut near, mut far) = ([0.0; LANES], [0.0; LANES]);
        for cpu in Cpu::all() {
            PacketIntersect::brackets(&shape, cpu, rays, &[MISS; LANES], (&mut near, &mut far));
            assert_eq!((near, far), (errors, errors), "{cpu}");
        }
        let part = rays.part(2..4);
        assert_eq!([part.error(0), part.error(1)], [3.0, 4.0]);
    }
}
