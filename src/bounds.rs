//! Boxes around shapes, and around all the ways that the rays of a packet go.

use crate::cpu::kernels;
use crate::packet::{Rays, View};
use glam::DVec3;

/// What rounding may make of a place, as a part of how far it is from the world's origin; far more than it does.
const SLACK: f64 = 1e-12;

/// A box along the world's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Its corner with the least x, y and z.
    pub low: DVec3,
    /// Its corner with the greatest.
    pub high: DVec3,
}

impl Bounds {
    /// A box that holds nothing, to be grown.
    pub const EMPTY: Self = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    /// The box around some points.
    pub fn around(points: &[DVec3]) -> Self {
        points.iter().fold(Self::EMPTY, |bounds, point| bounds.and(&Self { low: *point, high: *point }))
    }

    /// The box around two.
    #[inline(always)]
    pub fn and(&self, other: &Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Whether a point lies in both.
    #[inline(always)]
    pub fn overlaps(&self, other: &Self) -> bool {
        self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
    }

    /// Its middle.
    #[inline(always)]
    pub fn middle(&self) -> DVec3 {
        0.5 * (self.low + self.high)
    }

    /// Half its size each way.
    #[inline(always)]
    pub fn half_size(&self) -> DVec3 {
        0.5 * (self.high - self.low)
    }

    /// Half the area of its surface.
    pub fn half_area(&self) -> f64 {
        let size = (self.high - self.low).max(DVec3::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }

    /// A box larger by what rounding may make of places in it, and of places at this distance.
    #[inline(always)]
    pub fn with_slack(&self, distance: f64) -> Self {
        let slack = SLACK * (distance + self.low.abs().max(self.high.abs()).max_element());
        Self { low: self.low - slack, high: self.high + slack }
    }
}

/// Everywhere that the rays of a packet may go.
pub struct Bundle {
    /// Where they start.
    origin: Bounds,
    /// The reciprocals of the least and of the greatest of their directions' coordinates.
    least: DVec3,
    greatest: DVec3,
    inverse_least: DVec3,
    inverse_greatest: DVec3,
    reach: f64,
}

impl Bundle {
    /// The bundle of rays that start and go within these boxes.
    #[inline(always)]
    pub fn new(origin: Bounds, dir: Bounds) -> Self {
        Self {
            origin,
            least: dir.low,
            greatest: dir.high,
            inverse_least: dir.low.recip(),
            inverse_greatest: dir.high.recip(),
            reach: origin.low.abs().max(origin.high.abs()).max_element(),
        }
    }

    /// Whether a ray of it may come into a box. Never wrong where it says no.
    #[inline(always)]
    pub fn may_meet(&self, bounds: &Bounds) -> bool {
        let bounds = bounds.with_slack(self.reach);
        let (mut enters, mut leaves) = (0.0_f64, f64::INFINITY);
        for axis in 0..3 {
            // How far the way is to the box's near and far walls, from where it is shortest and longest.
            let up = bounds.low[axis] - self.origin.high[axis];
            let down = bounds.high[axis] - self.origin.low[axis];
            if up > 0.0 {
                if self.greatest[axis] <= 0.0 {
                    return false;
                }
                enters = enters.max(up * self.inverse_greatest[axis]);
            }
            if down < 0.0 {
                if self.least[axis] >= 0.0 {
                    return false;
                }
                enters = enters.max(down * self.inverse_least[axis]);
            }
            if self.least[axis] > 0.0 {
                leaves = leaves.min(down * self.inverse_least[axis]);
            } else if self.greatest[axis] < 0.0 {
                leaves = leaves.min(up * self.inverse_greatest[axis]);
            }
        }
        enters <= leaves * (1.0 + SLACK)
    }
}

/// A number's place in the order of all numbers, as a whole number: of those the least is found several at a time,
/// without a care for NaN.
#[inline(always)]
pub(crate) fn order(number: f64) -> i64 {
    let bits = number.to_bits() as i64;
    bits ^ (((bits >> 63) as u64) >> 1) as i64
}

/// The number at that place.
#[inline(always)]
pub(crate) fn from_order(place: i64) -> f64 {
    f64::from_bits((place ^ (((place >> 63) as u64) >> 1) as i64) as u64)
}

kernels! {
    /// The box around some points.
    pub fn around(points: View) -> Bounds {
        let range = |of: &[f64]| {
            let (mut low, mut high) = (i64::MAX, i64::MIN);
            for number in of {
                low = low.min(order(*number));
                high = high.max(order(*number));
            }
            (from_order(low), from_order(high))
        };
        let ((x0, x1), (y0, y1), (z0, z1)) = (range(points.x), range(points.y), range(points.z));
        Bounds { low: DVec3::new(x0, y0, z0), high: DVec3::new(x1, y1, z1) }
    }

    /// Whether any ray may come into a box before its end. Never wrong where it says no.
    pub fn any_meets(rays: Rays, inverse: View, ends: &[f64], bounds: &Bounds) -> bool {
        let count = ends.len();
        let (origin, inverse) = (rays.origin.first(count), inverse.first(count));
        let (low, high) = (bounds.low, bounds.high);
        let mut any = 0;
        for lane in 0..count {
            let (from, inverse) = (origin.get(lane), inverse.get(lane));
            let (a, b) = ((low - from) * inverse, (high - from) * inverse);
            let (near, far) = (a.min(b), a.max(b));
            let enters = near.x.max(near.y).max(near.z).max(0.0);
            let leaves = far.x.min(far.y).min(far.z).min(ends[lane]);
            any |= u64::from(enters <= leaves * (1.0 + SLACK));
        }
        any != 0
    }
}
