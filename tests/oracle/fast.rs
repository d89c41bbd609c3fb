//! Intervals with two `f64` ends, rounded outward in each operation. They decide most rays.

use super::dyadic::Dyadic;
use super::number::{Constant, Number};
use super::wide::Wide;
use std::cmp::Ordering;
use std::f64::consts::PI;

/// An interval. Where nothing is known, it is from minus to plus infinity.
#[derive(Clone, Copy, Debug)]
pub struct Fast {
    pub low: f64,
    pub high: f64,
}

impl Fast {
    fn outward(low: f64, high: f64) -> Self {
        if low.is_nan() || high.is_nan() {
            return Self::any();
        }
        Self { low: low.next_down(), high: high.next_up() }
    }

    fn is_zero(&self) -> bool {
        self.low == 0.0 && self.high == 0.0
    }

    fn of_four([a, b, c, d]: [f64; 4]) -> Self {
        if a.is_nan() || b.is_nan() || c.is_nan() || d.is_nan() {
            return Self::any();
        }
        Self::outward(a.min(b).min(c.min(d)), a.max(b).max(c.max(d)))
    }

    /// Returns bounds of a function's values that the standard library computes to a few units in the last place.
    fn roughly(low: f64, high: f64) -> Self {
        let slack = |value: f64| 1e-15 * value.abs() + 1e-300;
        Self::outward(low - slack(low), high + slack(high))
    }
}

impl Number for Fast {
    fn exact(value: &Dyadic) -> Self {
        Self { low: value.to_f64(false), high: value.to_f64(true) }
    }

    fn constant(of: &Constant) -> Self {
        Self { low: of.low, high: of.high }
    }

    fn of(value: &Wide) -> Self {
        match value.ends() {
            Some((low, high)) => Self { low: low.to_f64(false), high: high.to_f64(true) },
            None => Self::any(),
        }
    }

    fn any() -> Self {
        Self { low: f64::NEG_INFINITY, high: f64::INFINITY }
    }

    fn add(&self, other: &Self) -> Self {
        // Exact zeros remain: a ray may lie in the plane of a pole.
        match (self.is_zero(), other.is_zero()) {
            (true, _) => return *other,
            (_, true) => return *self,
            _ => {}
        }
        Self::outward(self.low + other.low, self.high + other.high)
    }

    fn mul(&self, other: &Self) -> Self {
        if self.is_zero() || other.is_zero() {
            return Self { low: 0.0, high: 0.0 };
        }
        let (a, b) = (self, other);
        Self::of_four([a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high])
    }

    fn div(&self, other: &Self) -> Self {
        let (a, b) = (self, other);
        if b.low == 0.0 && b.high > 0.0 && a.low > 0.0 {
            return Self { low: (a.low / b.high).next_down(), high: f64::INFINITY };
        }
        if b.low <= 0.0 && b.high >= 0.0 {
            return Self::any();
        }
        Self::of_four([a.low / b.low, a.low / b.high, a.high / b.low, a.high / b.high])
    }

    fn neg(&self) -> Self {
        Self { low: -self.high, high: -self.low }
    }

    fn square(&self) -> Self {
        let Self { low, high } = Number::abs(self);
        let square = Self::outward(low * low, high * high);
        Self { low: square.low.max(0.0), high: square.high }
    }

    fn root(&self) -> Self {
        let root = Self::outward(self.low.max(0.0).sqrt(), self.high.max(0.0).sqrt());
        Self { low: root.low.max(0.0), high: root.high }
    }

    fn sin_cos(&self) -> (Self, Self) {
        let middle = 0.5 * (self.low + self.high);
        if !middle.is_finite() || middle.abs() > 1e12 {
            let all = Self { low: -1.0, high: 1.0 };
            return (all, all);
        }
        let radius = (self.high - middle).max(middle - self.low).next_up() + 2e-16;
        let around = |value: f64| Self {
            low: (value - radius).next_down().max(-1.0),
            high: (value + radius).next_up().min(1.0),
        };
        (around(middle.sin()), around(middle.cos()))
    }

    fn exp(&self) -> Self {
        let exp = Self::roughly(self.low.exp(), self.high.exp());
        Self { low: exp.low.max(0.0), high: exp.high }
    }

    fn ln(&self) -> Self {
        match (self.low > 0.0, self.high > 0.0) {
            (true, _) => Self::roughly(self.low.ln(), self.high.ln()),
            (_, true) => Self { low: f64::NEG_INFINITY, high: Self::roughly(0.0, self.high.ln()).high },
            _ => Self::any(),
        }
    }

    fn abs(&self) -> Self {
        if self.low >= 0.0 {
            *self
        } else if self.high <= 0.0 {
            self.neg()
        } else {
            Self { low: 0.0, high: self.high.max(-self.low) }
        }
    }

    fn min(&self, other: &Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.min(other.high) }
    }

    fn max(&self, other: &Self) -> Self {
        Self { low: self.low.max(other.low), high: self.high.max(other.high) }
    }

    fn hull(&self, other: &Self) -> Self {
        Self { low: self.low, high: other.high }
    }

    fn meet(&self, other: &Self) -> Option<Self> {
        let (low, high) = (self.low.max(other.low), self.high.min(other.high));
        (low <= high).then_some(Self { low, high })
    }

    fn sign(&self) -> Option<Ordering> {
        if self.low > 0.0 {
            Some(Ordering::Greater)
        } else if self.high < 0.0 {
            Some(Ordering::Less)
        } else if self.low == 0.0 && self.high == 0.0 {
            Some(Ordering::Equal)
        } else {
            None
        }
    }

    fn inner(&self) -> Self {
        let point = self.low + 0.482_913 * (self.high - self.low);
        Self { low: point, high: point }
    }

    fn low(&self) -> Self {
        Self { low: self.low, high: self.low }
    }

    fn high(&self) -> Self {
        Self { low: self.high, high: self.high }
    }

    fn atan(&self) -> Self {
        Self::roughly(self.low.atan(), self.high.atan())
    }

    fn floor(&self) -> Self {
        Self { low: self.low.floor(), high: self.high.floor() }
    }

    fn half_turn() -> Self {
        Self { low: PI, high: PI.next_up() }
    }

    fn huge() -> Self {
        Self { low: f64::INFINITY, high: f64::INFINITY }
    }

    fn is_point(&self) -> bool {
        self.low == self.high
    }

    fn is_from_0(&self) -> bool {
        self.low >= 0.0
    }

    fn is_narrow(&self, size: &Self, _bits: i64) -> bool {
        self.high - self.low <= 1e-15 * (self.low.abs() + size.high)
    }

    fn is_half(&self, other: &Self) -> bool {
        self.high - self.low < 0.5 * (other.high - other.low)
    }

    fn to_wide(&self) -> Wide {
        Wide::between(Dyadic::from(self.low), Dyadic::from(self.high))
    }

    fn int(number: i64) -> Self {
        // Formulas and polynomials take integers far below 2^53, which are exact.
        Self { low: number as f64, high: number as f64 }
    }
}
