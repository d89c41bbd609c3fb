//! The endpoints of an interval: floating-point numbers, and their outward rounding.

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
    fn product_ends(one: [Self; 2], other: [Self; 2]) -> Option<(Self, Self)>;
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

    /// Widens by two ulps: the errors of the `libm` functions are assumed to be within one.
    /// `intervals_hold_the_true_results` tests this.
    #[inline]
    fn around(low: Self, high: Self) -> (Self, Self) {
        let (low, high) = Self::outward(low, high);
        Self::outward(low, high)
    }

    fn enclosing(low: f256, high: f256) -> (Self, Self) {
        (low.to_f64().next_down(), high.to_f64().next_up())
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

/// The format `binary256` of IEEE 754: 237 bits, and exponents up to 2^262143. Squares and fourth powers of a scene's
/// numbers do not overflow.
impl Float for f256 {
    const IS_LONG: bool = true;
    const INFINITY: Self = f256::INFINITY;
    const PI: Self = ::f256::consts::PI;
    const EPSILON: Self = f256::EPSILON;
    const MAX: Self = f256::MAX;

    fn of(value: f64) -> Self {
        Self::from(value)
    }

    fn to_f64(self) -> f64 {
        if self.is_nan() || self.is_infinite() {
            return if self.is_nan() { f64::NAN } else { f64::INFINITY.copysign(sign(self)) };
        }
        let (_, exponent, (high, low)) = self.as_sign_exp_signif();
        // Both halves are rounded to nearest, and so is their sum. The lower half is below the upper half's last bit.
        let magnitude = libm::ldexp(high as f64, 128) + low as f64;
        libm::ldexp(magnitude, exponent).copysign(sign(self))
    }

    fn outward(low: Self, high: Self) -> (Self, Self) {
        (low.next_down(), high.next_up())
    }

    fn outward_sum(low: Self, high: Self) -> (Self, Self) {
        (
            if low.eq_zero() { low } else { low.next_down() },
            if high.eq_zero() { high } else { high.next_up() },
        )
    }

    /// Computes only the two products that the signs select, if no endpoint is 0. A product takes longer than the tests
    /// of signs.
    fn product_ends([one_low, one_high]: [Self; 2], [low, high]: [Self; 2]) -> Option<(Self, Self)> {
        let zero = Self::ZERO;
        let is_plain = |of: Self| of.is_finite() && !of.eq_zero();
        if ![one_low, one_high, low, high].into_iter().all(is_plain) || (one_low < zero && one_high > zero) {
            return None;
        }
        let (below, above) = if one_low > zero { (one_low, one_high) } else { (one_high, one_low) };
        // With a positive first factor, the sign of each endpoint of the second selects the endpoint of the first.
        let smallest = if low > zero { below } else { above } * low;
        let largest = if high > zero { above } else { below } * high;
        Some(if one_low > zero { (smallest, largest) } else { (largest, smallest) })
    }

    /// Widens by eight ulps: the errors of the crate's functions are assumed to be within seven.
    /// `wide_intervals_hold_the_right_results` tests this.
    fn around(low: Self, high: Self) -> (Self, Self) {
        let steps = |of: Self| Self::from(8.0) * of.abs() * Self::EPSILON;
        ((low - steps(low)).next_down(), (high + steps(high)).next_up())
    }

    fn enclosing(low: Self, high: Self) -> (Self, Self) {
        (low, high)
    }

    fn sqrt(self) -> Self {
        self.sqrt()
    }

    fn sines([one, other]: [Self; 2]) -> ([Self; 2], [Self; 2]) {
        let sin = |of: Self| if is_small(of) { of } else { of.sin() };
        // The crate's combined function takes longer than two separate ones.
        let (sine, cosine) = (sin(one), one.cos());
        if one == other {
            return ([sine; 2], [cosine; 2]);
        }
        ([sine, sin(other)], [cosine, other.cos()])
    }

    fn tan(self) -> Self {
        if is_small(self) { self } else { f256::tan(&self) }
    }

    fn exp(self) -> Self {
        f256::exp(&self)
    }

    fn ln(self) -> Self {
        if self.eq_zero() { f256::NEG_INFINITY } else { f256::ln(&self) }
    }

    /// Of numbers that are near each other, the second power follows from the first: `e^d` is less than `1 + d + d^2` for
    /// small d. Four ulps cover the rounding.
    fn exps(low: Self, high: Self) -> (Self, Self) {
        let (below, apart) = (low.exp(), high - low);
        match apart {
            _ if apart.eq_zero() => (below, below),
            _ if apart <= Self::from(NEAR) => {
                let four = Self::from(4.0) * Self::EPSILON;
                (below, below * (Self::ONE + apart + apart * apart + four))
            }
            _ => (below, high.exp()),
        }
    }

    /// Of numbers that are near each other, the second logarithm follows from the first: that of `1 + d` is less than d.
    /// Sixteen ulps cover the rounding.
    fn lns(low: Self, high: Self) -> (Self, Self) {
        let (below, apart) = (low.ln(), high - low);
        match apart {
            _ if apart.eq_zero() => (below, below),
            _ if apart <= Self::from(NEAR) * low => {
                let above = apart / low;
                let rounding = Self::from(16.0) * Self::EPSILON * (below.abs() + above);
                (below, below + above + rounding)
            }
            _ => (below, high.ln()),
        }
    }

    fn atan2(self, x: Self) -> Self {
        // The crate's angles are wrong if an argument is infinite, if both are equally large, and for -0.
        let part = |of: Self| match of.is_infinite() {
            true => Self::ONE.copysign(of),
            false => Self::ZERO.copysign(of),
        };
        let is_far = self.is_infinite() || x.is_infinite();
        let (y, x) = if is_far { (part(self), part(x)) } else { (self, x) };
        let is_diagonal = y.abs() == x.abs() && !y.eq_zero();
        let angle = match is_diagonal {
            true if x.is_sign_negative() => Self::from(0.75) * Self::PI,
            true => ::f256::consts::FRAC_PI_4,
            false if x > Self::ZERO && is_small(y / x) => y / x,
            false => f256::atan2(&y, &x),
        };
        angle.copysign(self)
    }

    fn floor(self) -> Self {
        f256::floor(&self)
    }

    fn abs(self) -> Self {
        f256::abs(&self)
    }

    fn is_finite(self) -> bool {
        f256::is_finite(self)
    }

    fn is_nan(self) -> bool {
        f256::is_nan(self)
    }
}

/// How near two numbers are whose powers and logarithms follow from each other: their difference, or the ratio of that to
/// the numbers.
const NEAR: f64 = 1.0 / (1_u64 << 32) as f64;

/// Angles up to this are their own sines and tangents, to within an ulp.
const SMALL: f64 = 1.0 / (1_u128 << 119) as f64;

/// Tells whether an angle is its own sine and tangent. The crate computes them with fixed-point numbers, which know no
/// digits of an angle below 2^-492.
fn is_small(angle: f256) -> bool {
    angle.abs() <= f256::from(SMALL)
}

/// Returns 1 or -1, with the sign of a number.
fn sign(of: f256) -> f64 {
    if of.is_sign_negative() { -1.0 } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_angles_keep_their_digits() {
        let (one, few) = (f256::ONE, f256::from(8.0) * <f256 as Float>::EPSILON);
        let (mut power, three, six) = (f256::from(0.5), f256::from(3.0), f256::from(6.0));
        for _ in 0..16 {
            power = power * power;
            // The next terms of the series are below an ulp up to there.
            if power > f256::from(1e-18) {
                continue;
            }
            let angle = f256::from(1.1) * power;
            let square = angle * angle;
            for (of, series) in [
                (f256::sines([angle; 2]).0[0], one - square / six),
                (Float::tan(angle), one + square / three),
                (Float::atan2(angle, one), one - square / three),
                (Float::atan2(-angle * power, power), square / three - one),
            ] {
                assert!(Float::abs(of / angle - series) <= few, "{angle:?}: {of:?}");
            }
        }
    }

    #[test]
    fn angles_of_237_bits_are_those_of_53_in_every_direction() {
        let numbers = [f64::NEG_INFINITY, -2.0, -1.0, -0.0, 0.0, 1.0, 2.0, f64::INFINITY];
        for (y, x) in numbers.into_iter().flat_map(|y| numbers.map(|x| (y, x))) {
            let (found, right) = (Float::atan2(f256::from(y), f256::from(x)).to_f64(), libm::atan2(y, x));
            // The sign of 0 as x does not matter beside a y of 0, whose angle may be any.
            let is_right = (found - right).abs() < 1e-15 || y == 0.0 && x == 0.0;
            assert!(is_right, "the angle to {x}, {y} is {found}, and not {right}");
        }
    }
}
