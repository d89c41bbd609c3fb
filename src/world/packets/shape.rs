//! Shapes for packets of rays.
//!
//! A [`Shape`] is asked in three ways: by an author's functions for one ray ([`OneRay`]), which loops take in that are
//! compiled for each level of instructions; by packets ([`Packets`]), which follows from that but for surfaces that take
//! packets themselves; and for what is certain ([`Proofs`]).

use crate::geometry::ray::{Bracket, MISS, Ray, RayRange, Side};
use crate::geometry::ray_packet::{Brackets, Nearest, RayPacket, mark_occluded, merge_nearest};
use crate::geometry::roots::Method;
use crate::geometry::sight::Sight;
use crate::numeric::double_double::DoubleDouble;
use crate::simd::cpu::{Cpu, kernels};
use crate::world::certify::{self, Enclosure, Equation, Precision};
use crate::world::coincidence::{CLOSE, ROUNDING};
use crate::world::hittable::{Bracketed, Certified, Hittable, Searched};
use crate::world::interaction::{SurfaceInteraction, turned};
use crate::world::shape::{ByBracket, ByDistance, ByEquation, ByFormula, ByRoots, Shape, Unproven};
use glam::DVec3;

/// Any shape as packets of rays ask it.
pub trait PacketShape: Packets + Proofs {
    /// The author's shape.
    fn hittable(&self) -> &(dyn Hittable + 'static);
}

impl<T: Hittable + 'static, S, P> PacketShape for Shape<T, S, P>
where
    Self: Packets + Proofs,
{
    fn hittable(&self) -> &(dyn Hittable + 'static) {
        &self.shape
    }
}

/// What packets of rays ask.
pub trait Packets: Send + Sync {
    /// Compares the hits of a packet with the nearest so far, and tells whether any is in doubt. `sides` are those of
    /// this shape that the rays leave, if they do; `id` is its index in the scene and 1.
    fn closest_hits(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        sides: Option<&[Side]>,
        id: u64,
        nearest: Nearest,
    ) -> bool;

    /// Marks the rays of a packet that it blocks before their ends, and those of which that is in doubt; tells
    /// whether any is.
    fn occluded(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        sides: Option<&[Side]>,
        t_max: &[f64],
        blocked: &mut [u64],
        doubt: &mut [u64],
    ) -> bool;

    /// The distances of hits that are certain, each between two distances where
    /// [`closest_hits`](Self::closest_hits) has bracketed it; NaN where it takes more than plain arithmetic.
    fn refine(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        sides: Option<&[Side]>,
        brackets: (&[f64], &[f64]),
        out: &mut [f64],
    );

    /// Where the rays of a packet come to it after these distances, and its normals there.
    fn interact(&self, cpu: Cpu, rays: RayPacket, distances: &[f64], landing: SurfaceInteraction);

    /// Between which distances the distance of one ray is.
    fn t_bounds(&self, ray: &Ray, range: &RayRange) -> Bracket;

    /// The distance of one ray's hit that [`t_bounds`](Self::t_bounds) has found for certain, or NaN.
    fn refine_one(&self, ray: &Ray, origin_side: Option<Side>) -> f64;
}

/// What is certain of a shape's hits.
pub trait Proofs: Send + Sync {
    /// Whether a point lies on its surface, but for an error of so many world units and for what rounding makes of the
    /// shape's own numbers. Rays that start there leave it.
    fn touches(&self, at: DVec3, error: f64) -> bool;

    /// The distance of the hit at about this one, in twice the precision, where that is to be had.
    fn fine_distance(&self, ray: &Ray, distance: f64) -> Option<DoubleDouble>;

    /// What is certain about the first hit of a ray.
    fn certify(&self, sight: &Sight, precision: Precision) -> Enclosure;

    /// Whether it is found by a formula of the notes, whose program tests every ray against each.
    fn is_of_the_notes(&self) -> bool {
        false
    }

    /// The distance by another method of finding roots; nothing where the shape is not the roots of a function along a
    /// ray, or is found in closed form.
    fn distance_by(&self, method: Method, ray: &Ray, range: &RayRange) -> Option<f64>;
}

impl<T: Hittable, S> Proofs for Shape<T, S, Unproven> {
    fn touches(&self, at: DVec3, error: f64) -> bool {
        is_met_within(&self.shape, at, error)
    }

    fn fine_distance(&self, _ray: &Ray, _distance: f64) -> Option<DoubleDouble> {
        None
    }

    fn certify(&self, _sight: &Sight, _precision: Precision) -> Enclosure {
        Enclosure::UNKNOWN
    }

    fn distance_by(&self, _method: Method, _ray: &Ray, _range: &RayRange) -> Option<f64> {
        None
    }
}

impl<T: Hittable + Equation, S> Proofs for Shape<T, S, ByFormula> {
    fn is_of_the_notes(&self) -> bool {
        true
    }

    fn touches(&self, at: DVec3, error: f64) -> bool {
        is_met_within(&self.shape, at, error)
    }

    fn fine_distance(&self, _ray: &Ray, _distance: f64) -> Option<DoubleDouble> {
        None
    }

    fn certify(&self, sight: &Sight, precision: Precision) -> Enclosure {
        certify::first_hit(&self.shape, sight, precision)
    }

    fn distance_by(&self, _method: Method, _ray: &Ray, _range: &RayRange) -> Option<f64> {
        None
    }
}

impl<T: Certified, S> Proofs for Shape<T, S, ByEquation> {
    fn touches(&self, at: DVec3, error: f64) -> bool {
        self.shape.touches(at, error)
    }

    fn fine_distance(&self, ray: &Ray, distance: f64) -> Option<DoubleDouble> {
        self.shape.fine_distance(ray, distance)
    }

    fn certify(&self, sight: &Sight, precision: Precision) -> Enclosure {
        certify::first_hit(&self.shape, sight, precision)
    }

    fn distance_by(&self, _method: Method, _ray: &Ray, _range: &RayRange) -> Option<f64> {
        None
    }
}

impl<T: Searched, S> Proofs for Shape<T, S, ByRoots> {
    fn touches(&self, at: DVec3, error: f64) -> bool {
        self.shape.touches(at, error)
    }

    fn fine_distance(&self, ray: &Ray, distance: f64) -> Option<DoubleDouble> {
        self.shape.fine_distance(ray, distance)
    }

    fn certify(&self, sight: &Sight, precision: Precision) -> Enclosure {
        certify::first_hit(&self.shape, sight, precision)
    }

    fn distance_by(&self, method: Method, ray: &Ray, range: &RayRange) -> Option<f64> {
        Some(self.shape.distance_by(method, ray, range))
    }
}

/// Whether a short ray through a point, upright on a shape, meets the shape within an error.
fn is_met_within(shape: &impl Hittable, at: DVec3, error: f64) -> bool {
    let dir = shape.normal(at);
    let short = 2.0 * error + ROUNDING * at.abs().max_element();
    let ray = Ray { origin: at - short * dir, dir };
    shape.distance(&ray, &RayRange { far: 2.0 * short, ..RayRange::ALL }) < MISS
}

/// A shape that is asked for one ray at a time.
pub trait OneRay: Send + Sync {
    /// The author's shape.
    type Author: Hittable;

    /// The author's shape.
    fn author(&self) -> &Self::Author;

    /// Between which distances the distance is.
    fn t_bounds(&self, ray: &Ray, range: &RayRange) -> Bracket;

    /// The distance of a hit that [`t_bounds`](Self::t_bounds) has found for certain, or NaN where that takes more than
    /// plain arithmetic.
    fn refine(&self, ray: &Ray, origin_side: Option<Side>) -> f64;

    /// What [`refine`](Self::refine) gives for each ray of a packet.
    #[inline(always)]
    fn refine_each(&self, rays: RayPacket, sides: Option<&[Side]>, out: &mut [f64]) {
        let (count, rays) = (out.len(), rays.first(out.len()));
        match sides {
            None => {
                for lane in 0..count {
                    out[lane] = self.refine(&rays.get(lane), None);
                }
            }
            Some(sides) => {
                for lane in 0..count {
                    out[lane] = self.refine(&rays.get(lane), Some(sides[lane]));
                }
            }
        }
    }
}

impl<T: Bracketed, P> OneRay for Shape<T, ByBracket, P> {
    type Author = T;

    #[inline(always)]
    fn author(&self) -> &T {
        &self.shape
    }

    #[inline(always)]
    fn t_bounds(&self, ray: &Ray, range: &RayRange) -> Bracket {
        self.shape.t_bounds(ray, range)
    }

    #[inline(always)]
    fn refine(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        self.shape.refine(ray, origin_side)
    }
}

/// The author's distance and what is known of where a shape is tell its bracket.
impl<T: Hittable, P: Coincidence> OneRay for Shape<T, ByDistance, P>
where
    Self: Proofs,
{
    type Author = T;

    #[inline(always)]
    fn author(&self) -> &T {
        &self.shape
    }

    #[inline(always)]
    fn t_bounds(&self, ray: &Ray, range: &RayRange) -> Bracket {
        if P::IS_PLAIN {
            return Bracket::exactly(self.shape.distance(ray, range));
        }
        let touches = || self.touches(ray.origin, range.origin_error);
        by_distance(range, touches, |range| Some(self.shape.distance(ray, range)))
    }

    #[inline(always)]
    fn refine(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        self.shape.distance(ray, &RayRange { origin_side, ..RayRange::ALL })
    }
}

/// The bracket of a shape that has no quicker one than its distance, where rounding does not decide that; `touches` tells
/// whether the shape touches the ray's origin within the span's `origin_error`.
#[inline(always)]
pub fn by_distance(
    range: &RayRange,
    touches: impl FnOnce() -> bool,
    distance: impl FnOnce(&RayRange) -> Option<f64>,
) -> Bracket {
    let RayRange { far, origin_side, origin_error, .. } = *range;
    if origin_side.is_none() && origin_error > 0.0 && touches() {
        return Bracket::UNKNOWN;
    }
    let close = if far < MISS { CLOSE * far } else { 0.0 };
    let Some(distance) = distance(&RayRange { far: far + close, ..*range }) else { return Bracket::UNKNOWN };
    // At the distance of another surface, more digits tell which comes first.
    if (distance - far).abs() <= close {
        return Bracket { near: distance - close, far: distance + close };
    }
    Bracket::exactly(distance)
}

/// Whether what meets at one distance is looked at closer.
pub trait Coincidence {
    /// Whether it is not.
    const IS_PLAIN: bool = false;
}

impl Coincidence for Unproven {}
impl Coincidence for ByEquation {}
impl Coincidence for ByRoots {}
impl Coincidence for ByFormula {
    const IS_PLAIN: bool = true;
}

/// For packets, one ray after the other, as many at a time as the processor takes.
impl<T: Hittable, S, P> Packets for Shape<T, S, P>
where
    Self: OneRay<Author = T>,
{
    fn closest_hits(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        sides: Option<&[Side]>,
        id: u64,
        nearest: Nearest,
    ) -> bool {
        closest_hits(cpu, self, rays, sides, id, nearest)
    }

    fn occluded(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        sides: Option<&[Side]>,
        t_max: &[f64],
        blocked: &mut [u64],
        doubt: &mut [u64],
    ) -> bool {
        occluded(cpu, self, rays, sides, t_max, blocked, doubt)
    }

    fn refine(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        sides: Option<&[Side]>,
        _brackets: (&[f64], &[f64]),
        out: &mut [f64],
    ) {
        refine(cpu, self, rays, sides, out);
    }

    fn interact(&self, cpu: Cpu, rays: RayPacket, distances: &[f64], landing: SurfaceInteraction) {
        let SurfaceInteraction { points, normals, sides, cosines, travelled } = landing;
        interact(cpu, &self.shape, rays, distances, sides, cosines, travelled, points, normals);
    }

    fn t_bounds(&self, ray: &Ray, range: &RayRange) -> Bracket {
        OneRay::t_bounds(self, ray, range)
    }

    fn refine_one(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        OneRay::refine(self, ray, origin_side)
    }
}

kernels! {
    /// Compares a shape's hits with the nearest so far. Tells whether any is in doubt.
    fn closest_hits[T: OneRay](shape: &T, rays: RayPacket, sides: Option<&[Side]>, id: u64, nearest: Nearest) -> bool {
        let (count, rays) = (rays.len(), rays.first(rays.len()));
        let Nearest { near, far, met, doubt } = nearest;
        match sides {
            None => merge_nearest(count, &ShapeBounds { shape, rays }, id, near, far, met, doubt),
            Some(sides) => {
                merge_nearest(count, &LeavingBounds { shape, rays, sides: &sides[..count] }, id, near, far, met, doubt)
            }
        }
    }

    /// Marks the rays that a shape's hits block before they come to their ends. Tells whether any is in doubt.
    fn occluded[T: OneRay](
        shape: &T, rays: RayPacket, sides: Option<&[Side]>, t_max: &[f64], blocked: &mut [u64], doubt: &mut [u64]
    ) -> bool {
        let (count, rays) = (t_max.len(), rays.first(t_max.len()));
        match sides {
            None => mark_occluded(&ShapeBounds { shape, rays }, t_max, blocked, doubt),
            Some(sides) => mark_occluded(&LeavingBounds { shape, rays, sides: &sides[..count] }, t_max, blocked, doubt),
        }
    }

    /// The distances of a shape's hits, as [`OneRay::refine`] gives them.
    fn refine[T: OneRay](shape: &T, rays: RayPacket, sides: Option<&[Side]>, out: &mut [f64]) {
        shape.refine_each(rays, sides, out);
    }

    /// Where rays come to a shape after these distances, and its normals there.
    fn interact[T: Hittable](
        shape: &T, rays: RayPacket, distances: &[f64], sides: &mut [Side], cosines: &mut [f64], travelled: &mut [f64]
    ) => points, normals {
        let (count, is_two_sided) = (travelled.len(), shape.is_two_sided());
        let (rays, distances) = (rays.first(count), &distances[..count]);
        let (sides, cosines) = (&mut sides[..count], &mut cosines[..count]);
        let (mut points, mut normals) = (points.first(count), normals.first(count));
        for lane in 0..count {
            let ray = rays.get(lane);
            let point = ray.at(distances[lane]);
            let normal;
            (sides[lane], cosines[lane], normal) = turned(ray.dir, shape.normal(point), is_two_sided);
            points.set(lane, point);
            normals.set(lane, normal);
            travelled[lane] += distances[lane];
        }
    }
}

/// The brackets that a shape gives.
struct ShapeBounds<'b, T> {
    shape: &'b T,
    rays: RayPacket<'b>,
}

impl<T: OneRay> Brackets for ShapeBounds<'_, T> {
    #[inline(always)]
    fn get(&self, lane: usize, far: f64) -> Bracket {
        let origin_error = self.rays.origin_error;
        self.shape.t_bounds(&self.rays.get(lane), &RayRange { far, origin_error, ..RayRange::ALL })
    }
}

/// The brackets that a shape gives for rays that leave it.
struct LeavingBounds<'b, T> {
    shape: &'b T,
    rays: RayPacket<'b>,
    sides: &'b [Side],
}

impl<T: OneRay> Brackets for LeavingBounds<'_, T> {
    #[inline(always)]
    fn get(&self, lane: usize, far: f64) -> Bracket {
        let origin_side = self.sides[lane];
        if !self.shape.author().can_hit_itself(origin_side) {
            return Bracket::MISS;
        }
        let (origin_side, origin_error) = (Some(origin_side), self.rays.origin_error);
        self.shape
            .t_bounds(&self.rays.get(lane), &RayRange { far, origin_side, origin_error, ..RayRange::ALL })
    }
}
