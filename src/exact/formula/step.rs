//! The operations of a formula.

use crate::scalar::{Scalar, apart, apart_if};
use crate::spline::Spline;
use std::mem::{Discriminant, discriminant};

/// The minimum size of a number, in bytes, at which each operation is a call.
const LONG: usize = 64;

/// An operation of a formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Step {
    /// A variable, by its index.
    Variable(u8),
    Number(f64),
    Neg,
    Add,
    Sub,
    Mul,
    Div,
    /// A power with an integer exponent.
    Powi(i32),
    /// A product with a constant.
    Scale(f64),
    /// A sum with a constant.
    Shift(f64),
    /// The formula's spline.
    Spline,
    Call(Function),
}

/// A key of an operation.
pub(super) type StepKey = (Discriminant<Step>, u64);

impl Step {
    /// Returns a key that is equal for equal operations.
    pub fn key(self) -> StepKey {
        let payload = match self {
            Self::Number(number) | Self::Scale(number) | Self::Shift(number) => number.to_bits(),
            Self::Variable(index) => index.into(),
            Self::Powi(exponent) => exponent as u64,
            Self::Call(function) => function as u64,
            Self::Neg | Self::Add | Self::Sub | Self::Mul | Self::Div | Self::Spline => 0,
        };
        (discriminant(&self), payload)
    }

    /// Returns the number of operands.
    #[inline(always)]
    pub fn operands(self) -> usize {
        match self {
            Self::Variable(_) | Self::Number(_) => 0,
            Self::Add | Self::Sub | Self::Mul | Self::Div => 2,
            Self::Call(Function::Min | Function::Max | Function::Pow | Function::Atan2) => 2,
            Self::Call(Function::Noise | Function::If | Function::Smin | Function::Smax) => 3,
            Self::Neg | Self::Powi(_) | Self::Scale(_) | Self::Shift(_) | Self::Spline | Self::Call(_) => 1,
        }
    }

    /// Tells whether the operation is defined and continuous for all numbers.
    pub fn is_total(self) -> bool {
        match self {
            Self::Div | Self::Spline => false,
            Self::Powi(exponent) => exponent >= 0,
            Self::Call(function) => matches!(
                function,
                Function::Sin | Function::Cos | Function::Exp | Function::Abs | Function::Min | Function::Max
            ),
            _ => true,
        }
    }

    /// Returns the estimated number of arithmetic operations: 8 for a `libm` function, 24 for a power,
    /// 160 for noise.
    pub fn cost(self) -> u64 {
        match self {
            Self::Call(
                Function::Abs
                | Function::Floor
                | Function::Heaviside
                | Function::If
                | Function::Min
                | Function::Max,
            ) => 1,
            Self::Call(Function::Pow | Function::Atan2) => 24,
            Self::Call(Function::Smin | Function::Smax) => 7,
            Self::Call(Function::Noise) => 160,
            Self::Call(_) => 8,
            Self::Spline => 12,
            Self::Powi(exponent) => u64::from(exponent.unsigned_abs().max(1)),
            _ => 1,
        }
    }

    /// Returns the estimated number of arithmetic operations on bounds in a box, where noise has up to eight cells.
    pub fn cost_in_box(self) -> u64 {
        match self {
            Self::Call(Function::Noise) => 8 * self.cost(),
            _ => self.cost(),
        }
    }

    /// Applies the operation to one or two values, or with a third one that `c` returns. `MAY_CALL` tells whether
    /// operations on long numbers are calls.
    #[inline(always)]
    pub fn of<N: Scalar, const MAY_CALL: bool>(
        self,
        a: N,
        b: N,
        c: impl FnOnce() -> N,
        spline: Option<&Spline>,
    ) -> N {
        /// Calls an operation on a long number. One with derivatives in wide precision, for example, takes up to
        /// thousands of instructions.
        macro_rules! long {
            ($operation:expr) => {
                apart_if!(MAY_CALL && size_of::<N>() >= LONG, $operation)
            };
        }
        match self {
            // The value of a variable is in its register.
            Self::Variable(_) => a,
            Self::Number(number) => N::constant(number),
            Self::Neg => -a,
            Self::Powi(exponent) => long!(a.powi(exponent)),
            Self::Spline => match spline {
                Some(spline) => long!(a.spline(spline, 0)),
                None => a,
            },
            Self::Scale(factor) => long!(a.scaled(factor)),
            Self::Shift(by) => long!(a.shifted(by)),
            Self::Add => long!(a + b),
            Self::Sub => long!(a - b),
            Self::Mul => long!(a * b),
            Self::Div => long!(a / b),
            Self::Call(Function::Sin) => long!(a.sin()),
            Self::Call(Function::Cos) => long!(a.cos()),
            Self::Call(Function::Tan) => long!(a.tan()),
            Self::Call(Function::Exp) => long!(a.exp()),
            Self::Call(Function::Ln) => long!(a.ln()),
            Self::Call(Function::Sqrt) => long!(a.sqrt()),
            Self::Call(Function::Abs) => long!(a.abs()),
            Self::Call(Function::Floor) => long!(a.floor()),
            Self::Call(Function::Min) => long!(a.min(b)),
            Self::Call(Function::Max) => long!(a.max(b)),
            Self::Call(Function::Pow) => long!(a.pow(b)),
            Self::Call(Function::Noise) => {
                let at = [a, b, c()];
                apart(move || N::noise(at, [0; 3]))
            }
            Self::Call(Function::Heaviside) => long!(a.step()),
            Self::Call(Function::If) => {
                let c = c();
                long!(a.choose(b, c))
            }
            Self::Call(Function::Atan2) => long!(a.atan2(b)),
            Self::Call(Function::Smin) => {
                let width = c();
                long!(a.min(b) - blend(a, b, width))
            }
            Self::Call(Function::Smax) => {
                let width = c();
                long!(a.max(b) + blend(a, b, width))
            }
        }
    }
}

/// A function of up to three values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Function {
    Sin,
    Cos,
    Tan,
    Exp,
    Ln,
    Sqrt,
    Abs,
    Floor,
    Min,
    Max,
    Pow,
    Noise,
    /// 1 for numbers from 0 up, and 0 for negative ones.
    Heaviside,
    /// The second value if the first one is 0 or above, and otherwise the third one.
    If,
    Atan2,
    /// The minimum and the maximum of two values, rounded off where they differ by less than the third one.
    Smin,
    Smax,
}

/// Returns the amount by which the minimum or the maximum of two values is rounded off: a quarter of the width if they
/// are equal, and 0 if they differ by the width or more.
///
/// Source: I. Quilez, "Smooth minimum" (2013), the quadratic polynomial.
#[inline(always)]
fn blend<N: Scalar>(a: N, b: N, width: N) -> N {
    (width - (a - b).abs()).max(N::constant(0.0)).powi(2) / width.scaled(4.0)
}

/// The maximum nesting of a formula, as the number of values that wait for an operation.
pub(super) const MAX_DEPTH: usize = 32;

/// Carries out operations in postfix order on values of any type, and returns the last one. `of` returns the value of
/// an operation, given its index and its operands; nothing more is carried out once it returns `None`.
#[inline(always)]
pub fn fold<T>(steps: &[Step], mut of: impl FnMut(usize, Step, &mut [T]) -> Option<T>) -> Option<T> {
    let mut waiting = Vec::new();
    for (index, step) in steps.iter().enumerate() {
        let start = waiting.len() - step.operands();
        let value = of(index, *step, &mut waiting[start..])?;
        waiting.truncate(start);
        waiting.push(value);
    }
    waiting.pop()
}

/// Returns the maximum number of values that wait for an operation.
pub fn deepest(steps: &[Step]) -> usize {
    let (mut depth, mut deepest) = (0, 0);
    for step in steps {
        depth = depth + 1 - step.operands();
        deepest = deepest.max(depth);
    }
    deepest
}
