//! Formulas along lines, as polynomials.

use super::program::{NAMED_REGISTERS, Program, Value, Values};
use super::recorded::{self, Recorder};
use super::step::Step;
use super::variables::SPACE;
use crate::polynomial::{Coefficient, Polynomial};
use crate::scalar::Scalar;

/// A formula in x, y and z along lines. Powers are products.
#[derive(Clone, Debug, PartialEq)]
pub struct AlongLines(pub(super) Program);

impl AlongLines {
    /// Records a function. Returns `None` if it has an operation that no formula of a scene expresses, or is too long.
    pub fn recorded(function: impl FnOnce([Recorder; 3]) -> Recorder) -> Option<Self> {
        let (values, _) = recorded::values(function);
        let is_known = |value: &Value| match value.step {
            Step::Number(number) | Step::Scale(number) | Step::Shift(number) => number.is_finite(),
            step => step != Step::Spline,
        };
        let program = by_products(&values, SPACE.len(), Products::All);
        let fits = program.registers <= NAMED_REGISTERS && values.list.iter().all(is_known);
        fits.then_some(Self(program))
    }

    /// Evaluates the formula at a point with polynomials as coordinates. Operations work in place, because copying a
    /// polynomial for each would be slow.
    pub fn polynomial<C: Coefficient, const N: usize>(&self, at: [Polynomial<C, N>; 3]) -> Polynomial<C, N> {
        let mut registers = Vec::with_capacity(self.0.registers.max(at.len()));
        registers.extend_from_slice(&at);
        for instruction in &self.0.instructions {
            let (a, b) = (usize::from(instruction.operands[0]), usize::from(instruction.operands[1]));
            let result = usize::from(instruction.result);
            if result == registers.len() {
                registers.push(Polynomial::constant(0.0));
            }
            match instruction.step {
                Step::Mul => registers[result] = registers[a].times(&registers[b]),
                Step::Add if result == a => add(&mut registers, result, b, 1.0),
                Step::Add if result == b => add(&mut registers, result, a, 1.0),
                Step::Sub if result == a => add(&mut registers, result, b, -1.0),
                Step::Scale(factor) if result == a => registers[result].scale(factor),
                Step::Shift(by) if result == a => registers[result].shift(by),
                Step::Number(number) => registers[result].set(number),
                step => {
                    let c = || registers[usize::from(instruction.operands[2])];
                    registers[result] = step.of::<_, true>(registers[a], registers[b], c, None);
                }
            }
        }
        registers[usize::from(self.0.result)]
    }
}

/// Adds one register to another, times a sign that is 1 or -1.
fn add<C: Coefficient, const N: usize>(
    registers: &mut [Polynomial<C, N>],
    to: usize,
    from: usize,
    sign: f64,
) {
    if let Ok([to, from]) = registers.get_disjoint_mut([to, from]) {
        to.add_times(from, sign);
    } else {
        registers[to] = registers[to] + registers[from].scaled(sign);
    }
}

/// The powers to compute as products. The factors are known powers of the same number, if there are any: `x^6` is the
/// product of `x^4` and `x^2`.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Products {
    /// All powers.
    All,
    /// Even powers, as products of squares. Bounds of such a product are as tight as bounds of the power.
    OfSquares,
}

/// Returns a program in which powers are products. It may have more registers than instructions can name.
pub(super) fn by_products(given: &Values, variables: usize, which: Products) -> Program {
    let mut new = Powers { list: given.list[..variables].to_vec(), known: Vec::new() };
    let mut places: Vec<usize> = (0..variables).collect();
    for value in &given.list[variables..] {
        let operands = value.operands.map(|operand| places.get(operand).copied().unwrap_or(0));
        places.push(match value.step {
            Step::Powi(exponent) if exponent > 1 && which == Products::All => {
                new.power(operands[0], exponent.unsigned_abs())
            }
            Step::Powi(exponent) if exponent > 1 && exponent % 2 == 0 => {
                let square = new.square(operands[0]);
                new.power(square, exponent.unsigned_abs() / 2)
            }
            step => new.push(step, operands),
        });
    }
    Program::of(&Values { list: new.list, result: places[given.result] }, variables)
}

struct Powers {
    list: Vec<Value>,
    /// The known powers: the base, the exponent, and the value of the power.
    known: Vec<(usize, u32, usize)>,
}

impl Powers {
    fn push(&mut self, step: Step, operands: [usize; 3]) -> usize {
        self.list.push(Value { step, operands });
        self.list.len() - 1
    }

    /// Returns the value for a power of another one with an exponent of 1 or more.
    fn power(&mut self, of: usize, exponent: u32) -> usize {
        if exponent == 1 {
            return of;
        }
        let known = |exponent: u32| if exponent == 1 { Some(of) } else { self.find(of, exponent) };
        if let Some(power) = known(exponent) {
            return power;
        }
        let parts =
            (exponent / 2..exponent).rev().find_map(|part| Some([known(part)?, known(exponent - part)?]));
        let parts = parts.unwrap_or_else(|| {
            let half = self.power(of, exponent / 2);
            [if exponent.is_multiple_of(2) { half } else { self.power(of, exponent - exponent / 2) }, half]
        });
        let product = self.push(Step::Mul, [parts[0], parts[1], 0]);
        self.known.push((of, exponent, product));
        product
    }

    /// Returns the value for the square of another one.
    fn square(&mut self, of: usize) -> usize {
        self.find(of, 2).unwrap_or_else(|| {
            let square = self.push(Step::Powi(2), [of, 0, 0]);
            self.known.push((of, 2, square));
            square
        })
    }

    fn find(&self, of: usize, exponent: u32) -> Option<usize> {
        self.known.iter().find(|power| (power.0, power.1) == (of, exponent)).map(|power| power.2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formula::rational::Rational;
    use crate::formula::tests::field;
    use crate::interval::Interval;
    use crate::polynomial::MAX_COEFFICIENTS;
    use crate::spline::Spline;

    const ORIGIN: [f64; 3] = [0.25, 0.0, 1.5];
    const DIR: [f64; 3] = [0.5, -2.0, 1.0];

    #[test]
    fn a_function_is_the_polynomial_of_its_formula() {
        let recorded = AlongLines::recorded(|[x, y, z]| {
            (x.powi(2) + y.powi(4) - Recorder::constant(1.0)).powi(3) - x * y * z.powi(5).scaled(3.0)
        });
        let field = field("(x^2 + y^4 - 1)^3 - x*y*z^5*3");
        let both = [&recorded.expect("a polynomial"), field.along_lines()];
        let t = Polynomial::<f64, MAX_COEFFICIENTS>::along(Interval { low: -1.0, high: 1.0 });
        let at = [0, 1, 2].map(|axis| t.scaled(DIR[axis]).shifted(ORIGIN[axis]));
        let [recorded, written] = both.map(|of| of.polynomial(at));
        assert_eq!((recorded.degree(), written.degree()), (Some(12), Some(12)));
        for (one, other) in recorded.coefficients().iter().zip(written.coefficients()) {
            assert!((one - other).abs() <= 1e-12 * other.abs(), "{one} is not {other}");
        }
        let [origin, dir] = [ORIGIN, DIR].map(|of| of.map(Rational::from));
        let [recorded, written] = both.map(|of| of.exactly(&origin, &dir).expect("a polynomial"));
        assert_eq!(recorded.coefficients(), written.coefficients());
    }

    #[test]
    fn what_no_formula_expresses_is_not_recorded() {
        let spline = Spline::new(&[[0.0, 0.5], [1.0, 1.0], [2.0, 0.0]]);
        assert_eq!(AlongLines::recorded(|[x, y, _]| x + y.spline(&spline, 0)), None);
        assert_eq!(AlongLines::recorded(|[x, ..]| x + Recorder::about(1.0, 0.1)), None);
        assert_eq!(AlongLines::recorded(|[x, ..]| x.scaled(f64::INFINITY)), None);
    }
}
