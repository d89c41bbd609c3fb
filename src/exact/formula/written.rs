//! Formulas as they were written: the operations of the text, one by one, in plain intervals.
//!
//! This is a second opinion on proofs, which evaluate simplified formulas with derivatives in other number types. It
//! shares nothing with them but the rounding of a [`Float`] and the noise: no step is left out, joined with another,
//! or cleared of its denominators. It also tells where a formula is defined, which a simplified one does not.

mod seen;

pub use seen::Seen;

use super::Formula;
use super::field::FieldOf;
use super::step::Step;
use crate::interval::{Float, Interval};
use seen::MAYBE_UNDEFINED;

/// The evaluation of a formula as it was written.
pub struct Written<'f, F> {
    steps: &'f [Step],
    waiting: Vec<Seen<F>>,
}

/// What keeps proofs from looking past the points of a box.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Obstacle {
    /// An operation that may not be defined there, as it is written.
    Undefined(String),
    /// An operation whose values may jump.
    Jump(String),
    /// All operations are defined and continuous there: what is left is a slope without bounds.
    Slope,
}

impl Formula {
    /// Returns the first operation, in the order of evaluation, that may not be defined at the points of a box, or
    /// else the first that may not be continuous.
    pub fn obstacle(&self, at: &[Interval]) -> Obstacle {
        let (mut undefined, mut jump) = (None, None);
        self.written::<f64>().each(at, |step, seen| {
            if !seen.is_continuous() {
                let first = if seen.is_defined() == Some(true) { &mut jump } else { &mut undefined };
                first.get_or_insert(step);
            }
        });
        let text = |step: usize| self.text_of(step).to_owned();
        let undefined = undefined.map(|step| Obstacle::Undefined(text(step)));
        undefined.or(jump.map(|step| Obstacle::Jump(text(step)))).unwrap_or(Obstacle::Slope)
    }

    fn written<F: Float>(&self) -> Written<'_, F> {
        Written { steps: &self.steps, waiting: Vec::new() }
    }
}

impl<const N: usize> FieldOf<N> {
    /// Returns what [`Formula::obstacle`] tells of the formula as it was written.
    pub fn obstacle(&self, at: &[Interval]) -> Obstacle {
        self.as_written().obstacle(at)
    }

    /// Returns the evaluation of the formula as it was written.
    pub fn written<F: Float>(&self) -> Written<'_, F> {
        self.as_written().written()
    }
}

impl<F: Float> Written<'_, F> {
    /// Evaluates the formula at the points of a box.
    pub fn at(&mut self, at: &[Interval<F>]) -> Seen<F> {
        self.each(at, |_, _| {})
    }

    /// Evaluates the formula as [`at`](Self::at) does, and shows the value of each operation.
    #[inline(always)]
    fn each(&mut self, at: &[Interval<F>], mut show: impl FnMut(usize, &Seen<F>)) -> Seen<F> {
        let unknown = Seen { faults: MAYBE_UNDEFINED, ..Seen::whole() };
        self.waiting.clear();
        for (index, step) in self.steps.iter().enumerate() {
            let mut operand = || self.waiting.pop().unwrap_or(unknown);
            let value = match step.operands() {
                0 => match *step {
                    Step::Variable(index) => {
                        Seen::of(at[usize::from(index)].low, at[usize::from(index)].high)
                    }
                    Step::Number(number) => Seen::of(F::of(number), F::of(number)),
                    _ => unknown,
                },
                1 => operand().one(*step),
                2 => {
                    let b = operand();
                    operand().two(*step, b)
                }
                _ => {
                    let (c, b) = (operand(), operand());
                    operand().three(*step, b, c)
                }
            };
            show(index, &value);
            self.waiting.push(value);
        }
        self.waiting.pop().unwrap_or(unknown)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formula::Formula;
    use crate::formula::field::Field;
    use std::sync::Arc;

    #[test]
    fn what_keeps_proofs_from_looking_past_the_origin_is_named() {
        let undefined = |text: &str| Obstacle::Undefined(text.to_owned());
        let jump = |text: &str| Obstacle::Jump(text.to_owned());
        for (text, expected) in [
            ("x^2 + y^2 - 1", Obstacle::Slope),
            ("sqrt(abs(x)) + |y|", Obstacle::Slope),
            ("1/cbrt(x - z) - 1", undefined("1/cbrt(x - z)")),
            ("2 - cbrt(x - z)^-1 + y", undefined("cbrt(x - z)^-1")),
            ("sqrt(x + 1)*ln( y ) + z/x", undefined("ln( y )")),
            ("(x + 1)*(y/z)*3", undefined("y/z")),
            ("asin(y/x)", undefined("asin(y/x)")),
            ("smin(1/x, y, 0.3)", undefined("1/x")),
            ("x² + 2 floor(5x) y", jump("floor(5x)")),
            ("min(x, if(y < 1/z, 1, 2))", undefined("1/z")),
            ("min(x, if(y < z, 1, 2))", jump("if(y < z, 1, 2)")),
            ("x = |y|^(1/z)", undefined("1/z")),
        ] {
            let formula =
                Formula::parse_in(text, Field::VARIABLES).unwrap_or_else(|fault| panic!("{fault:?}"));
            let field = Field::new(Arc::new(formula)).expect("its variables are x, y and z");
            assert_eq!(field.obstacle(&[Interval { low: -0.01, high: 0.01 }; 3]), expected, "{text}");
        }
    }
}
