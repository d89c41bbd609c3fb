//! Affine arithmetic: quantities over a small region, as linear functions of the place in it with a bound on the rest.
//!
//! An interval knows only the range of a quantity, and forgets what it depends on: over a pixel, the range of a formula's
//! result is then many times too wide. An [`Affine`] number keeps the linear part, so that what is left open shrinks with
//! the square of the region's size; and the mean over the region is known to within that rest alone, however steep the
//! linear part is.

use crate::numeric::interval::Interval;
use crate::numeric::scalar::{Scalar, of_cubic};
use crate::numeric::spline::Spline;
use std::array;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The number of variables.
pub const VARIABLES: usize = 5;

/// A quantity `centre + linear . e + rest`, where each variable in `e` lies anywhere from -1 to 1 and the rest anywhere
/// from `-rest` to `rest`. All roundings are in the rest. An unbounded quantity has an infinite rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine {
    /// The value where all variables and the rest are 0.
    pub centre: f64,
    /// The change with each variable.
    pub linear: [f64; VARIABLES],
    /// A bound on the magnitude of what is not linear, at least 0.
    pub rest: f64,
}

/// Bounds the roundings of an operation, as a fraction of the sum of the magnitudes of its terms: of about 20 in a
/// product of two numbers, each term takes part in at most 12 sums and one product.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// More than what terms lose that underflow.
const UNDERFLOW: f64 = 1e-300;

impl Affine {
    /// Any number, and undefined results.
    pub const WHOLE: Self = Self { centre: 0.0, linear: [0.0; VARIABLES], rest: f64::INFINITY };

    const ZERO: Self = Self { centre: 0.0, linear: [0.0; VARIABLES], rest: 0.0 };

    /// Returns `centre + half * e`, where `e` is the variable of this index.
    pub fn variable(index: usize, centre: f64, half: f64) -> Self {
        let mut linear = [0.0; VARIABLES];
        linear[index] = half;
        Self { centre, linear, rest: 0.0 }
    }

    /// Makes a number of its parts, and adds the roundings of terms whose magnitudes add up to `size`.
    #[inline]
    fn rounded(centre: f64, linear: [f64; VARIABLES], rest: f64, size: f64) -> Self {
        let rest = rest + (ROUNDING * size + UNDERFLOW);
        // A NaN in any part makes this sum no finite number.
        if (rest + size + centre.abs() + spread(&linear)).is_finite() {
            Self { centre, linear, rest }
        } else {
            Self::WHOLE
        }
    }

    /// Returns a bound on the difference from the centre, rounded up.
    #[inline]
    pub fn radius(&self) -> f64 {
        (spread(&self.linear) + self.rest) * (1.0 + ROUNDING)
    }

    /// Encloses all values.
    #[inline]
    pub fn range(&self) -> Interval {
        if self.is_thin() { Interval::point(self.centre) } else { around(self.centre, self.radius()) }
    }

    /// Encloses the mean over all variables, each of which has the mean 0.
    pub fn mean(&self) -> Interval {
        if self.is_thin() { Interval::point(self.centre) } else { around(self.centre, self.rest) }
    }

    /// Returns the mean over the variable of this index, which is the same at any value of the others and has the mean 0.
    pub fn without(mut self, index: usize) -> Self {
        self.linear[index] = 0.0;
        self
    }

    /// Returns the quantity with the dependence on the variable of this index in the rest.
    pub fn absorbing(self, index: usize) -> Self {
        let rest = (self.rest + self.linear[index].abs()) * (1.0 + f64::EPSILON);
        Self { rest, ..self.without(index) }
    }

    /// Tells whether the quantity is 0, for certain.
    #[inline]
    fn is_nothing(&self) -> bool {
        self.centre == 0.0 && self.is_thin()
    }

    /// Tells whether the quantity is one number.
    #[inline]
    fn is_thin(&self) -> bool {
        self.rest == 0.0 && self.linear == [0.0; VARIABLES]
    }

    /// Returns whether the quantity may be 0.
    pub fn has_zero(&self) -> bool {
        self.range().has_zero()
    }

    /// Returns whether the quantity has bounds.
    pub fn is_bounded(&self) -> bool {
        self.rest.is_finite()
    }

    /// Encloses what may be either of two quantities.
    pub fn hull(self, other: Self) -> Self {
        if self == other { self } else { self.range().hull(other.range()).into() }
    }

    /// Applies a function, given its value and its derivative at the centre, and its second derivative over the range.
    #[inline]
    fn chain(&self, value: Interval, slope: Interval, bend: Interval) -> Self {
        let radius = Interval { low: 0.0, high: self.radius() };
        // By Taylor's theorem, of which half of the second derivative and the square of a difference remain.
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

    /// Returns the number, or what else is known to enclose it where that says more of its mean.
    fn or(self, range: Interval) -> Self {
        if 0.5 * range.width() < self.rest { range.into() } else { self }
    }

    /// Applies a function of intervals, where nothing more is known.
    fn by_range(self, function: impl FnOnce(Interval) -> Interval) -> Self {
        function(self.range()).into()
    }
}

/// Encloses a power by repeated squaring: many exponents of highlights are in the hundreds.
fn power(base: Interval, exponent: i32) -> Interval {
    if base.low < 0.0 || exponent < 8 {
        return base.powi(exponent);
    }
    let half = power(base, exponent / 2);
    let square = half * half;
    let power = if exponent % 2 == 0 { square } else { square * base };
    Interval { low: power.low.max(0.0), high: power.high }
}

/// Returns the sum of the magnitudes of the linear parts, rounded.
#[inline]
fn spread(linear: &[f64; VARIABLES]) -> f64 {
    linear.iter().map(|part| part.abs()).sum()
}

/// Encloses the numbers no farther than `radius` from a centre.
#[inline]
fn around(centre: f64, radius: f64) -> Interval {
    let slack = f64::EPSILON * (centre.abs() + radius);
    let (low, high) = (centre - radius - slack, centre + radius + slack);
    if low.is_nan() || high.is_nan() { Interval::WHOLE } else { Interval { low, high } }
}

impl From<Interval> for Affine {
    fn from(of: Interval) -> Self {
        if of.low == of.high && of.is_bounded() {
            return Self { centre: of.low, ..Self::ZERO };
        }
        let half = 0.5 * of.high - 0.5 * of.low;
        Self::rounded(0.5 * of.low + 0.5 * of.high, [0.0; VARIABLES], half, of.low.abs() + of.high.abs())
    }
}

impl Add for Affine {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        let centre = self.centre + other.centre;
        if self.is_nothing() {
            return other;
        }
        if other.is_nothing() {
            return self;
        }
        if self.is_thin()
            && other.is_thin()
            && centre - self.centre == other.centre
            && centre - other.centre == self.centre
        {
            return Self { centre, ..Self::ZERO };
        }
        let linear = array::from_fn(|at| self.linear[at] + other.linear[at]);
        let rest = self.rest + other.rest;
        Self::rounded(centre, linear, rest, centre.abs() + spread(&linear) + rest)
    }
}

impl Sub for Affine {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Neg for Affine {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self { centre: -self.centre, linear: self.linear.map(|part| -part), rest: self.rest }
    }
}

impl Mul for Affine {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        if self.is_nothing() || other.is_nothing() {
            return Self::ZERO;
        }
        let (a, b) = (&self.linear, &other.linear);
        let (lines, others) = (spread(a), spread(b));
        let size = (self.centre.abs() + lines + self.rest) * (other.centre.abs() + others + other.rest);
        if lines == 0.0 || others == 0.0 {
            let rest = self.rest * (other.centre.abs() + others + other.rest)
                + other.rest * (self.centre.abs() + lines);
            let linear = array::from_fn(|at| self.centre * b[at] + other.centre * a[at]);
            return Self::rounded(self.centre * other.centre, linear, rest, size);
        }
        // The square of a variable lies between 0 and 1, and the product of two variables between -1 and 1.
        let (mut shift, mut curved) = (0.0, 0.0);
        for one in 0..VARIABLES {
            let square = a[one] * b[one];
            shift += 0.5 * square;
            curved += 0.5 * square.abs();
            for two in 0..one {
                curved += (a[one] * b[two] + a[two] * b[one]).abs();
            }
        }
        let rest = curved
            + self.rest * (other.centre.abs() + others + other.rest)
            + other.rest * (self.centre.abs() + lines);
        let linear = array::from_fn(|at| self.centre * b[at] + other.centre * a[at]);
        Self::rounded(self.centre * other.centre + shift, linear, rest, size)
    }
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

    fn sqrt(self) -> Self {
        let range = self.range();
        // Where the slope is no longer nearly the same, the line is a worse bound than the range.
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
            of_cubic(self, spline, first, order)
        } else {
            self.by_range(|range| range.spline(spline, order))
        }
    }

    fn floor(self) -> Self {
        self.by_range(Interval::floor)
    }

    fn min(self, other: Self) -> Self {
        -(-self).max(-other)
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

    fn kink(self) -> Self {
        self.by_range(Interval::kink)
    }

    fn jump(self) -> Self {
        self.by_range(Interval::jump)
    }

    fn is_zero(self) -> bool {
        self.is_nothing()
    }
}
