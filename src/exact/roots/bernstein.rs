//! Polynomials in Bernstein form. Their coefficients bound them, and the signs of the coefficients tell the number of
//! roots.
//!
//! Source: G. Farin, Curves and Surfaces for CAGD, fifth edition, 2002, sections 5.1 and 6.4: the convex hull property,
//! subdivision at the middle, and variation diminution.

use super::newton;
use crate::dual::Dual;
use crate::polynomial::{Coefficient, FEW, MAX_COEFFICIENTS, Polynomial};
use crate::scalar::Scalar;

/// Coefficients of at most this many times their error count as hidden by rounding.
const HIDDEN: f64 = 2.0;

/// The binomial coefficients "n over k", by n and then by k.
pub(crate) static BINOMIALS: [[f64; MAX_COEFFICIENTS]; MAX_COEFFICIENTS] = {
    let mut of = [[0.0; MAX_COEFFICIENTS]; MAX_COEFFICIENTS];
    let mut n = 0;
    while n < MAX_COEFFICIENTS {
        of[n][0] = 1.0;
        let mut k = 1;
        while k <= n {
            of[n][k] = of[n - 1][k - 1] + of[n - 1][k];
            k += 1;
        }
        n += 1;
    }
    of
};

/// A polynomial on a piece of a line. It stands for all polynomials that differ from it by at most its error.
#[derive(Clone, Copy)]
pub struct Bernstein<C = f64, const N: usize = FEW> {
    coefficients: [C; N],
    degree: usize,
    /// A bound of the error of each coefficient.
    error: f64,
}

/// The roots on a piece, between its ends, as far as the coefficients tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Roots {
    /// There is no root.
    None,
    /// There is one root, where the sign changes, and the ends are not roots. The root is near this part of the piece,
    /// from 0 to 1.
    One {
        /// Whether the polynomial rises at the root.
        rises: bool,
        /// The part of the piece.
        near: f64,
    },
    /// The polynomial is monotonic, and has at most one root.
    Monotone {
        /// Whether the polynomial rises.
        rises: bool,
        /// The part of the piece, from 0 to 1, near which a root would be.
        near: f64,
    },
    /// Nothing is known, but shorter pieces would help.
    Unknown,
    /// Rounding hides the polynomial.
    Hidden,
}

impl<C: Coefficient, const N: usize> Bernstein<C, N> {
    /// Converts a polynomial for the piece with -1 <= s <= 1, or returns `None` if nothing is known of it.
    pub fn of(polynomial: &Polynomial<C, N>) -> Option<Self> {
        // A number that is not finite makes the error infinite or NaN.
        let is_known = polynomial.error() < f64::INFINITY;
        let (given, mut coefficients) = (polynomial.coefficients(), [C::from(0.0); N]);
        let degree = given.len() - 1;
        let mut norm = given[degree].nearest().abs();
        coefficients[0] = given[degree];
        // This is Horner's scheme, in powers of x = (1 + s) / 2 and 1 - x. The product with s = x - (1 - x) is of the
        // next degree, and so is a constant times a power of 1 = x + (1 - x).
        for step in 1..=degree {
            let (coefficient, binomials) = (given[degree - step], &BINOMIALS[step]);
            for index in (1..=step).rev() {
                let shifted = coefficients[index - 1] - coefficients[index];
                coefficients[index] = shifted + coefficient * C::from(binomials[index]);
            }
            coefficients[0] = coefficient - coefficients[0];
            norm += coefficient.nearest().abs();
        }
        for index in 0..=degree {
            coefficients[index] = coefficients[index] / C::from(BINOMIALS[degree][index]);
        }
        // A coefficient of degree n is a binomial times a mean of coefficients, and at most the norm. Each step rounds
        // three times, by half a ROUNDING.
        let rounding = 4.0 * C::ROUNDING * (degree + 1) as f64 * norm;
        let error = 1.001 * (polynomial.error() + rounding);
        is_known.then_some(Self { coefficients, degree, error })
    }

    /// Makes the form with these coefficients, which may be off by `error`. Returns `None` if that is not finite.
    pub(crate) fn known(coefficients: [C; N], degree: usize, error: f64) -> Option<Self> {
        (error < f64::INFINITY).then_some(Self { coefficients, degree, error })
    }

    /// Returns the coefficients.
    pub(crate) fn coefficients(&self) -> &[C] {
        &self.coefficients[..=self.degree]
    }

    /// Returns a bound of the error of the polynomial.
    pub fn error(&self) -> f64 {
        self.error
    }

    /// Returns the values at the ends of the piece.
    pub fn ends(&self) -> [C; 2] {
        [self.coefficients[0], self.coefficients[self.degree]]
    }

    /// Returns the forms for the lower and the upper half of the piece.
    pub fn halves(&self) -> [Self; 2] {
        let (mut lower, mut upper) = (*self, *self);
        let (degree, largest, half) = (self.degree, self.largest(), C::from(0.5));
        for step in 1..=degree {
            let row = &mut upper.coefficients[..degree - step + 2];
            for index in 0..row.len() - 1 {
                row[index] = half * (row[index] + row[index + 1]);
            }
            lower.coefficients[step] = row[0];
        }
        let error = self.error + C::ROUNDING * degree as f64 * largest;
        [Self { error, ..lower }, Self { error, ..upper }]
    }

    fn largest(&self) -> f64 {
        let mut largest = 0.0_f64;
        for coefficient in self.coefficients() {
            largest = largest.max(coefficient.nearest().abs());
        }
        largest
    }

    /// Returns the roots, as far as the coefficients tell.
    pub fn roots(&self) -> Roots {
        let (coefficients, error) = (self.coefficients(), self.error);
        let sign = |index: usize| {
            let of = coefficients[index].nearest();
            i32::from(of > error) - i32::from(of < -error)
        };
        let last = self.degree;
        let (start, end) = (sign(0), sign(last));
        let mut first_ones = 1;
        while first_ones <= last && sign(first_ones) == start {
            first_ones += 1;
        }
        if start != 0 && first_ones > last {
            return Roots::None;
        }
        if self.largest() <= HIDDEN * error {
            return Roots::Hidden;
        }
        let (low, high) = (coefficients[0].nearest(), coefficients[last].nearest());
        let (rises, near) = (low < high, low / (low - high));
        let mut last_ones = 1;
        while last_ones <= last && sign(last - last_ones) == end {
            last_ones += 1;
        }
        // A single coefficient between coefficients of opposite signs causes one sign change, whichever sign it has.
        if start * end < 0 && first_ones + last_ones >= last {
            return Roots::One { rises, near };
        }
        let mut is_monotone = true;
        for index in 0..last {
            let step = coefficients[index + 1].nearest() - coefficients[index].nearest();
            is_monotone &= (if rises { step } else { -step }) > 4.0 * error;
        }
        if is_monotone {
            return Roots::Monotone { rises, near };
        }
        Roots::Unknown
    }
}

/// The error of the place near a root, as a fraction of the piece.
const NEAR: f64 = 1e-9;

/// The maximum error of a known slope, as a fraction of the slope.
const STEEP: f64 = 1.0 / 262_144.0;

/// A place near a root.
#[derive(Clone, Copy, Debug)]
pub struct NearRoot {
    /// The place, from 0 to 1 on the piece, or on the line.
    pub place: f64,
    /// The computed slope there.
    pub slope: f64,
    /// Whether the slope is certainly approximately right.
    pub is_known: bool,
}

impl<const N: usize> Bernstein<f64, N> {
    /// Returns a place near the only root, from a guess.
    pub fn near_root(&self, rises: bool, guess: f64) -> NearRoot {
        let (n, binomials) = (self.degree, &BINOMIALS[self.degree]);
        let mut scaled = [0.0; N];
        for index in 0..=n {
            scaled[index] = self.coefficients[index] * binomials[index];
        }
        // With y = 1 - x, the polynomial is y^n q(x/y), or x^n q(y/x) from the other end. A Newton step does not need
        // the power.
        let at = |x: f64| {
            let (y, is_low) = (1.0 - x, x <= 0.5);
            let (own, other) = if is_low { (x, y) } else { (y, x) };
            let (part, mut value, mut slope) = (own / other, 0.0, 0.0);
            for index in (0..=n).rev() {
                (value, slope) =
                    (value * part + scaled[if is_low { index } else { n - index }], slope * part + value);
            }
            let slope = (slope - n as f64 * other * value) / (other * other);
            (Dual { value, slope: if is_low { slope } else { -slope } }, other)
        };
        let place = newton::root(|x| at(x).0, (0.0, 1.0), !rises, guess, NEAR);
        let (Dual { slope, .. }, other) = at(place);
        let slope = slope * Scalar::powi(other, n as i32);
        // The slope is n times a mean of the differences of coefficients.
        let is_known = 2.0 * n as f64 * self.error <= STEEP * slope.abs();
        NearRoot { place, slope, is_known }
    }

    /// Tells whether the polynomial is certainly nonzero within this part of the piece at either end.
    pub fn has_clear_ends(&self, part: f64) -> bool {
        let [start, end] = self.ends();
        // The slope is n times a mean of the differences of coefficients.
        let falls_by = 2.0 * self.degree as f64 * self.largest() * part;
        start.abs().min(end.abs()) > self.error + 1.001 * falls_by
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interval::Interval;

    /// Returns the form, from 0 to 1, of the polynomial with these roots that is positive far to the right.
    fn with_roots(roots: &[f64]) -> Bernstein {
        let place = Polynomial::<f64, FEW>::along(Interval { low: 0.0, high: 1.0 });
        let product = roots
            .iter()
            .fold(Polynomial::constant(1.0), |product, root| product * (place - Polynomial::constant(*root)));
        Bernstein::of(&product).expect("a polynomial")
    }

    #[test]
    fn coefficients_begin_and_end_with_the_values_at_the_ends() {
        let form = with_roots(&[0.25, 2.0, -1.0, 3.0]);
        let (start, end) = (form.coefficients[0], form.coefficients[form.degree]);
        assert!((start + 1.5).abs() < 1e-14 && (end - 3.0).abs() < 1e-14, "{start}, {end}");
        let [lower, upper] = form.halves();
        let middle: f64 = 0.25 * -1.5 * 1.5 * -2.5;
        assert!(
            (lower.coefficients[4] - middle).abs() < 1e-14 && (upper.coefficients[0] - middle).abs() < 1e-14
        );
    }

    #[test]
    fn a_root_and_its_slope_are_found_from_either_end() {
        for root in [0.01, 0.3, 0.5, 0.8, 0.999] {
            let NearRoot { place: near, slope, .. } = with_roots(&[root, 2.0, -1.0]).near_root(false, 0.5);
            let expected = (root - 2.0) * (root + 1.0);
            assert!((near - root).abs() < 1e-9 && (slope - expected).abs() < 1e-7, "{near}");
        }
    }

    #[test]
    fn roots_are_told_apart_by_halving() {
        assert_eq!(with_roots(&[1.5, -0.5]).roots(), Roots::None);
        assert!(matches!(with_roots(&[0.25, 1.5]).roots(), Roots::One { rises: false, .. }));
        let two = with_roots(&[0.25, 0.75]);
        assert_eq!(two.roots(), Roots::Unknown);
        let [lower, upper] = two.halves();
        assert!(matches!(lower.roots(), Roots::One { rises: false, .. }));
        assert!(matches!(upper.roots(), Roots::One { rises: true, .. }));
    }

    #[test]
    fn a_root_at_an_end_is_not_told() {
        assert!(matches!(with_roots(&[0.0, 3.0]).roots(), Roots::Monotone { rises: false, .. }));
        let [lower, upper] = with_roots(&[0.5]).halves();
        assert!(matches!(lower.roots(), Roots::Monotone { rises: true, .. }));
        assert!(matches!(upper.roots(), Roots::Monotone { rises: true, .. }));
    }

    #[test]
    fn a_double_root_is_not_told() {
        let mut form = with_roots(&[0.3, 0.3]);
        for _ in 0..40 {
            assert!(!matches!(form.roots(), Roots::One { .. }), "{:?}", form.roots());
            let [lower, upper] = form.halves();
            form = if matches!(lower.roots(), Roots::None) { upper } else { lower };
        }
        assert_eq!(form.roots(), Roots::Hidden);
    }
}
