//! The arithmetic of the search for roots: intervals, which are numbers known only to lie between two bounds, and their
//! derivatives.

use super::dyadic::Dyadic;
use super::wide::Wide;
use std::cmp::Ordering;

/// A number that a formula contains, with its bounds in `f64`: a search evaluates the formula many times.
#[derive(Clone, Debug)]
pub struct Constant {
    pub exact: Dyadic,
    pub low: f64,
    pub high: f64,
}

impl From<Dyadic> for Constant {
    fn from(exact: Dyadic) -> Self {
        Self { low: exact.to_f64(false), high: exact.to_f64(true), exact }
    }
}

/// An interval: a number that is only known to lie between two bounds.
pub trait Number: Clone {
    fn exact(value: &Dyadic) -> Self;
    fn constant(of: &Constant) -> Self;
    fn of(value: &Wide) -> Self;
    /// Returns the interval of all numbers.
    fn any() -> Self;
    fn add(&self, other: &Self) -> Self;
    fn mul(&self, other: &Self) -> Self;
    fn div(&self, other: &Self) -> Self;
    fn neg(&self) -> Self;
    fn square(&self) -> Self;
    /// Returns the square root of the part of the interval that is not negative.
    fn root(&self) -> Self;
    fn sin_cos(&self) -> (Self, Self);
    fn exp(&self) -> Self;
    fn ln(&self) -> Self;
    fn abs(&self) -> Self;
    fn min(&self, other: &Self) -> Self;
    fn max(&self, other: &Self) -> Self;
    /// Returns the interval from the low end of this one to the high end of the other.
    fn hull(&self, other: &Self) -> Self;
    /// Returns the intersection of two intervals, unless it is empty.
    fn meet(&self, other: &Self) -> Option<Self>;
    /// Returns the sign, if it is certain.
    fn sign(&self) -> Option<Ordering>;
    /// Returns a point of the interval, not quite its midpoint.
    fn inner(&self) -> Self;
    fn low(&self) -> Self;
    fn high(&self) -> Self;
    fn atan(&self) -> Self;
    /// Returns the interval of the integers below the ends.
    fn floor(&self) -> Self;
    fn half_turn() -> Self;
    /// Returns a point that stands for infinity.
    fn huge() -> Self;
    fn is_point(&self) -> bool;
    /// Tells whether no number of the interval is negative.
    fn is_from_0(&self) -> bool;
    /// Tells whether the interval is narrower than numbers of the magnitude of `size` by a factor of 2 to the power of
    /// `bits`, or by as much as its type is good for.
    fn is_narrow(&self, size: &Self, bits: i64) -> bool;
    /// Tells whether the interval is less than half as wide as another.
    fn is_half(&self, other: &Self) -> bool;
    fn to_wide(&self) -> Wide;
    fn int(number: i64) -> Self;

    fn sub(&self, other: &Self) -> Self {
        self.add(&other.neg())
    }

    fn is_negative(&self) -> bool {
        self.sign() == Some(Ordering::Less)
    }
}

/// A value and its derivative.
#[derive(Clone)]
pub struct Jet<T> {
    pub value: T,
    pub slope: T,
}

impl<T: Number> Jet<T> {
    pub fn constant(value: T) -> Self {
        Self { value, slope: T::int(0) }
    }

    pub fn variable(value: T) -> Self {
        Self { value, slope: T::int(1) }
    }

    pub fn add(&self, other: &Self) -> Self {
        Self { value: self.value.add(&other.value), slope: self.slope.add(&other.slope) }
    }

    pub fn sub(&self, other: &Self) -> Self {
        self.add(&other.neg())
    }

    pub fn neg(&self) -> Self {
        Self { value: self.value.neg(), slope: self.slope.neg() }
    }

    pub fn mul(&self, other: &Self) -> Self {
        let slope = self.value.mul(&other.slope).add(&self.slope.mul(&other.value));
        Self { value: self.value.mul(&other.value), slope }
    }

    pub fn square(&self) -> Self {
        let slope = self.value.mul(&self.slope).mul(&T::int(2));
        Self { value: self.value.square(), slope }
    }

    pub fn div(&self, other: &Self) -> Self {
        let value = self.value.div(&other.value);
        let slope = self.slope.sub(&value.mul(&other.slope)).div(&other.value);
        Self { value, slope }
    }

    pub fn root(&self) -> Self {
        let value = self.value.root();
        let slope = self.slope.div(&value.mul(&T::int(2)));
        Self { value, slope }
    }

    pub fn sin(&self) -> Self {
        let (sin, cos) = self.value.sin_cos();
        Self { value: sin, slope: cos.mul(&self.slope) }
    }

    pub fn cos(&self) -> Self {
        let (sin, cos) = self.value.sin_cos();
        Self { value: cos, slope: sin.neg().mul(&self.slope) }
    }

    pub fn exp(&self) -> Self {
        let value = self.value.exp();
        Self { slope: value.mul(&self.slope), value }
    }

    pub fn ln(&self) -> Self {
        Self { value: self.value.ln(), slope: self.slope.div(&self.value) }
    }

    pub fn abs(&self) -> Self {
        match self.value.sign() {
            Some(Ordering::Greater) => self.clone(),
            Some(Ordering::Less) => self.neg(),
            _ => Self { value: self.value.abs(), slope: self.slope.hull_of(&self.slope.neg()) },
        }
    }

    /// Returns the hull of two values, and of their derivatives.
    pub fn hull(&self, other: &Self) -> Self {
        Self { value: self.value.hull_of(&other.value), slope: self.slope.hull_of(&other.slope) }
    }

    pub fn min(&self, other: &Self) -> Self {
        self.neg().max(&other.neg()).neg()
    }

    pub fn max(&self, other: &Self) -> Self {
        match self.value.sub(&other.value).sign() {
            Some(Ordering::Greater) => self.clone(),
            Some(Ordering::Less) => other.clone(),
            _ => Self { value: self.value.max(&other.value), slope: self.slope.hull_of(&other.slope) },
        }
    }
}

/// A further operation that all intervals have.
trait HullOf: Number {
    /// Returns the hull of two intervals, in either order.
    fn hull_of(&self, other: &Self) -> Self {
        self.min(other).hull(&self.max(other))
    }
}

impl<T: Number> HullOf for T {}
