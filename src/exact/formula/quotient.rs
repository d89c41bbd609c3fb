//! Formulas that are quotients of polynomials. Such a formula is 0 where its numerator is 0.

use super::Formula;
use super::field::Field;
use super::step::{Step, fold};
use super::variables::SPACE;
use crate::polynomial::MAX_COEFFICIENTS;
use std::mem::take;
use std::sync::Arc;

/// The maximum number of operations of a numerator.
const MAX_STEPS: usize = 1 << 12;

/// The maximum power of a factor of a denominator. A polynomial of a higher degree is not expanded along a line.
const MAX_POWER: i32 = MAX_COEFFICIENTS as i32;

/// The operations of a numerator, and the distinct factors of its denominator, with their powers.
#[derive(Clone, Default)]
struct Quotient {
    above: Vec<Step>,
    below: Vec<(Vec<Step>, i32)>,
}

impl Field {
    /// Returns the numerator and the denominator of a quotient of polynomials without a common factor, as tested on
    /// lines that meet each factor. The numerator is 0 where the formula is 0, and elsewhere at most on curves. Returns
    /// `None` if the formula is not such a quotient, or has no denominator.
    pub fn quotient(&self) -> Option<[Self; 2]> {
        let steps = &self.formula().steps;
        if !steps.contains(&Step::Div) && !steps.iter().any(|step| matches!(step, Step::Powi(..0))) {
            return None;
        }
        let mut divisors = Vec::new();
        let Quotient { above, below } = Quotient::of(steps, &mut divisors)?;
        if below.is_empty() {
            return None;
        }
        let with =
            |steps: Vec<Step>| Self::new(Arc::new(Formula::new(self.formula().to_string(), SPACE, steps)));
        let (mut product, mut denominator) = (above.clone(), vec![Step::Number(1.0)]);
        for (factor, power) in &below {
            times(&mut product, factor);
            denominator.extend(factor);
            denominator.extend([Step::Powi(*power), Step::Mul]);
        }
        let product = with(product)?;
        let is_reduced = product.is_polynomial() && !product.has_repeated_factor();
        if !is_reduced {
            return None;
        }
        let poles = divisors.into_iter().reduce(|mut product, factor| {
            times(&mut product, &factor);
            product
        });
        let poles = poles.and_then(with);
        Some([self.simplified(with(above)?, poles, true), with(denominator)?])
    }
}

impl Quotient {
    /// Splits operations into a quotient, or returns `None` if one of them cannot occur in a quotient of polynomials.
    /// Adds the numerators of all divisors.
    fn of(steps: &[Step], divisors: &mut Vec<Vec<Step>>) -> Option<Self> {
        let mut divides_by = |of: &Self| {
            if of.above.iter().any(|step| matches!(step, Step::Variable(_))) && !divisors.contains(&of.above)
            {
                divisors.push(of.above.clone());
            }
        };
        fold(steps, |_, step, operands: &mut [Self]| {
            let [mut first, second] =
                [0, 1].map(|which| operands.get_mut(which).map(take).unwrap_or_default());
            match step {
                Step::Variable(_) | Step::Number(_) | Step::Neg | Step::Scale(_) => first.above.push(step),
                Step::Shift(number) => first = first.plus(Self::number(number), Step::Add),
                Step::Add | Step::Sub => first = first.plus(second, step),
                Step::Mul => first = first.times(second),
                Step::Div => {
                    divides_by(&second);
                    first = first.times(second.inverse()?);
                }
                Step::Powi(exponent) if exponent < 0 => {
                    divides_by(&first);
                    first = first.inverse()?.power(exponent.checked_neg()?)?;
                }
                Step::Powi(exponent) => first = first.power(exponent)?,
                Step::Spline | Step::Call(_) => return None,
            }
            if first.above.len() > MAX_STEPS || first.below.iter().any(|(_, power)| *power > MAX_POWER) {
                return None;
            }
            Some(first)
        })
    }

    fn number(number: f64) -> Self {
        Self { above: vec![Step::Number(number)], below: Vec::new() }
    }

    fn times(mut self, other: Self) -> Self {
        times(&mut self.above, &other.above);
        for (factor, power) in other.below {
            *self.power_of(&factor) += power;
        }
        self
    }

    /// Returns the power of a factor of the denominator, or 0 if the denominator does not have it.
    fn power_of(&mut self, factor: &[Step]) -> &mut i32 {
        let known = self.below.iter().position(|(known, _)| known == factor).unwrap_or(self.below.len());
        if known == self.below.len() {
            self.below.push((factor.to_vec(), 0));
        }
        &mut self.below[known].1
    }

    fn power(mut self, exponent: i32) -> Option<Self> {
        self.above.push(Step::Powi(exponent));
        for (_, power) in &mut self.below {
            *power = power.checked_mul(exponent)?;
        }
        self.below.retain(|(_, power)| *power != 0);
        Some(self)
    }

    /// Adds or subtracts, with a common denominator.
    fn plus(mut self, mut other: Self, step: Step) -> Self {
        for (factor, _) in self.below.clone().iter().chain(&other.below.clone()) {
            let (own, its) = (*self.power_of(factor), *other.power_of(factor));
            for (of, missing) in [(&mut self, its - own), (&mut other, own - its)] {
                if missing > 0 {
                    of.above.extend(factor);
                    of.above.extend([Step::Powi(missing), Step::Mul]);
                    *of.power_of(factor) += missing;
                }
            }
        }
        self.above.extend(other.above);
        self.above.push(step);
        self
    }

    /// Returns 1 divided by the quotient. A constant factor of the numerator stays out of the new denominator.
    fn inverse(self) -> Option<Self> {
        let mut inverse = Self::number(1.0);
        for (factor, power) in &self.below {
            inverse.above.extend(factor);
            inverse.above.extend([Step::Powi(*power), Step::Mul]);
        }
        inverse.divide_by(&self.above, 1)?;
        Some(inverse)
    }

    /// Divides by a power of a product.
    fn divide_by(&mut self, steps: &[Step], power: i32) -> Option<()> {
        let (last, operands) = steps.split_last()?;
        if !steps.iter().any(|step| matches!(step, Step::Variable(_))) {
            self.above.extend(steps);
            self.above.extend([Step::Powi(power), Step::Div]);
            return Some(());
        }
        match last {
            Step::Mul => {
                let (one, other) = operands.split_at(super::factors::start_of_last(operands));
                self.divide_by(one, power)?;
                self.divide_by(other, power)
            }
            Step::Neg => {
                if power % 2 != 0 {
                    self.above.push(Step::Neg);
                }
                self.divide_by(operands, power)
            }
            Step::Powi(exponent) if *exponent > 0 => self.divide_by(operands, power.checked_mul(*exponent)?),
            _ => {
                *self.power_of(steps) += power;
                Some(())
            }
        }
    }
}

/// Multiplies operations by others.
fn times(steps: &mut Vec<Step>, by: &[Step]) {
    steps.extend(by);
    steps.push(Step::Mul);
}

#[cfg(test)]
mod tests {
    use crate::formula::tests::field;

    #[test]
    fn a_quotient_of_polynomials_has_the_zeros_of_its_numerator() {
        for (text, expected) in [
            ("1/x + 1/y + 1/z - 3", "y*z + x*z + x*y - 3*x*y*z"),
            ("(y/(2*z) - x)^3 - (x/(4*z))^2", "(y/2 - x*z)^3 - z*(x/4)^2"),
            ("(x - y)/(1 + z^2) - 1", "x - y - (1 + z^2)"),
            ("x^-2 - y/(-(z*x)^3)", "x*z^3 + y"),
            ("1/(1/x + 1/y) - 1", "x*y - (x + y)"),
        ] {
            let [numerator, _] = field(text).quotient().expect(text);
            let expected = field(expected);
            let ratio = |at: [f64; 3]| numerator.at(at) / expected.at(at);
            let (one, other) = (ratio([0.3, 0.7, -1.1]), ratio([1.7, -0.4, 0.6]));
            assert!((one - other).abs() < 1e-12 * one.abs(), "{text}: {one} is not {other}");
        }
    }

    #[test]
    fn what_would_add_a_surface_is_left_as_it_is() {
        for text in
            ["x + ((3/y)^999)^999", "(x^2 - y^2)/(x - y)", "x + y/2", "sin(x)/y", "x/(x*y)", "z + x/x"]
        {
            assert_eq!(field(text).quotient(), None, "{text}");
        }
    }
}
