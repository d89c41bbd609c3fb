//! A number and its derivatives along several variables.

use crate::dual::Dual;
use crate::scalar::{Scalar, apart_if};
use crate::spline::Spline;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number with derivatives along several variables, computed in one evaluation. They have the same bits as with as many
/// [`Dual`] numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gradient<N = f64, const K: usize = 3> {
    /// The value.
    pub value: N,
    /// The derivatives.
    pub slopes: [N; K],
}

/// Makes an array of the values of a function, which is compiled into one place.
#[inline(always)]
fn each<N: Scalar, const K: usize>(of: impl Fn(usize) -> N) -> [N; K] {
    let mut all = [N::constant(0.0); K];
    let mut axis = 0;
    while axis < K {
        all[axis] = of(axis);
        axis += 1;
    }
    all
}

impl<N: Scalar, const K: usize> Gradient<N, K> {
    /// Returns the coordinates of a point.
    #[inline(always)]
    pub fn point(at: [N; K]) -> [Self; K] {
        let slope = |own: usize, axis: usize| N::constant(if own == axis { 1.0 } else { 0.0 });
        each(|axis| Self { value: at[axis], slopes: each(|own| slope(own, axis)) })
    }

    #[inline(always)]
    fn along(self, axis: usize) -> Dual<N> {
        Dual { value: self.value, slope: self.slopes[axis] }
    }

    /// Applies the chain rule, given a function's value and its derivative at the number.
    #[inline(always)]
    fn chain(self, value: N, derivative: N) -> Self {
        Self { value, slopes: each(|axis| derivative * self.slopes[axis]) }
    }

    /// Makes a number from the results of a function for each axis.
    #[inline(always)]
    fn of(function: impl Fn(usize) -> Dual<N>) -> Self {
        let along: [Dual<N>; K] = each(function);
        Self { value: along[0].value, slopes: each(|axis| along[axis].slope) }
    }

    /// Applies a function of one number.
    #[inline(always)]
    fn map(self, function: impl Fn(Dual<N>) -> Dual<N>) -> Self {
        Self::of(|axis| function(self.along(axis)))
    }
}

impl<N: Scalar, const K: usize> Add for Gradient<N, K> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, slopes: each(|axis| self.slopes[axis] + other.slopes[axis]) }
    }
}

impl<N: Scalar, const K: usize> Sub for Gradient<N, K> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, slopes: each(|axis| self.slopes[axis] - other.slopes[axis]) }
    }
}

impl<N: Scalar, const K: usize> Mul for Gradient<N, K> {
    type Output = Self;

    #[inline(always)]
    #[expect(clippy::suspicious_arithmetic_impl, reason = "the product rule")]
    fn mul(self, other: Self) -> Self {
        apart_if!(N::IS_LONG, {
            let slope = |axis: usize| self.value * other.slopes[axis] + self.slopes[axis] * other.value;
            Self { value: self.value * other.value, slopes: each(slope) }
        })
    }
}

impl<N: Scalar, const K: usize> Div for Gradient<N, K> {
    type Output = Self;

    #[inline(always)]
    #[expect(clippy::suspicious_arithmetic_impl, reason = "the quotient rule")]
    fn div(self, other: Self) -> Self {
        apart_if!(N::IS_LONG, {
            let value = self.value / other.value;
            let slope = |axis: usize| (self.slopes[axis] - value * other.slopes[axis]) / other.value;
            Self { value, slopes: each(slope) }
        })
    }
}

impl<N: Scalar, const K: usize> Neg for Gradient<N, K> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, slopes: each(|axis| -self.slopes[axis]) }
    }
}

impl<N: Scalar, const K: usize> Scalar for Gradient<N, K> {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self { value: N::constant(value), slopes: [N::constant(0.0); K] }
    }

    #[inline(always)]
    fn about(value: f64, error: f64) -> Self {
        Self { value: N::about(value, error), slopes: [N::constant(0.0); K] }
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
        Self::of(|axis| self.along(axis).atan2(x.along(axis)))
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
        self.map(|base| base.powi(exponent))
    }

    #[inline(always)]
    fn scaled(self, factor: f64) -> Self {
        Self { value: self.value.scaled(factor), slopes: each(|axis| self.slopes[axis].scaled(factor)) }
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
        self.value.is_zero() && self.slopes.iter().all(|slope| slope.is_zero())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interval::Interval;
    use crate::scalar::per_axis;
    use std::array::from_fn;

    fn function<N: Scalar>([x, y, z]: [N; 3]) -> N {
        let some = x.powi(3) * y.sin() - z.sqrt() / (x.exp() + y.cos()) + z.ln() * y.tan() + x.atan2(z);
        let more = x.max(y * z).min(z.shifted(1.0).scaled(3.0)) + (x - y).abs() + z.ramp(3) + x.floor();
        some + more * x.pow(y) + N::noise([x, y, z], [0; 3]) - (x - z).choose(x, y * y) + y.powi(-2)
    }

    #[test]
    fn slopes_have_the_bits_of_dual_numbers() {
        for at in [[0.3, 1.1, 2.5], [2.0, 0.1, 0.7], [1.4, 1.4, 1.4]] {
            let Gradient { value, slopes } = function(Gradient::point(at));
            for axis in 0..3 {
                let along = |own: usize| Dual { value: at[own], slope: f64::from(u8::from(own == axis)) };
                let Dual { value: alone, slope } = function(per_axis(along));
                assert_eq!((value.to_bits(), slopes[axis]), (alone.to_bits(), slope), "{at:?} {axis}");
            }
        }
    }

    /// Intervals are widened by each operation, so these are the same operations.
    #[test]
    fn slopes_of_intervals_have_the_bits_of_dual_numbers() {
        for at in [[0.3, 1.1, 2.5], [2.0, 0.1, 0.7], [1.4, 1.4, 1.4]] {
            let [x, _, z] = at.map(|at| Interval { low: at - 1e-3, high: at + 1e-3 });
            let of = |[x, y]: [Gradient<Interval, 2>; 2]| {
                function([x, y, Scalar::constant(0.3)]) + function([y, x, x * y])
            };
            let Gradient { value, slopes } = of(Gradient::point([x, z]));
            for axis in 0..2 {
                let own = [x, z].map(Dual::fixed);
                let [x, y] =
                    from_fn(
                        |own_axis| {
                            if own_axis == axis { Dual::variable(own[axis].value) } else { own[own_axis] }
                        },
                    );
                let alone = function([x, y, Scalar::constant(0.3)]) + function([y, x, x * y]);
                assert_eq!((value, slopes[axis]), (alone.value, alone.slope), "{at:?} {axis}");
            }
        }
    }
}
