//! The domain of a formula in x, y and z, and its jumps.

use super::Formula;
use super::field::Field;
use super::step::{Function, Step, fold};
use super::variables::SPACE;
use crate::interval::{Float, Interval};
use crate::scalar::Scalar;
use std::mem::take;
use std::sync::Arc;

/// The maximum number of jumps in a box. The formula is evaluated on both sides of each.
const MAX_JUMPS: u32 = 4;

impl Field {
    /// Returns a formula that is negative where this one is undefined: where the operand of a square root or a
    /// logarithm, or the base of a power with a fractional exponent, is negative. Returns `None` if this one is defined
    /// in the whole box with these corners.
    pub fn domain(&self, corners: [[f64; 3]; 2]) -> Option<Self> {
        let [low, high] = corners;
        let within = [0, 1, 2].map(|axis| Interval { low: low[axis], high: high[axis] });
        let steps = &self.formula().steps;
        // The operands that must not be negative, each with the index of the operation that requires this.
        let (mut conditions, mut of_all): (Vec<(usize, Vec<Step>)>, Vec<Step>) = (Vec::new(), Vec::new());
        fold(steps, |index, step, starts: &mut [usize]| {
            // The places where the operation's operands start, or where the last of them ends.
            let [first, end, last] = [0, 1, 2].map(|which| starts.get(which).copied().unwrap_or(index));
            match step {
                Step::Call(Function::Sqrt | Function::Ln | Function::Pow) => {
                    conditions.push((index, steps[first..end].to_vec()));
                }
                // An operand that is not chosen may be undefined.
                Step::Call(Function::If) => {
                    for (at, condition) in conditions.iter_mut().filter(|(at, _)| *at >= end) {
                        let fulfilled = vec![Step::Number(1.0)];
                        let own = take(condition);
                        let [one, other] = if *at < last { [own, fulfilled] } else { [fulfilled, own] };
                        *condition = [&steps[first..end], &one, &other, &[step]].concat();
                    }
                }
                _ => {}
            }
            Some(first)
        });
        let conditions: Vec<_> = conditions.into_iter().map(|(_, condition)| condition).collect();
        for (index, condition) in conditions.iter().enumerate() {
            // An operand that cannot be negative may be negative after rounding.
            let may_be_below = self.with(condition.to_vec()).at(within).low < -f64::MIN_POSITIVE;
            if !may_be_below || conditions[..index].contains(condition) {
                continue;
            }
            let is_first = of_all.is_empty();
            of_all.extend(condition);
            if !is_first {
                of_all.push(Step::Call(Function::Min));
            }
        }
        (!of_all.is_empty()).then(|| self.with(of_all))
    }

    /// Returns a field with other operations.
    fn with(&self, steps: Vec<Step>) -> Self {
        let formula = Formula::new(self.formula().to_string(), SPACE, steps);
        Self::new(Arc::new(formula)).unwrap_or_else(|| self.clone())
    }

    /// Tells whether the formula has jumps or poles in a box, and is certainly nonzero or undefined on all of their
    /// sides there.
    pub fn jumps_past_0<F: Float>(&self, at: [Interval<F>; 3]) -> bool {
        if !self.program().instructions.iter().any(|instruction| may_jump(instruction.step)) {
            return false;
        }
        // On one side of a jump, others may occur than on the other side: the sides are the leaves of a tree.
        let mut sides = 0;
        loop {
            let mut jumps = 0;
            let value = self.beside(at, sides, &mut jumps);
            if jumps == 0 || jumps > MAX_JUMPS || value.is_some_and(Interval::has_zero) {
                return false;
            }
            let Some(last) = (0..jumps).rev().find(|jump| sides >> jump & 1 == 0) else { return true };
            sides = sides & ((1 << last) - 1) | 1 << last;
        }
    }

    /// Encloses the formula on one side of each jump and pole in a box: above it if its bit of `sides` is set, and
    /// otherwise below it. Returns `None` if the formula is certainly undefined there. Counts the jumps and poles that
    /// occur there. A tangent with several poles counts as too many.
    fn beside<F: Float>(&self, at: [Interval<F>; 3], sides: u32, jumps: &mut u32) -> Option<Interval<F>> {
        let (value, is_undefined) = self.program().fold(at.map(|axis| (axis, false)), |step, operands| {
            let (a, b) = (operands[0].0, operands[1].0);
            let c = || operands[2].0;
            let mut value = step.of::<_, true>(a, b, c, None);
            let (zero, is_above) = (F::of(0.0), *jumps < MAX_JUMPS && sides >> *jumps & 1 == 1);
            let without = |which: usize| operands[which].1;
            let mut is_undefined = (0..step.operands()).any(without);
            // Tells whether a divisor is 0 at most on this side of its pole.
            let is_nowhere = |of: Interval<F>| if is_above { of.high <= zero } else { of.low >= zero };
            match step {
                // Of several jumps, bounds of all sides are known.
                Step::Call(Function::Floor | Function::Heaviside) if value.high - value.low == F::of(1.0) => {
                    value = Interval::point(if is_above { value.high } else { value.low });
                    *jumps += 1;
                }
                Step::Call(Function::If) if a.low < zero && a.high >= zero => {
                    value = if is_above { b } else { c() };
                    is_undefined = without(0) || without(if is_above { 1 } else { 2 });
                    *jumps += 1;
                }
                Step::Call(Function::If) => {
                    is_undefined = without(0) || without(if a.low >= zero { 1 } else { 2 });
                }
                Step::Call(Function::Pow | Function::Sqrt) if a.high < zero => is_undefined = true,
                Step::Call(Function::Ln) if a.high <= zero => is_undefined = true,
                // Logarithms and powers are undefined for negative numbers.
                Step::Call(Function::Ln | Function::Pow) if a.low < zero && a.high >= zero => {
                    let end = Interval::point(a.high);
                    value = match step {
                        Step::Call(Function::Ln) => Interval { low: -F::INFINITY, high: end.ln().high },
                        _ => Interval { low: zero, ..a }.pow(b),
                    };
                    *jumps += 1;
                }
                // Beside a pole, a quotient is far from 0.
                Step::Div if b.has_zero() && !a.has_zero() => {
                    value =
                        a / if is_above { Interval { low: zero, ..b } } else { Interval { high: zero, ..b } };
                    is_undefined |= is_nowhere(b);
                    *jumps += 1;
                }
                Step::Powi(exponent @ ..0) if exponent % 2 != 0 && a.has_zero() => {
                    let end = Interval::point(if is_above { a.high } else { a.low }).powi(exponent);
                    value = match is_above {
                        true => Interval { low: end.low, high: F::INFINITY },
                        false => Interval { low: -F::INFINITY, high: end.high },
                    };
                    is_undefined |= is_nowhere(a);
                    *jumps += 1;
                }
                Step::Call(Function::Tan) if !value.is_bounded() => {
                    let [before, after] = [a.low, a.high].map(|end| Interval::point(end).tan());
                    let is_single = a.width() < F::of(1.5) && before.low > zero && after.high < zero;
                    value = match is_above {
                        true => Interval { low: before.low, high: F::INFINITY },
                        false => Interval { low: -F::INFINITY, high: after.high },
                    };
                    *jumps += if is_single { 1 } else { MAX_JUMPS + 1 };
                }
                Step::Call(Function::Atan2) if a.has_zero() && b.high < zero => {
                    let height = Interval { low: zero, high: if is_above { a.high } else { -a.low } };
                    let angle = Interval::pi() - height.atan2(-b);
                    value = if is_above { angle } else { -angle };
                    *jumps += 1;
                }
                _ => {}
            }
            Some((value, is_undefined))
        })?;
        (!is_undefined).then_some(value)
    }
}

/// Tells whether an operation jumps or has a pole anywhere.
fn may_jump(step: Step) -> bool {
    use Function::{Atan2, Floor, Heaviside, If, Ln, Pow, Tan};
    match step {
        Step::Div => true,
        Step::Powi(exponent) => exponent < 0,
        Step::Call(function) => matches!(function, Floor | Heaviside | If | Ln | Pow | Tan | Atan2),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formula::tests::field;

    const BOX: [[f64; 3]; 2] = [[-2.0; 3], [2.0; 3]];

    #[test]
    fn a_domain_is_below_0_where_a_formula_is_not_defined() {
        for (text, at, expected) in [
            ("z - sqrt(1 - x^2 - y^2)", [1.0, 1.0, 0.0], -1.0),
            ("ln(x) + sqrt(y)", [1.5, 0.5, 0.0], 0.5),
            ("ln(x) + sqrt(y)", [-1.5, 0.5, 0.0], -1.5),
            ("sqrt(x - sqrt(y)) - z", [1.0, 1.0, 0.0], 0.0),
            ("x^(1/3) - y", [-1.0, 1.0, 0.0], -1.0),
            ("if(z < 0, sqrt(x), ln(y)) - z", [-1.0, 0.5, -1.0], -1.0),
            ("if(z < 0, sqrt(x), ln(y)) - z", [-1.0, 0.5, 1.0], 0.5),
            ("if(x < 0, sqrt(-x), if(y > 1, x, sqrt(x))) - z", [-0.5, 0.0, 0.0], 0.5),
            ("if(x < 0, sqrt(-x), if(y > 1, x, sqrt(x))) - z", [0.25, 0.0, 0.0], 0.25),
            ("if(x < 0, sqrt(-x), if(y > 1, x, sqrt(x))) - z", [0.25, 2.0, 0.0], 1.0),
        ] {
            let domain =
                field(text).domain(BOX).unwrap_or_else(|| panic!("{text} is not defined everywhere"));
            assert_eq!(domain.at(at), expected, "{text}");
        }
    }

    #[test]
    fn what_is_defined_everywhere_has_no_domain() {
        for text in [
            "x + y^3",
            "sqrt(x^2 + z^2) - y",
            "sqrt(x*x + (y - 1)*(y - 1)) - 1",
            "abs(x)^0.6 + |y|^0.6 - 1",
            "sqrt(x + 2) - ln(exp(y))",
        ] {
            assert_eq!(field(text).domain(BOX), None, "{text}");
        }
    }

    #[test]
    fn a_jump_past_0_is_told_from_a_root_beside_it() {
        let near = |x: f64| [x - 1e-9, x + 1e-9];
        for (text, [low, high], expected) in [
            ("floor(x) - 0.5", near(1.0), true),
            ("floor(x) - 0.5", near(0.5), false),
            ("(x - floor(x) - 0.5)^2 - 0.1", near(1.0), true),
            ("x - 2*floor(x) + 1", near(1.0), false),
            ("floor(9*x) - 1.5 - 1e9*x", [0.0, 1.0], false),
            ("heaviside(x - 1) - 0.5", near(1.0), true),
            ("if(x < 1, -2, 3)", near(1.0), true),
            ("if(x >= 1, y - x, 1 - y - 2*x)", near(1.0), true),
            ("if(x > 1, x - 1, 1 - x)", near(1.0), false),
            ("atan2(x - 1, -1) - y", near(1.0), true),
            ("sin(y)/(x - 1) - 3", near(1.0), true),
            ("(x - 1)/(x - 1) - 1", near(1.0), false),
            ("z - (x - 1)^-3", near(1.0), true),
            ("ln(x - 1) - z", near(1.0), true),
            ("(x - 1)^0.5 - z", near(1.0), true),
            ("ln(x) - z", near(1.0), false),
            ("tan(x) + z", near(1.0), false),
            ("tan(x) + z", near(std::f64::consts::FRAC_PI_2), true),
            ("atan2(x - 1, 1)", near(1.0), false),
            ("acos(-0.5/x) - 2", [-1.5, 3.0], false),
            ("ln(z/(x - 1)) - 0.2", near(1.0), true),
            ("acosh(z/(x - 1)) - 0.5", near(1.0), true),
            ("1/cbrt(x - 1) - z", near(1.0), true),
            ("cbrt(x - 1)^-1 - z", near(1.0), true),
            ("atanh(z/(x - 1)) - 1", near(1.0), true),
            ("y*floor(z/(x - 1)) - 1", near(1.0), true),
            ("sqrt(z/(x - 1)) - 7", near(1.0), true),
            ("if(x < 1, ln(z/(x - 1)), x - 1)", near(1.0), false),
        ] {
            let at = [Interval { low, high }, Interval::constant(0.3), Interval::constant(0.3)];
            assert_eq!(field(text).jumps_past_0(at), expected, "{text}");
        }
    }
}
