//! Affine arithmetic: quantities over a small region as linear functions of the position in it, with a bound of the
//! rest.
//!
//! An interval only knows the range of a quantity, not what the quantity depends on. Over a pixel, the range of a
//! formula's result is then many times too wide. An [`Affine`] number keeps the linear part, and the uncertain rest
//! shrinks with the square of the region's size. The error of the mean over the region is that rest alone, however
//! steep the linear part is.

mod functions;

use crate::interval::Interval;
use std::array;
use std::ops::{Add, Mul, Neg, Sub};

/// The number of variables.
pub const VARIABLES: usize = 5;

/// A quantity `centre + linear . e + rest`. Each variable in `e` is in the range from -1 to 1, and the rest in the
/// range from `-rest` to `rest`, which includes all roundings. An unbounded quantity has an infinite rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine {
    /// The value at 0 for all variables and the rest.
    pub centre: f64,
    /// The change with each variable.
    pub linear: [f64; VARIABLES],
    /// A bound of the magnitude of the nonlinear part, at least 0.
    pub rest: f64,
}

/// A bound of the roundings of an operation, as a fraction of the sum of the magnitudes of its terms. A product of two
/// numbers has about 20 terms, and each term takes part in at most 12 sums and one product.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// A bound of the error of terms that underflow.
const UNDERFLOW: f64 = 1e-300;

impl Affine {
    /// Any number, and undefined results.
    pub const WHOLE: Self = Self { centre: 0.0, linear: [0.0; VARIABLES], rest: f64::INFINITY };

    const ZERO: Self = Self { centre: 0.0, linear: [0.0; VARIABLES], rest: 0.0 };

    /// Returns `centre + half * e` for the variable `e` with this index.
    pub fn variable(index: usize, centre: f64, half: f64) -> Self {
        let mut linear = [0.0; VARIABLES];
        linear[index] = half;
        Self { centre, linear, rest: 0.0 }
    }

    /// Makes a number from its parts, and adds the roundings of terms with magnitudes that add up to `size`.
    #[inline]
    fn rounded(centre: f64, linear: [f64; VARIABLES], rest: f64, size: f64) -> Self {
        let rest = rest + (ROUNDING * size + UNDERFLOW);
        // If any part is a NaN, this sum is not finite.
        if (rest + size + centre.abs() + spread(&linear)).is_finite() {
            Self { centre, linear, rest }
        } else {
            Self::WHOLE
        }
    }

    /// Returns an upper bound of the difference from the centre.
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

    /// Returns the mean over the variable with this index, which is independent of the others and has the mean 0.
    pub fn without(mut self, index: usize) -> Self {
        self.linear[index] = 0.0;
        self
    }

    /// Moves the dependence on the variable with this index into the rest.
    pub fn absorbing(self, index: usize) -> Self {
        let rest = (self.rest + self.linear[index].abs()) * (1.0 + f64::EPSILON);
        Self { rest, ..self.without(index) }
    }

    /// Tells whether the quantity is certainly 0.
    #[inline]
    fn is_nothing(&self) -> bool {
        self.centre == 0.0 && self.is_thin()
    }

    /// Tells whether the quantity is a single number.
    #[inline]
    fn is_thin(&self) -> bool {
        self.rest == 0.0 && self.linear == [0.0; VARIABLES]
    }

    /// Returns whether the quantity may be 0.
    pub fn has_zero(&self) -> bool {
        self.range().has_zero()
    }

    /// Returns whether the quantity is bounded.
    pub fn is_bounded(&self) -> bool {
        self.rest.is_finite()
    }

    /// Encloses a quantity that may be either of two.
    pub fn hull(self, other: Self) -> Self {
        if self == other { self } else { self.range().hull(other.range()).into() }
    }
}

/// Returns the sum of the magnitudes of the linear parts, rounded.
#[inline]
fn spread(linear: &[f64; VARIABLES]) -> f64 {
    linear.iter().map(|part| part.abs()).sum()
}

/// Encloses the numbers within `radius` of a centre.
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
