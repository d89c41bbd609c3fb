//! Functions of affine numbers. Each uses its tangent and a bound of its curvature, or its range.

use super::{Affine, spread};
use crate::interval::Interval;
use crate::scalar::{Scalar, of_cubic, of_noise, per_axis};
use crate::spline::Spline;
use std::ops::Div;

impl Affine {
    /// Applies a function, given its value and derivative at the centre, and its second derivative over the range.
    #[inline]
    fn chain(&self, value: Interval, slope: Interval, bend: Interval) -> Self {
        let radius = Interval { low: 0.0, high: self.radius() };
        // The remainder in Taylor's theorem is half of the second derivative times the square of a difference.
        let curved = Interval::constant(0.5) * bend * radius * radius;
        let (from, to) = (curved.low.min(0.0), curved.high.max(0.0));
        let (middle, steep) = (value.middle(), slope.middle());
        let shift = 0.5 * (from + to);
        let lines = spread(&self.linear);
        let rest = slope.magnitude() * self.rest + (to - from) * 0.5 + value.width() + slope.width() * lines;
        let size = middle.abs() + from.abs() + to.abs() + steep.abs() * lines + rest;
        Self::rounded(middle + shift, self.linear.map(|part| steep * part), rest, size)
    }

    fn reciprocal(self) -> Self {
        let range = self.range();
        if range.has_zero() || !range.is_bounded() {
            return Self::WHOLE;
        }
        let (one, at) = (Interval::constant(1.0), Interval::point(self.centre));
        let value = one / at;
        self.chain(value, -(value * value), Interval::constant(2.0) / range.powi(3))
    }

    /// Returns the number, or its range if that bounds the mean more closely.
    fn or(self, range: Interval) -> Self {
        if 0.5 * range.width() < self.rest { range.into() } else { self }
    }

    /// Applies a function by its range alone.
    fn by_range(self, function: impl FnOnce(Interval) -> Interval) -> Self {
        function(self.range()).into()
    }
}

/// Encloses a power by repeated squaring, because exponents of highlights are often in the hundreds.
fn power(base: Interval, exponent: i32) -> Interval {
    if base.low < 0.0 || exponent < 8 {
        return base.powi(exponent);
    }
    let half = power(base, exponent / 2);
    let square = half * half;
    let power = if exponent % 2 == 0 { square } else { square * base };
    Interval { low: power.low.max(0.0), high: power.high }
}

impl Div for Affine {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        if self.is_nothing() && !other.has_zero() { self } else { self * other.reciprocal() }
    }
}

impl Scalar for Affine {
    #[inline]
    fn constant(value: f64) -> Self {
        Self { centre: value, ..Self::ZERO }
    }

    fn about(value: f64, error: f64) -> Self {
        Self { centre: value, rest: error, ..Self::ZERO }
    }

    #[inline(always)]
    fn bounds(self) -> [f64; 2] {
        let Interval { low, high } = self.range();
        [low, high]
    }

    fn sin_cos(self) -> (Self, Self) {
        let ((sin, cos), (sines, cosines)) = (Interval::point(self.centre).sin_cos(), self.range().sin_cos());
        (self.chain(sin, cos, -sines), self.chain(cos, -sin, -cosines))
    }

    fn tan(self) -> Self {
        self.by_range(Interval::tan)
    }

    fn exp(self) -> Self {
        let value = Interval::point(self.centre).exp();
        self.chain(value, value, self.range().exp())
    }

    fn ln(self) -> Self {
        let range = self.range();
        if range.low <= 0.0 {
            return self.by_range(Interval::ln);
        }
        let (one, at) = (Interval::constant(1.0), Interval::point(self.centre));
        self.chain(at.ln(), one / at, -(one / range.powi(2)))
    }

    fn atan2(self, x: Self) -> Self {
        self.range().atan2(x.range()).into()
    }

    fn sqrt(self) -> Self {
        let range = self.range();
        // If the slope varies a lot, the line is a worse bound than the range.
        if range.low <= 0.0 || self.is_thin() {
            return self.by_range(Interval::sqrt);
        }
        let root = Interval::point(self.centre).sqrt();
        let slope = Interval::constant(0.5) / root;
        let bend = Interval::constant(-0.25) / (range * range.sqrt());
        self.chain(root, slope, bend).or(range.sqrt())
    }

    fn abs(self) -> Self {
        let range = self.range();
        if range.low >= 0.0 {
            self
        } else if range.high <= 0.0 {
            -self
        } else {
            range.abs().into()
        }
    }

    fn spline(self, spline: &Spline, order: usize) -> Self {
        let range = self.range();
        let [first, last] = [range.low, range.high].map(|end| spline.piece(end));
        if first == last {
            of_cubic(self, spline, (first, order), |of| Self::about(of.near, of.error))
        } else {
            self.by_range(|range| range.spline(spline, order))
        }
    }

    fn noise(at: [Self; 3], orders: [u8; 3]) -> Self {
        let ranges = at.map(|along| along.range());
        let corner = ranges.map(|along| along.low.floor());
        let whole = Interval::noise(ranges, orders);
        let is_one = (0..3).all(|axis| ranges[axis].high < corner[axis] + 1.0);
        if is_one {
            of_noise(corner, per_axis(|axis| at[axis].shifted(-corner[axis])), orders).or(whole)
        } else {
            whole.into()
        }
    }

    fn floor(self) -> Self {
        self.by_range(Interval::floor)
    }

    fn max(self, other: Self) -> Self {
        let (one, two) = (self.range(), other.range());
        if one.low >= two.high {
            self
        } else if two.low >= one.high {
            other
        } else {
            one.max(two).into()
        }
    }

    fn pow(self, exponent: Self) -> Self {
        if let Some(exponent) = exponent.whole() {
            return self.powi(exponent);
        }
        let range = self.range();
        if !(exponent.is_thin() && range.low > 0.0) {
            return range.pow(exponent.range()).into();
        }
        let (power, one) = (Interval::point(exponent.centre), Interval::constant(1.0));
        let at = Interval::point(self.centre);
        let slope = power * at.pow(power - one);
        let bend = power * (power - one) * range.pow(power - one - one);
        self.chain(at.pow(power), slope, bend).or(range.pow(power))
    }

    fn whole(self) -> Option<i32> {
        self.range().whole()
    }

    fn powi(self, exponent: i32) -> Self {
        match exponent {
            0 => Self::constant(1.0),
            1 => self,
            2 => self * self,
            _ if exponent < 0 => self.powi(-exponent).reciprocal(),
            _ => {
                let (at, range) = (Interval::point(self.centre), self.range());
                let degree = f64::from(exponent);
                let slope = Interval::constant(degree) * power(at, exponent - 1);
                let bend = Interval::constant(degree * (degree - 1.0)) * power(range, exponent - 2);
                self.chain(power(at, exponent), slope, bend).or(power(range, exponent))
            }
        }
    }

    fn step(self) -> Self {
        self.by_range(Interval::step)
    }

    fn d_step(self) -> Self {
        self.by_range(Interval::d_step)
    }

    fn d_floor(self) -> Self {
        self.by_range(Interval::d_floor)
    }

    fn is_zero(self) -> bool {
        self.is_nothing()
    }
}
