//! Error-free transformations and double-double arithmetic (Dekker 1971, Knuth; Joldes et al. 2017).
//!
//! Nothing here uses a fused multiply-add, and so results have the same bits on each machine.

mod elementary;
pub mod exact;
pub mod vectors;

use crate::scalar::operator;
use glam::DVec3;

/// Returns the rounded sum of two numbers and its rounding error.
#[inline(always)]
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

/// Returns the rounded product of two numbers and its rounding error. Factors beyond 1e300 overflow.
#[inline(always)]
pub fn two_product(a: f64, b: f64) -> (f64, f64) {
    /// Splits a number into the upper half of its digits and the rest.
    #[inline(always)]
    fn split(a: f64) -> (f64, f64) {
        const SPLITTER: f64 = 134_217_729.0; // 2^27 + 1
        let scaled = SPLITTER * a;
        let high = scaled - (scaled - a);
        (high, a - high)
    }
    let product = a * b;
    let ((a, a_low), (b, b_low)) = (split(a), split(b));
    (product, ((a * b - product) + a * b_low + a_low * b) + a_low * b_low)
}

/// Computes `start + distance * step - from` to one ulp of the result, however far `start` is from `from`. The
/// difference is exact if it cancels, and is otherwise rounded once.
#[inline(always)]
pub fn offset(start: f64, distance: f64, step: f64, from: f64) -> f64 {
    let (way, way_low) = two_product(distance, step);
    let (place, place_low) = two_sum(start, way);
    (place - from) + (way_low + place_low)
}

/// Computes the dot product of `a` and `b + b_low`, plus `small`. `b_low` holds the rounding errors of `b`. The result
/// is rounded about once, with an error of at most 2^-102 of the size of its terms regardless of cancellation (Ogita,
/// Rump and Oishi 2005).
#[inline(always)]
pub fn dot(a: [f64; 3], b: [f64; 3], b_low: [f64; 3], small: f64) -> f64 {
    let (first, first_low) = two_product(a[0], b[0]);
    let (second, second_low) = two_product(a[1], b[1]);
    let (third, third_low) = two_product(a[2], b[2]);
    let (sum, sum_low) = two_sum(first, second);
    let (sum, rest_low) = two_sum(sum, third);
    let of_low = a[0] * b_low[0] + a[1] * b_low[1] + a[2] * b_low[2];
    sum + ((first_low + second_low + third_low) + (sum_low + rest_low) + (of_low + small))
}

/// Returns the exponent of the power of two that scales a magnitude to between 1/2 and 1, or 0 for 0.
#[inline]
pub fn exponent_to_one(magnitude: f64) -> i32 {
    // Subnormal numbers are scaled like the smallest normal number.
    let bits = magnitude.abs().max(f64::MIN_POSITIVE).to_bits() >> 52;
    if magnitude == 0.0 { 0 } else { 1022 - bits as i32 }
}

/// Returns a number times 2^`exponent`, exactly unless the result is too small or too large for a normal number.
#[inline]
pub fn times_power_of_two(number: f64, exponent: i32) -> f64 {
    let half = exponent / 2;
    number * power_of_two(half) * power_of_two(exponent - half)
}

/// Returns a vector times the power of two that scales its largest component to between 1/2 and 1, which keeps squares
/// from overflow and underflow. Components that are far smaller than the largest one may lose digits.
#[inline]
pub fn scaled(vector: DVec3) -> DVec3 {
    let exponent = exponent_to_one(vector.abs().max_element());
    vector.map(|part| times_power_of_two(part, exponent))
}

/// Returns 2^`exponent`, which may be subnormal. Returns infinity or 0 for too large or too small exponents.
#[inline]
pub fn power_of_two(exponent: i32) -> f64 {
    let is_normal = (-1022..=1023).contains(&exponent);
    if is_normal { f64::from_bits(((exponent + 1023) as u64) << 52) } else { libm::ldexp(1.0, exponent) }
}

/// A double-double: the unevaluated sum of two numbers. The second is at most about 2^-53 of the first.
///
/// Magnitudes must be below 1e290, and those of products above 1e-290. Outside of that range, parts overflow or
/// underflow.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct DoubleDouble {
    // Numbers compare by the fields in this order.
    /// The number, rounded to `f64`.
    pub high: f64,
    /// The rounding error of `high`.
    pub low: f64,
}

impl From<f64> for DoubleDouble {
    #[inline(always)]
    fn from(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }
}

impl DoubleDouble {
    /// Returns the exact difference of two numbers.
    #[inline(always)]
    pub fn difference(a: f64, b: f64) -> Self {
        let (high, low) = two_sum(a, -b);
        Self { high, low }
    }

    /// Returns the square root, or 0 for a negative number.
    pub fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return Self::from(0.0);
        }
        let root = Self::from(self.high.sqrt());
        let rest = self - root * root;
        root + Self::from(rest.high / (2.0 * root.high))
    }

    #[inline(always)]
    fn normal(high: f64, low: f64) -> Self {
        let sum = high + low;
        Self { high: sum, low: low - (sum - high) }
    }
}

operator!([] DoubleDouble, Add add(self, other) => {
    let (high, high_low) = two_sum(self.high, other.high);
    let (low, low_low) = two_sum(self.low, other.low);
    let Self { high, low } = Self::normal(high, high_low + low);
    Self::normal(high, low + low_low)
});
operator!([] DoubleDouble, Neg neg(self) => Self { high: -self.high, low: -self.low });
operator!([] DoubleDouble, Sub sub(self, other) => self + -other);
operator!([] DoubleDouble, Mul mul(self, other) => {
    let (high, low) = two_product(self.high, other.high);
    Self::normal(high, low + (self.high * other.low + self.low * other.high))
});
operator!([] DoubleDouble, Div div(self, other) => {
    let first = self.high / other.high;
    let rest = self - other * Self::from(first);
    let second = rest.high / other.high;
    let rest = rest - other * Self::from(second);
    Self::normal(first, second) + Self::from(rest.high / other.high)
});

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_rounding_takes_is_kept() {
        assert_eq!(two_sum(1.0, 1e-17), (1.0, 1e-17));
        let (product, low) = two_product(1.0 + f64::EPSILON, 1.0 + f64::EPSILON);
        assert_eq!((product, low), (1.0 + 2.0 * f64::EPSILON, f64::EPSILON * f64::EPSILON));
    }

    #[test]
    fn powers_of_two_bring_numbers_to_one() {
        for number in [1e-310, 1e-150, 0.3, 0.5, 1.0, -7.0, 1e150, f64::MAX] {
            let one = times_power_of_two(number, exponent_to_one(number)).abs();
            assert!((0.5..1.0).contains(&one) || number == 1e-310, "{number:e}: {one}");
        }
        assert_eq!(exponent_to_one(0.0), 0);
    }

    #[test]
    fn roots_and_quotients_have_twice_the_digits() {
        let two = DoubleDouble::from(2.0);
        let root = two.sqrt();
        let rest = root * root - two;
        assert!(rest.high.abs() < 1e-31, "{rest:?}");
        let third = DoubleDouble::from(1.0) / DoubleDouble::from(3.0);
        let rest = third * DoubleDouble::from(3.0) - DoubleDouble::from(1.0);
        assert!(rest.high.abs() < 1e-31, "{rest:?}");
    }
}
