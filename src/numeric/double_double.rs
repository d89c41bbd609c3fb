//! Error-free transformations and double-double arithmetic (Dekker 1971, Knuth; Joldes et al. 2017).
//!
//! Nothing here uses a fused multiply-add, so the bits are the same on every machine.

mod elementary;
mod exact;

pub use exact::{Exact, exact_sum};

use std::ops::{Add, Div, Mul, Neg, Sub};

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
    /// Splits a number into its upper half of the digits and the rest.
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
/// difference is exact where it cancels, and rounded once where it does not.
#[inline(always)]
pub fn offset(start: f64, distance: f64, step: f64, from: f64) -> f64 {
    let (way, way_low) = two_product(distance, step);
    let (place, place_low) = two_sum(start, way);
    (place - from) + (way_low + place_low)
}

/// Computes the dot product of `a` and `b + b_low`, plus `small`, where `b_low` holds the rounding errors of `b`. The
/// result is rounded about once, and off by at most 2^-102 of the size of its terms however much of it cancels (Ogita,
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

/// Returns the exponent of the power of two that scales a magnitude to between 1/2 and 1; 0 for 0.
#[inline]
pub fn exponent_to_one(magnitude: f64) -> i32 {
    // Subnormal numbers are scaled as the smallest normal number is.
    let bits = magnitude.abs().max(f64::MIN_POSITIVE).to_bits() >> 52;
    if magnitude == 0.0 { 0 } else { 1022 - bits as i32 }
}

/// Returns a number times 2^`exponent`: exactly, unless the result is too small or too large for a normal number.
#[inline]
pub fn times_power_of_two(number: f64, exponent: i32) -> f64 {
    let half = exponent / 2;
    number * power_of_two(half) * power_of_two(exponent - half)
}

/// Returns 2^`exponent`; infinity or 0 where that is too large or too small.
#[inline]
fn power_of_two(exponent: i32) -> f64 {
    let is_normal = (-1022..=1023).contains(&exponent);
    if is_normal { f64::from_bits(((exponent + 1023) as u64) << 52) } else { 2_f64.powi(exponent) }
}

/// A double-double: the unevaluated sum of two numbers, of which the second is about 2^-53 of the first.
///
/// Holds for finite magnitudes below 1e290 whose products have magnitudes above 1e-290; outside that range, parts
/// overflow or underflow.
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

    /// Returns the square root; 0 below 0.
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

impl Add for DoubleDouble {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let (high, high_low) = two_sum(self.high, other.high);
        let (low, low_low) = two_sum(self.low, other.low);
        let Self { high, low } = Self::normal(high, high_low + low);
        Self::normal(high, low + low_low)
    }
}

impl Neg for DoubleDouble {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for DoubleDouble {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let (high, low) = two_product(self.high, other.high);
        Self::normal(high, low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for DoubleDouble {
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

/// Returns the dot product of two vectors.
#[inline(always)]
pub fn product(a: [DoubleDouble; 3], b: [DoubleDouble; 3]) -> DoubleDouble {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns the cross product of two vectors, each component rounded once however much of it cancels.
#[inline]
pub fn cross(a: [DoubleDouble; 3], b: [DoubleDouble; 3]) -> [DoubleDouble; 3] {
    quick_cross(a, b).unwrap_or_else(|| exact_cross(a, b))
}

/// Returns the cross product of two vectors whose components are plain numbers, where each component is exactly a
/// double-double, as it mostly is; else `None`.
#[inline]
fn quick_cross(a: [DoubleDouble; 3], b: [DoubleDouble; 3]) -> Option<[DoubleDouble; 3]> {
    let is_plain = |of: [DoubleDouble; 3]| (of[0].low == 0.0) & (of[1].low == 0.0) & (of[2].low == 0.0);
    if !is_plain(a) | !is_plain(b) {
        return None;
    }
    let (product, lost) = plain_cross([a[0].high, a[1].high, a[2].high], [b[0].high, b[1].high, b[2].high]);
    (lost == 0.0).then_some(product)
}

/// Returns the cross product of two vectors, and the sum of what its components lack, without signs: where that is 0,
/// each is exactly a double-double.
#[inline(always)]
pub fn plain_cross(a: [f64; 3], b: [f64; 3]) -> ([DoubleDouble; 3], f64) {
    let part = |one: usize, other: usize| {
        let (plus, plus_low) = two_product(a[one], b[other]);
        let (minus, minus_low) = two_product(-a[other], b[one]);
        let (sum, of_sum) = two_sum(plus, minus);
        let (lows, of_lows) = two_sum(plus_low, minus_low);
        let (low, of_low) = two_sum(of_sum, lows);
        let (high, low) = two_sum(sum, low);
        (DoubleDouble { high, low }, of_lows.abs() + of_low.abs())
    };
    let ((x, x_lost), (y, y_lost), (z, z_lost)) = (part(1, 2), part(2, 0), part(0, 1));
    ([x, y, z], x_lost + y_lost + z_lost)
}

#[inline(never)]
fn exact_cross(a: [DoubleDouble; 3], b: [DoubleDouble; 3]) -> [DoubleDouble; 3] {
    let parts = |of: DoubleDouble, with: DoubleDouble| {
        let pairs = [(of.high, with.high), (of.high, with.low), (of.low, with.high), (of.low, with.low)];
        pairs.into_iter().flat_map(|(one, other)| <[f64; 2]>::from(two_product(one, other)))
    };
    [(1, 2), (2, 0), (0, 1)].map(|(one, other)| {
        let (plus, minus) = (parts(a[one], b[other]), parts(-a[other], b[one]));
        exact_sum(plus.chain(minus))
    })
}

/// Returns the triple product of three vectors, rounded once: its sign tells their orientation, and it is 0 exactly
/// where they are coplanar.
pub fn triple_product(a: [DoubleDouble; 3], b: [DoubleDouble; 3], c: [f64; 3]) -> DoubleDouble {
    let parts = |of: DoubleDouble, with: DoubleDouble, factor: f64| {
        let pairs = [(of.high, with.high), (of.high, with.low), (of.low, with.high), (of.low, with.low)];
        let products = pairs.into_iter().flat_map(|(one, other)| <[f64; 2]>::from(two_product(one, other)));
        products.flat_map(move |product| <[f64; 2]>::from(two_product(product, factor)))
    };
    exact_sum([(1, 2, 0), (2, 0, 1), (0, 1, 2)].into_iter().flat_map(|(one, other, last)| {
        parts(a[one], b[other], c[last]).chain(parts(-a[other], b[one], c[last]))
    }))
}

/// Returns the unit vector along a vector whose components have magnitudes around 1.
pub fn unit(vector: [DoubleDouble; 3]) -> [DoubleDouble; 3] {
    let length = product(vector, vector).sqrt();
    vector.map(|part| part / length)
}

/// Returns the components of [`unit()`], each rounded to a plain number.
#[inline]
pub fn rounded_unit(vector: [DoubleDouble; 3]) -> [f64; 3] {
    let length = product(vector, vector).sqrt();
    let first = 1.0 / length.high;
    let rest = DoubleDouble::from(1.0) - length * DoubleDouble::from(first);
    let inverse = DoubleDouble::normal(first, rest.high * first);
    let rounded = |part: DoubleDouble| {
        let DoubleDouble { high, low } = part * inverse;
        // The product and the inverse are off by a few 2^-104, and so is the quotient: where so little does not change
        // how either is rounded, both are rounded to the same number.
        let error = power_of_two(-98) * high.abs();
        let is_certain = high + (low - error) == high && high + (low + error) == high;
        if is_certain && part.high.abs() > 1e-200 { high } else { (part / length).high }
    };
    [rounded(vector[0]), rounded(vector[1]), rounded(vector[2])]
}

/// Returns what [`rounded_unit`] does, without branches, and whether it is that.
#[inline(always)]
pub fn quick_unit(vector: [DoubleDouble; 3]) -> ([f64; 3], bool) {
    let square = product(vector, vector);
    let root = DoubleDouble::from(square.high.sqrt());
    let rest = square - root * root;
    let length = root + DoubleDouble::from(rest.high / (2.0 * root.high));
    let first = 1.0 / length.high;
    let rest = DoubleDouble::from(1.0) - length * DoubleDouble::from(first);
    let inverse = DoubleDouble::normal(first, rest.high * first);
    let rounded = |part: DoubleDouble| {
        let DoubleDouble { high, low } = part * inverse;
        let error = power_of_two(-98) * high.abs();
        let is_certain = (high + (low - error) == high) & (high + (low + error) == high);
        (high, is_certain & (part.high.abs() > 1e-200))
    };
    let ((x, is_x), (y, is_y), (z, is_z)) = (rounded(vector[0]), rounded(vector[1]), rounded(vector[2]));
    ([x, y, z], is_x & is_y & is_z & (square.high > 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_rounding_takes_is_kept() {
        assert_eq!(two_sum(1.0, 1e-17), (1.0, 1e-17));
        let (product, low) = two_product(1.0 + f64::EPSILON, 1.0 + f64::EPSILON);
        assert_eq!((product, low), (1.0 + 2.0 * f64::EPSILON, f64::EPSILON * f64::EPSILON));
    }

    /// Returns a pseudorandom number from -1 to 1, with zeros and few digits among them.
    fn random(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        let number = (*state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0;
        match *state >> 32 & 7 {
            0 => 0.0,
            1 => f64::from(number as f32),
            2 => 1e-9 * number,
            _ => number,
        }
    }

    #[test]
    fn quick_cross_products_are_the_exact_ones() {
        let (mut state, mut quick) = (1, 0);
        for _ in 0..10_000 {
            let a = [(); 3].map(|()| DoubleDouble::from(random(&mut state)));
            let mut b = [(); 3].map(|()| DoubleDouble::from(random(&mut state)));
            if state >> 40 & 1 == 0 {
                // Nearly all cancels.
                b = a.map(|part| DoubleDouble::from(3.0 * part.high));
            }
            if let Some(product) = quick_cross(a, b) {
                assert_eq!(product, exact_cross(a, b), "{a:?} x {b:?}");
                quick += 1;
            }
        }
        assert!(quick > 5000, "{quick}");
    }

    #[test]
    fn rounded_units_are_units_that_are_rounded() {
        let mut state = 7;
        for _ in 0..10_000 {
            let vector = [(); 3].map(|()| {
                let (high, low) = two_sum(random(&mut state), 1e-17 * random(&mut state));
                DoubleDouble { high, low }
            });
            if vector.iter().any(|part| part.high != 0.0) {
                assert_eq!(rounded_unit(vector), unit(vector).map(|part| part.high), "{vector:?}");
            }
        }
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
