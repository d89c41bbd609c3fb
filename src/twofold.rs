//! Arithmetic without rounding error, or with that of twice the precision (Dekker 1971, Knuth; Joldes et al. 2017).
//!
//! Nothing here multiplies and adds in one step, so the bits are the same on every machine.

mod elementary;

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A sum, and what rounding took from it.
#[inline(always)]
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

/// A product, and what rounding took from it. Factors beyond 1e300 overflow.
#[inline(always)]
pub fn two_product(a: f64, b: f64) -> (f64, f64) {
    /// Half of the digits, and the rest.
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

/// `start + distance * step`, rounded once: to half a unit in the last place of the result, not of `start`.
#[inline(always)]
pub fn advance(start: f64, distance: f64, step: f64) -> f64 {
    let (product, product_low) = two_product(distance, step);
    let (sum, sum_low) = two_sum(start, product);
    sum + (product_low + sum_low)
}

/// `start + distance * step - from`: to a unit in the last place of the result, however far `start` is from there. The
/// difference is exact where it cancels, and rounded once where it does not.
#[inline(always)]
pub fn offset(start: f64, distance: f64, step: f64, from: f64) -> f64 {
    let (way, way_low) = two_product(distance, step);
    let (place, place_low) = two_sum(start, way);
    (place - from) + (way_low + place_low)
}

/// A sum of three products, the second factors with what rounding took from them: rounded about once, however much of
/// it cancels (Ogita, Rump and Oishi 2005).
#[inline(always)]
pub fn dot(a: [f64; 3], b: [f64; 3], b_low: [f64; 3]) -> f64 {
    let (first, first_low) = two_product(a[0], b[0]);
    let (second, second_low) = two_product(a[1], b[1]);
    let (third, third_low) = two_product(a[2], b[2]);
    let (sum, sum_low) = two_sum(first, second);
    let (sum, rest_low) = two_sum(sum, third);
    let of_low = a[0] * b_low[0] + a[1] * b_low[1] + a[2] * b_low[2];
    sum + ((first_low + second_low + third_low) + (sum_low + rest_low) + of_low)
}

/// A number in twice the precision: the sum of two, the second far smaller.
///
/// For finite numbers of a magnitude below 1e290, products' magnitudes above 1e-290: beyond them parts are lost.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Twofold {
    // The order of the fields is that in which numbers compare.
    /// The number, rounded.
    pub high: f64,
    /// What rounding took.
    pub low: f64,
}

impl From<f64> for Twofold {
    #[inline(always)]
    fn from(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }
}

impl Twofold {
    /// The difference of two numbers, exactly.
    #[inline(always)]
    pub fn difference(a: f64, b: f64) -> Self {
        let (high, low) = two_sum(a, -b);
        Self { high, low }
    }

    /// The square root; 0 below 0.
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

impl Add for Twofold {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let (high, high_low) = two_sum(self.high, other.high);
        let (low, low_low) = two_sum(self.low, other.low);
        let Self { high, low } = Self::normal(high, high_low + low);
        Self::normal(high, low + low_low)
    }
}

impl Neg for Twofold {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for Twofold {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Twofold {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let (high, low) = two_product(self.high, other.high);
        Self::normal(high, low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for Twofold {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * Self::from(first);
        let second = rest.high / other.high;
        let rest = rest - other * Self::from(second);
        Self::normal(first, second) + Self::from(rest.high / other.high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_rounding_takes_is_kept() {
        assert_eq!(two_sum(1.0, 1e-17), (1.0, 1e-17));
        let (product, low) = two_product(1.0 + f64::EPSILON, 1.0 + f64::EPSILON);
        assert_eq!((product, low), (1.0 + 2.0 * f64::EPSILON, f64::EPSILON * f64::EPSILON));
        assert_eq!(advance(1e8, 1.0, -1e8 + 1e-7), 1e8 + (-1e8 + 1e-7));
    }

    #[test]
    fn roots_and_quotients_have_twice_the_digits() {
        let two = Twofold::from(2.0);
        let root = two.sqrt();
        let rest = root * root - two;
        assert!(rest.high.abs() < 1e-31, "{rest:?}");
        let third = Twofold::from(1.0) / Twofold::from(3.0);
        let rest = third * Twofold::from(3.0) - Twofold::from(1.0);
        assert!(rest.high.abs() < 1e-31, "{rest:?}");
    }
}
