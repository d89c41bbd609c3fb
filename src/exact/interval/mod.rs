//! Interval arithmetic: each operation rounds outward, and so the resulting interval encloses the true result.
//!
//! The endpoints are `f64`, or, if `f64` leaves a decision open, fractions of numbers with 237 bits ([`Wide`]).

mod float;
mod fraction;
mod functions;
mod noise;
pub(crate) mod octuple;

use crate::scalar::{Scalar, apart_if};
use f256::f256;
pub use float::Float;
pub use fraction::Fraction;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A closed interval: all numbers from `low` to `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval<F = f64> {
    /// The lower endpoint.
    pub low: F,
    /// The upper endpoint.
    pub high: F,
}

/// An interval with endpoints of 237 bits, or with fractions as endpoints.
pub type Wide = Interval<Fraction>;

impl From<Interval> for Wide {
    fn from(of: Interval) -> Self {
        Self { low: of.low.into(), high: of.high.into() }
    }
}

impl Wide {
    /// Converts the endpoints to 237 bits, rounded outward.
    pub fn ends(self) -> [f256; 2] {
        [self.low.neighbours().0, self.high.neighbours().1]
    }
}

impl Interval {
    /// All numbers, and undefined results.
    pub const WHOLE: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY };
}

impl<F: Float> Interval<F> {
    /// Returns all numbers, and undefined results.
    pub fn whole() -> Self {
        Self { low: -F::INFINITY, high: F::INFINITY }
    }

    /// Returns the interval of one number.
    #[inline(always)]
    pub fn point(at: F) -> Self {
        Self { low: at, high: at }
    }

    /// Returns whether the interval may contain 0.
    #[inline(always)]
    pub fn has_zero(self) -> bool {
        !(self.low.is_positive() || self.high.is_negative())
    }

    /// Returns the largest absolute value in the interval.
    #[inline(always)]
    pub fn magnitude(self) -> F {
        self.low.abs().max(self.high.abs())
    }

    /// Returns the width of the interval, rounded.
    pub fn width(self) -> F {
        self.high - self.low
    }

    /// Returns the midpoint, rounded.
    pub fn middle(self) -> F {
        self.low + F::of(0.5) * (self.high - self.low)
    }

    /// Returns the smallest interval that contains both.
    pub fn hull(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Converts to `f64`, rounded outward. Numbers that need no rounding stay unchanged: a line parallel to an axis
    /// stays parallel to it.
    pub fn coarse(self) -> Interval {
        let (low, high) = (self.low.to_f64(), self.high.to_f64());
        Interval {
            low: if self.low.is_double() { low } else { low.next_down() },
            high: if self.high.is_double() { high } else { high.next_up() },
        }
    }

    /// Converts from `f64`, exactly.
    pub fn from_f64(of: Interval) -> Self {
        Self { low: F::of(of.low), high: F::of(of.high) }
    }

    /// Returns the largest integer that is at most the numbers, if it is the same for all of them.
    pub fn certain_floor(self) -> Option<f64> {
        let floor = self.low.floor();
        (floor == self.high.floor() && floor.is_finite()).then(|| floor.to_f64())
    }

    /// Encloses π.
    pub fn pi() -> Self {
        Self::outward(F::PI, F::PI)
    }

    /// Returns whether both endpoints are finite.
    pub fn is_bounded(self) -> bool {
        self.low.is_finite() && self.high.is_finite()
    }

    /// Widens rounded endpoints to enclose the exact ones. NaN gives the whole line.
    #[inline(always)]
    fn outward(low: F, high: F) -> Self {
        let (low, high) = F::outward(low, high);
        if low.is_nan() || high.is_nan() { Self::whole() } else { Self { low, high } }
    }

    /// Widens the rounded endpoints of a sum or difference. They are 0 only if they are exact.
    #[inline(always)]
    fn outward_sum(low: F, high: F) -> Self {
        let (low, high) = F::outward_sum(low, high);
        if low.is_nan() || high.is_nan() { Self::whole() } else { Self { low, high } }
    }

    /// Widens the endpoints of functions that are less precise than arithmetic.
    fn around(low: F, high: F) -> Self {
        let (low, high) = F::around(low, high);
        if low.is_nan() || high.is_nan() { Self::whole() } else { Self { low, high } }
    }

    /// Returns the minimum and the maximum of four numbers, ignoring NaN.
    #[inline(always)]
    fn extremes(a: F, b: F, c: F, d: F) -> (F, F) {
        (a.min(b).min(c.min(d)), a.max(b).max(c.max(d)))
    }
}

impl<F: Float> Add for Interval<F> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        apart_if!(F::IS_LONG, Self::outward_sum(self.low + other.low, self.high + other.high))
    }
}

impl<F: Float> Sub for Interval<F> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        apart_if!(F::IS_LONG, {
            // The difference of a single number with itself is exactly 0, and its product with an unbounded number
            // stays 0.
            if self == other && self.low == self.high {
                return Self::constant(0.0);
            }
            Self::outward_sum(self.low - other.high, self.high - other.low)
        })
    }
}

impl<F: Float> Neg for Interval<F> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low }
    }
}

impl<F: Float> Mul for Interval<F> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        apart_if!(F::IS_LONG, {
            // The common case: finite endpoints, none of them 0.
            match F::product_ends([self.low, self.high], [other.low, other.high]) {
                Some((low, high)) => {
                    let (low, high) = F::outward(low, high);
                    Self { low, high }
                }
                None => self.unusual_product(other),
            }
        })
    }
}

impl<F: Float> Interval<F> {
    /// Returns the product if an endpoint may be 0 or infinite. It is compiled once, and not into each formula.
    #[cold]
    #[inline(never)]
    fn unusual_product(self, other: Self) -> Self {
        // The product of 0 with anything is 0, even if that is unbounded.
        if self.is_zero() || other.is_zero() {
            return Self::constant(0.0);
        }
        let (low, high) = Self::extremes(
            self.low * other.low,
            self.low * other.high,
            self.high * other.low,
            self.high * other.high,
        );
        // `min` and `max` above ignored 0 times infinity, the product of an endpoint at 0 and an infinite one.
        let touches = |a: Self, b: Self| a.has_zero() && !b.is_bounded();
        if touches(self, other) || touches(other, self) {
            return Self::outward(low.min(F::of(0.0)), high.max(F::of(0.0)));
        }
        // Products of nonnegative numbers are not negative, and their square roots are defined.
        let zero = F::of(0.0);
        if self.low >= zero && other.low >= zero && low == zero {
            return Self { low, ..Self::outward(low, high) };
        }
        Self::outward(low, high)
    }

    /// Returns the quotient if the divisor may be 0 or infinite.
    #[cold]
    #[inline(never)]
    fn unusual_quotient(self, other: Self) -> Self {
        let (zero, one) = (F::of(0.0), F::of(1.0));
        // The reciprocal has one finite endpoint if the divisor is on one side of 0, and none if it is on both.
        let inverse = if other.low >= zero && other.high > zero {
            let high = if other.low > zero { one / other.low } else { F::INFINITY };
            Self { low: one / other.high, high }
        } else if other.high <= zero && other.low < zero {
            let low = if other.high < zero { one / other.high } else { -F::INFINITY };
            Self { low, high: one / other.low }
        } else {
            return Self::whole();
        };
        let Self { low, high } = Self::outward(inverse.low, inverse.high);
        // Infinite endpoints stay infinite, and 0, the reciprocal of an infinite one, stays 0.
        let low = if inverse.low == -F::INFINITY || inverse.low == zero { inverse.low } else { low };
        let high = if inverse.high == F::INFINITY || inverse.high == zero { inverse.high } else { high };
        self * Self { low, high }
    }
}

impl<F: Float> Div for Interval<F> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        apart_if!(F::IS_LONG, {
            if self.is_zero() && !other.is_zero() {
                return Self::constant(0.0);
            }
            if other.has_zero() || !other.is_bounded() {
                return self.unusual_quotient(other);
            }
            let (low, high) = F::quotient_ends([self.low, self.high], [other.low, other.high]);
            Self::outward(low, high)
        })
    }
}
