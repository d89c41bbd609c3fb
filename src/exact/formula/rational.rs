//! Exact formulas along lines of rational numbers: polynomials with integer coefficients.
//!
//! The numbers of a formula are `f64`, and therefore fractions. A formula of sums, differences, products, and quotients
//! by numbers is a polynomial along a line. Its coefficients are fractions if the line's are.

use super::along::AlongLines;
use super::step::Step;
use crate::interval::Fraction;
use crate::polynomial::MAX_COEFFICIENTS;
use crate::roots::whole::{Dyadic, Whole};
use dashu_int::IBig;
use dashu_int::ops::{Abs, BitTest};

/// The maximum power of two for scaling numbers to add them, or to make them integers. The 12th power of 1e-300 is
/// smaller, and not worth the time.
const MAX_BITS: i64 = 1 << 14;

/// The maximum number of bits of a number. Coefficients of polynomials of degree 40 have some thousands of bits.
const MAX_DIGITS: usize = 1 << 16;

/// A polynomial. Its coefficients are these integers times a power of two, divided by a positive number.
#[derive(Clone, Debug)]
pub struct Rational {
    numerators: Vec<IBig>,
    exponent: i64,
    denominator: IBig,
}

impl From<f64> for Rational {
    fn from(value: f64) -> Self {
        let Dyadic { digits, exponent } = value.into();
        Self::new(digits, exponent, IBig::ONE)
    }
}

impl Rational {
    fn new(numerator: IBig, exponent: i64, denominator: IBig) -> Self {
        Self { numerators: vec![numerator], exponent, denominator }
    }

    /// Converts a fraction, or returns `None` if it is not exact.
    pub fn of(fraction: Fraction) -> Option<Self> {
        let [above, below] = fraction.exactly()?.map(Dyadic::from);
        Some(Self::new(above.digits, above.exponent - below.exponent, below.digits))
    }

    /// Returns a number as an integer, the power of two that multiplies it, and the positive integer that divides it.
    pub(crate) fn fraction(&self) -> (&IBig, i64, &IBig) {
        (&self.numerators[0], self.exponent, &self.denominator)
    }

    /// Returns whether the polynomial is constant.
    fn is_number(&self) -> bool {
        self.numerators.len() == 1
    }

    fn negated(mut self) -> Self {
        self.numerators.iter_mut().for_each(|of| *of = -std::mem::take(of));
        self
    }

    /// Returns the polynomial plus t times another one.
    fn with_slope(&self, slope: &Self) -> Option<Self> {
        let rises = Self { numerators: vec![IBig::ZERO, slope.numerators[0].clone()], ..slope.clone() };
        self.plus(&rises)
    }

    fn plus(&self, other: &Self) -> Option<Self> {
        let exponent = self.exponent.min(other.exponent);
        let is_same = self.denominator == other.denominator;
        let scaled = |of: &Self, by: &IBig| {
            let up = of.exponent - exponent;
            let up = (up <= MAX_BITS).then_some(up as usize)?;
            let scaled = |number: &IBig| if is_same { number << up } else { (number << up) * by };
            Some(of.numerators.iter().map(scaled).collect::<Vec<_>>())
        };
        let (mut numerators, mut others) =
            (scaled(self, &other.denominator)?, scaled(other, &self.denominator)?);
        if numerators.len() < others.len() {
            std::mem::swap(&mut numerators, &mut others);
        }
        for (sum, other) in numerators.iter_mut().zip(others) {
            *sum += other;
        }
        while numerators.len() > 1 && numerators.last().is_some_and(IBig::is_zero) {
            numerators.pop();
        }
        let denominator = match is_same {
            true => self.denominator.clone(),
            false => &self.denominator * &other.denominator,
        };
        Self { numerators, exponent, denominator }.not_too_long()
    }

    /// Returns the polynomial, unless one of its numbers has too many bits.
    fn not_too_long(self) -> Option<Self> {
        let numbers = self.numerators.iter().chain([&self.denominator]);
        let is_short = numbers.into_iter().all(|number| number.bit_len() <= MAX_DIGITS);
        (is_short && self.exponent.abs() <= 4 * MAX_BITS).then_some(self)
    }

    fn times(&self, other: &Self) -> Option<Self> {
        let count = self.numerators.len() + other.numerators.len() - 1;
        if count > MAX_COEFFICIENTS {
            return None;
        }
        let mut numerators = vec![IBig::ZERO; count];
        for (power, one) in self.numerators.iter().enumerate().filter(|(_, one)| !one.is_zero()) {
            for (sum, other) in numerators[power..].iter_mut().zip(&other.numerators) {
                *sum += one * other;
            }
        }
        let denominator = &self.denominator * &other.denominator;
        let exponent = self.exponent + other.exponent;
        Self { numerators, exponent, denominator }.not_too_long()
    }

    fn over(&self, other: &Self) -> Option<Self> {
        let divisor = &other.numerators[0];
        if !other.is_number() || divisor.is_zero() {
            return None;
        }
        let is_negative = *divisor < IBig::ZERO;
        let numerator = &other.denominator * IBig::from(if is_negative { -1 } else { 1 });
        let inverse = Self::new(numerator, -other.exponent, divisor.clone().abs());
        self.times(&inverse)
    }

    fn power(&self, exponent: u32) -> Option<Self> {
        if exponent == 0 {
            return Some(Self::from(1.0));
        }
        let half = self.power(exponent / 2);
        let half = if exponent == 1 { return Some(self.clone()) } else { half? };
        let square = half.times(&half)?;
        if exponent.is_multiple_of(2) { Some(square) } else { square.times(self) }
    }
}

impl AlongLines {
    /// Returns the formula along the points `origin + t dir`, times a positive number. Returns `None` if it is not a
    /// polynomial of t with a degree that a [`Polynomial`](crate::polynomial::Polynomial) may have.
    pub fn exactly(&self, origin: &[Rational; 3], dir: &[Rational; 3]) -> Option<Whole> {
        let place = |axis: usize| origin[axis].with_slope(&dir[axis]);
        let along = self.0.fold([place(0)?, place(1)?, place(2)?], |step, [a, b, _]| {
            Some(match step {
                Step::Variable(_) => a.clone(),
                Step::Number(number) => Rational::from(number),
                Step::Neg => a.clone().negated(),
                Step::Add => a.plus(b)?,
                Step::Sub => a.plus(&b.clone().negated())?,
                Step::Mul => a.times(b)?,
                Step::Div => a.over(b)?,
                Step::Powi(exponent) if exponent >= 0 => a.power(exponent.unsigned_abs())?,
                Step::Powi(exponent) => Rational::from(1.0).over(&a.power(exponent.unsigned_abs())?)?,
                Step::Scale(factor) => a.times(&Rational::from(factor))?,
                Step::Shift(by) => a.plus(&Rational::from(by))?,
                Step::Spline | Step::Call(_) => return None,
            })
        });
        let Rational { mut numerators, .. } = along?;
        // A common power of two would only make coefficients longer.
        let zeros = numerators.iter().filter_map(|of| of.trailing_zeros()).min().unwrap_or(0);
        numerators.iter_mut().for_each(|of| *of >>= zeros);
        Some(Whole::new(numerators))
    }
}
