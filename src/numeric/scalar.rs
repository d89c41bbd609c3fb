//! What formulas compute with: plain numbers here, [`Interval`](crate::numeric::interval::Interval)s and
//! [`Dual`](crate::numeric::dual::Dual) numbers beside them.
//!
//! One formula evaluated with one type after the other gives values, derivatives and proven bounds. The functions
//! are those of the `libm` crate, whose results do not depend on the machine.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// What a formula computes with.
///
/// The square root of a number below 0 is 0, so that a profile such as `sqrt(9 - y^2)` has an end and not a gap in
/// its definition; the logarithm and powers of numbers below 0 are not defined.
pub trait Scalar:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// A number that does not depend on anything.
    fn constant(value: f64) -> Self;
    /// A number that is known but for an error: with bounds where there are bounds, else the number itself.
    #[inline(always)]
    fn about(value: f64, _error: f64) -> Self {
        Self::constant(value)
    }
    /// The sine and the cosine.
    fn sin_cos(self) -> (Self, Self);
    /// The sine.
    #[inline(always)]
    fn sin(self) -> Self {
        self.sin_cos().0
    }

    /// The cosine.
    #[inline(always)]
    fn cos(self) -> Self {
        self.sin_cos().1
    }

    /// The tangent.
    fn tan(self) -> Self;
    /// e to the power of it.
    fn exp(self) -> Self;
    /// The natural logarithm.
    fn ln(self) -> Self;
    /// The square root; 0 below 0.
    fn sqrt(self) -> Self;
    /// Its distance from 0.
    fn abs(self) -> Self;
    /// The greatest whole number that is not above it.
    fn floor(self) -> Self;
    /// The lesser of two.
    fn min(self, other: Self) -> Self;
    /// The greater of two.
    fn max(self, other: Self) -> Self;
    /// A power.
    fn pow(self, exponent: Self) -> Self;
    /// A whole power.
    fn powi(self, exponent: i32) -> Self;

    /// 1 above 0, 0 below: the slope of `max(0, x)`.
    fn step(self) -> Self;
    /// The slope of [`step`](Self::step): unbounded where this may be 0, else 0.
    fn kink(self) -> Self;
    /// The slope of [`floor`](Self::floor): unbounded where this may be whole, else 0.
    fn jump(self) -> Self;
    /// Whether it is 0 and nothing else.
    fn is_zero(self) -> bool;
}

/// The product of two vectors, a number.
pub fn dot<N: Scalar>(a: [N; 3], b: [N; 3]) -> N {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The product of two vectors, a vector upright on both.
pub fn cross<N: Scalar>(a: [N; 3], b: [N; 3]) -> [N; 3] {
    [0, 1, 2].map(|axis| {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        a[next] * b[last] - a[last] * b[next]
    })
}

impl Scalar for f64 {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        value
    }

    fn sin_cos(self) -> (Self, Self) {
        libm::sincos(self)
    }

    fn tan(self) -> Self {
        libm::tan(self)
    }

    fn exp(self) -> Self {
        libm::exp(self)
    }

    fn ln(self) -> Self {
        libm::log(self)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        // Written so that a NaN stays one.
        f64::sqrt(if self < 0.0 { 0.0 } else { self })
    }

    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }

    #[inline(always)]
    fn floor(self) -> Self {
        f64::floor(self)
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if other < self { other } else { self }
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if other > self { other } else { self }
    }

    fn pow(self, exponent: Self) -> Self {
        libm::pow(self, exponent)
    }

    /// By repeated squaring: the same bits on every machine.
    #[inline(always)]
    fn powi(self, exponent: i32) -> Self {
        let (mut result, mut square, mut left) = (1.0, self, exponent.unsigned_abs());
        while left > 0 {
            if left & 1 == 1 {
                result *= square;
            }
            left >>= 1;
            square *= square;
        }
        if exponent < 0 { 1.0 / result } else { result }
    }

    #[inline(always)]
    fn step(self) -> Self {
        if self < 0.0 { 0.0 } else { 1.0 }
    }

    #[inline(always)]
    fn kink(self) -> Self {
        0.0
    }

    #[inline(always)]
    fn jump(self) -> Self {
        0.0
    }

    #[inline(always)]
    fn is_zero(self) -> bool {
        self == 0.0
    }
}
