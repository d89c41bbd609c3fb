//! Intervals that certainly hold the true result: every operation rounds outward.
//!
//! Their ends are numbers of `f64`, or of 237 bits where those leave something open ([`Wide`]).

mod float;

use crate::numeric::scalar::Scalar;
use f256::f256;
pub use float::Float;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// All numbers from `low` to `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval<F = f64> {
    /// The least of them.
    pub low: F,
    /// The greatest of them.
    pub high: F,
}

/// An interval whose ends have 237 bits.
pub type Wide = Interval<f256>;

impl From<Interval> for Wide {
    fn from(of: Interval) -> Self {
        Self { low: of.low.into(), high: of.high.into() }
    }
}

impl Interval {
    /// All numbers, and what is not defined.
    pub const WHOLE: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY };
}

impl<F: Float> Interval<F> {
    /// All numbers, and what is not defined.
    fn whole() -> Self {
        Self { low: -F::INFINITY, high: F::INFINITY }
    }

    /// One number.
    #[inline(always)]
    pub fn point(at: F) -> Self {
        Self { low: at, high: at }
    }

    /// Whether 0 may be one of them.
    #[inline(always)]
    pub fn has_zero(self) -> bool {
        !(self.low > F::of(0.0) || self.high < F::of(0.0))
    }

    /// The greatest distance from 0.
    #[inline(always)]
    pub fn magnitude(self) -> F {
        self.low.abs().max(self.high.abs())
    }

    /// How far it is from end to end.
    pub fn width(self) -> F {
        self.high - self.low
    }

    /// A number halfway between its ends.
    pub fn middle(self) -> F {
        self.low + F::of(0.5) * (self.high - self.low)
    }

    /// Whether both its ends are numbers.
    pub fn is_bounded(self) -> bool {
        self.low.is_finite() && self.high.is_finite()
    }

    /// Around the exact ends of a result that was rounded to these. What is not a number becomes anything.
    #[inline(always)]
    fn outward(low: F, high: F) -> Self {
        let (low, high) = F::outward(low, high);
        if low.is_nan() || high.is_nan() { Self::whole() } else { Self { low, high } }
    }

    /// Around the exact ends of a sum or a difference, which is rounded to 0 only where it is 0.
    #[inline(always)]
    fn outward_sum(low: F, high: F) -> Self {
        let (low, high) = F::outward_sum(low, high);
        if low.is_nan() || high.is_nan() { Self::whole() } else { Self { low, high } }
    }

    /// Around the exact ends of functions whose results may be farther off.
    fn around(low: F, high: F) -> Self {
        let (low, high) = F::around(low, high);
        if low.is_nan() || high.is_nan() { Self::whole() } else { Self { low, high } }
    }

    /// Whether it may hold `start` and any number of turns from there.
    fn holds_angle(self, start: F) -> bool {
        // Four and a half roundings of the angle: the division by a turn, that turn itself, and the sum.
        let rounding = F::of(4.503_599_627_370_496) * F::EPSILON;
        let slack = rounding * (F::of(1.0) + self.low.abs() + self.high.abs());
        let turn = F::of(2.0) * F::PI;
        let turns = -(-((self.low - slack - start) / turn)).floor();
        start + turns * turn <= self.high + slack
    }

    /// Whether it is narrower than this and so near to 0 that its sines mean something; else angles are any.
    fn is_narrower(self, than: F) -> bool {
        self.width() < than && self.magnitude() < F::of(1e15)
    }

    /// The sine or cosine, whose values at the ends are these, and which is 1 at `top` and -1 half a turn on.
    fn wave(self, at_low: F, at_high: F, top: F) -> Self {
        let one = F::of(1.0);
        let Self { low, high } = Self::around(at_low.min(at_high), at_low.max(at_high));
        Self {
            low: if self.holds_angle(top - F::PI) { -one } else { low.max(-one) },
            high: if self.holds_angle(top) { one } else { high.min(one) },
        }
    }

    /// The least and the greatest of four, those that are not numbers left out.
    #[inline(always)]
    fn of_four(a: F, b: F, c: F, d: F) -> (F, F) {
        (a.min(b).min(c.min(d)), a.max(b).max(c.max(d)))
    }
}

impl<F: Float> Add for Interval<F> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::outward_sum(self.low + other.low, self.high + other.high)
    }
}

impl<F: Float> Sub for Interval<F> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        // Of one number alone the difference is 0 and not about 0: what is multiplied by it may have no end.
        if self == other && self.low == self.high {
            return Self::constant(0.0);
        }
        Self::outward_sum(self.low - other.high, self.high - other.low)
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
        // Nothing times anything is nothing, even where that has no end.
        if self.is_zero() || other.is_zero() {
            return Self::constant(0.0);
        }
        // Nearly always there is nothing to think about.
        if let Some((low, high)) = F::product_ends([self.low, self.high], [other.low, other.high]) {
            return Self::outward(low, high);
        }
        let (low, high) = Self::of_four(
            self.low * other.low,
            self.low * other.high,
            self.high * other.low,
            self.high * other.high,
        );
        // 0 times infinity was left out above, where an end at 0 meets no end.
        let touches = |a: Self, b: Self| a.has_zero() && !b.is_bounded();
        if touches(self, other) || touches(other, self) {
            return Self::outward(low.min(F::of(0.0)), high.max(F::of(0.0)));
        }
        // No product of what is not negative is: a root can be taken of it.
        let zero = F::of(0.0);
        if self.low >= zero && other.low >= zero && low == zero {
            return Self { low, ..Self::outward(low, high) };
        }
        Self::outward(low, high)
    }
}

impl<F: Float> Div for Interval<F> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        if self.is_zero() && !other.is_zero() {
            return Self::constant(0.0);
        }
        let (zero, one) = (F::of(0.0), F::of(1.0));
        if other.has_zero() || !other.is_bounded() {
            // The reciprocals of what lies on one side of 0 have one end, and only those of both sides have none.
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
            // What has an end at infinity keeps it.
            let low = if inverse.low == -F::INFINITY { -F::INFINITY } else { low };
            let high = if inverse.high == F::INFINITY { F::INFINITY } else { high };
            return self * Self { low, high };
        }
        let (low, high) = Self::of_four(
            self.low / other.low,
            self.low / other.high,
            self.high / other.low,
            self.high / other.high,
        );
        Self::outward(low, high)
    }
}

impl<F: Float> Scalar for Interval<F> {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self::point(F::of(value))
    }

    #[inline(always)]
    fn about(value: f64, error: f64) -> Self {
        let (value, error) = (F::of(value), F::of(error));
        Self::outward_sum(value - error, value + error)
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
        (self.wave(sin_low, sin_high, F::of(0.5) * half_turn), self.wave(cos_low, cos_high, zero))
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
        let zero = F::of(0.0);
        // Written so that what is not a number stays one.
        let root = |of: F| (if of < zero { zero } else { of }).sqrt();
        let root = Self::outward(root(self.low), root(self.high));
        Self { low: root.low.max(zero), high: root.high }
    }

    #[inline(always)]
    fn abs(self) -> Self {
        let zero = F::of(0.0);
        if self.low >= zero {
            self
        } else if self.high <= zero {
            -self
        } else {
            Self { low: zero, high: self.magnitude() }
        }
    }

    fn floor(self) -> Self {
        Self { low: self.low.floor(), high: self.high.floor() }
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.min(other.high) }
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self { low: self.low.max(other.low), high: self.high.max(other.high) }
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
                return Self { low: if square.low > zero { square.low } else { zero }, high: square.high };
            }
            _ => {}
        }
        let base = if exponent % 2 == 0 { self.abs() } else { self };
        let mut power = base;
        for _ in 1..exponent {
            power = power * base;
        }
        if exponent % 2 == 0 { Self { low: power.low.max(zero), high: power.high } } else { power }
    }

    #[inline(always)]
    fn step(self) -> Self {
        let (zero, one) = (F::of(0.0), F::of(1.0));
        Self {
            low: if self.low > zero { one } else { zero },
            high: if self.high < zero { zero } else { one },
        }
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
