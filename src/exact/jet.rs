//! Jets of the second order: forward-mode automatic differentiation, twice.
//!
//! Source: Griewank and Walther, Evaluating Derivatives, second edition, 2008, chapter 13, "Taylor and Tensor
//! Coefficients".

use crate::dual::Dual;
use crate::scalar::{Scalar, apart_if, noise_slope};
use crate::spline::Spline;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number and its first two derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<N = f64> {
    /// The value.
    pub value: N,
    /// The first derivative with respect to the variable.
    pub first: N,
    /// The second derivative.
    pub second: N,
}

impl<N: Scalar> Jet<N> {
    /// Returns the variable itself.
    #[inline(always)]
    pub fn variable(value: N) -> Self {
        Self { value, first: N::constant(1.0), second: N::constant(0.0) }
    }

    /// Returns a number that does not depend on the variable.
    #[inline(always)]
    pub fn fixed(value: N) -> Self {
        Self { value, first: N::constant(0.0), second: N::constant(0.0) }
    }

    /// Returns the number with only its first derivative.
    #[inline(always)]
    fn dual(self) -> Dual<N> {
        Dual { value: self.value, slope: self.first }
    }

    /// Returns the first derivative, with the second one as its derivative.
    #[inline(always)]
    fn slope(self) -> Dual<N> {
        Dual { value: self.first, slope: self.second }
    }

    #[inline(always)]
    fn of(value: N, slope: Dual<N>) -> Self {
        Self { value, first: slope.value, second: slope.slope }
    }

    /// Applies a function by the chain rule, given its value and its derivative at the number.
    #[inline(always)]
    fn chain(self, value: N, derivative: Dual<N>) -> Self {
        Self::of(value, derivative * self.slope())
    }
}

impl<N: Scalar> Add for Jet<N> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            first: self.first + other.first,
            second: self.second + other.second,
        }
    }
}

impl<N: Scalar> Sub for Jet<N> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self {
            value: self.value - other.value,
            first: self.first - other.first,
            second: self.second - other.second,
        }
    }
}

impl<N: Scalar> Mul for Jet<N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        apart_if!(N::IS_LONG, {
            let firsts = self.first * other.first;
            Self {
                value: self.value * other.value,
                first: self.value * other.first + self.first * other.value,
                second: (self.value * other.second + firsts) + (firsts + self.second * other.value),
            }
        })
    }
}

impl<N: Scalar> Div for Jet<N> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        apart_if!(N::IS_LONG, {
            let value = self.value / other.value;
            let first = (self.first - value * other.first) / other.value;
            let bent = first * other.first;
            let second = (self.second - (value * other.second + bent) - bent) / other.value;
            Self { value, first, second }
        })
    }
}

impl<N: Scalar> Neg for Jet<N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, first: -self.first, second: -self.second }
    }
}

impl<N: Scalar> Scalar for Jet<N> {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self::fixed(N::constant(value))
    }

    #[inline(always)]
    fn about(value: f64, error: f64) -> Self {
        Self::fixed(N::about(value, error))
    }

    #[inline(always)]
    fn bounds(self) -> [f64; 2] {
        self.value.bounds()
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.dual().sin_cos();
        (self.chain(sin.value, cos), self.chain(cos.value, -sin))
    }

    fn tan(self) -> Self {
        let tan = self.dual().tan();
        self.chain(tan.value, Dual::constant(1.0) + tan.powi(2))
    }

    fn exp(self) -> Self {
        let exp = self.dual().exp();
        self.chain(exp.value, exp)
    }

    fn ln(self) -> Self {
        self.chain(self.value.ln(), Dual::constant(1.0) / self.dual())
    }

    fn atan2(self, x: Self) -> Self {
        let (y, at) = (self.dual(), x.dual());
        let (one, other) = (at * self.slope(), y * x.slope());
        let turns = (one - other) / (at.powi(2) + y.powi(2));
        Self::of(self.value.atan2(x.value), turns + y.d_step() * (-at).step())
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        apart_if!(N::IS_LONG, {
            let root = self.dual().sqrt();
            self.chain(root.value, Dual::constant(0.5) * self.dual().step() / root)
        })
    }

    #[inline(always)]
    fn abs(self) -> Self {
        let sign = Dual::constant(2.0) * self.dual().step() - Dual::constant(1.0);
        self.chain(self.value.abs(), sign)
    }

    #[inline(always)]
    fn floor(self) -> Self {
        self.chain(self.value.floor(), self.dual().d_floor())
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        apart_if!(N::IS_LONG, {
            let own = (self.dual() - other.dual()).step();
            let slope = own * self.slope() + (Dual::constant(1.0) - own) * other.slope();
            Self::of(self.value.max(other.value), slope)
        })
    }

    fn pow(self, exponent: Self) -> Self {
        if let Some(exponent) = exponent.whole() {
            return self.powi(exponent);
        }
        let (base, power) = (self.dual(), exponent.dual());
        let value = base.pow(power);
        let by_base = power * base.pow(power - Dual::constant(1.0));
        // The exponent is nearly always a constant, and then the base may be 0 or negative.
        let is_constant = exponent.slope().is_zero();
        let by_exponent = if is_constant { Dual::constant(0.0) } else { value * base.ln() };
        Self::of(value.value, by_base * self.slope() + by_exponent * exponent.slope())
    }

    fn whole(self) -> Option<i32> {
        self.value.whole().filter(|_| self.slope().is_zero())
    }

    #[inline(always)]
    fn powi(self, exponent: i32) -> Self {
        apart_if!(N::IS_LONG, {
            let derivative = match exponent {
                0 => return Self::constant(1.0),
                1 => return self,
                2 => self.dual() + self.dual(),
                _ => Dual::constant(f64::from(exponent)) * self.dual().powi(exponent - 1),
            };
            self.chain(self.value.powi(exponent), derivative)
        })
    }

    #[inline(always)]
    fn scaled(self, factor: f64) -> Self {
        Self {
            value: self.value.scaled(factor),
            first: self.first.scaled(factor),
            second: self.second.scaled(factor),
        }
    }

    #[inline(always)]
    fn shifted(self, by: f64) -> Self {
        Self { value: self.value.shifted(by), ..self }
    }

    /// Differentiates the power as a whole. Its derivatives may be bounded where those of its base are not.
    #[inline(always)]
    fn ramp(self, exponent: i32) -> Self {
        let derivative = if exponent == 1 {
            self.dual().step()
        } else {
            Dual::constant(f64::from(exponent)) * self.dual().ramp(exponent - 1)
        };
        self.chain(self.value.ramp(exponent), derivative)
    }

    fn spline(self, spline: &Spline, order: usize) -> Self {
        self.chain(self.value.spline(spline, order), self.dual().spline(spline, order + 1))
    }

    fn noise(at: [Self; 3], orders: [u8; 3]) -> Self {
        let slope = noise_slope(at.map(Self::dual), at.map(Self::slope), orders);
        Self::of(N::noise(at.map(|along| along.value), orders), slope)
    }

    #[inline(always)]
    fn step(self) -> Self {
        self.chain(self.value.step(), self.dual().d_step())
    }

    #[inline(always)]
    fn d_step(self) -> Self {
        let slope = self.dual().d_step();
        self.chain(slope.value, slope)
    }

    #[inline(always)]
    fn d_floor(self) -> Self {
        let slope = self.dual().d_floor();
        self.chain(slope.value, slope)
    }

    #[inline(always)]
    fn is_zero(self) -> bool {
        self.value.is_zero() && self.slope().is_zero()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interval::Interval;
    use std::fmt::Debug;

    /// Returns functions that use each operation, with derivatives where x is positive and not an integer.
    fn functions<N: Scalar>(x: N) -> [N; 6] {
        let n = N::constant;
        let spline = Spline::new(&[[0.0, 1.0], [0.5, 2.0], [2.0, 1.5], [3.0, -1.0]]);
        [
            x.powi(3) - x.sqrt() * x.exp() + x.ln().sin() / x.tan() + x.cos().abs() + x.pow(n(1.5)),
            x.pow(x) / x.shifted(3.0).powi(-2) - x.powi(2).scaled(0.5).ramp(2) * x.floor(),
            x.min(n(2.0) - x).max(-x.powi(2)) * x.sin() * x.ramp(1),
            x.step() * x.powi(1) * x + x.powi(0) / (x + x.d_step() + x.d_floor()),
            x.spline(&spline, 0) * x.spline(&spline, 1),
            N::about(1.5, 1e-9) * x.powi(2) / N::about(-2.0, 1e-3),
        ]
    }

    fn assert_same_as_dual_numbers_of_dual_numbers<N: Scalar + Debug + PartialEq>(x: N) {
        let twice = functions(Dual::variable(Dual::variable(x)));
        for (jet, twice) in functions(Jet::variable(x)).into_iter().zip(twice) {
            let expected = [twice.value.value, twice.value.slope, twice.slope.slope];
            assert_eq!([jet.value, jet.first, jet.second], expected, "at {x:?}");
        }
    }

    #[test]
    fn derivatives_are_those_of_dual_numbers_of_dual_numbers() {
        for x in [0.3, 1.1, 2.5, 4.25] {
            assert_same_as_dual_numbers_of_dual_numbers(x);
        }
    }

    #[test]
    fn bounds_are_those_of_dual_numbers_of_dual_numbers() {
        for (low, high) in [(0.3, 0.31), (1.1, 1.9), (0.4, 2.1), (-1.5, 1.5), (-0.2, 0.0)] {
            assert_same_as_dual_numbers_of_dual_numbers(Interval { low, high });
        }
    }

    #[test]
    fn second_derivatives_are_those_of_small_differences_of_first_ones() {
        for x in [0.3, 1.1, 2.5, 4.25] {
            let step = 1e-5;
            let slopes = |x| functions(Dual::variable(x)).map(|dual: Dual| dual.slope);
            let around = slopes(x + step).into_iter().zip(slopes(x - step));
            for (jet, (after, before)) in functions(Jet::variable(x)).into_iter().zip(around) {
                let difference = (after - before) / (2.0 * step);
                let error = (jet.second - difference).abs();
                assert!(error < 1e-6 * difference.abs().max(1.0), "{} {difference} at {x}", jet.second);
            }
        }
    }
}
