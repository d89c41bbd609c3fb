//! The chain rule: functions of numbers that carry derivatives, once for all such numbers.

use crate::scalar::{Scalar, apart_if, noise_slope};
use crate::spline::Spline;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number with derivatives along one or more axes.
pub trait Differentiated:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// The number without derivatives.
    type Value: Scalar;
    /// A derivative along an axis. If there are second derivatives, it carries its own.
    type Slope: Scalar;

    /// Makes a number from its value and its derivative along each axis.
    fn new(value: Self::Value, slope: impl Fn(usize) -> Self::Slope) -> Self;
    /// Returns the number without its highest derivatives. At this number, the derivatives of functions are computed.
    fn lower(self) -> Self::Slope;
    /// Returns a number without its derivatives.
    fn bare(of: Self::Slope) -> Self::Value;
    /// Returns the derivative along an axis.
    fn slope(self, axis: usize) -> Self::Slope;
    /// Tells whether all derivatives are 0.
    fn is_fixed(self) -> bool;

    /// Returns the number without derivatives.
    #[inline(always)]
    fn value(self) -> Self::Value {
        Self::bare(self.lower())
    }

    /// Applies a function, given its value and its derivative at the number.
    #[inline(always)]
    fn chain(self, value: Self::Value, derivative: Self::Slope) -> Self {
        Self::new(value, |axis| derivative * self.slope(axis))
    }

    /// Returns the product of two numbers.
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        apart_if!(Self::Value::IS_LONG, {
            let slope = |axis| self.lower() * other.slope(axis) + self.slope(axis) * other.lower();
            Self::new(self.value() * other.value(), slope)
        })
    }

    /// Returns the quotient of two numbers.
    #[inline(always)]
    fn over(self, other: Self) -> Self {
        apart_if!(Self::Value::IS_LONG, {
            let quotient = self.lower() / other.lower();
            let slope = |axis| (self.slope(axis) - quotient * other.slope(axis)) / other.lower();
            Self::new(Self::bare(quotient), slope)
        })
    }
}

/// Implements the operators of a number with derivatives.
macro_rules! operators {
    ($generics:tt $Number:ty) => {
        $crate::scalar::operator!($generics $Number, Add add(self, other) => {
            Self::new(self.value + other.value, |axis| self.slope(axis) + other.slope(axis))
        });
        $crate::scalar::operator!($generics $Number, Sub sub(self, other) => {
            Self::new(self.value - other.value, |axis| self.slope(axis) - other.slope(axis))
        });
        $crate::scalar::operator!($generics $Number, Mul mul(self, other) => self.times(other));
        $crate::scalar::operator!($generics $Number, Div div(self, other) => self.over(other));
        $crate::scalar::operator!($generics $Number, Neg neg(self) => Self::new(-self.value, |axis| -self.slope(axis)));
    };
}

pub(crate) use operators;

impl<D: Differentiated> Scalar for D {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self::new(D::Value::constant(value), |_| D::Slope::constant(0.0))
    }

    #[inline(always)]
    fn about(value: f64, error: f64) -> Self {
        Self::new(D::Value::about(value, error), |_| D::Slope::constant(0.0))
    }

    #[inline(always)]
    fn bounds(self) -> [f64; 2] {
        self.value().bounds()
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.lower().sin_cos();
        (self.chain(D::bare(sin), cos), self.chain(D::bare(cos), -sin))
    }

    fn tan(self) -> Self {
        let tan = self.lower().tan();
        self.chain(D::bare(tan), D::Slope::constant(1.0) + tan.powi(2))
    }

    fn exp(self) -> Self {
        let exp = self.lower().exp();
        self.chain(D::bare(exp), exp)
    }

    fn ln(self) -> Self {
        self.chain(self.value().ln(), D::Slope::constant(1.0) / self.lower())
    }

    fn atan2(self, x: Self) -> Self {
        let (y, at) = (self.lower(), x.lower());
        let square = at.powi(2) + y.powi(2);
        // The slope is unbounded where the angle jumps.
        let jump = y.d_step() * (-at).step();
        let turns = |axis| (at * self.slope(axis) - y * x.slope(axis)) / square;
        Self::new(self.value().atan2(x.value()), |axis| turns(axis) + jump)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        apart_if!(D::Value::IS_LONG, {
            let root = self.lower().sqrt();
            self.chain(D::bare(root), D::Slope::constant(0.5) * self.lower().step() / root)
        })
    }

    #[inline(always)]
    fn abs(self) -> Self {
        let sign = D::Slope::constant(2.0) * self.lower().step() - D::Slope::constant(1.0);
        self.chain(self.value().abs(), sign)
    }

    #[inline(always)]
    fn floor(self) -> Self {
        self.chain(self.value().floor(), self.lower().d_floor())
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        apart_if!(D::Value::IS_LONG, {
            let own = (self.lower() - other.lower()).step();
            let others = D::Slope::constant(1.0) - own;
            let slope = |axis| own * self.slope(axis) + others * other.slope(axis);
            Self::new(self.value().max(other.value()), slope)
        })
    }

    fn pow(self, exponent: Self) -> Self {
        if let Some(exponent) = exponent.whole() {
            return self.powi(exponent);
        }
        let (base, power) = (self.lower(), exponent.lower());
        let value = base.pow(power);
        let by_base = power * base.pow(power - D::Slope::constant(1.0));
        // The exponent is nearly always a constant, and then the base may be 0 or negative.
        let by_exponent = |slope: D::Slope| {
            if slope.is_zero() { D::Slope::constant(0.0) } else { value * base.ln() }
        };
        let slope = |axis| {
            let along = exponent.slope(axis);
            by_base * self.slope(axis) + by_exponent(along) * along
        };
        Self::new(D::bare(value), slope)
    }

    fn whole(self) -> Option<i32> {
        self.value().whole().filter(|_| self.is_fixed())
    }

    #[inline(always)]
    fn powi(self, exponent: i32) -> Self {
        apart_if!(D::Value::IS_LONG, {
            let derivative = match exponent {
                0 => return Self::constant(1.0),
                1 => return self,
                2 => self.lower() + self.lower(),
                _ => D::Slope::constant(f64::from(exponent)) * self.lower().powi(exponent - 1),
            };
            self.chain(self.value().powi(exponent), derivative)
        })
    }

    #[inline(always)]
    fn scaled(self, factor: f64) -> Self {
        Self::new(self.value().scaled(factor), |axis| self.slope(axis).scaled(factor))
    }

    #[inline(always)]
    fn shifted(self, by: f64) -> Self {
        Self::new(self.value().shifted(by), |axis| self.slope(axis))
    }

    /// Differentiates the power as a whole. Its derivatives may be bounded where those of its base are not.
    #[inline(always)]
    fn ramp(self, exponent: i32) -> Self {
        let derivative = if exponent == 1 {
            self.lower().step()
        } else {
            D::Slope::constant(f64::from(exponent)) * self.lower().ramp(exponent - 1)
        };
        self.chain(self.value().ramp(exponent), derivative)
    }

    fn spline(self, spline: &Spline, order: usize) -> Self {
        self.chain(self.value().spline(spline, order), self.lower().spline(spline, order + 1))
    }

    fn noise(at: [Self; 3], orders: [u8; 3]) -> Self {
        let slope = |axis| noise_slope(at.map(Self::lower), at.map(|along| along.slope(axis)), orders);
        Self::new(D::Value::noise(at.map(Self::value), orders), slope)
    }

    #[inline(always)]
    fn step(self) -> Self {
        self.chain(self.value().step(), self.lower().d_step())
    }

    #[inline(always)]
    fn d_step(self) -> Self {
        let slope = self.lower().d_step();
        self.chain(D::bare(slope), slope)
    }

    #[inline(always)]
    fn d_floor(self) -> Self {
        let slope = self.lower().d_floor();
        self.chain(D::bare(slope), slope)
    }

    #[inline(always)]
    fn is_zero(self) -> bool {
        self.value().is_zero() && self.is_fixed()
    }
}
