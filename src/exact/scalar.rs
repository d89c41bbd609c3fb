//! The number types for the evaluation of formulas: plain numbers here, [`Interval`](crate::interval::Interval)s and
//! [`Dual`](crate::dual::Dual) numbers in their own modules.
//!
//! One formula evaluated with different types gives values, derivatives and proven bounds. The functions are those of
//! the `libm` crate, with results that do not depend on the machine.

use crate::noise::{self, Curve};
use crate::sines::sines;
use crate::spline::{Coefficient, Spline};
use glam::DVec3;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Inlines an operation, or calls it if it is long. A long one is thus compiled once and not into each formula, which
/// would take megabytes of code.
macro_rules! apart_if {
    ($is_long:expr, $operation:expr) => {
        if $is_long { $crate::scalar::apart(move || $operation) } else { $operation }
    };
}

pub(crate) use apart_if;

/// Calls a function without inlining it.
#[inline(never)]
pub(crate) fn apart<R>(operation: impl FnOnce() -> R) -> R {
    operation()
}

/// Implements an operator of a number type with these generic parameters.
macro_rules! operator {
    ([$($generics:tt)*] $Number:ty, $Operator:ident $function:ident($one:ident $(, $other:ident)?) => $value:expr) => {
        impl<$($generics)*> std::ops::$Operator for $Number {
            type Output = Self;

            #[inline(always)]
            fn $function($one $(, $other: Self)?) -> Self {
                $value
            }
        }
    };
}

pub(crate) use operator;

/// A number type for the evaluation of formulas.
///
/// The square root of a negative number is 0, and so a profile such as `sqrt(9 - y^2)` has an end and not a gap in its
/// domain. The logarithm and powers of negative numbers are undefined.
pub trait Scalar:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// Whether derivatives of the numbers are computed in calls. For numbers longer than an interval of `f64`, they
    /// take hundreds of instructions.
    const IS_LONG: bool = size_of::<Self>() > size_of::<[f64; 2]>();

    /// Returns a constant.
    fn constant(value: f64) -> Self;
    /// Returns a number that is known to within an error: an interval for types with bounds, and otherwise the number
    /// itself.
    #[inline(always)]
    fn about(value: f64, _error: f64) -> Self {
        Self::constant(value)
    }
    /// Returns bounds of the number, which are infinite for types without bounds.
    #[inline(always)]
    fn bounds(self) -> [f64; 2] {
        [f64::NEG_INFINITY, f64::INFINITY]
    }

    /// Returns the sine and the cosine of an angle in radians.
    fn sin_cos(self) -> (Self, Self);
    /// Returns the sine of an angle in radians.
    #[inline(always)]
    fn sin(self) -> Self {
        self.sin_cos().0
    }

    /// Returns the cosine of an angle in radians.
    #[inline(always)]
    fn cos(self) -> Self {
        self.sin_cos().1
    }

    /// Returns the tangent of an angle in radians.
    fn tan(self) -> Self;
    /// Returns e raised to this power.
    fn exp(self) -> Self;
    /// Returns the natural logarithm.
    fn ln(self) -> Self;
    /// Returns the angle, in radians from -π to π, from the positive x axis to the point with this y and the given x.
    /// The angle jumps at y = 0 and negative x.
    fn atan2(self, x: Self) -> Self;
    /// Returns the square root, or 0 for a negative number.
    fn sqrt(self) -> Self;
    /// Returns the absolute value.
    fn abs(self) -> Self;
    /// Returns the largest integer that is at most the number.
    fn floor(self) -> Self;
    /// Returns the smaller of two numbers.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        -(-self).max(-other)
    }

    /// Returns the larger of two numbers.
    fn max(self, other: Self) -> Self;
    /// Returns the number raised to a power.
    fn pow(self, exponent: Self) -> Self;
    /// Returns the number raised to an integer power.
    fn powi(self, exponent: i32) -> Self;

    /// Returns the integer that this number certainly is. Of numbers that enclose others, a power with such an exponent is a
    /// product. `None` of plain numbers, so that each power keeps its last bits.
    fn whole(self) -> Option<i32> {
        None
    }

    /// Returns the number times a constant.
    #[inline(always)]
    fn scaled(self, factor: f64) -> Self {
        self * Self::constant(factor)
    }

    /// Returns the number plus a constant.
    #[inline(always)]
    fn shifted(self, by: f64) -> Self {
        self + Self::constant(by)
    }

    /// Returns a power, 1 or more, of a positive number, and 0 for other numbers.
    #[inline(always)]
    fn ramp(self, exponent: i32) -> Self {
        self.max(Self::constant(0.0)).powi(exponent)
    }

    /// Returns the value of a spline, or its derivative of an order from 0.
    fn spline(self, spline: &Spline, order: usize) -> Self;

    /// Returns the gradient noise (Perlin 2002) at a point, or its derivative of these orders along x, y and z.
    fn noise(at: [Self; 3], orders: [u8; 3]) -> Self;

    /// Returns the step function, 1 for positive and 0 for negative numbers, which is the derivative of `max(0, x)`.
    fn step(self) -> Self;
    /// Returns `one` if this number is 0 or above, and `other` if it is negative. The number that is not returned may
    /// be undefined.
    #[inline(always)]
    fn choose(self, one: Self, other: Self) -> Self {
        let [low, high] = self.bounds();
        if low >= 0.0 {
            one
        } else if high < 0.0 {
            other
        } else {
            other + (one - other) * self.step()
        }
    }

    /// Returns the derivative of [`step`](Self::step): unbounded if the number may be 0, and otherwise 0.
    fn d_step(self) -> Self;
    /// Returns the derivative of [`floor`](Self::floor): unbounded if the number may be an integer, and otherwise 0.
    fn d_floor(self) -> Self;
    /// Returns whether the number is exactly 0, with no other possible value.
    fn is_zero(self) -> bool;
}

/// Calls a function for axes 0, 1 and 2, and returns the three results.
///
/// `map` of an array does the same, but guards against panics, which costs compile time for each number type and is
/// useless here.
#[inline(always)]
pub fn per_axis<T>(mut of: impl FnMut(usize) -> T) -> [T; 3] {
    [of(0), of(1), of(2)]
}

/// Returns the value of a piece of a spline, or its derivative of an order from 0. `number` converts coefficients.
#[inline]
pub(crate) fn of_cubic<N: Scalar>(
    y: N,
    spline: &Spline,
    (piece, order): (usize, usize),
    number: impl Fn(&Coefficient) -> N,
) -> N {
    let (from, of) = spline.cubic(piece, order);
    let t = y.shifted(-from);
    let [c0, c1, c2, c3] = of.each_ref().map(number);
    ((c3 * t + c2) * t + c1) * t + c0
}

/// Returns the value of a polynomial of one coordinate, given its coefficients.
fn curve<N: Scalar>(of: &Curve, t: N) -> N {
    of.iter().rev().skip(1).fold(N::constant(of[of.len() - 1]), |sum, term| (sum * t).shifted(*term))
}

/// Returns the noise, or its derivative of these orders, in the cell with this lowest corner. `t` has the coordinates
/// relative to that corner, from 0 to 1.
pub(crate) fn of_noise<N: Scalar>(corner: [f64; 3], t: [N; 3], orders: [u8; 3]) -> N {
    let along = |axis: usize| noise::curves(orders[axis]).map(|pair| pair.map(|of| curve(&of, t[axis])));
    let along = [along(0), along(1), along(2)];
    let mut sum = N::constant(0.0);
    for index in 0..8 {
        let at = [index & 1, index >> 1 & 1, index >> 2];
        let gradient = noise::gradient([0, 1, 2].map(|axis| corner[axis] + at[axis] as f64));
        for (axis, slope) in gradient.into_iter().enumerate().filter(|(_, slope)| *slope != 0.0) {
            // The factors are the rise along this axis and the weights along the others.
            let factor = |of: usize| along[of][usize::from(of == axis)][at[of]];
            let product = factor(0) * factor(1) * factor(2);
            sum = if slope > 0.0 { sum + product } else { sum - product };
        }
    }
    sum
}

/// Returns the derivative of the noise, or of its derivative of these orders, along the slopes of coordinates.
pub(crate) fn noise_slope<N: Scalar>(at: [N; 3], slopes: [N; 3], orders: [u8; 3]) -> N {
    let mut sum = N::constant(0.0);
    for axis in (0..3).filter(|axis| !slopes[*axis].is_zero()) {
        let mut more = orders;
        more[axis] += 1;
        sum = sum + N::noise(at, more) * slopes[axis];
    }
    sum
}

/// Returns a vector of constants.
#[inline(always)]
pub fn constants<N: Scalar>(of: DVec3) -> [N; 3] {
    [N::constant(of.x), N::constant(of.y), N::constant(of.z)]
}

/// Returns the dot product of two vectors.
#[inline]
pub fn dot<N: Scalar>(a: [N; 3], b: [N; 3]) -> N {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns the unit vector along a vector.
#[inline]
pub fn unit<N: Scalar>(vector: [N; 3]) -> [N; 3] {
    let inverse = N::constant(1.0) / dot(vector, vector).sqrt();
    per_axis(|axis| vector[axis] * inverse)
}

/// Returns the cross product of two vectors.
pub fn cross<N: Scalar>(a: [N; 3], b: [N; 3]) -> [N; 3] {
    per_axis(|axis| {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        a[next] * b[last] - a[last] * b[next]
    })
}

/// Computes a power by repeated squaring, which gives the same bits on each machine.
#[inline(always)]
pub(crate) fn by_squaring<N: Scalar>(base: N, exponent: i32) -> N {
    let (mut result, mut square, mut left) = (N::constant(1.0), base, exponent.unsigned_abs());
    while left > 0 {
        if left & 1 == 1 {
            result = result * square;
        }
        left >>= 1;
        square = square * square;
    }
    if exponent < 0 { N::constant(1.0) / result } else { result }
}

impl Scalar for f64 {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn bounds(self) -> [f64; 2] {
        [self, self]
    }

    fn sin_cos(self) -> (Self, Self) {
        let ([sin], [cos]) = sines([self]);
        (sin, cos)
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

    fn atan2(self, x: Self) -> Self {
        libm::atan2(self, x)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        // The comparison keeps a NaN.
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

    #[inline(always)]
    fn powi(self, exponent: i32) -> Self {
        // The result has the same bits.
        if exponent == 2 { self * self } else { by_squaring(self, exponent) }
    }

    fn spline(self, spline: &Spline, order: usize) -> Self {
        of_cubic(self, spline, (spline.piece(self), order), |of| of.near)
    }

    fn noise(at: [Self; 3], orders: [u8; 3]) -> Self {
        let corner = at.map(f64::floor);
        of_noise(corner, per_axis(|axis| at[axis] - corner[axis]), orders)
    }

    #[inline(always)]
    fn step(self) -> Self {
        if self < 0.0 { 0.0 } else { 1.0 }
    }

    #[inline(always)]
    fn d_step(self) -> Self {
        0.0
    }

    #[inline(always)]
    fn d_floor(self) -> Self {
        0.0
    }

    #[inline(always)]
    fn is_zero(self) -> bool {
        self == 0.0
    }
}
