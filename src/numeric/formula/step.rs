//! The operations of a formula.

/// One operation of a formula.
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

/// The largest stack depth, in values, and with it the deepest nesting that a formula may have.
pub(super) const MAX_DEPTH: usize = 32;
