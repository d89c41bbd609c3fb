//! Fractions of two 237-bit numbers, which stay exact as long as they fit.
//!
//! If a ray goes exactly through the edge of a tile, or starts exactly on a second surface, no interval decides,
//! however narrow it is. With the round numbers of scenes, such places are fractions with few digits. Their sums,
//! products, quotients and roots of squares are computed without rounding, and intervals of them have no width.

use super::float::Float;
use crate::double_double::power_of_two;
use f256::f256;
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The number of significant bits of an `f256`.
const BITS: u32 = 237;

/// A fraction, or a rounded number with a bound of its error.
#[derive(Clone, Copy, Debug)]
pub struct Fraction {
    numerator: f256,
    /// Positive, and 1 for a number that is infinite, NaN or rounded.
    denominator: f256,
    /// A bound of the difference from the exact result, or 0 for an exact number.
    error: f256,
}

/// Returns 2^-230, far more than the relative error of a few operations.
fn rounding() -> f256 {
    f256::from(power_of_two(-230))
}

impl Fraction {
    const fn whole(number: f256) -> Self {
        Self { numerator: number, denominator: f256::ONE, error: f256::ZERO }
    }

    /// Returns a rounded number. `size` is the sum of the magnitudes that it was computed from.
    fn rounded(number: f256, size: f256) -> Self {
        let error = rounding() * size.abs();
        let error = if Float::is_finite(error) { error } else { f256::ZERO };
        Self { numerator: number, denominator: f256::ONE, error }
    }

    /// Returns a quotient with a nonzero denominator, as an integer if it is one.
    fn quotient(numerator: f256, denominator: f256) -> Self {
        let (numerator, denominator) =
            if denominator < f256::ZERO { (-numerator, -denominator) } else { (numerator, denominator) };
        if numerator.eq_zero() {
            return Self::whole(f256::ZERO);
        }
        let whole = numerator / denominator;
        if product(whole, denominator).is_some_and(|product| product == numerator) {
            return Self::whole(whole);
        }
        Self { numerator, denominator, error: f256::ZERO }
    }

    /// Returns the value, rounded.
    fn value(self) -> f256 {
        if self.is_whole() { self.numerator } else { self.numerator / self.denominator }
    }

    /// Returns the nearest 237-bit numbers below and above, or the number itself.
    pub(super) fn neighbours(self) -> (f256, f256) {
        let value = self.value();
        if self.is_whole() { (value, value) } else { (value.next_down(), value.next_up()) }
    }

    /// Returns the numerator and the positive denominator, if the fraction is exact.
    pub(crate) fn exactly(self) -> Option<[f256; 2]> {
        let is_exact = self.error.eq_zero() && self.is_plain();
        is_exact.then_some([self.numerator, self.denominator])
    }

    fn is_whole(self) -> bool {
        self.denominator == f256::ONE
    }

    fn is_plain(self) -> bool {
        Float::is_finite(self.numerator)
    }

    /// Returns the sum, if it is exact.
    fn sum(self, other: Self) -> Option<Self> {
        if self.denominator == other.denominator {
            return Some(Self::quotient(sum(self.numerator, other.numerator)?, self.denominator));
        }
        let one = product(self.numerator, other.denominator)?;
        let two = product(other.numerator, self.denominator)?;
        Some(Self::quotient(sum(one, two)?, product(self.denominator, other.denominator)?))
    }

    /// Returns the result of a function outside of IEEE 754 for a rounded argument.
    fn about(result: f256, argument: Self) -> Self {
        if argument.is_whole() {
            return Self::whole(result);
        }
        // The slopes of these functions are at most the square of the result, plus 1.
        let one = f256::ONE;
        let slope = (one + argument.value().abs()) * (one + result * result);
        Self::rounded(result, f256::from(1024.0) * slope)
    }
}

/// Returns the number of significant bits.
fn bits(of: f256) -> u32 {
    let (_, _, (high, low)) = of.as_sign_exp_signif();
    if high != 0 { 256 - high.leading_zeros() } else { 128 - low.leading_zeros() }
}

/// Returns a product, if it is exact.
fn product(one: f256, other: f256) -> Option<f256> {
    if one.eq_zero() || other.eq_zero() {
        return Some(f256::ZERO);
    }
    let product = one * other;
    let is_exact = bits(one) + bits(other) <= BITS && Float::is_finite(product) && !product.eq_zero();
    is_exact.then_some(product)
}

/// Returns a sum, if it is exact.
fn sum(one: f256, other: f256) -> Option<f256> {
    let sum = one + other;
    // This is the rounding error of a sum (Knuth).
    let rest = sum - one;
    let error = (one - (sum - rest)) + (other - rest);
    (error.eq_zero() && Float::is_finite(sum)).then_some(sum)
}

impl PartialEq for Fraction {
    fn eq(&self, other: &Self) -> bool {
        self.partial_cmp(other) == Some(Ordering::Equal)
    }
}

/// Compares the fractions without their errors. Fractions that differ by a few roundings may compare equal.
impl PartialOrd for Fraction {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        if self.denominator == other.denominator {
            return self.numerator.partial_cmp(&other.numerator);
        }
        (self.numerator * other.denominator).partial_cmp(&(other.numerator * self.denominator))
    }
}

impl Add for Fraction {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        self.sum(other).unwrap_or_else(|| {
            let (one, other) = (self.value(), other.value());
            Self::rounded(one + other, one.abs() + other.abs())
        })
    }
}

impl Sub for Fraction {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Neg for Fraction {
    type Output = Self;

    fn neg(self) -> Self {
        Self { numerator: -self.numerator, ..self }
    }
}

impl Mul for Fraction {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let exact = || {
            let numerator = product(self.numerator, other.numerator)?;
            Some(Self::quotient(numerator, product(self.denominator, other.denominator)?))
        };
        if self.is_plain()
            && other.is_plain()
            && let Some(product) = exact()
        {
            return product;
        }
        let product = self.value() * other.value();
        Self::rounded(product, product)
    }
}

impl Div for Fraction {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let exact = || {
            let numerator = product(self.numerator, other.denominator)?;
            Some(Self::quotient(numerator, product(self.denominator, other.numerator)?))
        };
        if self.is_plain()
            && other.is_plain()
            && !other.numerator.eq_zero()
            && let Some(quotient) = exact()
        {
            return quotient;
        }
        let quotient = self.value() / other.value();
        Self::rounded(quotient, quotient)
    }
}

impl Float for Fraction {
    const IS_LONG: bool = true;
    const INFINITY: Self = Self::whole(f256::INFINITY);
    // Rounding changes pi by at most half of the last bit.
    const PI: Self = Self { error: f256::EPSILON, ..Self::whole(::f256::consts::PI) };
    const EPSILON: Self = Self::whole(f256::EPSILON);
    const MAX: Self = Self::whole(f256::MAX);

    fn of(value: f64) -> Self {
        Self::whole(value.into())
    }

    fn to_f64(self) -> f64 {
        self.value().to_f64()
    }

    fn is_double(self) -> bool {
        self.is_whole() && self.error.eq_zero() && f256::from(self.to_f64()) == self.numerator
    }

    fn outward(low: Self, high: Self) -> (Self, Self) {
        let below = |of: Self| match of.error.eq_zero() {
            true => of,
            false => Self::whole((of.value() - of.error).next_down()),
        };
        (below(low), -below(-high))
    }

    fn outward_sum(low: Self, high: Self) -> (Self, Self) {
        Self::outward(low, high)
    }

    /// Widens like [`f256`], in addition to the errors.
    fn around(low: Self, high: Self) -> (Self, Self) {
        let (low, high) = Self::outward(low, high);
        let (low, high) = <f256 as Float>::around(low.value().next_down(), high.value().next_up());
        (Self::whole(low), Self::whole(high))
    }

    fn product_ends(_: [Self; 2], _: [Self; 2]) -> Option<(Self, Self)> {
        None
    }

    fn enclosing(low: f256, high: f256) -> (Self, Self) {
        (low.into(), high.into())
    }

    fn sqrt(self) -> Self {
        let exact = |of: f256| {
            let root = of.sqrt();
            product(root, root).is_some_and(|square| square == of).then_some(root)
        };
        if self.is_plain()
            && let (Some(numerator), Some(denominator)) = (exact(self.numerator), exact(self.denominator))
        {
            return Self { numerator, denominator, error: f256::ZERO };
        }
        let root = self.value().sqrt();
        Self::rounded(root, root)
    }

    fn sines(angles: [Self; 2]) -> ([Self; 2], [Self; 2]) {
        let (sin, cos) = f256::sines(angles.map(Self::value));
        let about = |[one, other]: [f256; 2]| [Self::about(one, angles[0]), Self::about(other, angles[1])];
        (about(sin), about(cos))
    }

    fn tan(self) -> Self {
        Self::about(Float::tan(self.value()), self)
    }

    fn exp(self) -> Self {
        Self::about(Float::exp(self.value()), self)
    }

    fn ln(self) -> Self {
        // A relative error of the argument is an absolute error of the logarithm.
        let result = Float::ln(self.value());
        if self.is_whole() { Self::whole(result) } else { Self::rounded(result, f256::ONE + result.abs()) }
    }

    fn atan2(self, x: Self) -> Self {
        // A relative error of a coordinate is at most an absolute error of the angle.
        let angle = Float::atan2(self.value(), x.value());
        match self.is_whole() && x.is_whole() {
            true => Self::whole(angle),
            false => Self::rounded(angle, f256::from(1024.0)),
        }
    }

    fn floor(self) -> Self {
        if self.is_whole() {
            return Self::whole(Float::floor(self.numerator));
        }
        let floor = Float::floor(self.value());
        // The quotient may have been rounded up to an integer.
        let is_above = Self::whole(floor) > self;
        Self::whole(if is_above { floor - f256::ONE } else { floor })
    }

    fn abs(self) -> Self {
        Self { numerator: self.numerator.abs(), ..self }
    }

    fn is_finite(self) -> bool {
        self.is_plain()
    }

    /// Returns the number with the smaller lower bound.
    fn min(self, other: Self) -> Self {
        if other.is_nan() || !self.is_nan() && Self::outward(self, self).0 < Self::outward(other, other).0 {
            self
        } else {
            other
        }
    }

    /// Returns the number with the greater upper bound.
    fn max(self, other: Self) -> Self {
        if other.is_nan() || !self.is_nan() && Self::outward(self, self).1 > Self::outward(other, other).1 {
            self
        } else {
            other
        }
    }

    fn is_nan(self) -> bool {
        self.numerator.is_nan()
    }
}

impl From<f256> for Fraction {
    fn from(number: f256) -> Self {
        Self::whole(number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interval::{Interval, Wide};
    use crate::scalar::Scalar;
    use proptest::prelude::*;

    type Exact = Interval<Fraction>;

    fn is_exactly(of: Exact, numerator: f64, denominator: f64) -> bool {
        of.low == of.high && (of * Exact::constant(denominator) - Exact::constant(numerator)).is_zero()
    }

    #[test]
    fn fractions_of_few_digits_are_exact() {
        let n = Exact::constant;
        // A ray through row 58 of 120 hits the floor here, at the edge of a tile.
        let dir = n(58.0) / n(119.0) * n(6.0) - n(3.0);
        let place = n(6.0) - n(-3.0) / dir * n(-6.0) * n(-1.0);
        assert!(is_exactly(place, -232.0, 1.0), "{place:?}");
        assert!(is_exactly(n(1.0) / n(3.0) + n(1.0) / n(6.0), 1.0, 2.0));
        assert!(is_exactly((n(4.0) / n(9.0)).sqrt(), 2.0, 3.0));
        assert!(is_exactly(n(0.1) * n(0.1) / n(0.1), 0.1, 1.0));
        assert_eq!((n(-7.0) / n(3.0)).certain_floor(), Some(-3.0));
    }

    #[test]
    fn a_fraction_just_below_a_whole_number_has_its_floor_below() {
        let n = Exact::constant;
        let tiny = n(2_f64.powi(-200));
        let below = (n(3.0) - tiny * tiny) / n(1.0) - tiny / n(3.0);
        assert_eq!(below.certain_floor(), Some(2.0), "{below:?}");
    }

    proptest! {
        #![proptest_config(crate::properties())]

        /// Fractions that no longer fit are enclosed like 237-bit numbers.
        #[test]
        fn fractions_and_wide_numbers_enclose_the_same(a in -1e3..1e3, b in 0.1..1e3, c in 1e-6..1e3, power in -60..20) {
            fn term<N: Scalar>(a: f64, b: f64, c: f64, power: i32) -> N {
                let [a, b, c] = [a, b, c].map(N::constant);
                let scale = N::constant(2_f64.powi(power));
                let mixed = (a / b - c * scale) * (b / (c + b) + a.abs().sqrt()) / (a * a + b) - a / c;
                mixed.sin() + mixed.abs().sqrt() * (b + c.abs()).ln()
            }
            let (fraction, wide) = (term::<Exact>(a, b, c, power), term::<Wide>(a, b, c, power));
            let found = fraction.wide();
            prop_assert!(found.low <= wide.high && wide.low <= found.high, "{:?} {:?}", found, wide);
            let width = found.width() / (f256::ONE + found.magnitude());
            prop_assert!(width < f256::from(1e-45), "{:?} {:?}", found, width);
        }
    }
}
