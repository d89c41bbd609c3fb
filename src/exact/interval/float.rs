//! The endpoints of an interval: floating-point numbers, and their outward rounding.

use super::{Interval, octuple};
use crate::sines::sines;
use f256::f256;
use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A floating-point number for the endpoints of an [`Interval`](super::Interval).
///
/// Sums, products, quotients and square roots are those of IEEE 754, rounded to nearest. Other functions are assumed to
/// have an error of a stated number of ulps, by which [`around`](Self::around) widens.
/// `intervals_hold_the_true_results` and `wide_intervals_hold_the_right_results` in `tests/shapes/double_double.rs`
/// compare them with more precise functions.
pub trait Float:
    Copy
    + Debug
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + 'static
{
    /// Whether an operation takes hundreds of instructions rather than a few.
    const IS_LONG: bool;
    /// Positive infinity.
    const INFINITY: Self;
    /// π, rounded.
    const PI: Self;
    /// The difference between 1 and the next larger number.
    const EPSILON: Self;
    /// The largest finite number.
    const MAX: Self;

    /// Converts from `f64`, exactly.
    fn of(value: f64) -> Self;
    /// Converts to one of the two neighbouring `f64`, or infinity if the number is too large.
    fn to_f64(self) -> f64;
    /// Tells whether [`to_f64`](Self::to_f64) certainly returns the number itself.
    fn is_double(self) -> bool {
        Self::of(self.to_f64()) == self
    }
    /// Widens rounded endpoints by at least one ulp to enclose the exact ones. A NaN stays a NaN.
    fn outward(low: Self, high: Self) -> (Self, Self);
    /// Widens the rounded endpoints of a sum or difference like [`outward`](Self::outward), except that 0 stays 0,
    /// because a sum does not underflow.
    fn outward_sum(low: Self, high: Self) -> (Self, Self);
    /// Widens the endpoints from a function outside of IEEE 754 by its error bound.
    fn around(low: Self, high: Self) -> (Self, Self);
    /// Returns the smallest and the largest product of the endpoints of two intervals, rounded to nearest, or `None`
    /// for cases that need more care, such as endpoints that are 0 or infinite.
    ///
    /// By default, computes only the two products that the signs select, if no endpoint is 0. A product of long numbers
    /// takes longer than the tests of signs.
    fn product_ends([one_low, one_high]: [Self; 2], [low, high]: [Self; 2]) -> Option<(Self, Self)> {
        let is_plain = |of: Self| of.is_finite() && (of.is_positive() || of.is_negative());
        let is_positive = one_low.is_positive();
        if ![one_low, one_high, low, high].into_iter().all(is_plain) || is_positive != one_high.is_positive()
        {
            return None;
        }
        let (below, above) = if is_positive { (one_low, one_high) } else { (one_high, one_low) };
        // With a positive first factor, the sign of each endpoint of the second selects the endpoint of the first.
        let smallest = if low.is_positive() { below } else { above } * low;
        let largest = if high.is_positive() { above } else { below } * high;
        Some(if is_positive { (smallest, largest) } else { (largest, smallest) })
    }

    /// Returns the smallest and the largest quotient of the endpoints of two intervals, rounded to nearest. The divisor
    /// is bounded and does not contain 0.
    ///
    /// By default, computes only the two quotients that the signs select.
    fn quotient_ends([low, high]: [Self; 2], [least, most]: [Self; 2]) -> (Self, Self) {
        if most.is_negative() {
            return Self::quotient_ends([-high, -low], [-most, -least]);
        }
        let smallest = low / if low.is_positive() { most } else { least };
        (smallest, high / if high.is_positive() { least } else { most })
    }

    /// Converts endpoints, rounded outward.
    fn enclosing(low: f256, high: f256) -> (Self, Self);
    /// Returns the square root of a number that is not negative.
    fn sqrt(self) -> Self;
    /// Returns the sines and the cosines of two angles in radians.
    fn sines(angles: [Self; 2]) -> ([Self; 2], [Self; 2]);
    /// Returns the tangent of an angle in radians.
    fn tan(self) -> Self;
    /// Returns e raised to this power.
    fn exp(self) -> Self;
    /// Returns the natural logarithm of a nonnegative number. The logarithm of 0 is negative infinity.
    fn ln(self) -> Self;
    /// Returns e raised to two powers, the second of which is not smaller. The second result may be somewhat too large.
    fn exps(low: Self, high: Self) -> (Self, Self) {
        (low.exp(), high.exp())
    }
    /// Returns the natural logarithms of two nonnegative numbers, the second of which is not smaller. The second result
    /// may be somewhat too large.
    fn lns(low: Self, high: Self) -> (Self, Self) {
        (low.ln(), high.ln())
    }
    /// Returns the angle in radians, from -π to π, from the positive x axis to the point with this y.
    fn atan2(self, x: Self) -> Self;
    /// Returns the largest integer that is at most the number.
    fn floor(self) -> Self;
    /// Returns the absolute value.
    fn abs(self) -> Self;

    /// Returns whether the number is neither infinite nor NaN.
    #[inline(always)]
    fn is_finite(self) -> bool {
        self.abs() < Self::INFINITY
    }

    /// Returns the smaller of two numbers. If one is NaN, returns the other.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self < other || other.is_nan() { self } else { other }
    }

    /// Returns the larger of two numbers. If one is NaN, returns the other.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self > other || other.is_nan() { self } else { other }
    }

    /// Returns whether the number is NaN.
    #[inline(always)]
    #[expect(clippy::eq_op, reason = "what is no number differs from itself")]
    fn is_nan(self) -> bool {
        self != self
    }

    /// Returns whether the number is above 0.
    #[inline(always)]
    fn is_positive(self) -> bool {
        self > Self::of(0.0)
    }

    /// Returns whether the number is below 0.
    #[inline(always)]
    fn is_negative(self) -> bool {
        (-self).is_positive()
    }
}

/// The relative amount by which an endpoint in `f64` is moved outward: slightly more than one ulp.
const OUTWARD: f64 = 1.04 * f64::EPSILON;

impl Float for f64 {
    const IS_LONG: bool = false;
    const INFINITY: Self = f64::INFINITY;
    const PI: Self = std::f64::consts::PI;
    const EPSILON: Self = f64::EPSILON;
    const MAX: Self = f64::MAX;

    #[inline(always)]
    fn of(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn to_f64(self) -> f64 {
        self
    }

    /// Widens by a product and a difference, which are many times faster than `next_up` and `next_down`. The product is
    /// at least 1.04 ulps, and at least one whole ulp remains after the difference is rounded. `UNDERFLOW` exceeds the
    /// loss of a result that underflows.
    #[inline(always)]
    fn outward(low: Self, high: Self) -> (Self, Self) {
        const UNDERFLOW: f64 = 1e-305;
        (low - (f64::abs(low) * OUTWARD + UNDERFLOW), high + (f64::abs(high) * OUTWARD + UNDERFLOW))
    }

    /// If the product underflows, the sum that it widens was exact.
    #[inline(always)]
    fn outward_sum(low: Self, high: Self) -> (Self, Self) {
        (low - f64::abs(low) * OUTWARD, high + f64::abs(high) * OUTWARD)
    }

    /// Takes the minimum and the maximum of all four products, without a branch for their signs.
    #[inline(always)]
    fn product_ends([one_low, one_high]: [Self; 2], [low, high]: [Self; 2]) -> Option<(Self, Self)> {
        let [a, b, c, d] = [one_low * low, one_low * high, one_high * low, one_high * high];
        let less = |a: f64, b: f64| if a < b { a } else { b };
        let more = |a: f64, b: f64| if a > b { a } else { b };
        let is_plain = a * b * c * d != 0.0 && (a + b + c + d).is_finite();
        is_plain.then(|| (less(less(a, b), less(c, d)), more(more(a, b), more(c, d))))
    }

    #[inline(always)]
    fn quotient_ends([low, high]: [Self; 2], [least, most]: [Self; 2]) -> (Self, Self) {
        Interval::extremes(low / least, low / most, high / least, high / most)
    }

    /// Widens by two ulps: the errors of the `libm` functions are assumed to be within one.
    /// `intervals_hold_the_true_results` tests this.
    #[inline]
    fn around(low: Self, high: Self) -> (Self, Self) {
        let (low, high) = Self::outward(low, high);
        Self::outward(low, high)
    }

    fn enclosing(low: f256, high: f256) -> (Self, Self) {
        (octuple::to_f64(low).next_down(), octuple::to_f64(high).next_up())
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    #[inline]
    fn sines(angles: [Self; 2]) -> ([Self; 2], [Self; 2]) {
        sines(angles)
    }

    fn tan(self) -> Self {
        libm::tan(self)
    }

    fn exp(self) -> Self {
        libm::exp(self)
    }

    fn ln(self) -> Self {
        libm::log(self)
    }

    fn atan2(self, x: Self) -> Self {
        libm::atan2(self, x)
    }

    /// Avoids the standard library's function, which is a call unless the target processor has an instruction for it.
    #[inline(always)]
    fn floor(self) -> Self {
        /// Adding this rounds to an integer. From `WHOLE` on, all numbers are integers.
        const TO_WHOLE: f64 = 1.5 / f64::EPSILON;
        const WHOLE: f64 = 0.25 / f64::EPSILON;
        if f64::abs(self) < WHOLE {
            let near = (self + TO_WHOLE) - TO_WHOLE;
            (if near > self { near - 1.0 } else { near }).copysign(self)
        } else {
            self
        }
    }

    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        f64::min(self, other)
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        f64::max(self, other)
    }
}
