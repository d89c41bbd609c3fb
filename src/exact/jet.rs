//! Jets of the second order: forward-mode automatic differentiation, twice.
//!
//! Source: Griewank and Walther, Evaluating Derivatives, second edition, 2008, chapter 13, "Taylor and Tensor
//! Coefficients".

use crate::chain_rule::{Differentiated, operators};
use crate::dual::Dual;
use crate::scalar::{Scalar, apart_if};

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
}

impl<N: Scalar> Differentiated for Jet<N> {
    type Value = N;
    type Slope = Dual<N>;

    #[inline(always)]
    fn new(value: N, slope: impl Fn(usize) -> Dual<N>) -> Self {
        let Dual { value: first, slope: second } = slope(0);
        Self { value, first, second }
    }

    #[inline(always)]
    fn lower(self) -> Dual<N> {
        Dual { value: self.value, slope: self.first }
    }

    #[inline(always)]
    fn bare(of: Dual<N>) -> N {
        of.value
    }

    #[inline(always)]
    fn slope(self, _axis: usize) -> Dual<N> {
        Dual { value: self.first, slope: self.second }
    }

    #[inline(always)]
    fn is_fixed(self) -> bool {
        self.first.is_zero() && self.second.is_zero()
    }

    /// Computes what both derivatives have in common once.
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        apart_if!(N::IS_LONG, {
            let firsts = self.first * other.first;
            Self {
                value: self.value * other.value,
                first: self.value * other.first + self.first * other.value,
                second: (self.value * other.second + firsts) + (firsts + self.second * other.value),
            }
        })
    }

    /// Computes what both derivatives have in common once.
    #[inline(always)]
    fn over(self, other: Self) -> Self {
        apart_if!(N::IS_LONG, {
            let value = self.value / other.value;
            let first = (self.first - value * other.first) / other.value;
            let bent = first * other.first;
            let second = (self.second - (value * other.second + bent) - bent) / other.value;
            Self { value, first, second }
        })
    }
}

operators!([N: Scalar] Jet<N>);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interval::Interval;
    use crate::spline::Spline;
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
