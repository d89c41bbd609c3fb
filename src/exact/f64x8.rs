//! Eight lanes of `f64`, for evaluating formulas for eight numbers at once.
//!
//! Each lane has the same bits as a single number. Sines and cosines equal those of the `libm` crate, and are computed
//! for all eight lanes at once if possible.

use crate::scalar::{Scalar, by_squaring, operator};
use crate::sines::sines;
use crate::spline::Spline;

/// The number of lanes that are evaluated at once.
pub const LANES: usize = 8;

/// Eight independent numbers, one per lane.
#[derive(Clone, Copy, Debug)]
pub struct F64x8(pub [f64; LANES]);

/// Evaluates an expression for each lane of one or more vectors: `each!(a = x, b = y => a.hypot(b))`.
#[macro_export]
macro_rules! each {
    ($($number:ident = $vector:expr),+ => $value:expr) => {{
        let mut all = [0.0; $crate::f64x8::LANES];
        for lane in 0..$crate::f64x8::LANES {
            $(let $number = $vector.0[lane];)+
            all[lane] = $value;
        }
        $crate::f64x8::F64x8(all)
    }};
}
pub use each;

operator!([] F64x8, Add add(self, other) => each!(a = self, b = other => a + b));
operator!([] F64x8, Sub sub(self, other) => each!(a = self, b = other => a - b));
operator!([] F64x8, Mul mul(self, other) => each!(a = self, b = other => a * b));
operator!([] F64x8, Div div(self, other) => each!(a = self, b = other => a / b));
operator!([] F64x8, Neg neg(self) => each!(a = self => -a));

impl Scalar for F64x8 {
    /// Kernels inline the functions, to compile them for their CPU level.
    const IS_LONG: bool = false;

    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self([value; LANES])
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = sines(self.0);
        (Self(sin), Self(cos))
    }

    fn tan(self) -> Self {
        each!(a = self => libm::tan(a))
    }

    fn exp(self) -> Self {
        each!(a = self => libm::exp(a))
    }

    fn ln(self) -> Self {
        each!(a = self => libm::log(a))
    }

    fn atan2(self, x: Self) -> Self {
        each!(a = self, b = x => libm::atan2(a, b))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        each!(a = self => Scalar::sqrt(a))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        each!(a = self => a.abs())
    }

    #[inline(always)]
    fn floor(self) -> Self {
        each!(a = self => a.floor())
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        each!(a = self, b = other => Scalar::min(a, b))
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        each!(a = self, b = other => Scalar::max(a, b))
    }

    fn pow(self, exponent: Self) -> Self {
        each!(a = self, b = exponent => libm::pow(a, b))
    }

    #[inline(always)]
    fn powi(self, exponent: i32) -> Self {
        by_squaring(self, exponent)
    }

    fn spline(self, spline: &Spline, order: usize) -> Self {
        each!(a = self => a.spline(spline, order))
    }

    fn noise([x, y, z]: [Self; 3], orders: [u8; 3]) -> Self {
        each!(a = x, b = y, c = z => f64::noise([a, b, c], orders))
    }

    #[inline(always)]
    fn step(self) -> Self {
        each!(a = self => a.step())
    }

    #[inline(always)]
    fn d_step(self) -> Self {
        Self::constant(0.0)
    }

    #[inline(always)]
    fn d_floor(self) -> Self {
        Self::constant(0.0)
    }

    /// Returns whether all lanes are 0.
    #[inline(always)]
    fn is_zero(self) -> bool {
        self.0 == [0.0; LANES]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::Dual;

    fn same(a: f64, b: f64) -> bool {
        a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()
    }

    #[test]
    fn each_number_goes_its_own_way() {
        fn all<N: Scalar>(x: N) -> N {
            let some = x.powi(3) - x.sqrt() * x.exp() + x.ln().sin() / x.tan() + x.cos().abs();
            some.min(x).max(-x) + x.floor() * x.pow(N::constant(1.5)) - x.powi(-2)
        }
        let numbers = [0.3, 1.1, 2.5, 4.0, -0.7, 1e-3, 12.0, 700.0];
        let Dual { value, slope } = all(Dual::variable(F64x8(numbers)));
        for lane in 0..LANES {
            let alone = all(Dual::variable(numbers[lane]));
            assert!(same(value.0[lane], alone.value), "{}", numbers[lane]);
            assert!(same(slope.0[lane], alone.slope), "{}", numbers[lane]);
        }
    }
}
