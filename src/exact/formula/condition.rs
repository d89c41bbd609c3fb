//! Formulas that are 0 in a part of space alone, as `if` and `max` state it.

use super::factors::{has_variable, start_of_last, written};
use super::field::Field;
use super::step::{Function, Step};
use super::{Formula, value_of};
use std::sync::Arc;

impl Field {
    /// Returns a formula and a condition, so that this formula is 0 where the first one is, as far as the second one is not
    /// below 0: of `if(c > 0, f, 1)` and of `max(abs(f), -c)`, these are f and c. An end that `>` leaves out is taken in.
    /// `None` if the formula is written otherwise.
    pub fn conditional(&self) -> Option<[Self; 2]> {
        let (last, operands) = self.formula().steps.split_last()?;
        let (rest, second) = operands.split_at(start_of_last(operands));
        let negated = |steps: &[Step]| [steps, &[Step::Neg]].concat();
        let (formula, condition) = match last {
            Step::Call(Function::If) => {
                let (condition, first) = rest.split_at(start_of_last(rest));
                let is_never_0 = |steps: &[Step]| !has_variable(steps) && value_of(steps) != 0.0;
                match [is_never_0(first), is_never_0(second)] {
                    [false, true] => (first, condition.to_vec()),
                    [true, false] => (second, negated(condition)),
                    _ => return None,
                }
            }
            Step::Call(Function::Max) => match [rest.split_last(), second.split_last()] {
                [Some((Step::Call(Function::Abs), formula)), _] => (formula, negated(second)),
                [_, Some((Step::Call(Function::Abs), formula))] => (formula, negated(rest)),
                _ => return None,
            },
            _ => return None,
        };
        let field =
            |steps: Vec<Step>| Self::new(Arc::new(Formula::new(written(&steps), Self::VARIABLES, steps)));
        Some([field(formula.to_vec())?, field(condition)?])
    }
}

#[cfg(test)]
mod tests {
    use crate::formula::tests::field;

    #[test]
    fn a_condition_is_what_if_and_max_say() {
        for text in [
            "if(x > y, x*z - 1, 1)",
            "if(x >= y, x*z - 1, -2)",
            "if(x < y, 1, x*z - 1)",
            "if(x <= y, 1 + 1, x*z - 1)",
            "max(abs(x*z - 1), y - x)",
            "max(y - x, |x*z - 1|)",
        ] {
            let [formula, condition] = field(text).conditional().unwrap_or_else(|| panic!("{text}"));
            for at in [[0.5, -0.25, 2.0], [0.5, 0.75, 2.0], [-1.0, 3.0, 0.5]] {
                let [own, found, kept]: [f64; 3] = [field(text).at(at), formula.at(at), condition.at(at)];
                assert_eq!(own == 0.0, found == 0.0 && kept >= 0.0, "{text} at {at:?}");
                assert_eq!((found, kept.abs()), (at[0] * at[2] - 1.0, (at[0] - at[1]).abs()), "{text}");
            }
        }
        let again =
            field("if(x > 0, if(y > 0, z, 1), 1)").conditional().and_then(|[inner, _]| inner.conditional());
        assert!(again.is_some());
        for text in ["x", "max(x, y)", "if(x > 0, y, z)", "if(x > 0, y, 0)", "if(x > 0, 1, 1)"] {
            assert_eq!(field(text).conditional(), None, "{text}");
        }
    }
}
