//! Dual numbers: forward-mode automatic differentiation.

use crate::chain_rule::{Differentiated, operators};
use crate::scalar::Scalar;

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
}

impl<N: Scalar> Differentiated for Dual<N> {
    type Value = N;
    type Slope = N;

    #[inline(always)]
    fn new(value: N, slope: impl Fn(usize) -> N) -> Self {
        Self { value, slope: slope(0) }
    }

    #[inline(always)]
    fn lower(self) -> N {
        self.value
    }

    #[inline(always)]
    fn bare(of: N) -> N {
        of
    }

    #[inline(always)]
    fn slope(self, _axis: usize) -> N {
        self.slope
    }

    #[inline(always)]
    fn is_fixed(self) -> bool {
        self.slope.is_zero()
    }
}

operators!([N: Scalar] Dual<N>);

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
