//! Axis-aligned bounding boxes.

use crate::simd::cpu::kernels;
use crate::simd::soa::View;
use glam::DVec3;
use tabray_exact::double_double::power_of_two;

/// The slack for rounding errors, as a fraction of a point's distance from the world's origin: 4500 EPSILON, far more
/// than the few roundings of a coordinate.
pub const SLACK: f64 = 1e-12;

/// An axis-aligned bounding box in world coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The corner with the smallest x, y and z.
    pub low: DVec3,
    /// The corner with the largest x, y and z.
    pub high: DVec3,
}

impl Aabb {
    /// An empty box, the start of a union.
    pub const EMPTY: Self = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    /// Returns the bounding box of some points.
    pub fn around(points: &[DVec3]) -> Self {
        points.iter().fold(Self::EMPTY, |bounds, point| bounds.and(&Self { low: *point, high: *point }))
    }

    /// Returns the bounding box of two boxes.
    #[inline(always)]
    pub fn and(&self, other: &Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Returns whether two boxes have a common point.
    #[inline(always)]
    pub fn overlaps(&self, other: &Self) -> bool {
        self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
    }

    /// Returns the center of the box.
    #[inline(always)]
    pub fn middle(&self) -> DVec3 {
        0.5 * (self.low + self.high)
    }

    /// Returns half the size of the box along each axis, in world units.
    #[inline(always)]
    pub fn half_size(&self) -> DVec3 {
        0.5 * (self.high - self.low)
    }

    /// Returns the box, enlarged by the rounding error of the coordinates of points in it, and of points at this
    /// distance.
    #[inline(always)]
    pub fn with_slack(&self, distance: f64) -> Self {
        let size = |of: f64| if of.is_finite() { of.abs() } else { 0.0 };
        let largest = |of: DVec3| larger(larger(size(of.x), size(of.y)), size(of.z));
        let slack = SLACK * (size(distance) + larger(largest(self.low), largest(self.high)));
        Self { low: self.low - slack, high: self.high + slack }
    }
}

/// Returns a lower bound of the distance from a point to a shape with these bounds, in world units. `is_clear_of` tells
/// whether no part of the shape is in a region.
pub fn clearance(from: DVec3, bounds: Option<Aabb>, is_clear_of: impl Fn(&Aabb) -> bool) -> f64 {
    let scale = from.abs().max_element();
    let outside = bounds.map_or(0.0, |bounds| {
        let Aabb { low, high } = bounds.with_slack(scale);
        (low - from).max(from - high).max(DVec3::ZERO).length()
    });
    if outside > 0.0 {
        return outside * (1.0 - SLACK);
    }
    // This is the largest clear cube around the point, to one eighth of its size. Its half size exceeds 1e-8 of the
    // coordinates, and so rounding moves its sides by less than 1e-6 of its size.
    let clear = |half: &f64| is_clear_of(&Aabb { low: from - *half, high: from + *half });
    let min_half = (1e4 * SLACK * scale).max(1e-12);
    let sizes = (-40..60).rev().map(power_of_two).take_while(|half| *half > min_half);
    sizes.into_iter().find(clear).map_or(0.0, |half| {
        let eighths = (9..16).rev().map(|eighths| half * f64::from(eighths) / 8.0);
        eighths.into_iter().find(clear).unwrap_or(half) * (1.0 - 1e-6)
    })
}

/// Maps a number to an integer that preserves the order. Integer minima are vectorized without special cases for NaN.
#[inline(always)]
pub fn order(number: f64) -> i64 {
    let bits = number.to_bits() as i64;
    bits ^ (((bits >> 63) as u64) >> 1) as i64
}

/// Returns the number that [`order`] maps to an integer.
#[inline(always)]
pub fn from_order(place: i64) -> f64 {
    f64::from_bits((place ^ (((place >> 63) as u64) >> 1) as i64) as u64)
}

/// Returns the smallest and the largest of some numbers.
#[inline(always)]
pub fn range(of: &[f64]) -> (f64, f64) {
    let (mut low, mut high) = (i64::MAX, i64::MIN);
    for number in of {
        low = low.min(order(*number));
        high = high.max(order(*number));
    }
    (from_order(low), from_order(high))
}

/// Returns the smaller of two numbers, or the second one if either is NaN.
#[inline(always)]
pub fn smaller(one: f64, other: f64) -> f64 {
    if one < other { one } else { other }
}

/// Returns the larger of two numbers, or the second one if either is NaN.
#[inline(always)]
pub fn larger(one: f64, other: f64) -> f64 {
    if one > other { one } else { other }
}

kernels! {
    /// Returns the bounding box of some points.
    pub fn around(points: View) -> Aabb {
        let (x, y, z) = (range(points.x), range(points.y), range(points.z));
        Aabb { low: DVec3::new(x.0, y.0, z.0), high: DVec3::new(x.1, y.1, z.1) }
    }

    /// Returns the largest magnitude of a coordinate of some points, or 0 for none.
    pub fn reach(points: View) -> f64 {
        let largest = |of: &[f64]| of.iter().fold(0, |largest, number| largest.max(number.abs().to_bits() as i64));
        from_order(largest(points.x).max(largest(points.y)).max(largest(points.z)))
    }
}
