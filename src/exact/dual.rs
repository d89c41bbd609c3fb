//! Dual numbers: forward-mode automatic differentiation.

use crate::scalar::{Scalar, apart_if, noise_slope};
use crate::spline::Spline;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number and its derivative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<N = f64> {
    /// The value.
    pub value: N,
    /// The derivative with respect to the variable.
    pub slope: N,
}

impl<N: Scalar> Dual<N> {
    /// Returns the variable itself, with the derivative 1.
    #[inline(always)]
    pub fn variable(value: N) -> Self {
        Self { value, slope: N::constant(1.0) }
    }

    /// Returns a number that does not depend on the variable, with the derivative 0.
    #[inline(always)]
    pub fn fixed(value: N) -> Self {
        Self { value, slope: N::constant(0.0) }
    }

    /// Applies a function by the chain rule, given its value and its derivative at the number.
    #[inline(always)]
    fn chain(self, value: N, derivative: N) -> Self {
        Self { value, slope: derivative * self.slope }
    }
}

impl<N: Scalar> Add for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, slope: self.slope + other.slope }
    }
}

impl<N: Scalar> Sub for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, slope: self.slope - other.slope }
    }
}

impl<N: Scalar> Mul for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        apart_if!(N::IS_LONG, {
            Self {
                value: self.value * other.value,
                slope: self.value * other.slope + self.slope * other.value,
            }
        })
    }
}

impl<N: Scalar> Div for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        apart_if!(N::IS_LONG, {
            let value = self.value / other.value;
            Self { value, slope: (self.slope - value * other.slope) / other.value }
        })
    }
}

impl<N: Scalar> Neg for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, slope: -self.slope }
    }
}

impl<N: Scalar> Scalar for Dual<N> {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self { value: N::constant(value), slope: N::constant(0.0) }
    }

    #[inline(always)]
    fn about(value: f64, error: f64) -> Self {
        Self { value: N::about(value, error), slope: N::constant(0.0) }
    }

    #[inline(always)]
    fn bounds(self) -> [f64; 2] {
        self.value.bounds()
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        (self.chain(sin, cos), self.chain(cos, -sin))
    }

    fn tan(self) -> Self {
        let tan = self.value.tan();
        self.chain(tan, N::constant(1.0) + tan.powi(2))
    }

    fn exp(self) -> Self {
        let exp = self.value.exp();
        self.chain(exp, exp)
    }

    fn ln(self) -> Self {
        self.chain(self.value.ln(), N::constant(1.0) / self.value)
    }

    fn atan2(self, x: Self) -> Self {
        let (one, other) = (x.value * self.slope, self.value * x.slope);
        let turns = (one - other) / (x.value.powi(2) + self.value.powi(2));
        // The slope is unbounded where the angle jumps.
        Self { value: self.value.atan2(x.value), slope: turns + self.value.d_step() * (-x.value).step() }
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        apart_if!(N::IS_LONG, {
            let root = self.value.sqrt();
            self.chain(root, N::constant(0.5) * self.value.step() / root)
        })
    }

    #[inline(always)]
    fn abs(self) -> Self {
        let sign = N::constant(2.0) * self.value.step() - N::constant(1.0);
        self.chain(self.value.abs(), sign)
    }

    #[inline(always)]
    fn floor(self) -> Self {
        self.chain(self.value.floor(), self.value.d_floor())
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        apart_if!(N::IS_LONG, {
            let own = (self.value - other.value).step();
            let slope = own * self.slope + (N::constant(1.0) - own) * other.slope;
            Self { value: self.value.max(other.value), slope }
        })
    }

    fn pow(self, exponent: Self) -> Self {
        if let Some(exponent) = exponent.whole() {
            return self.powi(exponent);
        }
        let value = self.value.pow(exponent.value);
        let by_base = exponent.value * self.value.pow(exponent.value - N::constant(1.0));
        // The exponent is nearly always a constant, and then the base may be 0 or negative.
        let by_exponent = if exponent.slope.is_zero() { N::constant(0.0) } else { value * self.value.ln() };
        Self { value, slope: by_base * self.slope + by_exponent * exponent.slope }
    }

    fn whole(self) -> Option<i32> {
        self.value.whole().filter(|_| self.slope.is_zero())
    }

    #[inline(always)]
    fn powi(self, exponent: i32) -> Self {
        apart_if!(N::IS_LONG, {
            match exponent {
                0 => return Self::constant(1.0),
                1 => return self,
                2 => return self.chain(self.value.powi(2), self.value + self.value),
                _ => {}
            }
            let derivative = N::constant(f64::from(exponent)) * self.value.powi(exponent - 1);
            self.chain(self.value.powi(exponent), derivative)
        })
    }

    #[inline(always)]
    fn scaled(self, factor: f64) -> Self {
        Self { value: self.value.scaled(factor), slope: self.slope.scaled(factor) }
    }

    #[inline(always)]
    fn shifted(self, by: f64) -> Self {
        Self { value: self.value.shifted(by), slope: self.slope }
    }

    /// Differentiates the power as a whole. Its derivatives may be bounded where those of its base are not.
    #[inline(always)]
    fn ramp(self, exponent: i32) -> Self {
        let derivative = if exponent == 1 {
            self.value.step()
        } else {
            N::constant(f64::from(exponent)) * self.value.ramp(exponent - 1)
        };
        self.chain(self.value.ramp(exponent), derivative)
    }

    fn spline(self, spline: &Spline, order: usize) -> Self {
        self.chain(self.value.spline(spline, order), self.value.spline(spline, order + 1))
    }

    fn noise(at: [Self; 3], orders: [u8; 3]) -> Self {
        let (values, slopes) = (at.map(|along| along.value), at.map(|along| along.slope));
        Self { value: N::noise(values, orders), slope: noise_slope(values, slopes, orders) }
    }

    #[inline(always)]
    fn step(self) -> Self {
        self.chain(self.value.step(), self.value.d_step())
    }

    #[inline(always)]
    fn d_step(self) -> Self {
        let slope = self.value.d_step();
        self.chain(slope, slope)
    }

    #[inline(always)]
    fn d_floor(self) -> Self {
        let slope = self.value.d_floor();
        self.chain(slope, slope)
    }

    #[inline(always)]
    fn is_zero(self) -> bool {
        self.value.is_zero() && self.slope.is_zero()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_are_those_of_small_differences() {
        fn function<N: Scalar>(x: N) -> N {
            x.powi(3) - x.sqrt() * x.exp() + x.ln().sin() / x.tan() + x.cos().abs() + x.pow(N::constant(1.5))
        }
        for x in [0.3, 1.1, 2.5, 4.0] {
            let Dual { value, slope } = function(Dual::variable(x));
            let step = 1e-5;
            assert_eq!(value, function(x));
            let difference = (function(x + step) - function(x - step)) / (2.0 * step);
            assert!((slope - difference).abs() < 1e-7 * slope.abs().max(1.0), "{slope} {difference} at {x}");
        }
    }

    #[test]
    fn a_power_of_the_variable_may_have_any_base_that_it_is_defined_for() {
        let y = Dual::variable(0.0);
        assert_eq!(y.pow(Dual::constant(2.0)), Dual { value: 0.0, slope: 0.0 });
        assert_eq!(Dual::variable(-2.0).powi(3), Dual { value: -8.0, slope: 12.0 });
    }
}
