//! Interval arithmetic: every operation rounds outward, so that an interval encloses the true result.
//!
//! The endpoints are `f64`, or have 237 bits where `f64` leaves a question open ([`Wide`]).

mod float;
mod fraction;

use crate::numeric::scalar::Scalar;
use f256::f256;
pub use float::Float;
pub use fraction::Fraction;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Inlines an operation on intervals, or where numbers are [long](Float::IS_LONG) calls it, so that it is compiled once and
/// not into every formula, which would take megabytes of code.
macro_rules! apart_if_long {
    ($F:ident, $operation:expr) => {
        if $F::IS_LONG { apart(move || $operation) } else { $operation }
    };
}

/// Calls a function without inlining it.
#[inline(never)]
fn apart<R>(operation: impl FnOnce() -> R) -> R {
    operation()
}

/// A closed interval: all numbers from `low` to `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval<F = f64> {
    /// The lower endpoint.
    pub low: F,
    /// The upper endpoint.
    pub high: F,
}

/// An interval whose endpoints have 237 bits.
pub type Wide = Interval<f256>;

/// An interval whose endpoints are fractions.
pub type Fine = Interval<Fraction>;

impl From<Interval> for Wide {
    fn from(of: Interval) -> Self {
        Self { low: of.low.into(), high: of.high.into() }
    }
}

impl From<Wide> for Fine {
    fn from(of: Wide) -> Self {
        Self { low: of.low.into(), high: of.high.into() }
    }
}

impl Fine {
    /// Converts to 237 bits, rounded outward.
    pub fn wide(self) -> Wide {
        Wide { low: self.low.neighbours().0, high: self.high.neighbours().1 }
    }
}

impl Interval {
    /// All numbers, and undefined results.
    pub const WHOLE: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY };
}

impl<F: Float> Interval<F> {
    /// Returns all numbers, and undefined results.
    pub fn whole() -> Self {
        Self { low: -F::INFINITY, high: F::INFINITY }
    }

    /// Returns the interval of one number.
    #[inline(always)]
    pub fn point(at: F) -> Self {
        Self { low: at, high: at }
    }

    /// Returns whether the interval may contain 0.
    #[inline(always)]
    pub fn has_zero(self) -> bool {
        !(self.low > F::of(0.0) || self.high < F::of(0.0))
    }

    /// Returns the largest absolute value in the interval.
    #[inline(always)]
    pub fn magnitude(self) -> F {
        self.low.abs().max(self.high.abs())
    }

    /// Returns the width of the interval, rounded.
    pub fn width(self) -> F {
        self.high - self.low
    }

    /// Returns the midpoint, rounded.
    pub fn middle(self) -> F {
        self.low + F::of(0.5) * (self.high - self.low)
    }

    /// Returns the smallest interval that contains both.
    pub fn hull(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Converts to `f64`, rounded outward.
    pub fn coarse(self) -> Interval {
        Interval { low: self.low.to_f64().next_down(), high: self.high.to_f64().next_up() }
    }

    /// Returns the greatest integer that is not greater than the numbers, where it is the same for all of them.
    pub fn certain_floor(self) -> Option<f64> {
        let floor = self.low.floor();
        (floor == self.high.floor() && floor.is_finite()).then(|| floor.to_f64())
    }

    /// Encloses π.
    pub fn pi() -> Self {
        Self::outward(F::PI, F::PI)
    }

    /// Returns whether both endpoints are finite.
    pub fn is_bounded(self) -> bool {
        self.low.is_finite() && self.high.is_finite()
    }

    /// Widens rounded endpoints so that they enclose the exact ones. NaN gives the whole line.
    #[inline(always)]
    fn outward(low: F, high: F) -> Self {
        let (low, high) = F::outward(low, high);
        if low.is_nan() || high.is_nan() { Self::whole() } else { Self { low, high } }
    }

    /// Widens the rounded endpoints of a sum or difference, which are 0 only where they are exact.
    #[inline(always)]
    fn outward_sum(low: F, high: F) -> Self {
        let (low, high) = F::outward_sum(low, high);
        if low.is_nan() || high.is_nan() { Self::whole() } else { Self { low, high } }
    }

    /// Widens the endpoints of functions that are less precise than arithmetic.
    fn around(low: F, high: F) -> Self {
        let (low, high) = F::around(low, high);
        if low.is_nan() || high.is_nan() { Self::whole() } else { Self { low, high } }
    }

    /// Returns whether the interval may contain `start` plus any multiple of 2π radians.
    fn holds_angle(self, start: F) -> bool {
        // Roundings of half an EPSILON of the angles each: two in the difference, one each in π, the quotient, the
        // product and the two sums. That is 3.5 EPSILON in all.
        let rounding = F::of(4.503_599_627_370_496) * F::EPSILON;
        let slack = rounding * (F::of(1.0) + self.low.abs() + self.high.abs());
        let turn = F::of(2.0) * F::PI;
        let turns = -(-((self.low - slack - start) / turn)).floor();
        start + turns * turn <= self.high + slack
    }

    /// Returns whether the interval is narrower than a bound in radians, and below 1e15 radians, where sines still mean
    /// something; other angles are taken for any angle.
    fn is_narrower(self, than: F) -> bool {
        self.width() < than && self.magnitude() < F::of(1e15)
    }

    /// Returns the sine or cosine over the interval, from its values at the endpoints; it is 1 at `top` and -1 at `top
    /// - π` radians.
    fn sine_or_cosine(self, at_low: F, at_high: F, top: F) -> Self {
        let one = F::of(1.0);
        let Self { low, high } = Self::around(at_low.min(at_high), at_low.max(at_high));
        Self {
            low: if self.holds_angle(top - F::PI) { -one } else { low.max(-one) },
            high: if self.holds_angle(top) { one } else { high.min(one) },
        }
    }

    /// Returns the minimum and the maximum of four numbers, NaN ignored.
    #[inline(always)]
    fn extremes(a: F, b: F, c: F, d: F) -> (F, F) {
        (a.min(b).min(c.min(d)), a.max(b).max(c.max(d)))
    }
}

impl<F: Float> Add for Interval<F> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        apart_if_long!(F, Self::outward_sum(self.low + other.low, self.high + other.high))
    }
}

impl<F: Float> Sub for Interval<F> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        apart_if_long!(F, {
            // The difference of a single number with itself is exactly 0: a product with something unbounded then stays 0.
            if self == other && self.low == self.high {
                return Self::constant(0.0);
            }
            Self::outward_sum(self.low - other.high, self.high - other.low)
        })
    }
}

impl<F: Float> Neg for Interval<F> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low }
    }
}

impl<F: Float> Mul for Interval<F> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        apart_if_long!(F, {
            // The product of 0 with anything is 0, even if that is unbounded.
            if self.is_zero() || other.is_zero() {
                return Self::constant(0.0);
            }
            // The common case: finite endpoints, none of them 0.
            if let Some((low, high)) = F::product_ends([self.low, self.high], [other.low, other.high]) {
                return Self::outward(low, high);
            }
            let (low, high) = Self::extremes(
                self.low * other.low,
                self.low * other.high,
                self.high * other.low,
                self.high * other.high,
            );
            // `min` and `max` above ignored 0 times infinity, where an endpoint at 0 meets an infinite one.
            let touches = |a: Self, b: Self| a.has_zero() && !b.is_bounded();
            if touches(self, other) || touches(other, self) {
                return Self::outward(low.min(F::of(0.0)), high.max(F::of(0.0)));
            }
            // Products of numbers that are not negative are not negative: so a root can be taken of them.
            let zero = F::of(0.0);
            if self.low >= zero && other.low >= zero && low == zero {
                return Self { low, ..Self::outward(low, high) };
            }
            Self::outward(low, high)
        })
    }
}

impl<F: Float> Div for Interval<F> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        apart_if_long!(F, {
            if self.is_zero() && !other.is_zero() {
                return Self::constant(0.0);
            }
            let (zero, one) = (F::of(0.0), F::of(1.0));
            if other.has_zero() || !other.is_bounded() {
                // The reciprocal has one finite endpoint if the divisor is on one side of 0, and none if it is on both.
                let inverse = if other.low >= zero && other.high > zero {
                    let high = if other.low > zero { one / other.low } else { F::INFINITY };
                    Self { low: one / other.high, high }
                } else if other.high <= zero && other.low < zero {
                    let low = if other.high < zero { one / other.high } else { -F::INFINITY };
                    Self { low, high: one / other.low }
                } else {
                    return Self::whole();
                };
                let Self { low, high } = Self::outward(inverse.low, inverse.high);
                // Infinite endpoints stay infinite.
                let low = if inverse.low == -F::INFINITY { -F::INFINITY } else { low };
                let high = if inverse.high == F::INFINITY { F::INFINITY } else { high };
                return self * Self { low, high };
            }
            let (low, high) = Self::extremes(
                self.low / other.low,
                self.low / other.high,
                self.high / other.low,
                self.high / other.high,
            );
            Self::outward(low, high)
        })
    }
}

impl<F: Float> Scalar for Interval<F> {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self::point(F::of(value))
    }

    #[inline(always)]
    fn about(value: f64, error: f64) -> Self {
        apart_if_long!(F, {
            let (value, error) = (F::of(value), F::of(error));
            Self::outward_sum(value - error, value + error)
        })
    }

    fn sin_cos(self) -> (Self, Self) {
        let half_turn = F::PI;
        if !self.is_narrower(half_turn + half_turn) {
            let any = Self { low: F::of(-1.0), high: F::of(1.0) };
            return (any, any);
        }
        let (sin_low, cos_low) = self.low.sin_cos();
        let is_point = self.low == self.high;
        let (sin_high, cos_high) = if is_point { (sin_low, cos_low) } else { self.high.sin_cos() };
        let zero = F::of(0.0);
        (
            self.sine_or_cosine(sin_low, sin_high, F::of(0.5) * half_turn),
            self.sine_or_cosine(cos_low, cos_high, zero),
        )
    }

    fn tan(self) -> Self {
        let quarter = F::of(0.5) * F::PI;
        if !self.is_narrower(F::PI) || self.holds_angle(quarter) || self.holds_angle(-quarter) {
            return Self::whole();
        }
        Self::around(self.low.tan(), self.high.tan())
    }

    fn exp(self) -> Self {
        let Self { low, high } = Self::around(self.low.exp(), self.high.exp());
        Self { low: low.max(F::of(0.0)), high }
    }

    fn ln(self) -> Self {
        let zero = F::of(0.0);
        if self.low > zero {
            Self::around(self.low.ln(), self.high.ln())
        } else if self.low == zero && self.high > zero {
            Self { low: -F::INFINITY, ..Self::around(zero, self.high.ln()) }
        } else {
            Self::whole()
        }
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        apart_if_long!(F, {
            let zero = F::of(0.0);
            // Written so that a NaN stays a NaN.
            let root = |of: F| (if of < zero { zero } else { of }).sqrt();
            let root = Self::outward(root(self.low), root(self.high));
            Self { low: root.low.max(zero), high: root.high }
        })
    }

    #[inline(always)]
    fn abs(self) -> Self {
        apart_if_long!(F, {
            let zero = F::of(0.0);
            if self.low >= zero {
                self
            } else if self.high <= zero {
                -self
            } else {
                Self { low: zero, high: self.magnitude() }
            }
        })
    }

    fn floor(self) -> Self {
        Self { low: self.low.floor(), high: self.high.floor() }
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        apart_if_long!(F, Self { low: self.low.min(other.low), high: self.high.min(other.high) })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        apart_if_long!(F, Self { low: self.low.max(other.low), high: self.high.max(other.high) })
    }

    fn pow(self, exponent: Self) -> Self {
        let zero = F::of(0.0);
        if self.is_zero() && exponent.low > zero {
            Self::constant(0.0)
        } else if self.low >= zero {
            (exponent * self.ln()).exp()
        } else {
            Self::whole()
        }
    }

    #[inline(always)]
    fn powi(self, exponent: i32) -> Self {
        apart_if_long!(F, {
            if exponent < 0 {
                return Self::constant(1.0) / self.powi(-exponent);
            }
            let zero = F::of(0.0);
            match exponent {
                0 => return Self::constant(1.0),
                1 => return self,
                2 => {
                    let Self { low, high } = self.abs();
                    let square = Self::outward(low * low, high * high);
                    return Self {
                        low: if square.low > zero { square.low } else { zero },
                        high: square.high,
                    };
                }
                _ => {}
            }
            let base = if exponent % 2 == 0 { self.abs() } else { self };
            let mut power = base;
            for _ in 1..exponent {
                let next = power * base;
                // As after an underflow, whose numbers are also slow.
                if next.low == power.low && next.high == power.high {
                    break;
                }
                power = next;
            }
            if exponent % 2 == 0 { Self { low: power.low.max(zero), high: power.high } } else { power }
        })
    }

    #[inline(always)]
    fn step(self) -> Self {
        apart_if_long!(F, {
            let (zero, one) = (F::of(0.0), F::of(1.0));
            Self {
                low: if self.low > zero { one } else { zero },
                high: if self.high < zero { zero } else { one },
            }
        })
    }

    #[inline(always)]
    fn kink(self) -> Self {
        if self.has_zero() { Self::whole() } else { Self::constant(0.0) }
    }

    fn jump(self) -> Self {
        let below = self.low.floor();
        if below == self.high.floor() && self.low > below { Self::constant(0.0) } else { Self::whole() }
    }

    #[inline(always)]
    fn is_zero(self) -> bool {
        self.low == F::of(0.0) && self.high == F::of(0.0)
    }
}
