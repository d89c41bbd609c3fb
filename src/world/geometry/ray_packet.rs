//! Packets of rays as structures of arrays. A call of a shape serves all rays of a packet, and the processor handles
//! several at once.
//!
//! A plugin is written for one ray. Kernels over packets inline its functions, and are compiled for each instruction
//! level ([`cpu`](crate::simd::cpu)). The length of arrays is a multiple of [`LANES`](crate::simd::soa::LANES). The
//! lanes beyond the last ray are copies of it, and their results are ignored.

use crate::geometry::ray::{Bracket, MISS, Ray, RayBall, RayError, RayRange, Side};
use crate::simd::cpu::kernels;
use crate::simd::soa::{View, ViewMut};
use glam::DVec3;
use std::ops::Range;

/// The maximum number of rays in a packet.
pub const PACKET_SIZE: usize = 256;

/// The maximum number of close rays whose hits are searched together.
pub const BEAM: usize = 16;

/// Splits the lanes of `count` rays into consecutive ranges of at most `max_size` lanes.
#[inline]
pub fn split(count: usize, max_size: usize) -> impl Iterator<Item = Range<usize>> {
    (0..count).step_by(max_size).map(move |first| first..count.min(first + max_size))
}

/// A packet of rays that all leave the same object, or no object.
#[derive(Clone, Copy)]
pub struct RayPacket<'r> {
    /// The origins, in world coordinates.
    pub origin: View<'r>,
    /// The directions, unit vectors.
    pub dir: View<'r>,
    /// The maximum distance between an origin and the exact point that it was rounded from, in world units. It is 0 for
    /// camera rays.
    pub origin_error: f64,
    /// That distance for each ray, or at least a bound of it; empty where `origin_error` counts for all.
    pub origin_errors: &'r [f64],
    /// The maximum distance between each ray and the rays that it stands for.
    pub drift: RayError,
    /// The side of the shape that each ray leaves, if the rays leave the shape that they are tested against.
    pub leaving: Option<&'r [Side]>,
}

impl<'r> RayPacket<'r> {
    /// Makes a packet of rays that stand for themselves and leave nothing.
    #[inline(always)]
    pub fn new(origin: View<'r>, dir: View<'r>, origin_error: f64) -> Self {
        Self { origin, dir, origin_error, origin_errors: &[], drift: RayError::NONE, leaving: None }
    }

    /// Returns the rays, with a bound of the error of each origin. There must be as many bounds as rays, or none, and
    /// none may be larger than `origin_error`.
    #[inline(always)]
    pub fn with_errors(self, origin_errors: &'r [f64]) -> Self {
        Self { origin_errors, ..self }
    }

    /// Returns the rays, leaving a shape to these sides. There must be at least as many sides as rays.
    #[inline(always)]
    pub fn leaving(self, leaving: Option<&'r [Side]>) -> Self {
        Self { leaving, ..self }
    }

    /// Returns the side of the shape that a ray leaves, if it leaves the shape.
    #[inline(always)]
    pub fn side(&self, index: usize) -> Option<Side> {
        self.leaving.map(|sides| sides[index])
    }

    /// Returns a bound of the error of a ray's origin, in world units. It does not depend on the other rays.
    #[inline(always)]
    pub fn error(&self, index: usize) -> f64 {
        self.origin_errors.get(index).copied().unwrap_or(self.origin_error)
    }

    /// Returns the range of a ray that ends at a distance.
    #[inline(always)]
    pub fn range(&self, index: usize, far: f64) -> RayRange {
        let (origin_side, origin_error) = (self.side(index), self.error(index));
        RayRange { far, origin_side, origin_error, ..RayRange::ALL }
    }

    /// Computes the bracket of each ray in its own range.
    #[inline]
    pub fn each(
        &self,
        ranges: &[RayRange],
        brackets: &mut [Bracket],
        of: impl Fn(&RayBall, &RayRange) -> Bracket,
    ) {
        for (lane, range) in ranges.iter().enumerate() {
            brackets[lane] = of(&RayBall { ray: self.get(lane), drift: self.drift }, range);
        }
    }

    /// Returns the number of rays.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.origin.len()
    }

    /// Returns whether there are no rays.
    pub fn is_empty(&self) -> bool {
        self.origin.is_empty()
    }

    /// Returns the ray at an index.
    #[inline(always)]
    pub fn get(&self, index: usize) -> Ray {
        Ray { origin: self.origin.get(index), dir: self.dir.get(index) }
    }

    /// Returns the first `count` rays.
    #[inline(always)]
    pub fn first(&self, count: usize) -> Self {
        self.part(0..count)
    }

    /// Returns the rays in a range of indices.
    #[inline(always)]
    pub fn part(&self, range: Range<usize>) -> Self {
        let leaving = self.leaving.map(|sides| &sides[range.clone()]);
        let origin_errors =
            if self.origin_errors.is_empty() { &[] } else { &self.origin_errors[range.clone()] };
        let (origin, dir) = (self.origin.part(range.clone()), self.dir.part(range));
        Self { origin, dir, leaving, origin_errors, ..*self }
    }
}

/// The closest known hits of a packet's rays. All arrays have one element per ray.
pub struct HitRecordMut<'n> {
    /// Lower bounds of the distance of the hit of the object in `hit_ids`, in world units.
    pub near: &'n mut [f64],
    /// Upper bounds of that distance, equal to `near` if the distance is known exactly. Without a hit, both bounds are
    /// the end of the search.
    pub far: &'n mut [f64],
    /// The object's index plus 1, or 0 for no object.
    pub hit_ids: &'n mut [u64],
    /// Nonzero if brackets overlap, and the nearer of two hits is unknown.
    pub doubt: &'n mut [u64],
}

impl HitRecordMut<'_> {
    /// Returns the part for the rays in a range of indices.
    pub fn part(&mut self, range: Range<usize>) -> HitRecordMut<'_> {
        HitRecordMut {
            near: &mut self.near[range.clone()],
            far: &mut self.far[range.clone()],
            hit_ids: &mut self.hit_ids[range.clone()],
            doubt: &mut self.doubt[range],
        }
    }
}

kernels! {
    /// Merges an object's brackets into the closest hits so far. Returns whether any ray is in doubt.
    pub(crate) fn closest_of_brackets(near: &[f64], far: &[f64], id: u64, nearest: HitRecordMut) -> bool {
        let count = nearest.near.len().min(near.len());
        let (near, far) = (&near[..count], &far[..count]);
        let known = Known { near, far };
        merge_nearest(count, &known, id, nearest.near, nearest.far, nearest.hit_ids, nearest.doubt)
    }

    /// Marks the rays that brackets show to be occluded before `t_max`. Returns whether any ray is in doubt.
    pub fn occluded_by_brackets(
        near: &[f64], far: &[f64], t_max: &[f64], blocked: &mut [u64], doubt: &mut [u64]
    ) -> bool {
        let (near, far) = (&near[..t_max.len()], &far[..t_max.len()]);
        mark_occluded(&Known { near, far }, t_max, blocked, doubt)
    }
}

/// The brackets of an object's hits, by lane. This is a trait because closures are not reliably inlined into kernels.
pub(crate) trait Brackets {
    /// Returns the bracket of a hit before `far`.
    fn get(&self, lane: usize, far: f64) -> Bracket;
}

/// Computed brackets.
struct Known<'b> {
    near: &'b [f64],
    far: &'b [f64],
}

impl Brackets for Known<'_> {
    #[inline(always)]
    fn get(&self, lane: usize, _far: f64) -> Bracket {
        Bracket { near: self.near[lane], far: self.far[lane] }
    }
}

/// Merges an object's brackets of `count` rays into the closest hits so far. Returns whether any ray is in doubt.
///
/// The arrays are separate arguments, not a [`HitRecordMut`], which tells the compiler that they do not overlap. Otherwise,
/// it would check for overlap at each call, and handle small counts of rays one by one.
#[inline(always)]
pub(crate) fn merge_nearest(
    count: usize,
    brackets: &impl Brackets,
    id: u64,
    near: &mut [f64],
    far: &mut [f64],
    hit_ids: &mut [u64],
    doubt: &mut [u64],
) -> bool {
    let (near, far) = (&mut near[..count], &mut far[..count]);
    let (hit_ids, doubt) = (&mut hit_ids[..count], &mut doubt[..count]);
    let mut any = 0;
    for lane in 0..count {
        let Bracket { near: low, far: high } = brackets.get(lane, far[lane]);
        let is_nearer = high < near[lane];
        // Of two hits at the same distance, that of the earlier object in the scene wins.
        let is_earlier = (low == far[lane]) & (hit_ids[lane] > id);
        let is_farther = (low >= far[lane]) & !is_earlier;
        // This is a minimum because the compiler would turn a choice between two values into masked stores, which are
        // slow without AVX-512.
        let (low, high) = if is_nearer { (low, high) } else { (MISS, MISS) };
        near[lane] = if low < near[lane] { low } else { near[lane] };
        far[lane] = if high < far[lane] { high } else { far[lane] };
        hit_ids[lane] ^= if is_nearer { hit_ids[lane] ^ id } else { 0 };
        doubt[lane] = u64::from(!(is_nearer | is_farther));
        any |= doubt[lane];
    }
    any != 0
}

/// Marks the rays that brackets show to be occluded before `t_max`. Returns whether any ray is in doubt.
#[inline(always)]
pub(crate) fn mark_occluded(
    brackets: &impl Brackets,
    t_max: &[f64],
    blocked: &mut [u64],
    doubt: &mut [u64],
) -> bool {
    let count = t_max.len();
    let (blocked, doubt) = (&mut blocked[..count], &mut doubt[..count]);
    let mut any = 0;
    for lane in 0..count {
        let Bracket { near: low, far: high } = brackets.get(lane, t_max[lane]);
        let (is_before, is_behind) = (high < t_max[lane], low >= t_max[lane]);
        blocked[lane] |= u64::from(is_before);
        doubt[lane] = u64::from(!(is_before | is_behind)) & !blocked[lane];
        any |= doubt[lane];
    }
    any != 0
}

/// Hit points on one surface, one for each ray of a packet. All arrays are as long as the packet's.
pub struct SurfaceInteraction<'l> {
    /// The hit points, in world coordinates.
    pub points: ViewMut<'l>,
    /// The unit normals for shading the hit points, flipped to face the rays if both sides are lit.
    pub normals: ViewMut<'l>,
    /// The unit normals of the surface itself, flipped likewise. They are only written for shapes with other shading
    /// normals.
    pub geometric_normals: ViewMut<'l>,
    /// The side that each ray hits.
    pub sides: &'l mut [Side],
    /// The cosines of the angles between the rays and the unflipped normals, from -1 to 1.
    pub cosines: &'l mut [f64],
    /// The path lengths from the viewer, in world units: on entry to the rays' origins, on return to the hit points.
    pub travelled: &'l mut [f64],
}

/// Returns the side of a surface that a ray along `dir` hits, the cosine of the angle between `dir` and `normal`, and
/// the normal, flipped to face the ray if both sides are lit.
#[inline(always)]
pub fn turned(dir: DVec3, normal: DVec3, is_two_sided: bool) -> (Side, f64, DVec3) {
    let side = Side::seen_along(dir, normal);
    (side, dir.dot(normal), if is_two_sided & (side == Side::Inside) { -normal } else { normal })
}
