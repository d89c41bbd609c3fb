//! Formulas along lines, as polynomials. Operations work in place, because copying a polynomial for each would be slow.

use super::program::{MAX_REGISTERS, Program, Value, Values};
use super::step::Step;
use crate::polynomial::{Coefficient, Polynomial};
use crate::scalar::Scalar;

impl Program {
    /// Evaluates operations at a point with polynomials as coordinates.
    pub(super) fn along<C: Coefficient, const N: usize>(
        &self,
        at: [Polynomial<C, N>; 3],
    ) -> Polynomial<C, N> {
        let mut registers = Vec::with_capacity(self.registers.max(at.len()));
        registers.extend_from_slice(&at);
        for instruction in &self.instructions {
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
        registers[usize::from(self.result)]
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

/// Returns a program in which powers are products, or `None` if it needs too many registers.
pub(super) fn by_products(steps: &[Step], variables: usize, which: Products) -> Option<Program> {
    let given = Values::new(steps, variables);
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
    let program = Program::of(&Values { list: new.list, result: places[given.result] }, variables);
    (program.registers <= MAX_REGISTERS).then_some(program)
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
