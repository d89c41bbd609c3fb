//! Boxes around shapes.

use crate::geometry::ray_packet::RayPacket;
use crate::simd::cpu::kernels;
use crate::simd::soa::View;
use glam::DVec3;

/// What rounding may make of a place, as a part of how far it is from the world's origin; far more than it does.
pub const SLACK: f64 = 1e-12;

/// A box along the world's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Its corner with the least x, y and z.
    pub low: DVec3,
    /// Its corner with the greatest.
    pub high: DVec3,
}

impl Aabb {
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
        let size = |of: f64| if of.is_finite() { of.abs() } else { 0.0 };
        let largest = |of: DVec3| larger(larger(size(of.x), size(of.y)), size(of.z));
        let slack = SLACK * (distance + larger(largest(self.low), largest(self.high)));
        Self { low: self.low - slack, high: self.high + slack }
    }
}

/// How far a point is from a shape with these bounds, at least, where the shape tells of which regions it is clear.
pub fn clearance(from: DVec3, bounds: Option<Aabb>, is_clear_of: impl Fn(&Aabb) -> bool) -> f64 {
    let scale = from.abs().max_element();
    let outside = bounds.map_or(0.0, |bounds| {
        let Aabb { low, high } = bounds.with_slack(scale);
        (low - from).max(from - high).max(DVec3::ZERO).length()
    });
    if outside > 0.0 {
        return outside * (1.0 - SLACK);
    }
    // The largest cube around it that is clear, to an eighth: of a size that is more than rounding makes of its sides.
    let clear = |half: &f64| is_clear_of(&Aabb { low: from - *half, high: from + *half });
    let least = (1e4 * SLACK * scale).max(1e-12);
    let sizes = (-40..60).rev().map(|power| f64::from(power).exp2()).take_while(|half| *half > least);
    sizes.into_iter().find(clear).map_or(0.0, |half| {
        let eighths = (9..16).rev().map(|eighths| half * f64::from(eighths) / 8.0);
        eighths.into_iter().find(clear).unwrap_or(half) * (1.0 - 1e-6)
    })
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

/// The least and the greatest of some numbers.
#[inline(always)]
pub(crate) fn range(of: &[f64]) -> (f64, f64) {
    let (mut low, mut high) = (i64::MAX, i64::MIN);
    for number in of {
        low = low.min(order(*number));
        high = high.max(order(*number));
    }
    (from_order(low), from_order(high))
}

/// The smaller of two numbers; the second one where either is NaN.
#[inline(always)]
pub(crate) fn smaller(one: f64, other: f64) -> f64 {
    if one < other { one } else { other }
}

/// The larger of two numbers; the second one where either is NaN.
#[inline(always)]
pub(crate) fn larger(one: f64, other: f64) -> f64 {
    if one > other { one } else { other }
}

kernels! {
    /// The box around some points.
    pub fn around(points: View) -> Aabb {
        let (x, y, z) = (range(points.x), range(points.y), range(points.z));
        Aabb { low: DVec3::new(x.0, y.0, z.0), high: DVec3::new(x.1, y.1, z.1) }
    }

    /// Whether any ray may come into a box before its end. Never wrong where it says no.
    pub fn any_meets(rays: RayPacket, inverse: View, ends: &[f64], bounds: &Aabb) -> bool {
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
