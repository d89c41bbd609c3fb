//! Intervals that certainly hold the true result: every operation rounds outward.
//!
//! Sums, products, quotients and roots are rounded to nearest by the machine, so one step outward is enough. The
//! `libm` functions are trusted to within one unit in the last place, so two steps are.

use crate::number::Number;
use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// All numbers from `low` to `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The least of them.
    pub low: f64,
    /// The greatest of them.
    pub high: f64,
}

impl Interval {
    /// All numbers, and what is not defined.
    pub const WHOLE: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY };

    /// The numbers between two, in any order.
    #[inline(always)]
    pub fn hull(a: f64, b: f64) -> Self {
        if a < b { Self { low: a, high: b } } else { Self { low: b, high: a } }
    }

    /// Whether 0 may be one of them.
    #[inline(always)]
    pub fn has_zero(self) -> bool {
        !(self.low > 0.0 || self.high < 0.0)
    }

    /// The greatest distance from 0.
    #[inline(always)]
    pub fn magnitude(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// How far it is from end to end.
    pub fn width(self) -> f64 {
        self.high - self.low
    }

    /// A number halfway between its ends.
    pub fn middle(self) -> f64 {
        self.low + 0.5 * (self.high - self.low)
    }

    /// Whether both its ends are numbers.
    pub fn is_bounded(self) -> bool {
        self.low.is_finite() && self.high.is_finite()
    }

    /// At least one step outward at either end, two at most. What is not a number becomes anything.
    ///
    /// A product and a difference are many times faster than the next number of f64.
    #[inline(always)]
    fn outward(low: f64, high: f64) -> Self {
        const STEP: f64 = 1.04 * f64::EPSILON;
        const LEAST: f64 = 1e-305;
        let low = low - (low.abs() * STEP + LEAST);
        let high = high + (high.abs() * STEP + LEAST);
        if low.is_nan() || high.is_nan() { Self::WHOLE } else { Self { low, high } }
    }

    /// Around values that a function of `libm` gave.
    fn around(low: f64, high: f64) -> Self {
        let Self { low, high } = Self::outward(low, high);
        Self::outward(low, high)
    }

    /// Whether it may hold `start` and any number of turns from there.
    fn holds_angle(self, start: f64) -> bool {
        let slack = 1e-15 * (1.0 + self.low.abs() + self.high.abs());
        let turns = ((self.low - slack - start) / (2.0 * PI)).ceil();
        start + turns * 2.0 * PI <= self.high + slack
    }

    /// The sine or cosine, whose values at the ends are these, and which is 1 at `top` and -1 half a turn on.
    fn wave(self, at_low: f64, at_high: f64, top: f64) -> Self {
        // Written so that what is not a number, and angles without end, are any.
        if !(self.width() < 2.0 * PI && self.magnitude() < 1e15) {
            return Self { low: -1.0, high: 1.0 };
        }
        let Self { low, high } = Self::around(at_low.min(at_high), at_low.max(at_high));
        Self {
            low: if self.holds_angle(top - PI) { -1.0 } else { low.max(-1.0) },
            high: if self.holds_angle(top) { 1.0 } else { high.min(1.0) },
        }
    }

    /// The quotient by what may be 0. Where 0 is the end of the divisor and not in the dividend, one end is known.
    fn over_zero(self, other: Self) -> Self {
        if other.is_zero() {
            Self::WHOLE
        } else if self.is_zero() {
            Self::constant(0.0)
        } else if other.high == 0.0 {
            -self.over_zero(-other)
        } else if other.low == 0.0 && self.low > 0.0 {
            Self { high: f64::INFINITY, ..Self::outward(self.low / other.high, self.low) }
        } else if other.low == 0.0 && self.high < 0.0 {
            Self { low: f64::NEG_INFINITY, ..Self::outward(self.high, self.high / other.high) }
        } else {
            Self::WHOLE
        }
    }

    /// The least and the greatest of four, those that are not numbers left out.
    #[inline(always)]
    fn of_four(a: f64, b: f64, c: f64, d: f64) -> (f64, f64) {
        (a.min(b).min(c.min(d)), a.max(b).max(c.max(d)))
    }
}

impl Add for Interval {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::outward(self.low + other.low, self.high + other.high)
    }
}

impl Sub for Interval {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        // Of one number alone the difference is 0 and not about 0: what is multiplied by it may have no end.
        if self == other && self.low == self.high {
            return Self::constant(0.0);
        }
        Self::outward(self.low - other.high, self.high - other.low)
    }
}

impl Neg for Interval {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low }
    }
}

impl Mul for Interval {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // Nothing times anything is nothing, even where that has no end.
        if self.is_zero() || other.is_zero() {
            return Self::constant(0.0);
        }
        let products =
            [self.low * other.low, self.low * other.high, self.high * other.low, self.high * other.high];
        let [a, b, c, d] = products;
        // Nearly always there is nothing to think about.
        if a * b * c * d != 0.0 && (a + b + c + d).is_finite() {
            let less = |a: f64, b: f64| if a < b { a } else { b };
            let more = |a: f64, b: f64| if a > b { a } else { b };
            return Self::outward(less(less(a, b), less(c, d)), more(more(a, b), more(c, d)));
        }
        let (low, high) = Self::of_four(a, b, c, d);
        // 0 times infinity was left out above, where an end at 0 meets no end.
        let touches = |a: Self, b: Self| a.has_zero() && !b.is_bounded();
        if touches(self, other) || touches(other, self) {
            return Self::outward(low.min(0.0), high.max(0.0));
        }
        Self::outward(low, high)
    }
}

impl Div for Interval {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        if other.has_zero() {
            return self.over_zero(other);
        }
        if !other.is_bounded() {
            return self
                * Self {
                    low: (1.0 / other.high).min(1.0 / other.low),
                    high: (1.0 / other.low).max(1.0 / other.high),
                };
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

impl Number for Interval {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self { low: value, high: value }
    }

    #[inline(always)]
    fn about(value: f64, error: f64) -> Self {
        Self::outward(value - error, value + error)
    }

    fn sin_cos(self) -> (Self, Self) {
        let (sin_low, cos_low) = libm::sincos(self.low);
        let is_point = self.low == self.high;
        let (sin_high, cos_high) = if is_point { (sin_low, cos_low) } else { libm::sincos(self.high) };
        (self.wave(sin_low, sin_high, FRAC_PI_2), self.wave(cos_low, cos_high, 0.0))
    }

    fn tan(self) -> Self {
        if !(self.width() < PI && self.magnitude() < 1e15)
            || self.holds_angle(FRAC_PI_2)
            || self.holds_angle(-FRAC_PI_2)
        {
            return Self::WHOLE;
        }
        Self::around(libm::tan(self.low), libm::tan(self.high))
    }

    fn exp(self) -> Self {
        let Self { low, high } = Self::around(libm::exp(self.low), libm::exp(self.high));
        Self { low: low.max(0.0), high }
    }

    fn ln(self) -> Self {
        if self.low > 0.0 {
            Self::around(libm::log(self.low), libm::log(self.high))
        } else if self.low == 0.0 {
            let high = libm::log(self.high);
            Self { low: f64::NEG_INFINITY, ..Self::around(high, high) }
        } else {
            Self::WHOLE
        }
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = Self::outward(Number::sqrt(self.low), Number::sqrt(self.high));
        Self { low: root.low.max(0.0), high: root.high }
    }

    #[inline(always)]
    fn abs(self) -> Self {
        if self.low >= 0.0 {
            self
        } else if self.high <= 0.0 {
            -self
        } else {
            Self { low: 0.0, high: self.magnitude() }
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
        if self.low > 0.0 {
            return (exponent * self.ln()).exp();
        }
        // What may be 0: 0 to the power of 0 is 1, and to a power below 0 it has no end.
        if self.low == 0.0 {
            let most = (exponent * Self::constant(self.high).ln()).exp().high;
            let high = if exponent.low > 0.0 {
                most
            } else if exponent.low == 0.0 {
                most.max(1.0)
            } else {
                f64::INFINITY
            };
            return Self { low: 0.0, high };
        }
        Self::WHOLE
    }

    #[inline(always)]
    fn powi(self, exponent: i32) -> Self {
        if exponent < 0 {
            return Self::constant(1.0) / self.powi(-exponent);
        }
        match exponent {
            0 => return Self::constant(1.0),
            1 => return self,
            2 => {
                let Self { low, high } = self.abs();
                let square = Self::outward(low * low, high * high);
                return Self { low: if square.low > 0.0 { square.low } else { 0.0 }, high: square.high };
            }
            _ => {}
        }
        let base = if exponent % 2 == 0 { self.abs() } else { self };
        let mut power = base;
        for _ in 1..exponent {
            power = power * base;
        }
        if exponent % 2 == 0 { Self { low: power.low.max(0.0), high: power.high } } else { power }
    }

    #[inline(always)]
    fn step(self) -> Self {
        Self { low: if self.low > 0.0 { 1.0 } else { 0.0 }, high: if self.high < 0.0 { 0.0 } else { 1.0 } }
    }

    #[inline(always)]
    fn kink(self) -> Self {
        if self.has_zero() { Self::WHOLE } else { Self::constant(0.0) }
    }

    fn jump(self) -> Self {
        let below = self.low.floor();
        if below == self.high.floor() && self.low > below { Self::constant(0.0) } else { Self::WHOLE }
    }

    #[inline(always)]
    fn is_zero(self) -> bool {
        self.low == 0.0 && self.high == 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn over(low: f64, high: f64) -> Interval {
        Interval { low, high }
    }

    #[test]
    fn what_touches_zero_keeps_the_end_that_is_known() {
        let one = Interval::constant(1.0);
        let inverse = one / over(0.0, 4.0);
        assert!(inverse.low <= 0.25 && inverse.low > 0.2499 && inverse.high == f64::INFINITY, "{inverse:?}");
        let inverse = -one / over(-4.0, 0.0);
        assert!(inverse.low <= 0.25 && inverse.low > 0.2499 && inverse.high == f64::INFINITY, "{inverse:?}");
        let inverse = one / over(-4.0, 0.0);
        assert!(inverse.high >= -0.25 && inverse.low == f64::NEG_INFINITY, "{inverse:?}");
        assert_eq!(over(-1.0, 1.0) / over(0.0, 1.0), Interval::WHOLE);
        assert_eq!(one / over(-1.0, 1.0), Interval::WHOLE);
        let ln = over(0.0, 1.0).ln();
        assert!(ln.low == f64::NEG_INFINITY && (0.0..1e-300).contains(&ln.high), "{ln:?}");
        let power = over(0.0, 0.5).pow(over(0.0, 0.5));
        assert!(power.low == 0.0 && (1.0..1.0 + 1e-14).contains(&power.high), "{power:?}");
        assert_eq!(over(0.0, 2.0).pow(Interval::constant(-1.0)), over(0.0, f64::INFINITY));
        assert_eq!(over(-0.1, 2.0).pow(Interval::constant(0.5)), Interval::WHOLE);
    }
}
