//! Formulas of scenes and profile plugins: in y, such as `2 + sin(y)`, or in x, y and z.

pub mod along;
pub mod cells;
mod condition;
mod domain;
mod factors;
pub mod field;
mod function;
#[cfg(test)]
mod inclusion;
pub mod joint;
pub mod nodes;
mod own;
mod parser;
mod program;
mod quotient;
pub mod rational;
pub mod recorded;
mod spline;
mod step;
#[cfg(test)]
mod tests;
pub mod variables;
mod words;
pub mod written;

pub use function::functions;
pub use own::{OwnFunction, head};
pub use parser::{Meant, Named};
pub use words::{FormulaFault, is_in_name, is_taken};

use crate::dual::Dual;
use crate::f64x8::F64x8;
use crate::f64x8::LANES;
use crate::scalar::Scalar;
use crate::spline::Spline;
use parser::Operations;
use program::{Instruction, MAX_REGISTERS, Program};
use std::fmt;
use std::sync::Arc;
use step::{Function, Step};
use variables::HEIGHT;

/// A formula, ready to be evaluated with any [`Scalar`].
#[derive(Clone, Debug, PartialEq)]
pub struct Formula {
    text: String,
    variables: &'static [&'static str],
    /// The operations in postfix order: operands first.
    steps: Vec<Step>,
    /// The operations as a program.
    program: Program,
    /// The curve that [`Step::Spline`] evaluates.
    spline: Option<Arc<Spline>>,
    /// Whether the formula can be evaluated for eight y at once.
    is_plain: bool,
}

/// The number of registers that is enough for most formulas.
const FEW_REGISTERS: usize = 6;

/// Returns the value of operations without variables.
fn value_of(steps: &[Step]) -> f64 {
    Formula::new(String::new(), &[], steps.to_vec()).at(0.0)
}

impl OwnFunction {
    /// Parses a function with these arguments.
    ///
    /// # Errors
    /// Returns the first place where the text is not a formula in these arguments.
    pub fn parse(arguments: &[&str], text: &str, named: Named<'_>) -> Result<Self, FormulaFault> {
        let Operations { steps, pieces, .. } = parser::parse(text, arguments, named, value_of)?;
        Ok(Self::new(arguments.len(), steps, pieces))
    }
}

impl Formula {
    /// Parses a formula in y.
    ///
    /// # Errors
    /// Returns the first place where the text is not a formula.
    pub fn parse(text: &str) -> Result<Self, FormulaFault> {
        Self::parse_in(text, HEIGHT)
    }

    /// Parses a formula in these variables.
    ///
    /// # Errors
    /// Returns the first place where the text is not a formula.
    pub fn parse_in(text: &str, variables: &'static [&'static str]) -> Result<Self, FormulaFault> {
        Self::parse_with(text, variables, &|_| None)
    }

    /// Parses a formula in these variables that may use named numbers and functions of the scene. The text of the new
    /// formula is a single line. It contains the numbers in place of their names, and the formulas of functions in
    /// place of calls.
    ///
    /// # Errors
    /// Returns the first place where the text is not a formula.
    pub fn parse_with(
        text: &str,
        variables: &'static [&'static str],
        named: Named<'_>,
    ) -> Result<Self, FormulaFault> {
        let Operations { steps, pieces, has_calls, .. } = parser::parse(text, variables, named, value_of)?;
        let mut written = own::joined(&pieces);
        if written.contains('\n') || written.contains("  ") {
            written = written.split_whitespace().collect::<Vec<_>>().join(" ");
        }
        // The formulas of functions are nested more deeply than their calls. An unknown number is NaN.
        let is_known = |step: &Step| !matches!(step, Step::Number(number) if number.is_nan());
        if has_calls
            && steps.iter().all(is_known)
            && let Err(fault) = parser::parse(&written, variables, &|_| None, |_| 1.0)
        {
            return Err(FormulaFault { place: 0..text.len(), ..fault });
        }
        Ok(Self::new(written, variables, steps))
    }

    /// Returns the part of the text that an operation comes from, with its operands. Of a function that is itself a
    /// formula, that is the whole call.
    fn text_of(&self, step: usize) -> &str {
        let parsed = parser::parse(&self.text, self.variables, &|_| None, value_of);
        let mut parts = parsed.into_iter().flat_map(|parsed| parsed.parts);
        let part = parts.find(|part| part.steps.contains(&step));
        part.map_or(&self.text, |part| self.text[part.text].trim_end())
    }

    /// Returns the names of the variables.
    pub fn variables(&self) -> &'static [&'static str] {
        self.variables
    }

    /// Returns the square of the formula. The square of a root is its operand: at the end of a sphere's profile, the
    /// slope of the profile is infinite, but that of its square is finite.
    pub fn squared(&self) -> Self {
        let mut steps = self.steps.clone();
        match steps.last() {
            Some(Step::Call(Function::Sqrt)) => {
                steps.pop();
            }
            _ => steps.push(Step::Powi(2)),
        }
        let squared = Self::new(format!("({})^2", self.text), self.variables, steps);
        Self { spline: self.spline.clone(), is_plain: squared.is_plain && self.spline.is_none(), ..squared }
    }

    fn new(text: String, variables: &'static [&'static str], steps: Vec<Step>) -> Self {
        let program = Program::new(&steps, variables.len());
        // The derivative of a general power takes more than arithmetic, noise needs a table, and a choice may differ
        // among eight y.
        let is_long =
            |step: &Step| matches!(step, Step::Call(Function::Pow | Function::Noise | Function::If));
        let is_plain = program.registers <= FEW_REGISTERS && !steps.iter().any(is_long);
        Self { text, variables, steps, program, spline: None, is_plain }
    }

    /// Evaluates a formula in y.
    #[inline(always)]
    pub fn at<N: Scalar>(&self, y: N) -> N {
        // Setting up fewer registers is faster.
        if self.program.registers <= FEW_REGISTERS {
            self.run(&self.program, &mut [y; FEW_REGISTERS])
        } else {
            self.run(&self.program, &mut [y; MAX_REGISTERS])
        }
    }

    /// Returns the estimated number of arithmetic operations per evaluation: 8 for a `libm` function, 24 for a power.
    pub fn cost(&self) -> u64 {
        self.steps.iter().map(|step| step.cost()).sum()
    }

    /// Returns the estimated number of arithmetic operations on bounds in a box.
    pub fn cost_in_box(&self) -> u64 {
        self.steps.iter().map(|step| step.cost_in_box()).sum()
    }

    /// Evaluates a program of the formula in registers. The first ones hold the variables. One function per number type
    /// serves any number of registers. Inlined into the equation of each shape, it would be megabytes of code.
    #[inline(never)]
    fn run<N: Scalar>(&self, program: &Program, registers: &mut [N]) -> N {
        self.run_inline::<N, true>(program, registers)
    }

    /// Evaluates the formula and its derivative for eight y, in kernels.
    #[inline(always)]
    pub fn at_eight(&self, y: [f64; LANES]) -> Dual<F64x8> {
        if self.is_plain {
            let y = Dual::variable(F64x8(y));
            return self.run_inline::<_, false>(&self.program, &mut [y; FEW_REGISTERS]);
        }
        let (mut value, mut slope) = ([0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            Dual { value: value[lane], slope: slope[lane] } = self.at(Dual::variable(y[lane]));
        }
        Dual { value: F64x8(value), slope: F64x8(slope) }
    }

    #[inline(always)]
    fn run_inline<N: Scalar, const MAY_CALL: bool>(&self, program: &Program, registers: &mut [N]) -> N {
        let mut instructions = program.instructions.iter();
        while let Some(instruction) = instructions.next() {
            let &Instruction { step, operands, result } = instruction;
            let (a, b) = (registers[usize::from(operands[0])], registers[usize::from(operands[1])]);
            let c = || registers[usize::from(operands[2])];
            if let Some(next) = instructions.as_slice().first()
                && matches!(step, Step::Call(Function::Sin | Function::Cos))
                && instruction.is_of_one_angle_with(next)
            {
                let (sin, cos) = a.sin_cos();
                let is_sine_first = step == Step::Call(Function::Sin);
                let (first, second) = if is_sine_first { (sin, cos) } else { (cos, sin) };
                registers[usize::from(result)] = first;
                registers[usize::from(next.result)] = second;
                instructions.next();
                continue;
            }
            registers[usize::from(result)] = step.of::<N, MAY_CALL>(a, b, c, self.spline.as_deref());
        }
        registers[usize::from(program.result)]
    }
}

/// Displays the text that the formula was parsed from.
impl fmt::Display for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.text)
    }
}
