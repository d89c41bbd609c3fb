//! Polynomials in Bernstein form: their coefficients there bound them, and their signs tell how many roots they have.
//!
//! Source: G. Farin, Curves and Surfaces for CAGD, fifth edition, 2002, sections 5.1 and 6.4: the convex hull property,
//! subdivision at the middle, and variation diminution.

use crate::polynomial::{MAX_DEGREE, Polynomial};

/// Coefficients that are not above this many times their error are taken to be hidden by rounding.
const HIDDEN: f64 = 64.0;

/// A polynomial on a piece of a line, and all that differ from it by at most its error.
#[derive(Clone, Copy)]
pub struct Bernstein {
    coefficients: [f64; MAX_DEGREE + 1],
    degree: usize,
    /// A bound of the error of each coefficient.
    error: f64,
}

/// What the coefficients tell of the roots on a piece, between its ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Roots {
    /// There is none.
    None,
    /// There is one, at which the sign changes, and the ends are no roots. It is near this part of the piece, from 0 to 1.
    One {
        /// Whether the polynomial rises there.
        rises: bool,
        /// The part of the piece.
        near: f64,
    },
    /// The polynomial is monotone: there is at most one.
    Monotone {
        /// Whether the polynomial rises.
        rises: bool,
        /// The part of the piece near which the root would be, from 0 to 1.
        near: f64,
    },
    /// Nothing is known, but would be of shorter pieces.
    Unknown,
    /// Rounding hides the polynomial.
    Hidden,
}

impl Bernstein {
    /// Converts a polynomial for the piece with -1 <= s <= 1; `None` if nothing is known of it.
    pub fn of(polynomial: &Polynomial) -> Option<Self> {
        // A number that is not finite makes this infinite, or NaN.
        let is_known = polynomial.error() < f64::INFINITY;
        let (given, mut coefficients) = (polynomial.coefficients(), [0.0; MAX_DEGREE + 1]);
        let degree = given.len() - 1;
        let mut norm = given[degree].abs();
        coefficients[0] = given[degree];
        // Horner's scheme: the product with s, whose own coefficients are -1 and 1, is of the next degree.
        for (step, coefficient) in given[..degree].iter().rev().enumerate() {
            let next = (step + 1) as f64;
            for index in (0..=step + 1).rev() {
                let upper = index as f64;
                let (before, here) =
                    (if index > 0 { coefficients[index - 1] } else { 0.0 }, coefficients[index]);
                coefficients[index] = (upper * before - (next - upper) * here) / next + coefficient;
            }
            norm += coefficient.abs();
        }
        // Means of coefficients with these weights are no larger than these. Each step rounds four times, by half an EPSILON.
        let rounding = 4.0 * f64::EPSILON * degree as f64 * norm;
        is_known.then_some(Self { coefficients, degree, error: polynomial.error() + rounding })
    }

    fn coefficients(&self) -> &[f64] {
        &self.coefficients[..=self.degree]
    }

    /// Returns the forms for the lower and the upper half of the piece.
    pub fn halves(&self) -> [Self; 2] {
        let (mut lower, mut upper) = (*self, *self);
        let (degree, largest) = (self.degree, self.largest());
        for step in 1..=degree {
            for index in 0..=degree - step {
                upper.coefficients[index] = 0.5 * (upper.coefficients[index] + upper.coefficients[index + 1]);
            }
            lower.coefficients[step] = upper.coefficients[0];
        }
        let error = self.error + f64::EPSILON * degree as f64 * largest;
        [Self { error, ..lower }, Self { error, ..upper }]
    }

    fn largest(&self) -> f64 {
        let mut largest = 0.0_f64;
        for coefficient in self.coefficients() {
            largest = largest.max(coefficient.abs());
        }
        largest
    }

    /// Tells what is known of the roots.
    pub fn roots(&self) -> Roots {
        let (coefficients, error) = (self.coefficients(), self.error);
        let sign = |value: f64| i32::from(value > error) - i32::from(value < -error);
        let (start, end) = (coefficients[0], coefficients[self.degree]);
        let first_ones = coefficients.iter().take_while(|value| sign(**value) == sign(start)).count();
        if sign(start) != 0 && first_ones == coefficients.len() {
            return Roots::None;
        }
        if self.largest() <= HIDDEN * error {
            return Roots::Hidden;
        }
        let (rises, near) = (start < end, start / (start - end));
        let last_ones = coefficients.iter().rev().take_while(|value| sign(**value) == sign(end)).count();
        // Whichever sign a single coefficient has between those of either sign, signs change once.
        if sign(start) * sign(end) < 0 && first_ones + last_ones + 1 >= coefficients.len() {
            return Roots::One { rises, near };
        }
        let step = |pair: &[f64]| if rises { pair[1] - pair[0] } else { pair[0] - pair[1] };
        if coefficients.windows(2).all(|pair| step(pair) > 4.0 * error) {
            return Roots::Monotone { rises, near };
        }
        Roots::Unknown
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interval::Interval;
    use crate::scalar::Scalar;

    /// Returns the form, from 0 to 1, of the polynomial with these roots that is above 0 far to the right.
    fn with_roots(roots: &[f64]) -> Bernstein {
        let place = Polynomial::along(Interval { low: 0.0, high: 1.0 });
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
