//! A ray or a bundle of rays, prepared for tests against boxes.

use crate::geometry::aabb::{Aabb, SLACK, larger, smaller};
use crate::geometry::ray::{Ray, RayError};
use crate::geometry::ray_packet::RayPacket;
use crate::simd::soa::{LANES, Vectors};
use glam::DVec3;

/// The index of the low plane of a box along an axis.
pub const LOW: usize = 0;
/// The index of the high plane.
pub const HIGH: usize = 1;

/// The maximum reciprocal of a direction's component.
///
/// This replaces the reciprocal of 0. Within all distances that matter, a ray with a component of 0 moves less along
/// the axis than the slack.
const STEEPEST: f64 = 1e150;

/// The slack of rays with coordinates that are all 0, in world units. It is not 0, and its product with [`STEEPEST`] is
/// large.
const MIN_SLACK: f64 = 1e-100;

/// Rays that are tested together: bounds of their origins and of their directions.
///
/// The bounds of the origins include a slack of [`SLACK`] times their largest coordinate. The slack exceeds the
/// rounding of the distances to planes, and the shift of a ray with such coordinates by rounding. If a beam misses a
/// box, the exact rays thus miss it, too.
#[derive(Clone, Copy)]
pub struct Beam {
    /// The bounds of the origins along each axis. The first bounds, for distances to near planes, are the high bound
    /// for low planes and the low bound for high planes. The last of the four numbers is 0.
    pub from: [[f64; 4]; 2],
    /// The reciprocals of the components of the directions, in the same order: of the largest component for low planes,
    /// and of the smallest one for high planes.
    pub inverse: [[f64; 4]; 2],
    /// The side of a box that the rays reach first along each axis, [`LOW`] or [`HIGH`].
    pub near: [usize; 3],
    /// Whether some rays rise along the axis and others fall. They enter a box through either plane, and may stay in
    /// it.
    pub is_mixed: [bool; 3],
    /// The slack of the origins, in world units.
    slack: f64,
    /// A bound of the difference between the directions and those of the exact rays.
    swerve: f64,
    /// The maximum magnitude of a coordinate of the origins, in world units.
    reach: f64,
    /// The maximum extent of the origins along an axis, in world units.
    width: f64,
    /// The maximum difference between the same component of two directions.
    spread: f64,
}

impl Beam {
    /// Prepares one ray, and all rays within a drift of it.
    #[inline(always)]
    pub fn of(ray: &Ray, drift: RayError) -> Self {
        Self::between([ray.origin; 2], [ray.dir; 2], drift)
    }

    /// Bounds the rays of a packet that end beyond 0, and all rays within a drift of them. `t_max` has the ends of the
    /// packet's rays, as distances in world units. Returns `None` if there are no such rays.
    #[inline(always)]
    pub fn around(rays: RayPacket, t_max: &[f64], drift: RayError) -> Option<Self> {
        let lane = t_max.iter().position(|t_max| *t_max > 0.0)?;
        let ray = rays.get(lane);
        let (origin, dir) = (rays.origin, rays.dir);
        let [from_x, from_y, from_z] = [
            limits(origin.x, t_max, ray.origin.x),
            limits(origin.y, t_max, ray.origin.y),
            limits(origin.z, t_max, ray.origin.z),
        ];
        let [x, y, z] = [
            limits(dir.x, t_max, ray.dir.x),
            limits(dir.y, t_max, ray.dir.y),
            limits(dir.z, t_max, ray.dir.z),
        ];
        let corner =
            |x: [f64; 2], y: [f64; 2], z: [f64; 2], side: usize| DVec3::new(x[side], y[side], z[side]);
        Some(Self::between(
            [corner(from_x, from_y, from_z, LOW), corner(from_x, from_y, from_z, HIGH)],
            [corner(x, y, z, LOW), corner(x, y, z, HIGH)],
            drift,
        ))
    }

    /// Bounds rays, given the minimum and maximum coordinates of their origins and components of their directions.
    #[inline(always)]
    fn between([low, high]: [DVec3; 2], [mut least, mut greatest]: [DVec3; 2], drift: RayError) -> Self {
        let reach = larger(low.abs().max_element(), high.abs().max_element());
        let slack = SLACK * reach + MIN_SLACK + drift.origin;
        if drift.dir > 0.0 {
            (least, greatest) = (least - drift.dir, greatest + drift.dir);
        }
        let (mut near, mut is_mixed) = ([LOW; 3], [false; 3]);
        for axis in 0..3 {
            // Signs replace comparisons, because -0 has a negative reciprocal.
            let (falls, all_fall) = (least[axis].is_sign_negative(), greatest[axis].is_sign_negative());
            near[axis] = usize::from(falls & all_fall);
            is_mixed[axis] = falls & !all_fall;
        }
        let from = [(high + slack).to_array(), (low - slack).to_array()];
        let inverse = [greatest.recip().to_array(), least.recip().to_array()];
        let mut sorted = ([[0.0; 4]; 2], [[0.0; 4]; 2]);
        for axis in 0..3 {
            for side in [LOW, HIGH] {
                let plane = near[axis] ^ side;
                let inverse = inverse[plane][axis];
                let is_steep = inverse.abs() > STEEPEST;
                sorted.0[side][axis] = from[plane][axis];
                sorted.1[side][axis] = if is_steep { STEEPEST.copysign(inverse) } else { inverse };
            }
        }
        Self {
            from: sorted.0,
            inverse: sorted.1,
            near,
            is_mixed,
            slack,
            swerve: drift.dir,
            reach,
            width: (high - low).max_element(),
            spread: (greatest - least).max_element(),
        }
    }

    /// Returns a larger box. If an exact ray enters the original box, its rounded ray enters the larger one.
    #[inline(always)]
    pub fn grown(&self, Aabb { low, high }: &Aabb) -> Aabb {
        let mut slack = self.slack;
        if self.swerve > 0.0 {
            // The distance to a point of the box is less than four times the largest of all coordinates.
            let farthest = larger(self.reach, larger(low.abs().max_element(), high.abs().max_element()));
            slack += 4.0 * self.swerve * farthest;
        }
        Aabb { low: *low - slack, high: *high + slack }
    }

    /// Returns the maximum distance between the rays along an axis, at a distance from their origins, in world units.
    #[inline(always)]
    pub fn width(&self, distance: f64) -> f64 {
        self.width + distance * self.spread
    }
}

/// Eight rays of a packet.
#[derive(Clone)]
pub struct Eight {
    /// The origins, in world coordinates.
    pub origin: Vectors<LANES>,
    /// The reciprocals of the components of the directions.
    pub inverse: Vectors<LANES>,
}

impl Eight {
    /// Eight rays before [`set`](Self::set).
    pub const ZERO: Self = Self { origin: Vectors::ZERO, inverse: Vectors::ZERO };

    /// Sets the rays to those of a packet of eight.
    #[inline(always)]
    pub fn set(&mut self, rays: RayPacket) {
        let rays = rays.first(LANES);
        for lane in 0..LANES {
            let Ray { origin, dir } = rays.get(lane);
            self.origin.set(lane, origin);
            self.inverse.set(lane, dir.recip());
        }
    }
}

/// Returns the minimum and the maximum of the numbers for rays that end beyond 0. `some` is one of these numbers.
#[inline(always)]
fn limits(of: &[f64], t_max: &[f64], some: f64) -> [f64; 2] {
    let (mut low, mut high) = ([some; LANES], [some; LANES]);
    for first in (0..t_max.len()).step_by(LANES) {
        let (of, t_max) = (&of[first..][..LANES], &t_max[first..][..LANES]);
        for lane in 0..LANES {
            let number = if t_max[lane] > 0.0 { of[lane] } else { some };
            low[lane] = smaller(number, low[lane]);
            high[lane] = larger(number, high[lane]);
        }
    }
    [low.into_iter().fold(some, smaller), high.into_iter().fold(some, larger)]
}
