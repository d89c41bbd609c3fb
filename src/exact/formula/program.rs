//! Formulas as programs: operations on registers. Equal operations are carried out only once.

use super::step::{Function, MAX_DEPTH, Step, StepKey, fold};
use super::variables::SURFACE;
use std::collections::HashMap;

/// An operation: reads up to three registers, and writes one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Instruction {
    pub step: Step,
    pub operands: [u8; 3],
    pub result: u8,
}

impl Instruction {
    /// Tells whether this and the next operation are the sine and the cosine of the same number, in any order.
    /// Computing both takes hardly longer than computing one.
    #[inline(always)]
    pub fn is_of_one_angle_with(&self, next: &Self) -> bool {
        let steps = (self.step, next.step);
        let are_pair = steps == (Step::Call(Function::Sin), Step::Call(Function::Cos))
            || steps == (Step::Call(Function::Cos), Step::Call(Function::Sin));
        are_pair && self.operands[0] == next.operands[0]
    }
}

/// A formula's operations, in order.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Program {
    pub instructions: Vec<Instruction>,
    /// The register with the final result.
    pub result: u8,
    /// The number of registers. The first ones hold the variables.
    pub registers: usize,
}

/// The number of registers that instructions can name. A program with more cannot be carried out.
pub(super) const NAMED_REGISTERS: usize = 1 << u8::BITS;

/// The number of registers of the largest program of a scene's formula: one for each variable, and those for the deepest nesting, with a
/// square root of its operand and a 0 as the innermost operation.
pub(super) const MAX_REGISTERS: usize = SURFACE.len() + MAX_DEPTH + 1;

/// An operation, and the indices of its operands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Value {
    pub step: Step,
    pub operands: [usize; 3],
}

/// The values of a formula. The variables come first, and each value comes after its operands.
#[derive(Clone, Debug)]
pub(super) struct Values {
    pub list: Vec<Value>,
    /// The index of the value of the whole formula.
    pub result: usize,
}

impl Value {
    /// Returns a key that is equal for equal values.
    pub fn key(&self) -> (StepKey, [usize; 3]) {
        (self.step.key(), self.operands)
    }

    /// Returns the operands of the operation.
    pub fn used(&self) -> &[usize] {
        &self.operands[..self.step.operands()]
    }
}

impl Program {
    /// Makes a program from operations in postfix order. `variables` is the number of variables.
    pub fn new(steps: &[Step], variables: usize) -> Self {
        Self::of(&Values::new(steps, variables), variables)
    }

    /// Assigns a register to each value, until its last use.
    pub fn of(Values { list, result }: &Values, variables: usize) -> Self {
        Self::keeping(list, variables, [*result]).0
    }

    /// Assigns a register to each value, until its last use, or for good to some results. Returns their registers. The
    /// first is that of the program.
    pub fn keeping<const RESULTS: usize>(
        values: &[Value],
        variables: usize,
        results: [usize; RESULTS],
    ) -> (Self, [u8; RESULTS]) {
        let mut last_uses = vec![0; values.len()];
        for (index, value) in values.iter().enumerate() {
            value.used().iter().for_each(|used| last_uses[*used] = index);
        }
        results.iter().for_each(|result| last_uses[*result] = values.len());
        let (mut free, mut registers) = (Vec::new(), variables);
        let mut places: Vec<usize> = (0..variables).collect();
        let mut instructions = Vec::with_capacity(values.len() - variables);
        for (index, value) in values.iter().enumerate().skip(variables) {
            let mut operands = [0; 3];
            for (operand, used) in operands.iter_mut().zip(value.used()) {
                *operand = places[*used] as u8;
            }
            for (operand, used) in value.used().iter().enumerate() {
                let is_ended = *used >= variables && last_uses[*used] == index;
                if is_ended && !value.used()[..operand].contains(used) {
                    free.push(places[*used]);
                }
            }
            let place = free.pop().unwrap_or_else(|| {
                registers += 1;
                registers - 1
            });
            places.push(place);
            instructions.push(Instruction { step: value.step, operands, result: place as u8 });
        }
        let results = results.map(|result| places[result] as u8);
        (Self { instructions, result: results[0], registers }, results)
    }

    /// Carries out the operations on values of any type, given those of the variables. `of` returns the value of an
    /// operation on up to three operands; nothing more is carried out once it returns `None`.
    pub fn fold<T: Clone, const VARIABLES: usize>(
        &self,
        at: [T; VARIABLES],
        mut of: impl FnMut(Step, [&T; 3]) -> Option<T>,
    ) -> Option<T> {
        let mut registers = at.to_vec();
        registers.resize(self.registers.max(VARIABLES), at[0].clone());
        for Instruction { step, operands, result } in &self.instructions {
            let value = of(*step, operands.map(|operand| &registers[usize::from(operand)]))?;
            registers[usize::from(*result)] = value;
        }
        Some(registers.swap_remove(usize::from(self.result)))
    }

    /// Returns the values that the program computes, in order.
    pub fn values(&self, variables: usize) -> Values {
        let variable = |index| Value { step: Step::Variable(index as u8), operands: [0; 3] };
        let mut list: Vec<_> = (0..variables).map(variable).collect();
        // The value in each register.
        let mut held = vec![0; self.registers];
        (0..variables).for_each(|index| held[index] = index);
        for Instruction { step, operands, result } in &self.instructions {
            let operands = operands.map(|operand| held[usize::from(operand)]);
            held[usize::from(*result)] = list.len();
            list.push(Value { step: *step, operands });
        }
        Values { list, result: held[usize::from(self.result)] }
    }
}

impl Values {
    /// Returns the values of operations in postfix order. Equal values are shared if there are enough registers,
    /// because a shared value occupies a register until its last use.
    pub fn new(steps: &[Step], variables: usize) -> Self {
        let shared = values(steps, variables, true);
        let fits = |values: &Self| Program::of(values, variables).registers <= MAX_REGISTERS;
        // Kernels compute formulas in one variable, with few registers.
        let paired = if variables > 1 { paired(&shared.list, variables) } else { None };
        let paired = paired.map(|(list, places)| Self { list, result: places[shared.result] });
        if let Some(paired) = paired.filter(fits) {
            paired
        } else if fits(&shared) {
            shared
        } else {
            values(steps, variables, false)
        }
    }

    /// Joins the values of several formulas in the same variables. Equal ones occur once. Returns the indices of the
    /// formulas' results.
    pub fn joined<const COUNT: usize>(all: [Self; COUNT], variables: usize) -> (Vec<Value>, [usize; COUNT]) {
        let mut list = all[0].list[..variables].to_vec();
        let mut known = HashMap::new();
        let results = all.map(|Self { list: own, result }| {
            let mut places: Vec<_> = (0..variables).collect();
            for value in &own[variables..] {
                let value = Value { operands: value.operands.map(|of| places[of]), ..*value };
                let place = *known.entry(value.key()).or_insert(list.len());
                if place == list.len() {
                    list.push(value);
                }
                places.push(place);
            }
            places[result]
        });
        match paired(&list, variables) {
            Some((list, places)) => (list, results.map(|result| places[result])),
            None => (list, results),
        }
    }
}

/// Returns the same values, with the sine and the cosine of a number next to each other, and their new places, or `None`
/// if there is no such pair.
fn paired(list: &[Value], variables: usize) -> Option<(Vec<Value>, Vec<usize>)> {
    let mut known = HashMap::new();
    for (index, value) in list.iter().enumerate() {
        if let Step::Call(Function::Sin | Function::Cos) = value.step {
            known.entry(value.key()).or_insert(index);
        }
    }
    let pairs = list.iter().map(|value| {
        let other = match value.step {
            Step::Call(Function::Sin) => Function::Cos,
            Step::Call(Function::Cos) => Function::Sin,
            _ => return None,
        };
        known.get(&Value { step: Step::Call(other), ..*value }.key()).copied()
    });
    let pairs: Vec<_> = pairs.collect();
    pairs.iter().flatten().next()?;
    let (mut places, mut order) = (vec![usize::MAX; list.len()], Vec::with_capacity(list.len()));
    for index in 0..list.len() {
        for index in [Some(index), pairs[index]].into_iter().flatten() {
            if places[index] == usize::MAX {
                places[index] = order.len();
                order.push(index);
            }
        }
    }
    let moved = |index: &usize| Value {
        operands: if *index < variables { [0; 3] } else { list[*index].operands.map(|of| places[of]) },
        ..list[*index]
    };
    Some((order.iter().map(moved).collect(), places))
}

/// Returns the values of operations. If `are_shared`, equal values occur once.
fn values(steps: &[Step], variables: usize, are_shared: bool) -> Values {
    let variable = |index: usize| Value { step: Step::Variable(index as u8), operands: [0; 3] };
    let mut values: Vec<_> = (0..variables).map(variable).collect();
    let mut known = HashMap::new();
    let result = fold(steps, |_, step, of: &mut [usize]| {
        if let Step::Variable(index) = step {
            return Some(usize::from(index));
        }
        let value = Value { step, operands: [0, 1, 2].map(|which| of.get(which).copied().unwrap_or(0)) };
        let new = values.len();
        let index = if are_shared { *known.entry(value.key()).or_insert(new) } else { new };
        if index == new {
            values.push(value);
        }
        Some(index)
    });
    Values { list: values, result: result.unwrap_or(0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formula::Formula;
    use crate::formula::field::{Field, SurfaceField};
    use crate::formula::variables::SPACE;
    use std::sync::Arc;

    #[test]
    fn what_a_formula_says_twice_is_computed_once() {
        let formula = Formula::parse_in("(x^2 + y^2 - 1)^2 * (y^2 + x*z - 1) + sin(x^2)*sin(x^2)", SPACE);
        let formula = formula.expect("a formula");
        let operations = &formula.program.instructions;
        let squares = operations.iter().filter(|operation| operation.step == Step::Powi(2)).count();
        // These are the squares of x, of y, and of the first factor.
        assert_eq!((squares, operations.len()), (3, 13));
        let field = Field::new(Arc::new(formula)).expect("its variables are x, y and z");
        let expected = (9.0 + 4.0 - 1.0) * (9.0 + 4.0 - 1.0) * (4.0 + 1.5 - 1.0) + 9_f64.sin().powi(2);
        assert!((field.at([3.0, 2.0, 0.5]) - expected).abs() < 1e-12);
    }

    #[test]
    fn the_sine_and_the_cosine_of_a_number_follow_each_other() {
        let text = "cos(2*x)*sin(y) + sin(x*x) + sin(2*x)*cos(y) - cos(z)";
        let formula = Formula::parse_in(text, SPACE).expect("a formula");
        let operations = &formula.program.instructions;
        let pairs = operations.windows(2).filter(|pair| pair[0].is_of_one_angle_with(&pair[1]));
        assert_eq!((pairs.count(), operations.len()), (2, 14));
        let at = [0.3_f64, 1.2, -0.7];
        let field = Field::new(Arc::new(formula)).expect("its variables are x, y and z");
        let [x, y, z] = at;
        let expected = (2.0 * x).cos() * y.sin() + (x * x).sin() + (2.0 * x).sin() * y.cos() - z.cos();
        assert!((field.at(at) - expected).abs() < 1e-14);
    }

    #[test]
    fn a_formula_that_shares_more_than_there_are_registers_is_computed_without_sharing() {
        // Each square is needed again, in the opposite order.
        let squares: Vec<_> = (0..60).map(|index| format!("(y + {index})^2")).collect();
        let (there, back) =
            (squares.join(" + "), squares.iter().rev().cloned().collect::<Vec<_>>().join(" - "));
        let formula = Formula::parse(&format!("{there} - ({back})")).expect("a formula");
        assert!(formula.program.registers <= 5, "{}", formula.program.registers);
        let sum = |numbers: &mut dyn Iterator<Item = f64>| numbers.map(|number| number * number).sum::<f64>();
        let expected =
            sum(&mut (0..60).map(f64::from)) - (2.0 * 59.0 * 59.0 - sum(&mut (0..60).map(f64::from)));
        assert_eq!(formula.at(0.0), expected);
    }

    #[test]
    fn the_deepest_formulas_of_a_surface_have_registers() {
        // Each sine waits for the rest of the formula, and a root takes one more register.
        let open = |depth: usize| (0..depth).map(|k| format!("(sin(x + {k}) + ")).collect::<String>();
        let nested = |depth: usize| format!("{}sqrt(nz){}", open(depth), ")".repeat(depth));
        let formulas = (1..100).map_while(|depth| Formula::parse_in(&nested(depth), SURFACE).ok());
        let fields = formulas.filter_map(|formula| SurfaceField::new(Arc::new(formula)));
        let depth = fields.map(|field| assert!(field.at([0.5; SURFACE.len()]).is_finite())).count();
        assert!(depth + 4 >= MAX_DEPTH, "the nesting goes as deep as it may: {depth}");
    }
}
