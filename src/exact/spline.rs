//! Natural cubic splines.
//!
//! The coefficients are quotients of the points' numbers, and most are not `f64`. They are computed with fractions and
//! then with 237-bit bounds, and each number type takes what it can hold. Bounds thus are those of the curve through
//! the points.

use f256::f256;

/// A curve of cubics, each between two neighbouring points, with two continuous derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct Spline {
    /// The y of each point, rising.
    pub(crate) knots: Vec<f64>,
    /// The coefficients of each cubic and of its first three derivatives, the constant first.
    pub(crate) cubics: Vec<[[Coefficient; 4]; 4]>,
}

/// A number known to 237 bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficient {
    /// The nearest `f64`, or a neighbour of it.
    pub near: f64,
    /// The difference from `near`, rounded.
    pub rest: f64,
    /// A bound of the error of `near`, or 0 if it is exact.
    pub error: f64,
    /// A lower and an upper bound of the number.
    pub bounds: [f256; 2],
}

/// The coefficients of the derivatives of a cubic from the fourth on.
static NOTHING: [Coefficient; 4] =
    [Coefficient { near: 0.0, rest: 0.0, error: 0.0, bounds: [f256::ZERO; 2] }; 4];

impl Spline {
    /// Returns the index of the cubic at y. The first and the last cubic extend beyond the ends.
    #[inline]
    pub fn piece(&self, y: f64) -> usize {
        let inner = &self.knots[1..self.knots.len() - 1];
        inner.partition_point(|knot| *knot <= y)
    }

    /// Returns the ends of a cubic: the y of its lower and its upper point, or infinity beyond the ends.
    pub fn ends(&self, piece: usize) -> [f64; 2] {
        let last = self.cubics.len() - 1;
        [
            if piece == 0 { f64::NEG_INFINITY } else { self.knots[piece] },
            if piece == last { f64::INFINITY } else { self.knots[piece + 1] },
        ]
    }

    /// Returns the origin in y of a cubic, or of its derivative of an order from 0, and its coefficients, the constant
    /// first.
    #[inline]
    pub fn cubic(&self, piece: usize, order: usize) -> (f64, &[Coefficient; 4]) {
        (self.knots[piece], self.cubics[piece].get(order).unwrap_or(&NOTHING))
    }
}
