//! Shapes: the trait that a plugin implements for one ray, and what follows from it for packets of rays.

use crate::geometry::bounds::{self, Bounds};
use crate::geometry::packet::{Brackets, Nearest, Rays, mark, merge};
use crate::geometry::ray::{Bracket, MISS, Ray, Side, Span};
use crate::geometry::roots::Method;
use crate::geometry::sight::Sight;
use crate::numeric::twofold::Twofold;
use crate::simd::cpu::{Cpu, kernels};
use crate::world::certify::{Enclosure, Precision};
use crate::world::coincidence::{CLOSE, ROUNDING};
use crate::world::landing::{Landing, turned};
use glam::DVec3;

/// A shape that rays can hit. Shapes do not change while a picture is made.
///
/// A plugin implements `distance` and `normal`, and of the others what is not as their defaults have it. The last
/// ones, which take packets, are there for every shape.
pub trait Hittable: Send + Sync {
    /// The distance from the ray's origin to its first hit of the shape within the span, or [`MISS`].
    fn distance(&self, ray: &Ray, within: &Span) -> f64;

    /// The unit normal of the shape at a point of it.
    fn normal(&self, at: DVec3) -> DVec3;

    /// A box that holds all of it; nothing where there is none.
    fn bounds(&self) -> Option<Bounds> {
        None
    }

    /// Whether no part of it lies in a region, which may be without an end. A shape without bounds may know better.
    fn is_clear_of(&self, region: &Bounds) -> bool {
        self.bounds().is_some_and(|bounds| !bounds.overlaps(region))
    }

    /// A point and the unit normal of the plane that all of it lies in, if there is one: rays that leave it stay on their
    /// side of that.
    fn plane(&self) -> Option<[DVec3; 2]> {
        None
    }

    /// How far from a point all of it is, at least; 0 where that is not known.
    fn clearance(&self, from: DVec3) -> f64 {
        bounds::clearance(from, self.bounds(), |region| self.is_clear_of(region))
    }

    /// Between which distances [`distance`](Self::distance) is. Where that is dear, plain arithmetic without branches
    /// says quickly which shape a ray may meet first, and the rest is computed for that one alone.
    ///
    /// Where the ray may start on the shape, that is where it [`touches`](Self::touches) the origin within the span's
    /// `origin_error`, it is a bracket without a certain end.
    #[inline(always)]
    fn bracket(&self, ray: &Ray, within: &Span) -> Bracket {
        bracket_by(self, ray, within, |within| Some(self.distance(ray, within)))
    }

    /// What [`distance`](Self::distance) gives, to the last bit, or NaN where it takes more than plain arithmetic
    /// without branches.
    #[inline(always)]
    fn quick_distance(&self, ray: &Ray, within: &Span) -> f64 {
        self.distance(ray, within)
    }

    /// Whether a ray that leaves it on this side may meet it again. Where it may not, it is not asked. A plane is never
    /// met again, a ball only from inside; `true` is never wrong, as long as [`distance`](Self::distance) heeds
    /// `within.leaves`.
    fn meets_itself(&self, _leaving: Side) -> bool {
        true
    }

    /// Whether a point lies on its surface, but for an error of so many world units and for what rounding makes of the
    /// shape's own numbers. Rays that start there leave it.
    fn touches(&self, at: DVec3, error: f64) -> bool {
        is_met_within(self, at, error)
    }

    /// How large the coordinates are that its hits are computed from, in world units: its own, not the ray's.
    fn reach(&self) -> f64 {
        self.bounds().map_or(0.0, |bounds| bounds.low.abs().max(bounds.high.abs()).max_element())
    }

    /// The distance of the hit at about this one, in twice the precision: it tells which of two surfaces that lie
    /// together is nearer. Nothing where it is not to be had;
    /// [`coincidence::distance`](crate::world::coincidence::distance) gives it for shapes that have an equation.
    fn fine_distance(&self, _ray: &Ray, _distance: f64) -> Option<Twofold> {
        None
    }

    /// Whether both its sides are lit: then its normal is turned to the side that a ray comes from. A plane shows
    /// one side.
    fn is_two_sided(&self) -> bool {
        false
    }

    /// How its hits are found, in a few words, for the plan of a scene.
    fn method(&self) -> String {
        "its own distance".to_owned()
    }

    /// The distance by another method of finding roots, to be compared with it; nothing where the shape is not the
    /// roots of a function along a ray, or is found in closed form.
    fn distance_by(&self, _method: Method, _ray: &Ray, _within: &Span) -> Option<f64> {
        None
    }

    /// What is certain about the first hit of a ray. A shape that says nothing of it cannot be verified;
    /// [`certify::first_hit`](crate::world::certify::first_hit) proves it for shapes that have an equation.
    fn certify(&self, _sight: &Sight, _precision: Precision) -> Enclosure {
        Enclosure::UNKNOWN
    }

    /// Compares the hits of a packet with the nearest so far, and tells whether any is in doubt. `sides` are those of
    /// this shape that the rays leave, if they do; `id` is its index in the scene and 1.
    fn meet(&self, cpu: Cpu, rays: Rays, sides: Option<&[Side]>, id: u64, nearest: Nearest) -> bool {
        meet(cpu, self, rays, sides, id, nearest)
    }

    /// Marks the rays of a packet that it blocks before their ends, and those of which that is in doubt; tells
    /// whether any is.
    fn block(
        &self,
        cpu: Cpu,
        rays: Rays,
        sides: Option<&[Side]>,
        ends: &[f64],
        blocked: &mut [u64],
        doubt: &mut [u64],
    ) -> bool {
        block(cpu, self, rays, sides, ends, blocked, doubt)
    }

    /// The distances of hits that are certain, each between two distances where [`meet`](Self::meet) has bracketed it;
    /// NaN where it takes more than plain arithmetic.
    fn distances(
        &self,
        cpu: Cpu,
        rays: Rays,
        sides: Option<&[Side]>,
        _brackets: (&[f64], &[f64]),
        out: &mut [f64],
    ) {
        distances(cpu, self, rays, sides, out);
    }

    /// Where the rays of a packet come to it after these distances, and its normals there.
    fn land(&self, cpu: Cpu, rays: Rays, distances: &[f64], landing: Landing) {
        let Landing { points, normals, sides, cosines, travelled } = landing;
        land(cpu, self, rays, distances, sides, cosines, travelled, points, normals);
    }
}

/// The bracket of a shape that has no quicker one than its distance, where rounding does not decide that.
#[inline(always)]
pub(crate) fn bracket_by<T: Hittable + ?Sized>(
    shape: &T,
    ray: &Ray,
    within: &Span,
    distance: impl FnOnce(&Span) -> Option<f64>,
) -> Bracket {
    let Span { far, leaves, origin_error, .. } = *within;
    if leaves.is_none() && origin_error > 0.0 && shape.touches(ray.origin, origin_error) {
        return Bracket::UNKNOWN;
    }
    let close = if far < MISS { CLOSE * far } else { 0.0 };
    let Some(distance) = distance(&Span { far: far + close, ..*within }) else { return Bracket::UNKNOWN };
    // At the distance of another surface, more digits tell which comes first.
    if (distance - far).abs() <= close {
        return Bracket { near: distance - close, far: distance + close };
    }
    Bracket::exactly(distance)
}

/// Whether a short ray through a point, upright on a shape, meets the shape within an error.
fn is_met_within<T: Hittable + ?Sized>(shape: &T, at: DVec3, error: f64) -> bool {
    let dir = shape.normal(at);
    let short = 2.0 * error + ROUNDING * at.abs().max_element();
    let ray = Ray { origin: at - short * dir, dir };
    shape.distance(&ray, &Span { far: 2.0 * short, ..Span::RAY }) < MISS
}

kernels! {
    /// Compares a shape's hits with the nearest so far. Tells whether any is in doubt.
    fn meet[T: Hittable](shape: &T, rays: Rays, sides: Option<&[Side]>, id: u64, nearest: Nearest) -> bool {
        let (count, rays) = (rays.len(), rays.first(rays.len()));
        let Nearest { near, far, met, doubt } = nearest;
        match sides {
            None => merge(count, &Sought { shape, rays }, id, near, far, met, doubt),
            Some(sides) => {
                merge(count, &Leaving { shape, rays, sides: &sides[..count] }, id, near, far, met, doubt)
            }
        }
    }

    /// Marks the rays that a shape's hits block before they come to their ends. Tells whether any is in doubt.
    fn block[T: Hittable](
        shape: &T, rays: Rays, sides: Option<&[Side]>, ends: &[f64], blocked: &mut [u64], doubt: &mut [u64]
    ) -> bool {
        let (count, rays) = (ends.len(), rays.first(ends.len()));
        match sides {
            None => mark(&Sought { shape, rays }, ends, blocked, doubt),
            Some(sides) => mark(&Leaving { shape, rays, sides: &sides[..count] }, ends, blocked, doubt),
        }
    }

    /// The distances of a shape's hits, as [`Hittable::quick_distance`] gives them.
    pub(crate) fn distances[T: Hittable](shape: &T, rays: Rays, sides: Option<&[Side]>, out: &mut [f64]) {
        let (count, rays) = (out.len(), rays.first(out.len()));
        match sides {
            None => for lane in 0..count {
                out[lane] = shape.quick_distance(&rays.get(lane), &Span::RAY);
            },
            Some(sides) => for lane in 0..count {
                out[lane] = shape.quick_distance(&rays.get(lane), &Span { leaves: Some(sides[lane]), ..Span::RAY });
            },
        }
    }

    /// Where rays come to a shape after these distances, and its normals there.
    fn land[T: Hittable](
        shape: &T, rays: Rays, distances: &[f64], sides: &mut [Side], cosines: &mut [f64], travelled: &mut [f64]
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

/// Those that a shape gives.
struct Sought<'b, T: ?Sized> {
    shape: &'b T,
    rays: Rays<'b>,
}

impl<T: Hittable + ?Sized> Brackets for Sought<'_, T> {
    #[inline(always)]
    fn get(&self, lane: usize, far: f64) -> Bracket {
        let origin_error = self.rays.origin_error;
        self.shape.bracket(&self.rays.get(lane), &Span { far, origin_error, ..Span::RAY })
    }
}

/// Those that a shape gives for rays that leave it.
struct Leaving<'b, T: ?Sized> {
    shape: &'b T,
    rays: Rays<'b>,
    sides: &'b [Side],
}

impl<T: Hittable + ?Sized> Brackets for Leaving<'_, T> {
    #[inline(always)]
    fn get(&self, lane: usize, far: f64) -> Bracket {
        let leaves = self.sides[lane];
        if !self.shape.meets_itself(leaves) {
            return Bracket::MISS;
        }
        let (leaves, origin_error) = (Some(leaves), self.rays.origin_error);
        self.shape.bracket(&self.rays.get(lane), &Span { far, leaves, origin_error, ..Span::RAY })
    }
}
