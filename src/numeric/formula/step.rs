//! The operations of a formula.

/// One of the operations of a formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Step {
    Y,
    Number(f64),
    Neg,
    Add,
    Sub,
    Mul,
    Div,
    /// A power with a whole exponent.
    Powi(i32),
    Call(Function),
}

/// A function of one value or two.
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

/// The most values that wait for their operation, and so how deep a formula can be nested.
pub(super) const DEPTH: usize = 32;
