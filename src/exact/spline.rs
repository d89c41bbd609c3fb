//! Natural cubic splines.
//!
//! The coefficients follow from the points by quotients, and most are no `f64`. They are computed with fractions, and then
//! with bounds of 237 bits, of which each number type takes what it can hold: so bounds are those of the curve through the
//! points.

use f256::f256;

/// A curve of cubics, one between each two neighbouring points, with two continuous derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct Spline {
    /// The y of each point, rising.
    pub(crate) knots: Vec<f64>,
    /// The coefficients of each cubic and of its first three derivatives, the constant first.
    pub(crate) cubics: Vec<[[Coefficient; 4]; 4]>,
}

/// A number that is known to 237 bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficient {
    /// The nearest `f64`, or one beside it.
    pub near: f64,
    /// What that lacks, rounded.
    pub rest: f64,
    /// A bound on the error of `near`; 0 where it is exact.
    pub error: f64,
    /// A lower and an upper bound of the number.
    pub bounds: [f256; 2],
}

/// The coefficients of the derivatives of a cubic from the fourth on.
static NOTHING: [Coefficient; 4] =
    [Coefficient { near: 0.0, rest: 0.0, error: 0.0, bounds: [f256::ZERO; 2] }; 4];

impl Spline {
    /// Returns the index of the cubic at y. The first and the last go on beyond the ends.
    #[inline]
    pub fn piece(&self, y: f64) -> usize {
        let inner = &self.knots[1..self.knots.len() - 1];
        inner.partition_point(|knot| *knot <= y)
    }

    /// Returns where a cubic ends: its lower and its upper point's y, infinite for those that go on.
    pub fn ends(&self, piece: usize) -> [f64; 2] {
        let last = self.cubics.len() - 1;
        [
            if piece == 0 { f64::NEG_INFINITY } else { self.knots[piece] },
            if piece == last { f64::INFINITY } else { self.knots[piece + 1] },
        ]
    }

    /// Returns the y from which a cubic, or its derivative of an order from 0, is measured, and its coefficients, the
    /// constant first.
    #[inline]
    pub fn cubic(&self, piece: usize, order: usize) -> (f64, &[Coefficient; 4]) {
        (self.knots[piece], self.cubics[piece].get(order).unwrap_or(&NOTHING))
    }
}
