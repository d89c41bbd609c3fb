//! Coefficients of polynomials, in three precisions.

use crate::double_double::DoubleDouble;
use crate::interval::{Float, Fraction, Interval, Wide, octuple};
use f256::f256;
use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A coefficient of a polynomial.
pub trait Coefficient:
    Copy
    + Debug
    + PartialOrd
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// A bound of the relative error of a product that is added to a sum. Each of the two operations contributes at
    /// most half of it.
    const ROUNDING: f64;

    /// The magnitude from which on intermediate products may overflow.
    const LARGEST: f64 = f64::MAX;

    /// The endpoints of intervals around a coefficient.
    type End: Float;

    /// Returns the number, rounded to `f64`.
    fn nearest(self) -> f64;

    /// Encloses all numbers that differ from this one by at most `error`.
    fn bounds(self, error: f64) -> Interval<Self::End>;

    /// Returns a number in an interval, and a bound of its distance from the other numbers there, which is infinite for
    /// an unbounded interval.
    fn about(bounds: Interval<Self::End>) -> (Self, f64);
}

impl Coefficient for f64 {
    const ROUNDING: f64 = f64::EPSILON;

    type End = f64;

    #[inline(always)]
    fn nearest(self) -> f64 {
        self
    }

    fn bounds(self, error: f64) -> Interval {
        Interval { low: (self - error).next_down(), high: (self + error).next_up() }
    }

    fn about(bounds: Interval) -> (Self, f64) {
        (bounds.middle(), if bounds.is_bounded() { bounds.width() } else { f64::INFINITY })
    }
}

impl Coefficient for DoubleDouble {
    /// 2^-100: the rounding error is 3 2^-106 for sums and 7 2^-106 for products (Joldes et al. 2017).
    const ROUNDING: f64 = f64::from_bits((1023 - 100) << 52);

    const LARGEST: f64 = 1e290;

    type End = Fraction;

    #[inline(always)]
    fn nearest(self) -> f64 {
        self.high
    }

    fn bounds(self, error: f64) -> Wide {
        (f256::from(self.high) + f256::from(self.low)).bounds(error)
    }

    fn about(bounds: Wide) -> (Self, f64) {
        let (middle, error) = f256::about(bounds);
        let high = octuple::to_f64(middle);
        let number = Self { high, low: octuple::to_f64(middle - f256::from(high)) };
        (number, error + Self::ROUNDING * high.abs())
    }
}

impl Coefficient for f256 {
    /// 2^-236.
    const ROUNDING: f64 = f64::from_bits((1023 - 236) << 52);

    type End = Fraction;

    fn nearest(self) -> f64 {
        octuple::to_f64(self)
    }

    fn bounds(self, error: f64) -> Wide {
        let error = f256::from(error);
        Wide { low: (self - error).next_down().into(), high: (self + error).next_up().into() }
    }

    fn about(bounds: Wide) -> (Self, f64) {
        let error = if bounds.is_bounded() { bounds.width().to_f64().next_up() } else { f64::INFINITY };
        (bounds.middle().value(), if bounds.low == bounds.high { 0.0 } else { error })
    }
}
