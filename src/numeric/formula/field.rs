//! Formulas in x, y and z, and in all that is known of a point of a surface.

use super::step::{Function, MAX_DEPTH, Step};
use super::{Formula, SMALL_STACK};
use crate::numeric::scalar::Scalar;
use std::sync::Arc;

/// The variables of a formula of space.
pub const SPACE: &[&str] = &["x", "y", "z"];

/// The variables of a formula of a surface: the point, u and v, and the unit normal.
pub const SURFACE: &[&str] = &["x", "y", "z", "u", "v", "nx", "ny", "nz"];

/// The stack depth that suffices for most formulas of space, in values. A stack of [`MAX_DEPTH`] takes longer to set up
/// than most formulas to evaluate.
const MEDIUM_STACK: usize = 8;

/// A formula in x, y and z: `x^2 + y^2 + z^2 - 1`.
pub type Field = FieldOf<3>;

/// A formula in the variables of [`SURFACE`]: `0.5 + 0.5*sin(4*x)`.
pub type SurfaceField = FieldOf<8>;

/// A formula in 3 variables, those of [`SPACE`], or in the 8 of [`SURFACE`].
#[derive(Clone, Debug, PartialEq)]
pub struct FieldOf<const N: usize> {
    /// The formula as it was read.
    formula: Arc<Formula>,
    /// The same with fewer operations.
    quick: Formula,
}

impl<const COUNT: usize> FieldOf<COUNT> {
    /// The names of the variables.
    pub const VARIABLES: &'static [&'static str] = if COUNT == SURFACE.len() { SURFACE } else { SPACE };

    /// Takes a formula, if its variables are these.
    pub fn new(formula: Arc<Formula>) -> Option<Self> {
        if formula.variables() != Self::VARIABLES {
            return None;
        }
        let quick = Formula::new(formula.text.clone(), Self::VARIABLES, with_constants(&formula.steps));
        Some(Self { formula, quick })
    }

    /// Tells whether the formula uses the variable of this index.
    pub fn uses(&self, index: usize) -> bool {
        self.quick.steps.iter().any(|step| *step == Step::Variable(index as u8))
    }

    /// Tells whether the formula has a value wherever an interval has one: it has no square roots, which intervals take of
    /// what is not negative alone.
    pub fn is_enclosed(&self) -> bool {
        !self.quick.steps.contains(&Step::Call(Function::Sqrt))
    }

    /// Returns the formula.
    pub fn formula(&self) -> &Arc<Formula> {
        &self.formula
    }

    /// Evaluates the formula at a point.
    #[inline(always)]
    pub fn at<N: Scalar>(&self, at: [N; COUNT]) -> N {
        let depth = self.quick.stack_depth;
        if depth <= SMALL_STACK {
            self.quick.run(&at, &mut [at[0]; SMALL_STACK])
        } else if depth <= MEDIUM_STACK {
            self.quick.run(&at, &mut [at[0]; MEDIUM_STACK])
        } else {
            self.quick.run(&at, &mut [at[0]; MAX_DEPTH])
        }
    }
}

/// Returns the same operations, where those with a constant take one step and no derivatives of the constant.
fn with_constants(steps: &[Step]) -> Vec<Step> {
    let (mut out, mut starts) = (Vec::with_capacity(steps.len()), Vec::new());
    for step in steps {
        match step {
            Step::Variable(_) | Step::Number(_) => starts.push(out.len()),
            Step::Add | Step::Sub | Step::Mul | Step::Div => {
                let second = starts.pop().unwrap_or(0);
                let first = starts.last().copied().unwrap_or(0);
                let last = out.len() - 1;
                let constant =
                    |step: &Step| if let Step::Number(number) = *step { Some(number) } else { None };
                let right = if second == last { constant(&out[last]) } else { None };
                let left = if second == first + 1 { constant(&out[first]) } else { None };
                let (at, quick): (usize, &[Step]) = match (step, left, right) {
                    (Step::Add, _, Some(number)) => (last, &[Step::Shift(number)]),
                    (Step::Sub, _, Some(number)) => (last, &[Step::Shift(-number)]),
                    (Step::Mul, _, Some(number)) => (last, &[Step::Scale(number)]),
                    (Step::Add, Some(number), _) => (first, &[Step::Shift(number)]),
                    (Step::Sub, Some(number), _) => (first, &[Step::Neg, Step::Shift(number)]),
                    (Step::Mul, Some(number), _) => (first, &[Step::Scale(number)]),
                    _ => {
                        out.push(*step);
                        continue;
                    }
                };
                out.remove(at);
                out.extend(quick);
                continue;
            }
            Step::Call(Function::Min | Function::Max | Function::Pow) => {
                starts.pop();
            }
            _ => {}
        }
        out.push(*step);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_means_what_its_formula_says() {
        for (text, expected) in [
            ("x^2 + y^2/2 + z^2 - 1", 1.0 + 2.0 + 9.0 - 1.0),
            ("4*x - (3 - 2*y)*z", 4.0 - (3.0 - 4.0) * 3.0),
            ("1 - 6/(x + 1) + min(2, y*3) - max(z, 4) * 2", 1.0 - 3.0 + 2.0 - 8.0),
            ("2 - 3 - 4*5 + x", -20.0),
            (
                "(2 + x)*(y + (z + (x - (y - (z - (x*(y + 3)))))))",
                3.0 * (2.0 + (3.0 + (1.0 - (2.0 - (3.0 - 5.0))))),
            ),
            ("-(5 - x) * 2 - pi + pi", -8.0),
        ] {
            let formula = Formula::parse_in(text, SPACE).unwrap_or_else(|fault| panic!("{text}: {fault:?}"));
            let field = Field::new(Arc::new(formula)).expect("its variables are x, y and z");
            let value: f64 = field.at([1.0, 2.0, 3.0]);
            assert!((value - expected).abs() < 1e-14, "{text} is {value}");
        }
        assert_eq!(Field::new(Arc::new(Formula::parse("y").expect("a formula"))), None);
    }
}
