//! The functions that a formula can call. Number types compute some of them, and the others are formulas of those.

use super::step::Function;

/// A function of formulas.
pub(super) struct FormulaFunction {
    pub name: &'static str,
    /// The names of the arguments.
    pub arguments: &'static [&'static str],
    pub meaning: Meaning,
}

/// The meaning of a function.
#[derive(Clone, Copy)]
pub(super) enum Meaning {
    /// An operation on one value or on two. An operation on two may be applied to further values, one after the other.
    Operation(Function),
    /// An operation on two values and a width. It may be applied to further values, one after the other.
    Smooth(Function),
    /// An operation on exactly as many values as it has arguments.
    Fixed(Function),
    /// A comparison, and the values if it is true and if it is false.
    Choice,
    /// A formula in the arguments, given by this text.
    Formula(&'static str),
}

use Meaning::{Fixed, Formula, Operation, Smooth};

/// The functions of formulas.
static FUNCTIONS: [FormulaFunction; 40] = [
    FormulaFunction { name: "sin", arguments: &["x"], meaning: Operation(Function::Sin) },
    FormulaFunction { name: "cos", arguments: &["x"], meaning: Operation(Function::Cos) },
    FormulaFunction { name: "tan", arguments: &["x"], meaning: Operation(Function::Tan) },
    FormulaFunction { name: "exp", arguments: &["x"], meaning: Operation(Function::Exp) },
    FormulaFunction { name: "ln", arguments: &["x"], meaning: Operation(Function::Ln) },
    FormulaFunction { name: "sqrt", arguments: &["x"], meaning: Operation(Function::Sqrt) },
    FormulaFunction { name: "abs", arguments: &["x"], meaning: Operation(Function::Abs) },
    FormulaFunction { name: "floor", arguments: &["x"], meaning: Operation(Function::Floor) },
    FormulaFunction { name: "min", arguments: &["x", "y"], meaning: Operation(Function::Min) },
    FormulaFunction { name: "max", arguments: &["x", "y"], meaning: Operation(Function::Max) },
    FormulaFunction { name: "ceil", arguments: &["x"], meaning: Formula("-floor(-x)") },
    FormulaFunction { name: "round", arguments: &["x"], meaning: Formula("floor(x + 0.5)") },
    FormulaFunction { name: "fract", arguments: &["x"], meaning: Formula("x - floor(x)") },
    FormulaFunction { name: "mod", arguments: &["x", "m"], meaning: Formula("x - m*floor(x/m)") },
    FormulaFunction {
        name: "clamp",
        arguments: &["x", "low", "high"],
        meaning: Formula("min(max(x, low), high)"),
    },
    FormulaFunction { name: "mix", arguments: &["a", "b", "t"], meaning: Formula("a + (b - a)*t") },
    FormulaFunction {
        name: "smoothstep",
        arguments: &["low", "high", "x"],
        meaning: Formula(
            "clamp((x - low)/(high - low), 0, 1)^2 * (3 - 2*clamp((x - low)/(high - low), 0, 1))",
        ),
    },
    FormulaFunction { name: "hypot", arguments: &["x", "y"], meaning: Formula("sqrt(x^2 + y^2)") },
    FormulaFunction { name: "sinh", arguments: &["x"], meaning: Formula("(exp(x) - exp(-x))/2") },
    FormulaFunction { name: "cosh", arguments: &["x"], meaning: Formula("(exp(x) + exp(-x))/2") },
    FormulaFunction { name: "tanh", arguments: &["x"], meaning: Formula("1 - 2/(exp(2*x) + 1)") },
    FormulaFunction { name: "noise", arguments: &["x", "y", "z"], meaning: Fixed(Function::Noise) },
    FormulaFunction { name: "heaviside", arguments: &["x"], meaning: Fixed(Function::Heaviside) },
    FormulaFunction { name: "if", arguments: &["a < b", "c", "d"], meaning: Meaning::Choice },
    FormulaFunction { name: "atan2", arguments: &["y", "x"], meaning: Fixed(Function::Atan2) },
    FormulaFunction { name: "trunc", arguments: &["x"], meaning: Formula("floor(abs(x))*sign(x)") },
    FormulaFunction { name: "sign", arguments: &["x"], meaning: Formula("2*heaviside(x) - 1") },
    FormulaFunction { name: "step", arguments: &["edge", "x"], meaning: Formula("heaviside(x - edge)") },
    FormulaFunction { name: "log", arguments: &["x"], meaning: Formula("ln(x)") },
    FormulaFunction { name: "log2", arguments: &["x"], meaning: Formula("ln(x)/ln(2)") },
    FormulaFunction { name: "log10", arguments: &["x"], meaning: Formula("ln(x)/ln(10)") },
    FormulaFunction { name: "cbrt", arguments: &["x"], meaning: Formula("abs(x)^(1/3)*sign(x)") },
    FormulaFunction { name: "asin", arguments: &["x"], meaning: Formula("atan2(x, sqrt(1 - x^2))") },
    FormulaFunction { name: "acos", arguments: &["x"], meaning: Formula("atan2(sqrt(1 - x^2), x)") },
    FormulaFunction { name: "atan", arguments: &["x"], meaning: Formula("atan2(x, 1)") },
    FormulaFunction { name: "asinh", arguments: &["x"], meaning: Formula("2*atanh(x/(1 + sqrt(1 + x^2)))") },
    FormulaFunction { name: "acosh", arguments: &["x"], meaning: Formula("ln(x + sqrt(x - 1)*sqrt(x + 1))") },
    FormulaFunction { name: "atanh", arguments: &["x"], meaning: Formula("ln((1 + x)/(1 - x))/2") },
    FormulaFunction { name: "smin", arguments: &["a", "b", "k"], meaning: Smooth(Function::Smin) },
    FormulaFunction { name: "smax", arguments: &["a", "b", "k"], meaning: Smooth(Function::Smax) },
];

/// Returns the names of the functions of formulas, each with the names of its arguments.
pub fn functions() -> impl Iterator<Item = (&'static str, &'static [&'static str])> {
    FUNCTIONS.iter().map(|function| (function.name, function.arguments))
}

/// Finds a function by its name.
pub(super) fn find(name: &str) -> Option<&'static FormulaFunction> {
    FUNCTIONS.iter().find(|function| function.name == name)
}

impl FormulaFunction {
    /// Tells whether the function takes further arguments, like a minimum.
    pub fn takes_more(&self) -> bool {
        matches!(self.meaning, Operation(Function::Min | Function::Max) | Smooth(_))
    }

    /// Tells whether the name is reserved: no number of a scene can have it. Names of functions that were added later
    /// are not reserved.
    pub fn is_reserved(&self) -> bool {
        matches!(self.meaning, Operation(_))
    }
}
