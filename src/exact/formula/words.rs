//! The words of formulas, and errors in their texts.

use super::function::{self, functions};
use crate::text;
use std::ops::Range;

/// An error in the text of a formula.
#[derive(Clone, Debug, PartialEq)]
pub struct FormulaFault {
    /// The byte range of the text to mark.
    pub place: Range<usize>,
    /// The error, for messages.
    pub message: String,
    /// The correction, for messages.
    pub help: String,
    /// The unknown name, if that is the error.
    pub unknown: Option<String>,
}

/// Returns whether a name has a meaning in all formulas, and a scene cannot give it to a number.
pub fn is_taken(name: &str) -> bool {
    ["x", "y", "z", "pi", "π"].contains(&name)
        || function::find(name).is_some_and(function::FormulaFunction::is_reserved)
}

/// The digits of exponents, from 0.
pub(super) const SUPERSCRIPTS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

/// Returns whether a character can be part of a name in a formula. The `²` of `x²` is not part of a name.
pub fn is_in_name(letter: char) -> bool {
    (letter.is_alphanumeric() || letter == '_') && !SUPERSCRIPTS.contains(&letter)
}

/// Describes the elements of a formula in these variables.
pub(super) fn language(variables: &[&str]) -> String {
    let variables = match variables {
        [] => "named numbers".to_owned(),
        variables => text::list(variables.iter().copied()),
    };
    let of = |count: usize| {
        let names = functions().filter(|(name, arguments)| arguments.len() == count && *name != "if");
        let names = names.map(|(name, _)| name);
        names.collect::<Vec<_>>().join(" ")
    };
    format!(
        "a formula consists of numbers, {variables}, `pi`, + - * / ^, parentheses, and the functions {} of one value, {} of \
         two, {} of three, and `if(a < b, c, d)`",
        of(1),
        of(2),
        of(3)
    )
}
