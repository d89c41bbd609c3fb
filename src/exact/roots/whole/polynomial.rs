//! Polynomials with integer coefficients.

use super::dyadic::Dyadic;
use dashu_int::{IBig, Sign};

/// A polynomial with integer coefficients.
#[derive(Clone, Debug)]
pub struct Whole {
    /// The coefficients of the powers from 0 on. The last one is nonzero, except for the polynomial 0.
    pub(super) coefficients: Vec<IBig>,
}

impl Whole {
    /// Makes a polynomial from the coefficients of the powers from 0 on.
    pub fn new(mut coefficients: Vec<IBig>) -> Self {
        while coefficients.len() > 1 && coefficients.last().is_some_and(IBig::is_zero) {
            coefficients.pop();
        }
        Self { coefficients }
    }

    /// Returns the coefficients of the powers from 0 on.
    pub fn coefficients(&self) -> &[IBig] {
        &self.coefficients
    }

    /// Returns the degree, or 0 for the polynomial 0.
    pub fn degree(&self) -> usize {
        self.coefficients.len() - 1
    }

    /// Returns whether this is the polynomial 0.
    pub fn is_zero(&self) -> bool {
        self.coefficients.iter().all(IBig::is_zero)
    }

    /// Returns the sign at a place: 1, 0 or -1.
    pub fn sign_at(&self, place: &Dyadic) -> i32 {
        let mut sum = IBig::ZERO;
        let up = place.exponent.max(0) as usize;
        let down = (-place.exponent).max(0) as usize;
        let at = &place.digits << up;
        for (step, coefficient) in self.coefficients.iter().rev().enumerate() {
            sum = sum * &at + (coefficient << (down * step));
        }
        sign(&sum)
    }

    /// Returns the derivative.
    pub fn derivative(&self) -> Self {
        let slopes = self.coefficients.iter().enumerate().skip(1).map(|(power, of)| of * IBig::from(power));
        let slopes: Vec<_> = slopes.collect();
        Self::new(if slopes.is_empty() { vec![IBig::ZERO] } else { slopes })
    }
}

/// Returns the sign of an integer: 1, 0 or -1.
pub(super) fn sign(of: &IBig) -> i32 {
    match of.sign() {
        _ if of.is_zero() => 0,
        Sign::Positive => 1,
        Sign::Negative => -1,
    }
}
