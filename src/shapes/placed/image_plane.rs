//! The ends of copies of planes: the z in world space beyond which the camera cuts off planes.
//!
//! The object itself does not end there, because it has other coordinates. A ray hits a plane at most once, and so no
//! other hit lies behind a hit that is cut off.

use tabray_exact::affine::Affine;
use tabray_exact::interval::{Float, Interval, Wide};
use tabray_exact::scalar::Scalar;
use tabray_world::certify::{Enclosure, FootprintHit, HitEnclosure};
use tabray_world::geometry::ray::{Bracket, MISS, Ray};
use tabray_world::geometry::sight::{Line, Sight};

/// The z, in world units, at which a copy ends, if it does.
#[derive(Clone, Copy)]
pub struct MaxZ(pub Option<f64>);

impl MaxZ {
    /// Tells whether a hit of a ray is cut off, in `f64` arithmetic.
    #[inline(always)]
    pub fn cuts_off(self, ray: &Ray, distance: f64) -> bool {
        self.0.is_some_and(|max_z| ray.at(distance).z > max_z)
    }

    /// Returns the bracket of a ray's hit before the end. The ray's origin may be off by `origin_error` world units.
    #[inline(always)]
    pub fn kept_bracket(self, ray: &Ray, bracket: Bracket, origin_error: f64) -> Bracket {
        let Some(max_z) = self.0 else { return bracket };
        let Bracket { near, far } = bracket;
        let z = |distance: f64| ray.origin.z + distance * ray.dir.z;
        // In units of 2^-53, the error of a component of a camera ray's direction is 3, and that of the product and of
        // the sum 1 each. Their sum, 5, is less than 8 units.
        let error = |distance: f64| origin_error + 4.0 * f64::EPSILON * (ray.origin.z.abs() + distance);
        let is_beyond = |distance: f64| z(distance) - error(distance) > max_z;
        let is_before = |distance: f64| z(distance) + error(distance) < max_z;
        let is_endless = far == MISS;
        let ends_beyond = if is_endless { ray.dir.z > 0.0 } else { is_beyond(far) };
        let is_cut_off = is_beyond(near) & ends_beyond;
        let is_whole = is_endless | (is_before(near) & is_before(far));
        Bracket {
            near: if is_cut_off { MISS } else { near },
            far: if is_cut_off | !is_whole { MISS } else { far },
        }
    }

    /// Returns the enclosure of a line's hit before the end.
    pub fn kept_hit<F: Float>(self, line: &Line<Interval<F>>, found: HitEnclosure<F>) -> HitEnclosure<F> {
        let (HitEnclosure::Hits(at) | HitEnclosure::Edge(at)) = found else { return found };
        match self.is_kept(|| line.origin[2] + at * line.dir[2]) {
            Some(true) => found,
            Some(false) => HitEnclosure::Misses,
            None => HitEnclosure::Edge(at),
        }
    }

    /// Returns the enclosure of a ray's hit before the end, in world space.
    pub fn kept_enclosure(self, sight: &Sight, found: Enclosure) -> Enclosure {
        let (Enclosure::Hits(at) | Enclosure::Edge(at)) = found else { return found };
        let z = || {
            let Line { origin, dir } = sight.line::<Wide>();
            origin[2] + at * dir[2]
        };
        match self.is_kept(z) {
            Some(true) => found,
            Some(false) => Enclosure::Misses,
            None => Enclosure::Edge(at),
        }
    }

    /// Returns the hits of the lines of a footprint before the end, or `None` if there are none.
    pub fn kept_footprint(self, line: &Line<Affine>, found: FootprintHit) -> Option<FootprintHit> {
        let (FootprintHit::Hits(at) | FootprintHit::Perhaps(at)) = found else { return Some(found) };
        match self.is_kept(|| (line.origin[2] + at * line.dir[2]).range()) {
            Some(true) => Some(found),
            Some(false) => None,
            None => Some(FootprintHit::Perhaps(at)),
        }
    }

    /// Tells whether a z in world space is before the end, or `None` if its enclosure does not decide.
    fn is_kept<F: Float>(self, z: impl FnOnce() -> Interval<F>) -> Option<bool> {
        let Some(max_z) = self.0 else { return Some(true) };
        let left = Interval::<F>::constant(max_z) - z();
        if left.low >= F::of(0.0) {
            Some(true)
        } else if left.high < F::of(0.0) {
            Some(false)
        } else {
            None
        }
    }
}
