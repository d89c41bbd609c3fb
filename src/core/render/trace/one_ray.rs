//! The exact hit of one ray with one shape, where rounding leaves the hits of a packet in doubt.

use crate::geometry::ray::{Bracket, MISS, Ray, RayRange, Side};
use crate::geometry::sight::Sight;
use crate::world::any_shape::AnyShape;
use crate::world::certify::{self, Enclosure, Precision};
use crate::world::coincidence::CLOSE;
use f256::f256;
use tabray_exact::interval::{Float, Interval, Wide};

/// A rounded ray, and the bounds of the true ray that it stands for.
pub(super) struct RoundedRay {
    pub ray: Ray,
    /// A bound on the error of the origin, in world units.
    pub error: f64,
    /// The ray before anything is rounded, if it is a primary ray.
    pub sight: Option<Sight>,
}

impl RoundedRay {
    /// Returns the side of a shape that the ray leaves, if the ray starts on the shape. `own` is that side if the shape
    /// belongs to the object that the ray leaves. Another shape that passes through the same point is left, too.
    pub fn leaves(&self, shape: &AnyShape, own: Option<Side>) -> Option<Side> {
        let Ray { origin, dir } = self.ray;
        let touched = || Side::seen_along(dir, shape.normal(origin)).opposite();
        own.or_else(|| (self.error > 0.0 && shape.touches(origin, self.error)).then(touched))
    }
}

/// A ray's hit of a shape.
pub(super) struct Located {
    /// The exact distance, in world units, or [`MISS`].
    pub distance: f64,
    /// A bracket of that distance and of the distance along the ray before anything is rounded.
    pub bracket: Bracket,
    /// Where 237 bits do not decide whether the ray hits the shape, the distance from which on it may, as a multiple of the
    /// length of the ray's direction before anything is rounded.
    pub open: Option<f256>,
}

impl Located {
    /// A hit at a known distance.
    fn known(distance: f64) -> Self {
        Self { distance, bracket: Bracket::exactly(distance), open: None }
    }

    /// No hit.
    const MISS: Self = Self { distance: MISS, bracket: Bracket::MISS, open: None };
}

/// Returns the distance, in world units, of a primary ray's hit of a shape as the tracer finds it where a packet leaves it
/// in doubt, or [`MISS`]. `ray` is the rounded ray, and `sight` the one before anything is rounded.
pub fn primary_distance(shape: &AnyShape, ray: Ray, sight: &Sight) -> f64 {
    exact(shape, &RoundedRay { ray, error: 0.0, sight: Some(sight.clone()) }, None, MISS)
}

/// Returns the exact distance of one ray's hit of a shape before `far`, in world units, or [`MISS`]. `origin_side` is
/// the side of the shape that the ray leaves, if the shape belongs to the object that the packet leaves.
pub(super) fn exact(shape: &AnyShape, start: &RoundedRay, origin_side: Option<Side>, far: f64) -> f64 {
    located(shape, start, origin_side, far).distance
}

/// Returns the hit whose distance [`exact`] returns.
pub(super) fn located(shape: &AnyShape, start: &RoundedRay, origin_side: Option<Side>, far: f64) -> Located {
    match start.leaves(shape, origin_side) {
        Some(side) if !shape.can_hit_itself(side) => return Located::MISS,
        None => {}
        origin_side => {
            let range = RayRange { far, origin_side, origin_error: start.error, ..RayRange::ALL };
            return Located::known(shape.distance(&start.ray, &range));
        }
    }
    let range = RayRange { far, ..RayRange::ALL };
    let Some(sight) = &start.sight else { return Located::known(shape.distance(&start.ray, &range)) };
    let bracket = shape.t_bounds(&start.ray, &RayRange::ALL);
    // A bracket of width 0 is the distance itself.
    let is_known = bracket.near == bracket.far;
    let distance = if is_known { range.keep(bracket.near) } else { shape.distance(&start.ray, &range) };
    // Where the rounding of the ray may decide whether it hits the shape, the unrounded ray decides.
    if bracket.is_doubtful() {
        decided(shape, sight, distance)
    } else {
        Located { distance, bracket, open: None }
    }
}

/// The width from which on an enclosure of a distance is too wide to be that of a point, as a fraction of the distance.
const WIDE: f64 = 64.0 * f64::EPSILON;

/// Returns a hit with this distance, if the ray before anything is rounded hits the shape as far as a proof with 237 bits
/// tells, and none otherwise.
fn decided(shape: &AnyShape, sight: &Sight, distance: f64) -> Located {
    let enclosure = match shape.certify(sight, Precision::Double) {
        Enclosure::Edge(_) | Enclosure::Doubtful(_) => shape.certify(sight, Precision::Octuple),
        // As where the ray passes near the edge of a face that it grazes, which holds much of the ray.
        Enclosure::Hits(at) if at.width().to_f64() > WIDE * at.high.to_f64() => {
            shape.certify(sight, Precision::Octuple)
        }
        certain => certain,
    };
    match enclosure {
        Enclosure::Misses => Located::MISS,
        // Edges belong to their surfaces.
        Enclosure::Hits(at) | Enclosure::Edge(at) => {
            let Interval { low, high } = certify::bounds_in_world_units(at, sight);
            let bracket = Bracket { near: low, far: high };
            Located { distance: distance.clamp(low, high), bracket, open: None }
        }
        // What is undecided lies beyond the computed distance, as for a ray that is parallel to a plane up to rounding.
        Enclosure::Doubtful(from) if in_world_units(from, sight) * (1.0 - CLOSE) > distance => {
            Located { open: Some(from), ..Located::MISS }
        }
        Enclosure::Doubtful(from) => Located { open: Some(from), ..Located::known(distance) },
    }
}

/// Converts a distance from lengths of a sight's direction to world units.
pub(super) fn in_world_units(distance: f256, sight: &Sight) -> f64 {
    certify::in_world_units(Wide::point(distance), sight).high
}
