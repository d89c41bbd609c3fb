//! What the ends of an interval are: numbers that are rounded, and how far outward that asks for.

use f256::f256;
use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A floating-point number that can be an end of an [`Interval`](super::Interval).
///
/// Sums, products, quotients and square roots are those of IEEE 754, rounded to nearest. Every other function is
/// trusted to a stated number of units in the last place, which [`around`](Self::around) takes outward; the tests of
/// this module compare them with correctly rounded ones.
pub trait Float:
    Copy
    + Debug
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Whether an operation takes hundreds of instructions, and not a few.
    const IS_LONG: bool;
    /// What every finite number is below.
    const INFINITY: Self;
    /// The ratio of a circle's circumference to its diameter, rounded.
    const PI: Self;
    /// The distance from 1 to the next number.
    const EPSILON: Self;

    /// A number of `f64`, exactly.
    fn of(value: f64) -> Self;
    /// The number as `f64`, rounded to one of the two next to it; infinite where it is too large.
    fn to_f64(self) -> f64;
    /// The ends of an interval around exact ends that were rounded to these: at least one unit in the last place outward.
    /// An end that is no number stays one.
    fn outward(low: Self, high: Self) -> (Self, Self);
    /// As [`outward`](Self::outward), of sums and differences: what is 0 stays 0, as a sum never underflows.
    fn outward_sum(low: Self, high: Self) -> (Self, Self);
    /// The ends of an interval around values that a function other than those of IEEE 754 gave.
    fn around(low: Self, high: Self) -> (Self, Self);
    /// The least and the greatest product of the ends of two intervals, rounded to nearest; nothing where that takes more
    /// thought, as with ends that are 0 or infinite.
    fn product_ends(one: [Self; 2], other: [Self; 2]) -> Option<(Self, Self)>;
    /// The square root of a number that is not negative.
    fn sqrt(self) -> Self;
    /// The sine and the cosine.
    fn sin_cos(self) -> (Self, Self);
    /// The tangent.
    fn tan(self) -> Self;
    /// e to the power of it.
    fn exp(self) -> Self;
    /// The natural logarithm of a number that is not negative; that of 0 is infinite.
    fn ln(self) -> Self;
    /// The greatest whole number that is not above it.
    fn floor(self) -> Self;
    /// Its distance from 0.
    fn abs(self) -> Self;

    /// Whether it is neither infinite nor no number.
    #[inline(always)]
    fn is_finite(self) -> bool {
        self.abs() < Self::INFINITY
    }

    /// The lesser of two; the other one where one is no number.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self < other || other.is_nan() { self } else { other }
    }

    /// The greater of two; the other one where one is no number.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self > other || other.is_nan() { self } else { other }
    }

    /// Whether it is no number.
    #[inline(always)]
    #[expect(clippy::eq_op, reason = "what is no number differs from itself")]
    fn is_nan(self) -> bool {
        self != self
    }
}

/// What is taken outward from a number of `f64`, as a part of it.
const STEP: f64 = 1.04 * f64::EPSILON;

impl Float for f64 {
    const IS_LONG: bool = false;
    const INFINITY: Self = f64::INFINITY;
    const PI: Self = std::f64::consts::PI;
    const EPSILON: Self = f64::EPSILON;

    #[inline(always)]
    fn of(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn to_f64(self) -> f64 {
        self
    }

    /// A product and a difference are many times faster than the next number of `f64`. The product is at least 1.04
    /// units in the last place, which leaves at least one whole unit of the difference; `LEAST` is more than what
    /// results lose that underflow.
    #[inline(always)]
    fn outward(low: Self, high: Self) -> (Self, Self) {
        const LEAST: f64 = 1e-305;
        (low - (f64::abs(low) * STEP + LEAST), high + (f64::abs(high) * STEP + LEAST))
    }

    /// Where the product underflows the sum that it is to be taken from was exact.
    #[inline(always)]
    fn outward_sum(low: Self, high: Self) -> (Self, Self) {
        (low - f64::abs(low) * STEP, high + f64::abs(high) * STEP)
    }

    /// Of all four products, without a branch for their signs.
    #[inline(always)]
    fn product_ends([one_low, one_high]: [Self; 2], [low, high]: [Self; 2]) -> Option<(Self, Self)> {
        let [a, b, c, d] = [one_low * low, one_low * high, one_high * low, one_high * high];
        let less = |a: f64, b: f64| if a < b { a } else { b };
        let more = |a: f64, b: f64| if a > b { a } else { b };
        let is_plain = a * b * c * d != 0.0 && (a + b + c + d).is_finite();
        is_plain.then(|| (less(less(a, b), less(c, d)), more(more(a, b), more(c, d))))
    }

    /// The `libm` functions are trusted to within one unit in the last place: two steps.
    fn around(low: Self, high: Self) -> (Self, Self) {
        let (low, high) = Self::outward(low, high);
        Self::outward(low, high)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    fn sin_cos(self) -> (Self, Self) {
        libm::sincos(self)
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

    #[inline(always)]
    fn floor(self) -> Self {
        f64::floor(self)
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

/// The format `binary256` of IEEE 754: 237 bits, and exponents to 2^262143, so that no square or fourth power of a
/// scene's numbers overflows.
impl Float for f256 {
    const IS_LONG: bool = true;
    const INFINITY: Self = f256::INFINITY;
    const PI: Self = ::f256::consts::PI;
    const EPSILON: Self = f256::EPSILON;

    fn of(value: f64) -> Self {
        Self::from(value)
    }

    fn to_f64(self) -> f64 {
        if self.is_nan() || self.is_infinite() {
            return if self.is_nan() { f64::NAN } else { f64::INFINITY.copysign(sign(self)) };
        }
        let (_, exponent, (high, low)) = self.as_sign_exp_signif();
        // Both halves are rounded to nearest and so is their sum, in which the lower half is below the upper's last bit.
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

    /// Of the two products that the signs leave, where none of the ends is 0: each takes longer than looking at signs.
    fn product_ends([one_low, one_high]: [Self; 2], [low, high]: [Self; 2]) -> Option<(Self, Self)> {
        let zero = Self::ZERO;
        let is_plain = |of: Self| of.is_finite() && !of.eq_zero();
        if ![one_low, one_high, low, high].into_iter().all(is_plain) || (one_low < zero && one_high > zero) {
            return None;
        }
        let (below, above) = if one_low > zero { (one_low, one_high) } else { (one_high, one_low) };
        // Of factors above 0, the far end of the first goes with what is on the far side of 0 of the second.
        let least = if low > zero { below } else { above } * low;
        let greatest = if high > zero { above } else { below } * high;
        Some(if one_low > zero { (least, greatest) } else { (greatest, least) })
    }

    /// The functions of the crate are trusted to within seven units in the last place: eight steps.
    fn around(low: Self, high: Self) -> (Self, Self) {
        let steps = |of: Self| Self::from(8.0) * of.abs() * Self::EPSILON;
        ((low - steps(low)).next_down(), (high + steps(high)).next_up())
    }

    fn sqrt(self) -> Self {
        self.sqrt()
    }

    fn sin_cos(self) -> (Self, Self) {
        // The crate's own function of both takes longer than both.
        (self.sin(), self.cos())
    }

    fn tan(self) -> Self {
        f256::tan(&self)
    }

    fn exp(self) -> Self {
        f256::exp(&self)
    }

    fn ln(self) -> Self {
        if self.eq_zero() { f256::NEG_INFINITY } else { f256::ln(&self) }
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

/// 1 or -1.
fn sign(of: f256) -> f64 {
    if of.is_sign_negative() { -1.0 } else { 1.0 }
}
