//! A number and its derivatives along x, y and z.

use crate::dual::Dual;
use crate::scalar::{Scalar, per_axis};
use crate::spline::Spline;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number with three derivatives, computed in one evaluation. They have the same bits as with three [`Dual`] numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gradient {
    /// The value.
    pub value: f64,
    /// The derivatives.
    pub slopes: [f64; 3],
}

impl Gradient {
    /// Returns the coordinates of a point.
    pub fn point(at: [f64; 3]) -> [Self; 3] {
        per_axis(|axis| Self { value: at[axis], slopes: per_axis(|own| if own == axis { 1.0 } else { 0.0 }) })
    }

    fn along(self, axis: usize) -> Dual {
        Dual { value: self.value, slope: self.slopes[axis] }
    }

    /// Applies a function of one number.
    #[inline(always)]
    fn map(self, function: impl Fn(Dual) -> Dual) -> Self {
        let Dual { value, slope } = function(Dual::variable(self.value));
        Self { value, slopes: per_axis(|axis| slope * self.slopes[axis]) }
    }

    /// Makes a number from the results of a function for each axis.
    #[inline(always)]
    fn of(function: impl Fn(usize) -> Dual) -> Self {
        let along = per_axis(function);
        Self { value: along[0].value, slopes: per_axis(|axis| along[axis].slope) }
    }
}

impl Add for Gradient {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::of(|axis| self.along(axis) + other.along(axis))
    }
}

impl Sub for Gradient {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::of(|axis| self.along(axis) - other.along(axis))
    }
}

impl Mul for Gradient {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::of(|axis| self.along(axis) * other.along(axis))
    }
}

impl Div for Gradient {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Self::of(|axis| self.along(axis) / other.along(axis))
    }
}

impl Neg for Gradient {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self::of(|axis| -self.along(axis))
    }
}

impl Scalar for Gradient {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self { value, slopes: [0.0; 3] }
    }

    #[inline(always)]
    fn bounds(self) -> [f64; 2] {
        self.value.bounds()
    }

    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = Scalar::sin_cos(self.value);
        (self.map(|_| Dual { value: sin, slope: cos }), self.map(|_| Dual { value: cos, slope: -sin }))
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

    fn atan2(self, x: Self) -> Self {
        Self::of(|axis| self.along(axis).atan2(x.along(axis)))
    }

    fn sqrt(self) -> Self {
        self.map(Scalar::sqrt)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.map(Scalar::abs)
    }

    #[inline(always)]
    fn floor(self) -> Self {
        self.map(Scalar::floor)
    }

    fn max(self, other: Self) -> Self {
        Self::of(|axis| self.along(axis).max(other.along(axis)))
    }

    fn pow(self, exponent: Self) -> Self {
        Self::of(|axis| self.along(axis).pow(exponent.along(axis)))
    }

    #[inline(always)]
    fn powi(self, exponent: i32) -> Self {
        match exponent {
            0 => Self::constant(1.0),
            1 => self,
            _ => self.map(|base| base.powi(exponent)),
        }
    }

    #[inline(always)]
    fn scaled(self, factor: f64) -> Self {
        Self::of(|axis| self.along(axis).scaled(factor))
    }

    #[inline(always)]
    fn shifted(self, by: f64) -> Self {
        Self { value: self.value.shifted(by), ..self }
    }

    fn ramp(self, exponent: i32) -> Self {
        self.map(|base| base.ramp(exponent))
    }

    fn spline(self, spline: &Spline, order: usize) -> Self {
        self.map(|at| at.spline(spline, order))
    }

    fn noise(at: [Self; 3], orders: [u8; 3]) -> Self {
        Self::of(|axis| Dual::noise(at.map(|of| of.along(axis)), orders))
    }

    fn step(self) -> Self {
        self.map(Scalar::step)
    }

    fn d_step(self) -> Self {
        self.map(Scalar::d_step)
    }

    fn d_floor(self) -> Self {
        self.map(Scalar::d_floor)
    }

    fn is_zero(self) -> bool {
        self.value == 0.0 && self.slopes == [0.0; 3]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_have_the_bits_of_dual_numbers() {
        fn function<N: Scalar>([x, y, z]: [N; 3]) -> N {
            let some = x.powi(3) * y.sin() - z.sqrt() / (x.exp() + y.cos()) + z.ln() * y.tan() + x.atan2(z);
            let more = x.max(y * z).min(z.shifted(1.0).scaled(3.0)) + (x - y).abs() + z.ramp(3) + x.floor();
            some + more * x.pow(y) + N::noise([x, y, z], [0; 3]) - (x - z).choose(x, y * y) + y.powi(-2)
        }
        for at in [[0.3, 1.1, 2.5], [2.0, 0.1, 0.7], [1.4, 1.4, 1.4]] {
            let Gradient { value, slopes } = function(Gradient::point(at));
            for axis in 0..3 {
                let along = |own: usize| Dual { value: at[own], slope: f64::from(u8::from(own == axis)) };
                let Dual { value: alone, slope } = function(per_axis(along));
                assert_eq!((value.to_bits(), slopes[axis]), (alone.to_bits(), slope), "{at:?} {axis}");
            }
        }
    }
}
