//! The operations of a formula.

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

impl Step {
    /// Returns the number of values that the operation is applied to.
    pub fn operands(self) -> usize {
        match self {
            Self::Variable(_) | Self::Number(_) => 0,
            Self::Add | Self::Sub | Self::Mul | Self::Div => 2,
            Self::Call(Function::Min | Function::Max | Function::Pow) => 2,
            Self::Neg | Self::Powi(_) | Self::Scale(_) | Self::Shift(_) | Self::Spline | Self::Call(_) => 1,
        }
    }
}

/// A function of one or two values.
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
}

/// The deepest nesting that a formula may have, in values that wait for an operation.
pub(super) const MAX_DEPTH: usize = 32;
