//! Repeated factors of a formula. Where such a factor is 0, the formula does not change its sign, or its slope is 0.

use super::field::Field;
use super::rational::Rational;
use super::step::{Function, Step, StepKey, fold};
use super::{Formula, value_of};
use crate::text;
use std::collections::HashMap;
use std::mem::take;
use std::sync::Arc;

/// The starts and directions of lines with short coordinates, in general position.
const LINES: [[[f64; 3]; 2]; 3] = [
    [[0.3125, -0.71875, 0.453125], [0.59375, 0.8125, -0.40625]],
    [[-0.859375, 0.15625, 0.6875], [0.78125, -0.34375, 0.90625]],
    [[0.546875, 0.9375, -0.265625], [-0.421875, 0.65625, 0.71875]],
];

impl Field {
    /// Returns the formula with each of its factors to the first power, and the text of the factors that had higher
    /// powers. Returns `None` if all factors have the power 1. Both formulas have the same zeros.
    pub fn without_powers(&self) -> Option<(Self, Vec<String>)> {
        let mut factors = Factors::default();
        let sign = factors.add(&self.formula().steps, 1);
        if factors.powers.iter().all(|(_, power)| *power == 1) {
            return None;
        }
        let mut steps = Vec::new();
        for (index, (factor, _)) in factors.powers.iter().enumerate() {
            steps.extend_from_slice(factor);
            if index > 0 {
                steps.push(Step::Mul);
            }
        }
        if sign < 0.0 {
            steps.push(Step::Neg);
        }
        let repeated = factors.powers.iter().filter(|(_, power)| *power > 1);
        let names = repeated.map(|(factor, _)| written(factor)).collect();
        let formula = Formula::new(self.formula().to_string(), Self::VARIABLES, steps);
        Some((self.simplified(Self::new(Arc::new(formula))?, None, false), names))
    }

    /// Tells whether the formula is a polynomial, with a degree within the limit for polynomials along a line.
    pub fn is_polynomial(&self) -> bool {
        let [origin, dir] = LINES[0].map(|of| of.map(Rational::from));
        self.along_lines().exactly(&origin, &dir).is_some()
    }

    /// Tells whether the formula is a polynomial with a repeated factor, by three lines. They detect each factor,
    /// except in the rare case that all three meet a factor in unusually few places. Fewer than one line in a million
    /// does so.
    pub fn has_repeated_factor(&self) -> bool {
        LINES.iter().all(|[origin, dir]| {
            let along = self.along_lines().exactly(&origin.map(Rational::from), &dir.map(Rational::from));
            along.is_some_and(|along| along.degree() > 1 && !along.has_no_repeated_factor())
        })
    }
}

/// The distinct factors of a product, with their powers.
#[derive(Default)]
struct Factors<'s> {
    powers: Vec<(&'s [Step], u32)>,
    /// The places of the factors in this list.
    places: HashMap<Vec<StepKey>, usize>,
}

impl<'s> Factors<'s> {
    /// Adds the factors of a power of a product. Returns the sign of the constant factors.
    fn add(&mut self, of: &'s [Step], power: u32) -> f64 {
        // A list of what is yet to be added, as products may have more factors than a stack has room for.
        let (mut waiting, mut sign) = (vec![(of, power)], 1.0);
        while let Some((of, power)) = waiting.pop() {
            let Some((last, operands)) = of.split_last() else { continue };
            let odd = if power.is_multiple_of(2) { 1.0 } else { -1.0 };
            if !has_variable(of) {
                let value = value_of(of);
                // A constant factor of 0 counts like any other factor.
                if value != 0.0 && value.is_finite() {
                    sign *= if value < 0.0 { odd } else { 1.0 };
                    continue;
                }
            }
            let (left, right) = operands.split_at(start_of_last(operands));
            match last {
                Step::Mul => waiting.extend([(right, power), (left, power)]),
                Step::Div if !has_variable(right) => waiting.extend([(right, power), (left, power)]),
                Step::Neg => {
                    sign *= odd;
                    waiting.push((operands, power));
                }
                Step::Powi(exponent) if *exponent > 0 => {
                    waiting.push((operands, power.saturating_mul(exponent.unsigned_abs())));
                }
                _ => self.add_one(of, power),
            }
        }
        sign
    }

    /// Adds a power of a factor that is no product.
    fn add_one(&mut self, factor: &'s [Step], power: u32) {
        let new = self.powers.len();
        let place = *self.places.entry(factor.iter().map(|step| step.key()).collect()).or_insert(new);
        match self.powers.get_mut(place) {
            Some((_, known)) => *known = known.saturating_add(power),
            None => self.powers.push((factor, power)),
        }
    }
}

pub(super) fn has_variable(steps: &[Step]) -> bool {
    steps.iter().any(|step| matches!(step, Step::Variable(_)))
}

/// Returns the start of the last operand's operations.
pub(super) fn start_of_last(steps: &[Step]) -> usize {
    let (mut at, mut missing) = (steps.len(), 1);
    while missing > 0 && at > 0 {
        at -= 1;
        missing = missing - 1 + steps[at].operands();
    }
    at
}

/// Returns the text of a formula in x, y and z.
pub(super) fn written(steps: &[Step]) -> String {
    /// A text, and the precedence of its last operation: sums 0, products 1, signs 2, powers 3, values 4.
    type Part = (String, u8);
    fn within((text, binds): Part, least: u8) -> String {
        if binds < least { format!("({text})") } else { text }
    }
    let whole = fold(steps, |_, step, operands: &mut [Part]| {
        let [a, b, c] = [0, 1, 2].map(|which| operands.get_mut(which).map(take).unwrap_or_default());
        Some(match step {
            Step::Variable(index) => (Field::VARIABLES[usize::from(index)].to_owned(), 4),
            Step::Number(number) => (text::shortest(number), if number < 0.0 { 2 } else { 4 }),
            Step::Neg => (format!("-{}", within(a, 3)), 2),
            Step::Add | Step::Shift(_) => (format!("{} + {}", within(a, 0), within(b, 0)), 0),
            Step::Sub => (format!("{} - {}", within(a, 0), within(b, 1)), 0),
            Step::Mul | Step::Scale(_) => (format!("{}*{}", within(a, 1), within(b, 1)), 1),
            Step::Div => (format!("{}/{}", within(a, 1), within(b, 2)), 1),
            Step::Powi(exponent) => (format!("{}^{exponent}", within(a, 4)), 3),
            Step::Spline => a,
            Step::Call(Function::Pow) => (format!("{}^{}", within(a, 4), within(b, 4)), 3),
            Step::Call(Function::If) => (format!("if({} >= 0, {}, {})", a.0, b.0, c.0), 4),
            Step::Call(function) => {
                let name = format!("{function:?}").to_lowercase();
                let arguments = [a.0, b.0, c.0][..step.operands()].join(", ");
                (format!("{name}({arguments})"), 4)
            }
        })
    });
    whole.unwrap_or_default().0
}

#[cfg(test)]
mod tests {
    use crate::formula::tests::field;

    #[test]
    fn powers_of_factors_are_left_out() {
        for (text, factors, left) in [
            (
                "(x^2 + y^2 + z^2 - 1)^2*(x - 2*y + 0.25)",
                "x^2 + y^2 + z^2 - 1",
                "(x^2+y^2+z^2-1)*(x-2*y+0.25)",
            ),
            ("-2*x*(y - z)*x^3", "x", "-x*(y - z)"),
            ("(-(x*y)^2)^3*z/1", "x, y", "-x*y*z"),
            ("(sin(x) - y/2)^4", "sin(x) - y/2", "sin(x) - y/2"),
        ] {
            let (reduced, names) = field(text).without_powers().expect(text);
            assert_eq!(names.join(", "), factors, "{text}");
            let expected = field(left);
            for at in [[0.3, 0.7, -1.1], [1.7, -0.4, 0.6]] {
                let (found, expected): (f64, f64) = (reduced.at(at), expected.at(at));
                assert!((found - expected).abs() < 1e-12, "{text}: {found} is not {expected}");
            }
        }
        for text in ["x^2 + y^2 - 1", "x*y*z", "2*(x - 1)*(y - 1)", "-x"] {
            assert_eq!(field(text).without_powers(), None, "{text}");
        }
    }

    #[test]
    fn numbers_of_a_million_digits_are_not_computed() {
        for text in ["x + ((3^999)^999)^999", "(x + 3)*((7^999)^999)^999"] {
            assert!(!field(text).is_polynomial(), "{text}");
        }
    }

    #[test]
    fn repeated_factors_are_seen_however_they_are_written() {
        for text in [
            "(x + y)^2*z",
            "x^2 + 2*x*y + y^2",
            "(x^2 - y^2)*(x - y)*z",
            "x^4 + y^4 + 2*x^2*y^2 - 2*(x^2 + y^2)*z + z^2",
        ] {
            assert!(field(text).has_repeated_factor(), "{text}");
        }
        for text in
            ["x^2 + y^2 + z^2 - 1", "x^2*y^2 + y^2*z^2 + z^2*x^2 - 2*x*y*z", "x^2 - y^2*z", "sin(x)^2", "x"]
        {
            assert!(!field(text).has_repeated_factor(), "{text}");
        }
    }
}
