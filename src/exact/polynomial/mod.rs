//! Polynomials. A formula of sums, differences and products is a polynomial along a line.
//!
//! A polynomial stands for all polynomials that differ from it by at most its error: a bound of the sum of the absolute
//! errors of the coefficients. For -1 <= s <= 1, this also bounds the error of the value.

mod coefficient;

use crate::interval::Interval;
use crate::scalar::Scalar;
use crate::spline::Spline;
pub use coefficient::Coefficient;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The number of coefficients that is enough for most polynomials, with degrees up to 12. In `f64`, a polynomial of
/// degree 12 takes 128 bytes, and compilers do not copy larger values inline.
pub const FEW: usize = 13;

/// The number of coefficients for degrees up to 21.
pub const SOME: usize = 22;

/// The maximum number of coefficients, for degrees up to 40. A product of a higher degree is unknown.
pub const MAX_COEFFICIENTS: usize = 41;

/// The factor that keeps a computed bound valid after up to eight rounded operations on positive numbers.
const ROUNDED_UP: f64 = 1.0 + 8.0 * f64::EPSILON;

/// A polynomial in s with at most `N` coefficients of type `C`.
#[derive(Clone, Copy, Debug)]
pub struct Polynomial<C = f64, const N: usize = FEW> {
    /// The coefficients of the powers of s from 0 on. Those above the degree are 0.
    coefficients: [C; N],
    degree: usize,
    /// A bound of the sum of the coefficients' absolute values.
    norm: f64,
    /// A bound of the sum of the coefficients' absolute errors, or infinity if nothing is known.
    error: f64,
}

impl<C: Coefficient, const N: usize> Polynomial<C, N> {
    /// Returns a polynomial about which nothing is known.
    pub fn unknown() -> Self {
        Self { norm: f64::INFINITY, ..Self::about(0.0, f64::INFINITY) }
    }

    /// Returns a constant that is known to within an error.
    pub fn number(value: C, error: f64) -> Self {
        let mut coefficients = [C::from(0.0); N];
        coefficients[0] = value;
        Self { coefficients, degree: 0, norm: value.nearest().abs() * ROUNDED_UP, error }
    }

    /// Returns a constant within bounds, or an unknown polynomial if they are infinite.
    pub fn enclosed(bounds: Interval<C::End>) -> Self {
        let (value, error) = C::about(bounds);
        if error < f64::INFINITY { Self::number(value, error) } else { Self::unknown() }
    }

    /// Returns the place on a piece of a line: its lower end at s = -1, and its upper end at s = 1. The result also
    /// stands for places that are off by up to eight times the rounding of the ends.
    pub fn along(piece: Interval) -> Self {
        let (low, high) = (C::from(0.5 * piece.low), C::from(0.5 * piece.high));
        let (middle, half) = (low + high, high - low);
        let mut place = Self::number(middle, 0.0);
        place.coefficients[1] = half;
        let norm = ROUNDED_UP * (middle.nearest().abs() + half.nearest().abs());
        Self { degree: 1, norm, error: 8.0 * C::ROUNDING * norm, ..place }
    }

    /// Returns the coefficients of the powers of s from 0 to the degree.
    pub fn coefficients(&self) -> &[C] {
        &self.coefficients[..=self.degree]
    }

    /// Returns a bound of the sum of the absolute errors of the coefficients, or infinity if nothing is known of the
    /// polynomial.
    pub fn error(&self) -> f64 {
        self.error
    }

    /// Returns the degree, or `None` if nothing is known of the polynomial.
    pub fn degree(&self) -> Option<usize> {
        self.error.is_finite().then_some(self.degree)
    }

    /// Returns the value and the slope at a place from -1 to 1.
    pub fn at(&self, s: C) -> [C; 2] {
        let (mut value, mut slope) = (C::from(0.0), C::from(0.0));
        for power in (0..=self.degree).rev() {
            (value, slope) = (value * s + self.coefficients[power], slope * s + value);
        }
        [value, slope]
    }

    /// Returns a bound of the error of the value from [`at`](Self::at), including rounding.
    pub fn error_at(&self) -> f64 {
        let steps = (self.degree + 1) as f64;
        ROUNDED_UP * (self.error + 2.0 * steps * C::ROUNDING * self.norm + steps * f64::MIN_POSITIVE)
    }

    /// Returns a bound of the distance of the slope from [`at`](Self::at) from that at any place at most `reach` from
    /// there, including rounding.
    pub fn slope_change(&self, reach: f64) -> f64 {
        let degree = self.degree as f64;
        // A derivative multiplies each coefficient by at most the degree.
        ROUNDED_UP * degree * (self.error_at() + ROUNDED_UP * degree * self.norm * reach)
    }

    /// Returns bounds of a constant, or `None` for any other polynomial.
    fn bounds(self) -> Option<Interval<C::End>> {
        let [at, error] = [self.coefficients[0].nearest(), self.error];
        let is_exact = error == 0.0 && C::from(at) == self.coefficients[0];
        let bounds = || if is_exact { Interval::constant(at) } else { self.coefficients[0].bounds(error) };
        (self.degree == 0 && error.is_finite()).then(bounds)
    }

    /// Applies a function to a constant. A function of any other polynomial is unknown.
    fn map(self, function: impl Fn(Interval<C::End>) -> Interval<C::End>) -> Self {
        self.bounds().map(function).map_or(Self::unknown(), Self::enclosed)
    }

    /// Adds a polynomial, times a sign that is 1 or -1.
    pub(crate) fn add_times(&mut self, other: &Self, sign: f64) {
        self.degree = self.degree.max(other.degree);
        // Plain loops are used because iterators are calls if crates are compiled in many parts.
        let others = other.coefficients();
        let sums = &mut self.coefficients[..others.len()];
        if sign < 0.0 {
            for power in 0..others.len() {
                sums[power] = sums[power] - others[power];
            }
        } else {
            for power in 0..others.len() {
                sums[power] = sums[power] + others[power];
            }
        }
        self.norm = norm(self.coefficients());
        self.error = ROUNDED_UP * (self.error + other.error + C::ROUNDING * self.norm);
    }

    /// Returns the product with another polynomial.
    pub(crate) fn times(&self, other: &Self) -> Self {
        let degree = self.degree + other.degree;
        if degree >= N {
            return Self::unknown();
        }
        let (short, long) = if self.degree < other.degree { (self, other) } else { (other, self) };
        let mut coefficients = [C::from(0.0); N];
        let factors = long.coefficients();
        for power in 0..=short.degree {
            let (of, sums) = (short.coefficients[power], &mut coefficients[power..][..factors.len()]);
            for index in 0..factors.len() {
                sums[index] = sums[index] + of * factors[index];
            }
        }
        // A coefficient is a sum of as many products as the polynomial of smaller degree has coefficients. Each product
        // and each sum is rounded by half a ROUNDING, or underflows below MIN_POSITIVE.
        let terms = (short.degree + 1) as f64;
        let product = ROUNDED_UP * self.norm * other.norm + f64::MIN_POSITIVE;
        let handed_on = self.error * (other.norm + other.error) + self.norm * other.error;
        let error = ROUNDED_UP * (handed_on + terms * C::ROUNDING * product + f64::MIN_POSITIVE);
        let (largest, norm) = (self.norm.max(other.norm).max(product), norm(&coefficients[..=degree]));
        // The comparisons are false for NaN, the result of infinite coefficients or errors.
        let is_known = error < f64::INFINITY && largest < C::LARGEST;
        Self { coefficients, degree, norm, error: if is_known { error } else { f64::INFINITY } }
    }

    /// Replaces the polynomial by a constant.
    pub(crate) fn set(&mut self, value: f64) {
        self.coefficients[..=self.degree].fill(C::from(0.0));
        self.coefficients[0] = C::from(value);
        (self.degree, self.norm, self.error) = (0, value.abs() * ROUNDED_UP, 0.0);
    }

    /// Multiplies by a constant.
    pub(crate) fn scale(&mut self, factor: f64) {
        for coefficient in &mut self.coefficients[..=self.degree] {
            *coefficient = *coefficient * C::from(factor);
        }
        self.norm = ROUNDED_UP * self.norm * factor.abs() + f64::MIN_POSITIVE;
        self.error = ROUNDED_UP * (self.error * factor.abs() + C::ROUNDING * self.norm + f64::MIN_POSITIVE);
        if self.norm.max(factor.abs()) >= C::LARGEST {
            self.error = f64::INFINITY;
        }
    }

    /// Adds a constant.
    pub(crate) fn shift(&mut self, by: f64) {
        self.coefficients[0] = self.coefficients[0] + C::from(by);
        self.norm = norm(self.coefficients());
        self.error = ROUNDED_UP * (self.error + C::ROUNDING * self.norm);
    }
}

/// Returns a bound of the sum of the absolute values of up to [`MAX_COEFFICIENTS`] rounded coefficients.
fn norm<C: Coefficient>(of: &[C]) -> f64 {
    const ROUNDED_UP: f64 = 1.0 + 64.0 * f64::EPSILON;
    let mut sum = 0.0;
    for coefficient in of {
        sum += coefficient.nearest().abs();
    }
    ROUNDED_UP * sum
}

impl<C: Coefficient, const N: usize> Add for Polynomial<C, N> {
    type Output = Self;

    fn add(mut self, other: Self) -> Self {
        self.add_times(&other, 1.0);
        self
    }
}

impl<C: Coefficient, const N: usize> Sub for Polynomial<C, N> {
    type Output = Self;

    fn sub(mut self, other: Self) -> Self {
        self.add_times(&other, -1.0);
        self
    }
}

impl<C: Coefficient, const N: usize> Mul for Polynomial<C, N> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        self.times(&other)
    }
}

impl<C: Coefficient, const N: usize> Div for Polynomial<C, N> {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        self.mul(other.map(|divisor| Interval::constant(1.0) / divisor))
    }
}

impl<C: Coefficient, const N: usize> Neg for Polynomial<C, N> {
    type Output = Self;

    fn neg(mut self) -> Self {
        for power in 0..=self.degree {
            self.coefficients[power] = -self.coefficients[power];
        }
        self
    }
}

/// Implements functions that are known of constants alone.
macro_rules! of_constants {
    ($($function:ident)+) => {$(
        fn $function(self) -> Self {
            self.map(Scalar::$function)
        }
    )+};
}

impl<C: Coefficient, const N: usize> Scalar for Polynomial<C, N> {
    of_constants!(tan exp ln sqrt abs floor step d_step d_floor);

    fn constant(value: f64) -> Self {
        Self::about(value, 0.0)
    }

    fn about(value: f64, error: f64) -> Self {
        Self::number(C::from(value), error)
    }

    fn sin_cos(self) -> (Self, Self) {
        (self.map(Scalar::sin), self.map(Scalar::cos))
    }

    fn atan2(self, x: Self) -> Self {
        x.bounds().map_or(Self::unknown(), |x| self.map(|y| y.atan2(x)))
    }

    fn max(self, other: Self) -> Self {
        other.bounds().map_or(Self::unknown(), |other| self.map(|value| value.max(other)))
    }

    fn pow(self, exponent: Self) -> Self {
        exponent.bounds().map_or(Self::unknown(), |exponent| self.map(|base| base.pow(exponent)))
    }

    fn powi(self, exponent: i32) -> Self {
        match exponent {
            0 => Self::constant(1.0),
            1 => self,
            2.. => {
                let half = self.powi(exponent / 2);
                if exponent % 2 == 0 { half * half } else { half * half * self }
            }
            _ => self.map(|base| base.powi(exponent)),
        }
    }

    fn scaled(mut self, factor: f64) -> Self {
        self.scale(factor);
        self
    }

    fn shifted(mut self, by: f64) -> Self {
        self.shift(by);
        self
    }

    fn spline(self, spline: &Spline, order: usize) -> Self {
        self.map(|at| at.spline(spline, order))
    }

    fn noise([x, y, z]: [Self; 3], orders: [u8; 3]) -> Self {
        match (y.bounds(), z.bounds()) {
            (Some(y), Some(z)) => x.map(|x| Interval::noise([x, y, z], orders)),
            _ => Self::unknown(),
        }
    }

    fn is_zero(self) -> bool {
        self.error == 0.0 && self.coefficients().iter().all(|coefficient| *coefficient == C::from(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interval::Wide;

    type Plain = Polynomial<f64, FEW>;

    /// Applies some operations to a place, in any number type.
    fn formula<N: Scalar>(at: N) -> N {
        let n = N::constant;
        let square = (at + n(0.3)) * at - n(1e-3);
        (square.powi(3) - n(7.0).sqrt() * at.powi(5)) / n(3.0) + (n(2.0) - at).powi(2) * square
            - n(0.1).max(n(0.2))
    }

    #[test]
    fn a_polynomial_is_no_farther_from_its_formula_than_its_error() {
        for piece in [(-1.0, 1.0), (0.7, 0.9), (1e3, 1e3 + 1.0), (-2e-9, 1e-9)] {
            let piece = Interval { low: piece.0, high: piece.1 };
            let polynomial = formula(Plain::along(piece));
            assert_eq!(polynomial.coefficients().len(), 7);
            for step in 0..=16 {
                let s = f64::from(step) / 8.0 - 1.0;
                let point = |value: f64| Wide::from(Interval { low: value, high: value });
                let at = point(piece.middle()) + point(0.5 * (piece.high - piece.low)) * point(s);
                let terms = polynomial.coefficients().iter().rev();
                let value = terms.fold(point(0.0), |sum, coefficient| sum * point(s) + point(*coefficient));
                let off = (value - formula(at)).coarse().magnitude();
                assert!(off <= polynomial.error(), "{off:e} above {:e} at {s}", polynomial.error());
                assert!(polynomial.error() < 1e-12 * polynomial.norm, "{:e}", polynomial.error());
            }
        }
    }

    #[test]
    fn what_is_no_polynomial_is_unknown() {
        let place = Plain::along(Interval { low: 1.0, high: 2.0 });
        for of in [place.sqrt(), place.sin(), place.max(Plain::constant(0.0)), Plain::constant(1.0) / place] {
            assert_eq!(of.error(), f64::INFINITY);
            assert_eq!((of * Plain::constant(0.0) + place).error(), f64::INFINITY);
        }
        assert_eq!(place.powi(12).coefficients().len(), 13);
        assert_eq!(place.powi(13).error(), f64::INFINITY);
    }
}
