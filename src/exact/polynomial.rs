//! Polynomials: what a formula is along a line, if it does nothing but add, subtract and multiply.
//!
//! A polynomial stands for all that differ from it by no more than its error, a bound of the sum of the absolute errors of
//! its coefficients. Where -1 <= s <= 1 this is a bound of the error of its value, too.

use crate::interval::Interval;
use crate::scalar::Scalar;
use crate::spline::Spline;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The highest degree; a product of a higher one is unknown. A polynomial of this degree takes 128 bytes, more than which
/// compilers do not copy inline.
pub(crate) const MAX_DEGREE: usize = 12;

/// What a bound is multiplied by, so that it is one although up to eight operations on numbers above 0 were rounded.
const ROUNDED_UP: f64 = 1.0 + 8.0 * f64::EPSILON;

/// A polynomial in s.
#[derive(Clone, Copy, Debug)]
pub struct Polynomial {
    /// The coefficients of the powers of s from 0 on; those above the degree are 0.
    coefficients: [f64; MAX_DEGREE + 1],
    degree: usize,
    /// A bound of the sum of the coefficients' absolute values.
    norm: f64,
    /// A bound of the sum of the coefficients' absolute errors; infinite if nothing is known.
    error: f64,
}

impl Polynomial {
    const UNKNOWN: Self =
        Self { coefficients: [0.0; MAX_DEGREE + 1], degree: 0, norm: f64::INFINITY, error: f64::INFINITY };

    /// Returns the place on a piece of a line: its lower end at s = -1, its upper end at s = 1. Stands also for places that
    /// are off by eight times the rounding of the ends.
    pub fn along(piece: Interval) -> Self {
        let (middle, half) = (piece.middle(), 0.5 * (piece.high - piece.low));
        let mut place = Self::constant(middle);
        place.coefficients[1] = half;
        let norm = ROUNDED_UP * (middle.abs() + half);
        Self { degree: 1, norm, error: 8.0 * f64::EPSILON * norm, ..place }
    }

    /// Returns the coefficients of the powers of s from 0 to the degree.
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients[..=self.degree]
    }

    /// Returns a bound of the sum of the absolute errors of the coefficients; infinite if nothing is known of the
    /// polynomial.
    pub fn error(&self) -> f64 {
        self.error
    }

    /// Returns bounds of a constant; `None` for any other polynomial.
    fn bounds(self) -> Option<Interval> {
        let [at, error] = [self.coefficients[0], self.error];
        let rounded = || Interval { low: (at - error).next_down(), high: (at + error).next_up() };
        let is_known = self.degree == 0 && error.is_finite();
        is_known.then(|| if error == 0.0 { Interval::constant(at) } else { rounded() })
    }

    /// Applies a function to a constant. A function of any other polynomial is unknown.
    fn map(self, function: impl Fn(Interval) -> Interval) -> Self {
        let Some(value) = self.bounds().map(function).filter(|value| value.is_bounded()) else {
            return Self::UNKNOWN;
        };
        Self::about(value.middle(), value.width())
    }

    /// Adds a polynomial, times a sign that is 1 or -1.
    fn plus(mut self, other: Self, sign: f64) -> Self {
        self.degree = self.degree.max(other.degree);
        for power in 0..=other.degree {
            self.coefficients[power] += sign * other.coefficients[power];
        }
        self.norm = ROUNDED_UP * (self.norm + other.norm);
        self.error = ROUNDED_UP * (self.error + other.error + f64::EPSILON * self.norm);
        self
    }
}

impl Add for Polynomial {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        self.plus(other, 1.0)
    }
}

impl Sub for Polynomial {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self.plus(other, -1.0)
    }
}

impl Mul for Polynomial {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let degree = self.degree + other.degree;
        if degree > MAX_DEGREE {
            return Self::UNKNOWN;
        }
        let mut coefficients = [0.0; MAX_DEGREE + 1];
        for power in 0..=self.degree {
            let sums = &mut coefficients[power..=power + other.degree];
            for (other_power, coefficient) in other.coefficients().iter().enumerate() {
                sums[other_power] += self.coefficients[power] * coefficient;
            }
        }
        // A coefficient is a sum of as many products as the smaller degree has powers: each product and each sum is rounded
        // by half an EPSILON, or vanishes below MIN_POSITIVE.
        let terms = (self.degree.min(other.degree) + 1) as f64;
        let norm = ROUNDED_UP * self.norm * other.norm + f64::MIN_POSITIVE;
        let handed_on = self.error * (other.norm + other.error) + self.norm * other.error;
        let error = ROUNDED_UP * (handed_on + terms * f64::EPSILON * norm + f64::MIN_POSITIVE);
        // Written so that a NaN, of infinite coefficients or errors, is unknown.
        if error < f64::INFINITY { Self { coefficients, degree, norm, error } } else { Self::UNKNOWN }
    }
}

impl Div for Polynomial {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        self.mul(other.map(|divisor| Interval::constant(1.0) / divisor))
    }
}

impl Neg for Polynomial {
    type Output = Self;

    fn neg(mut self) -> Self {
        for power in 0..=self.degree {
            self.coefficients[power] = -self.coefficients[power];
        }
        self
    }
}

impl Scalar for Polynomial {
    fn constant(value: f64) -> Self {
        Self::about(value, 0.0)
    }

    fn about(value: f64, error: f64) -> Self {
        let mut coefficients = [0.0; MAX_DEGREE + 1];
        coefficients[0] = value;
        Self { coefficients, degree: 0, norm: value.abs(), error }
    }

    fn sin_cos(self) -> (Self, Self) {
        (self.map(Scalar::sin), self.map(Scalar::cos))
    }

    fn tan(self) -> Self {
        self.map(Scalar::tan)
    }

    fn exp(self) -> Self {
        self.map(Scalar::exp)
    }

    fn ln(self) -> Self {
        self.map(Scalar::ln)
    }

    fn sqrt(self) -> Self {
        self.map(Scalar::sqrt)
    }

    fn abs(self) -> Self {
        self.map(Scalar::abs)
    }

    fn floor(self) -> Self {
        self.map(Scalar::floor)
    }

    fn max(self, other: Self) -> Self {
        other.bounds().map_or(Self::UNKNOWN, |other| self.map(|value| value.max(other)))
    }

    fn pow(self, exponent: Self) -> Self {
        exponent.bounds().map_or(Self::UNKNOWN, |exponent| self.map(|base| base.pow(exponent)))
    }

    fn powi(self, exponent: i32) -> Self {
        match exponent {
            0 => Self::constant(1.0),
            1.. => {
                let half = self.powi(exponent / 2);
                if exponent % 2 == 0 { half * half } else { half * half * self }
            }
            _ => self.map(|base| base.powi(exponent)),
        }
    }

    fn scaled(mut self, factor: f64) -> Self {
        for power in 0..=self.degree {
            self.coefficients[power] *= factor;
        }
        self.norm = ROUNDED_UP * self.norm * factor.abs() + f64::MIN_POSITIVE;
        self.error = ROUNDED_UP * (self.error * factor.abs() + f64::EPSILON * self.norm + f64::MIN_POSITIVE);
        self
    }

    fn shifted(mut self, by: f64) -> Self {
        self.coefficients[0] += by;
        self.norm = ROUNDED_UP * (self.norm + by.abs());
        self.error = ROUNDED_UP * (self.error + f64::EPSILON * self.norm);
        self
    }

    fn spline(self, spline: &Spline, order: usize) -> Self {
        self.map(|at| at.spline(spline, order))
    }

    fn step(self) -> Self {
        self.map(Scalar::step)
    }

    fn kink(self) -> Self {
        self.map(Scalar::kink)
    }

    fn jump(self) -> Self {
        self.map(Scalar::jump)
    }

    fn is_zero(self) -> bool {
        self.error == 0.0 && self.coefficients().iter().all(|coefficient| *coefficient == 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interval::Wide;

    /// Some operations on a place, in any number type.
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
            let polynomial = formula(Polynomial::along(piece));
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
        let place = Polynomial::along(Interval { low: 1.0, high: 2.0 });
        for of in [
            place.sqrt(),
            place.sin(),
            place.max(Polynomial::constant(0.0)),
            Polynomial::constant(1.0) / place,
        ] {
            assert_eq!(of.error(), f64::INFINITY);
            assert_eq!((of * Polynomial::constant(0.0) + place).error(), f64::INFINITY);
        }
        assert_eq!(place.powi(12).coefficients().len(), 13);
        assert_eq!(place.powi(13).error(), f64::INFINITY);
    }
}
