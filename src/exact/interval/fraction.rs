//! Fractions of two 237-bit numbers, which stay exact as long as they fit.
//!
//! If a ray goes exactly through the edge of a tile, or starts exactly on a second surface, no interval decides,
//! however narrow it is. With the round numbers of scenes, such places are fractions with few digits. Their sums,
//! products, quotients and roots of squares are computed without rounding, and intervals of them have no width.

use super::float::Float;
use super::octuple;
use f256::f256;
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The number of significant bits of an `f256`.
const BITS: u32 = 237;

/// The number of bits of the exponent.
const EXPONENT_BITS: u32 = 19;

/// The number that is added to an exponent where it is stored.
const BIAS: i32 = (1 << (EXPONENT_BITS - 1)) - 1;

/// The most bits of a numerator and of a denominator. A number with more was most likely rounded before, and then only the
/// time of fractions would be left.
const KEPT: u32 = BITS - 8;

/// The exponent of a bound of the relative error of a few operations, which is far more than that.
const ROUNDING: i32 = -230;

/// A number of 237 bits, or a fraction of two such numbers.
#[derive(Clone, Copy, Debug)]
pub struct Fraction {
    numerator: f256,
    /// Positive, and 1 for a number that is infinite, NaN or rounded.
    denominator: f256,
    error: Error,
}

/// A bound of the difference of a number from the exact result.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Error {
    /// The number is exact.
    None,
    /// The number is at most one step from the result.
    Step,
    /// The number differs from the result by at most 2 to this power.
    Power(i32),
}

impl Fraction {
    const fn whole(number: f256) -> Self {
        Self { numerator: number, denominator: f256::ONE, error: Error::None }
    }

    /// Returns the rounded result of one operation on numbers that are no fractions.
    fn stepped(number: f256, is_exact: bool) -> Self {
        let error = if is_exact { Error::None } else { Error::Step };
        Self { error, ..Self::whole(number) }
    }

    /// Returns a rounded number. `size` is at least the sum of the magnitudes that it was computed from.
    fn rounded(number: f256, size: f256) -> Self {
        if !size.is_finite() {
            return Self::whole(number);
        }
        Self { error: Error::Power(exponent(size) + 1 + ROUNDING), ..Self::whole(number) }
    }

    /// Returns a quotient with a nonzero denominator: an integer if it is one, and a fraction if that has few digits.
    fn quotient(numerator: f256, denominator: f256) -> Self {
        if numerator.eq_zero() {
            return Self::whole(f256::ZERO);
        }
        let whole = numerator / denominator;
        if product(whole, denominator).is_some_and(|product| product == numerator) {
            return Self::whole(whole);
        }
        if bits(numerator) > KEPT || bits(denominator) > KEPT {
            return Self::stepped(whole, false);
        }
        let (numerator, denominator) =
            if denominator < f256::ZERO { (-numerator, -denominator) } else { (numerator, denominator) };
        Self { numerator, denominator, error: Error::None }
    }

    /// Returns the value, rounded.
    pub(crate) fn value(self) -> f256 {
        if self.is_whole() { self.numerator } else { self.numerator / self.denominator }
    }

    /// Returns the nearest 237-bit numbers below and above, or the number itself.
    pub(super) fn neighbours(self) -> (f256, f256) {
        let value = self.value();
        if self.is_whole() { (value, value) } else { (value.next_down(), value.next_up()) }
    }

    /// Returns the numerator and the positive denominator, if the fraction is exact.
    pub(crate) fn exactly(self) -> Option<[f256; 2]> {
        let is_exact = self.error == Error::None && self.is_plain();
        is_exact.then_some([self.numerator, self.denominator])
    }

    #[inline]
    fn is_whole(self) -> bool {
        self.denominator.to_bits() == f256::ONE.to_bits()
    }

    #[inline]
    fn is_plain(self) -> bool {
        self.numerator.is_finite()
    }

    /// Returns a number at most as large as the exact result.
    #[inline]
    fn below(self) -> Self {
        match self.error {
            Error::None => self,
            Error::Step => Self::whole(self.numerator.next_down()),
            Error::Power(power) => Self::whole((self.numerator - power_of_two(power)).next_down()),
        }
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

/// Returns the exponent of the first bit of a finite number; of 0 and of tiny numbers, one that is not larger than that
/// of any other number.
#[inline]
fn exponent(of: f256) -> i32 {
    ((of.to_bits().0 << 1) >> (u128::BITS - EXPONENT_BITS)) as i32 - BIAS
}

/// Tells whether a number is neither 0 nor infinite nor so tiny that it has fewer bits.
#[inline]
fn is_normal(of: f256) -> bool {
    (1 - BIAS..=BIAS).contains(&exponent(of))
}

/// Returns 2 to a power, or the least normal number.
fn power_of_two(power: i32) -> f256 {
    let stored = (power + BIAS).clamp(1, 2 * BIAS);
    f256::from_bits(((stored as u128) << (u128::BITS - 1 - EXPONENT_BITS), 0))
}

/// Returns the number of significant bits of a normal number.
#[inline]
fn bits(of: f256) -> u32 {
    let (high, low) = of.to_bits();
    let first = 1 << (u128::BITS - 1 - EXPONENT_BITS);
    let zeros = if low == 0 { u128::BITS + (high | first).trailing_zeros() } else { low.trailing_zeros() };
    BITS - zeros
}

/// Tells whether a product is exact.
#[inline]
fn is_exact_product(one: f256, other: f256, product: f256) -> bool {
    if one.eq_zero() || other.eq_zero() {
        return true;
    }
    is_normal(one) && is_normal(other) && is_normal(product) && bits(one) + bits(other) <= BITS
}

/// Tells whether a sum is exact.
#[inline]
fn is_exact_sum(one: f256, other: f256, sum: f256) -> bool {
    if one.eq_zero() || other.eq_zero() || sum.eq_zero() {
        return true;
    }
    let last = |of: f256| exponent(of) - bits(of) as i32;
    // The sum has all bits from its first one to the last one of both.
    is_normal(one)
        && is_normal(other)
        && is_normal(sum)
        && exponent(sum) - last(one).min(last(other)) <= BITS as i32
}

/// Returns a product, if it is exact.
fn product(one: f256, other: f256) -> Option<f256> {
    let product = one * other;
    (product.is_finite() && is_exact_product(one, other, product)).then_some(product)
}

/// Returns a sum, if it is exact.
fn sum(one: f256, other: f256) -> Option<f256> {
    let sum = one + other;
    (sum.is_finite() && is_exact_sum(one, other, sum)).then_some(sum)
}

impl PartialEq for Fraction {
    fn eq(&self, other: &Self) -> bool {
        self.partial_cmp(other) == Some(Ordering::Equal)
    }
}

/// Compares the fractions without their errors. Fractions that differ by a few roundings may compare equal.
impl PartialOrd for Fraction {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        if self.denominator.to_bits() == other.denominator.to_bits() {
            return self.numerator.partial_cmp(&other.numerator);
        }
        (self.numerator * other.denominator).partial_cmp(&(other.numerator * self.denominator))
    }
}

impl Add for Fraction {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        if self.is_whole() && other.is_whole() {
            let (one, other) = (self.numerator, other.numerator);
            let sum = one + other;
            return Self::stepped(sum, is_exact_sum(one, other, sum));
        }
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
        if self.is_whole() && other.is_whole() {
            let (one, other) = (self.numerator, other.numerator);
            let product = one * other;
            return Self::stepped(product, is_exact_product(one, other, product));
        }
        let exact = || {
            let numerator = product(self.numerator, other.numerator)?;
            Some(Self::quotient(numerator, product(self.denominator, other.denominator)?))
        };
        exact().unwrap_or_else(|| {
            let product = self.value() * other.value();
            Self::rounded(product, product)
        })
    }
}

impl Div for Fraction {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        if !self.is_plain() || !is_normal(other.numerator) {
            return Self::stepped(self.value() / other.value(), false);
        }
        if self.is_whole() && other.is_whole() {
            return Self::quotient(self.numerator, other.numerator);
        }
        let exact = || {
            let numerator = product(self.numerator, other.denominator)?;
            Some(Self::quotient(numerator, product(self.denominator, other.numerator)?))
        };
        exact().unwrap_or_else(|| {
            let quotient = self.value() / other.value();
            Self::rounded(quotient, quotient)
        })
    }
}

impl Float for Fraction {
    const IS_LONG: bool = true;
    const INFINITY: Self = Self::whole(f256::INFINITY);
    const PI: Self = Self { error: Error::Step, ..Self::whole(::f256::consts::PI) };
    const EPSILON: Self = Self::whole(f256::EPSILON);
    const MAX: Self = Self::whole(f256::MAX);

    fn of(value: f64) -> Self {
        Self::whole(value.into())
    }

    fn to_f64(self) -> f64 {
        octuple::to_f64(self.value())
    }

    fn is_double(self) -> bool {
        self.is_whole() && self.error == Error::None && f256::from(self.to_f64()) == self.numerator
    }

    fn outward(low: Self, high: Self) -> (Self, Self) {
        (low.below(), -(-high).below())
    }

    fn outward_sum(low: Self, high: Self) -> (Self, Self) {
        Self::outward(low, high)
    }

    /// Widens like [`f256`], in addition to the errors.
    fn around(low: Self, high: Self) -> (Self, Self) {
        let (low, high) = Self::outward(low, high);
        let (low, high) = octuple::around(low.neighbours().0, high.neighbours().1);
        (Self::whole(low), Self::whole(high))
    }

    fn enclosing(low: f256, high: f256) -> (Self, Self) {
        (low.into(), high.into())
    }

    fn sqrt(self) -> Self {
        let exact = |of: f256| {
            let root = of.sqrt();
            product(root, root).is_some_and(|square| square == of).then_some(root)
        };
        if self.is_whole() {
            let root = self.numerator.sqrt();
            return Self::stepped(root, product(root, root).is_some_and(|square| square == self.numerator));
        }
        if let (Some(numerator), Some(denominator)) = (exact(self.numerator), exact(self.denominator)) {
            return Self { numerator, denominator, error: Error::None };
        }
        let root = self.value().sqrt();
        Self::rounded(root, root)
    }

    fn sines(angles: [Self; 2]) -> ([Self; 2], [Self; 2]) {
        let (sin, cos) = octuple::sines(angles.map(Self::value));
        let about = |[one, other]: [f256; 2]| [Self::about(one, angles[0]), Self::about(other, angles[1])];
        (about(sin), about(cos))
    }

    fn tan(self) -> Self {
        Self::about(octuple::tan(self.value()), self)
    }

    fn exp(self) -> Self {
        Self::about(self.value().exp(), self)
    }

    fn ln(self) -> Self {
        // A relative error of the argument is an absolute error of the logarithm.
        let result = octuple::ln(self.value());
        if self.is_whole() { Self::whole(result) } else { Self::rounded(result, f256::ONE + result.abs()) }
    }

    fn exps(low: Self, high: Self) -> (Self, Self) {
        if low.is_whole() && high.is_whole() {
            let (low, high) = octuple::exps(low.numerator, high.numerator);
            return (Self::whole(low), Self::whole(high));
        }
        (low.exp(), high.exp())
    }

    fn lns(low: Self, high: Self) -> (Self, Self) {
        if low.is_whole() && high.is_whole() {
            let (low, high) = octuple::lns(low.numerator, high.numerator);
            return (Self::whole(low), Self::whole(high));
        }
        (low.ln(), high.ln())
    }

    fn atan2(self, x: Self) -> Self {
        // A relative error of a coordinate is at most an absolute error of the angle.
        let angle = octuple::atan2(self.value(), x.value());
        match self.is_whole() && x.is_whole() {
            true => Self::whole(angle),
            false => Self::rounded(angle, f256::from(1024.0)),
        }
    }

    fn floor(self) -> Self {
        if self.is_whole() {
            return Self::whole(self.numerator.floor());
        }
        let floor = self.value().floor();
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
        if other.is_nan() || !self.is_nan() && self.below() < other.below() { self } else { other }
    }

    /// Returns the number with the greater upper bound.
    fn max(self, other: Self) -> Self {
        -(-self).min(-other)
    }

    fn is_nan(self) -> bool {
        self.numerator.is_nan()
    }

    /// Looks at the bits, which takes a fraction of the time of a comparison.
    #[inline]
    fn is_positive(self) -> bool {
        self.numerator.is_sign_positive() && !self.numerator.eq_zero() && !self.numerator.is_nan()
    }
}

impl From<f64> for Fraction {
    fn from(number: f64) -> Self {
        Self::whole(number.into())
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
    use crate::interval::{Interval, Wide as Exact};
    use crate::roots::whole::Dyadic;
    use crate::scalar::Scalar;
    use dashu_int::IBig;
    use proptest::prelude::*;

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

    /// An exact quotient.
    #[derive(Clone, Debug)]
    struct Quotient([Dyadic; 2]);

    impl Quotient {
        /// Tells whether the quotient is at least a number.
        fn is_at_least(&self, number: Fraction) -> bool {
            let [numerator, denominator] = [number.numerator, number.denominator].map(Dyadic::from);
            let Self([above, below]) = self;
            let apart = above.times(&denominator).plus(&below.times(&numerator).negated());
            apart.times(below).digits >= IBig::ZERO
        }

        fn negated(&self) -> Self {
            let Self([above, below]) = self;
            Self([above.negated(), below.clone()])
        }
    }

    proptest! {
        #![proptest_config(crate::properties())]

        /// Sums, differences, products and quotients in any order, of numbers of few and of many digits.
        #[test]
        fn operations_enclose_the_exact_results(
            terms in prop::collection::vec((0..4, prop_oneof![-9.0..9.0, (-9..9).prop_map(f64::from)], -60..20), 1..12),
        ) {
            let (mut found, mut right) = (Exact::constant(1.0), Quotient([1.0, 1.0].map(Dyadic::from)));
            for (operation, number, power) in terms {
                let number = number * 2_f64.powi(power);
                let (other, exact) = (Exact::constant(number), Dyadic::from(number));
                let Quotient([above, below]) = right;
                let moved = |by: Dyadic| Quotient([above.plus(&below.times(&by)), below.clone()]);
                (found, right) = match operation {
                    0 => (found + other, moved(exact)),
                    1 => (found - other, moved(exact.negated())),
                    2 => (found * other, Quotient([above.times(&exact), below])),
                    _ if number != 0.0 => (found / other, Quotient([above, below.times(&exact)])),
                    _ => (other / found, Quotient([Dyadic::from(0.0), Dyadic::from(1.0)])),
                };
                prop_assert!(right.is_at_least(found.low), "{:?} {:?}", found, right);
                prop_assert!(right.negated().is_at_least(-found.high), "{:?} {:?}", found, right);
                if found.is_bounded() {
                    let width = found.width().to_f64();
                    prop_assert!(width <= 1e-60 * (1.0 + found.magnitude().to_f64()), "{:?}", found);
                }
                if found.has_zero() {
                    break;
                }
            }
        }

        #[test]
        fn functions_of_fractions_enclose_those_of_53_bits(a in -1e3..1e3, b in 0.1..1e3, c in 1e-6..1e3, power in -60..20) {
            fn term<N: Scalar>(a: f64, b: f64, c: f64, power: i32) -> N {
                let [a, b, c] = [a, b, c].map(N::constant);
                let scale = N::constant(2_f64.powi(power));
                let mixed = (a / b - c * scale) * (b / (c + b) + a.abs().sqrt()) / (a * a + b) - a / c;
                mixed.sin() + mixed.abs().sqrt() * (b + c.abs()).ln()
            }
            let (fraction, coarse) = (term::<Exact>(a, b, c, power), term::<Interval>(a, b, c, power));
            prop_assert!(coarse.low <= fraction.low.to_f64() && fraction.high.to_f64() <= coarse.high);
            let width = fraction.width().to_f64() / (1.0 + fraction.magnitude().to_f64());
            prop_assert!(width < 1e-45, "{:?}", fraction);
        }
    }
}
