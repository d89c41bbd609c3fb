//! Formulas in x, y and z, or in all known quantities at a point of a surface.

use super::along::{AlongLines, Products, by_products};
use super::cells::{Cells, is_choice};
use super::program::{MAX_REGISTERS, Program, Values};
use super::step::{Function, Step, fold};
use super::variables::{CURVE, PATCH, SPACE, SURFACE};
use super::{FEW_REGISTERS, Formula};
use crate::f64x8::F64x8;
use crate::interval::Interval;
use crate::scalar::Scalar;
use std::sync::Arc;

/// The number of registers that is enough for most formulas of space. Setting up [`MAX_REGISTERS`] takes longer than
/// evaluating most formulas.
pub(super) const SOME_REGISTERS: usize = 12;

/// The number of registers that is enough for most formulas of a surface, which have more variables.
const MORE_REGISTERS: usize = 15;

/// A formula in x, y and z: `x^2 + y^2 + z^2 - 1`.
pub type Field = FieldOf<3>;

/// A formula in the variables of [`SURFACE`]: `0.5 + 0.5*sin(4*x)`.
pub type SurfaceField = FieldOf<{ SURFACE.len() }>;

/// A formula in u and v.
pub type PatchField = FieldOf<{ PATCH.len() }>;

/// A formula in t.
pub type CurveField = FieldOf<{ CURVE.len() }>;

/// A formula in the variables of [`SPACE`], [`PATCH`], [`CURVE`] or [`SURFACE`], depending on their number.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldOf<const N: usize> {
    formula: Arc<Formula>,
    /// The formula as read, from which this one may have been simplified.
    written: Arc<Formula>,
    /// Whether the formula as read has divisors that may be 0.
    divides: bool,
    /// Whether the formula as read is defined and continuous everywhere, by each of its operations.
    is_total: bool,
    /// Whether this formula changes its sign where the one as read does: no powers of its factors were left out.
    keeps_signs: bool,
    /// What is 0 where a divisor of the formula as read is 0, if this one was cleared of its denominators.
    poles: Option<Arc<Self>>,
    /// The same formula with fewer operations.
    quick: Formula,
    /// The formula along lines.
    along_lines: AlongLines,
    /// The cells of a box, each with its own program.
    cells: Option<Arc<Cells>>,
}

impl<const COUNT: usize> FieldOf<COUNT> {
    /// The names of the variables.
    pub const VARIABLES: &'static [&'static str] = match COUNT {
        1 => CURVE,
        2 => PATCH,
        3 => SPACE,
        _ => SURFACE,
    };

    /// Makes a field from a formula, or returns `None` if the formula has other variables.
    pub fn new(formula: Arc<Formula>) -> Option<Self> {
        if formula.variables() != Self::VARIABLES {
            return None;
        }
        let new = |steps| Formula::new(formula.text.clone(), Self::VARIABLES, steps);
        let mut quick = new(with_constants(&formula.steps));
        let of_surface = COUNT == SURFACE.len() && quick.steps.contains(&Step::Call(Function::Sqrt));
        if of_surface {
            quick = new(with_roots(&quick.steps));
        }
        let values = (COUNT == SPACE.len()).then(|| Values::new(&quick.steps, COUNT));
        let of_space = |which| {
            let program = by_products(values.as_ref()?, COUNT, which);
            (program.registers <= MAX_REGISTERS).then_some(program)
        };
        let along_lines = AlongLines(of_space(Products::All).unwrap_or_else(|| quick.program.clone()));
        if let Some(program) = of_space(Products::OfSquares) {
            quick.program = program;
        }
        let (written, divides) = (formula.clone(), divides(&formula.steps));
        let is_total = formula.steps.iter().all(|step| step.is_total());
        Some(Self {
            formula,
            written,
            divides,
            is_total,
            keeps_signs: true,
            poles: None,
            quick,
            along_lines,
            cells: None,
        })
    }

    /// Returns a simpler field in place of this one. `poles` is 0 where a divisor is 0, if the field has no more
    /// divisors.
    pub(super) fn simplified(&self, to: Self, poles: Option<Self>, keeps_signs: bool) -> Self {
        let poles = poles.map(Arc::new).or_else(|| self.poles.clone());
        let keeps_signs = keeps_signs && self.keeps_signs;
        let Self { divides, is_total, .. } = *self;
        Self { written: self.written.clone(), divides, is_total, keeps_signs, poles, ..to }
    }

    /// Tells whether the formula as read changes its sign at each simple root of this one.
    pub fn keeps_signs(&self) -> bool {
        self.keeps_signs
    }

    /// Returns the formula as read.
    pub(super) fn as_written(&self) -> &Formula {
        &self.written
    }

    /// Tells whether the formula as read is defined and continuous everywhere, by each of its operations.
    pub fn is_total(&self) -> bool {
        self.is_total
    }

    /// Tells whether the formula as read has divisors that may be 0.
    pub fn divides(&self) -> bool {
        self.divides
    }

    /// Returns what is 0 where a divisor of the formula as read is 0, if this one was cleared of its denominators.
    pub fn poles(&self) -> Option<&Self> {
        self.poles.as_deref()
    }

    /// Tells whether the formula uses the variable with this index.
    pub fn uses(&self, index: usize) -> bool {
        self.quick.steps.contains(&Step::Variable(index as u8))
    }

    /// Tells whether intervals also enclose the formula where it may take the square root of a negative number. In a
    /// formula of a surface, such a root is 0.
    pub fn is_enclosed(&self) -> bool {
        let is_root = |step: &Step| *step == Step::Call(Function::Sqrt);
        let roots = |steps: &[Step]| steps.iter().filter(|step| is_root(step)).count();
        let pairs = self.quick.steps.windows(ROOT.len());
        roots(&self.quick.steps) == pairs.filter(|steps| *steps == ROOT).count()
    }

    /// Tells whether an evaluation takes at most ten thousand operations, as [`Formula::cost`] counts them. A shape that is
    /// evaluated in thousands of places is then made within seconds.
    pub fn is_short(&self) -> bool {
        self.formula.cost() <= 10_000
    }

    /// Returns the formula.
    pub fn formula(&self) -> &Arc<Formula> {
        &self.formula
    }

    /// Returns the formula with fewer operations, which is evaluated.
    pub(super) fn quick(&self) -> &Formula {
        &self.quick
    }

    /// Returns the operations.
    pub(super) fn program(&self) -> &Program {
        &self.quick.program
    }

    /// Evaluates the formula as read at eight points, rounded to nearest.
    pub fn as_written_at(&self, at: [F64x8; COUNT]) -> F64x8 {
        let of = &*self.written;
        let with = |registers: &mut [F64x8]| {
            registers[..COUNT].copy_from_slice(&at);
            of.run_inline::<_, false>(&of.program, registers)
        };
        if of.program.registers <= SOME_REGISTERS {
            with(&mut [at[0]; SOME_REGISTERS])
        } else {
            with(&mut [at[0]; MAX_REGISTERS])
        }
    }

    /// Evaluates the formula at a point.
    #[inline(always)]
    pub fn at<N: Scalar>(&self, at: [N; COUNT]) -> N {
        let cell = match (&self.cells, at.first_chunk()) {
            (Some(cells), Some(at)) => cells.program(bounds_of(*at)),
            _ => None,
        };
        let program = cell.unwrap_or(&self.quick.program);
        let with = |registers: &mut [N]| {
            registers[..COUNT].copy_from_slice(&at);
            self.quick.run(program, registers)
        };
        let registers = program.registers;
        if registers <= FEW_REGISTERS {
            with(&mut [at[0]; FEW_REGISTERS])
        } else if COUNT != SURFACE.len() && registers <= SOME_REGISTERS {
            with(&mut [at[0]; SOME_REGISTERS])
        } else if COUNT == SURFACE.len() && registers <= MORE_REGISTERS {
            with(&mut [at[0]; MORE_REGISTERS])
        } else {
            with(&mut [at[0]; MAX_REGISTERS])
        }
    }
}

/// The minimum number of operations for cutting a formula into cells.
const MANY: usize = 64;

impl Field {
    /// Returns the same formula, with cells in a box if it chooses among many numbers, for example by their minimum.
    pub fn within(self, corners: [[f64; 3]; 2]) -> Self {
        let steps = &self.quick.steps;
        let is_cut = self.program().instructions.len() >= MANY && steps.iter().any(|step| is_choice(*step));
        let cells = is_cut.then(|| Cells::new(&Program::new(steps, 3), corners)).flatten();
        Self { cells: cells.map(Arc::new), ..self }
    }

    /// Returns the formula along lines.
    pub fn along_lines(&self) -> &AlongLines {
        &self.along_lines
    }

    /// Returns the cells, if any.
    pub fn cells(&self) -> Option<&Cells> {
        self.cells.as_deref()
    }

    /// Returns the estimated number of arithmetic operations per evaluation at a point or in a box, like
    /// [`Formula::cost`].
    pub fn cost<N: Scalar>(&self, at: [N; 3]) -> u64 {
        let cell = self.cells().and_then(|cells| cells.program(bounds_of(at)));
        cell.unwrap_or(self.program()).instructions.iter().map(|of| of.step.cost_in_box()).sum()
    }
}

/// Tells whether operations divide by anything but numbers.
fn divides(steps: &[Step]) -> bool {
    let mut divides = false;
    // For each value, whether it depends on variables.
    fold(steps, |_, step, varies: &mut [bool]| {
        let divisor = match step {
            Step::Div | Step::Call(Function::Smin | Function::Smax) => varies.last(),
            Step::Powi(..0) => varies.first(),
            _ => None,
        };
        divides |= divisor == Some(&true);
        Some(varies.contains(&true) || matches!(step, Step::Variable(_)))
    });
    divides
}

/// A square root that is 0 for a negative number.
const ROOT: [Step; 3] = [Step::Number(0.0), Step::Call(Function::Max), Step::Call(Function::Sqrt)];

/// Returns the operations with each square root replaced by one that is 0 for negative numbers.
fn with_roots(steps: &[Step]) -> Vec<Step> {
    let mut out = Vec::with_capacity(steps.len());
    for step in steps {
        match step {
            Step::Call(Function::Sqrt) => out.extend(ROOT),
            step => out.push(*step),
        }
    }
    out
}

/// Returns the simplified operations: an operation with a constant takes one step and no derivatives of the constant,
/// and a product of two equal values is a square.
fn with_constants(steps: &[Step]) -> Vec<Step> {
    let (mut out, mut starts) = (Vec::with_capacity(steps.len()), Vec::new());
    for step in steps {
        match step {
            Step::Variable(_) | Step::Number(_) => starts.push(out.len()),
            Step::Add | Step::Sub | Step::Mul | Step::Div => {
                let second = starts.pop().unwrap_or(0);
                let first = starts.last().copied().unwrap_or(0);
                let last = out.len() - 1;
                // The bounds of a square are not negative.
                if *step == Step::Mul && out[first..second] == out[second..] {
                    out.truncate(second);
                    out.push(Step::Powi(2));
                    continue;
                }
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
            Step::Call(Function::Min | Function::Max | Function::Pow | Function::Atan2) => {
                starts.pop();
            }
            Step::Call(Function::Noise | Function::If | Function::Smin | Function::Smax) => {
                starts.truncate(starts.len().saturating_sub(2))
            }
            Step::Powi(0) => {
                out.truncate(starts.last().copied().unwrap_or(0));
                out.push(Step::Number(1.0));
                continue;
            }
            _ => {}
        }
        out.push(*step);
    }
    out
}

/// Returns the bounds of a point's coordinates.
#[inline(always)]
fn bounds_of<N: Scalar>(at: [N; 3]) -> [Interval; 3] {
    at.map(|place| {
        let [low, high] = place.bounds();
        Interval { low, high }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_of_negative_numbers_are_0_in_a_formula_of_a_surface() {
        let formula = Formula::parse_in("2 + sqrt(x)*nz", SURFACE).expect("a formula");
        let field = SurfaceField::new(Arc::new(formula)).expect("its variables are those of a surface");
        assert!(field.is_enclosed() && field.uses(7) && !field.uses(6));
        let at = |x: f64| field.at([x, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0]);
        assert_eq!([at(-4.0), at(4.0)], [2.0, 3.0]);
    }

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
