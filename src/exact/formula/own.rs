//! Functions that a scene defines, and texts of formulas with the names of a scene replaced.

use super::function;
use super::step::Step;
use super::words::is_in_name;
use crate::text;
use std::ops::Range;

/// The maximum number of arguments of a function.
const MAX_ARGUMENTS: usize = 16;

/// The maximum length of a formula's text, in bytes, after calls are replaced by the formulas of their functions.
const LONGEST: usize = 1 << 20;

/// A function that a scene defines, such as `f(u, v)` as `u^2 + v`.
#[derive(Clone, Debug)]
pub struct OwnFunction {
    count: usize,
    /// The operations. The variables are the arguments.
    pub(super) steps: Vec<Step>,
    pub(super) pieces: Vec<Piece>,
}

impl OwnFunction {
    /// Makes a function with `count` arguments from its operations and the pieces of its text.
    pub(super) fn new(count: usize, steps: Vec<Step>, pieces: Vec<Piece>) -> Self {
        Self { count, steps, pieces }
    }

    /// Returns the number of arguments.
    pub fn count(&self) -> usize {
        self.count
    }
}

/// Splits the head of a function, `f(u, v)`, into its name and its arguments. Returns `None` for other texts.
///
/// # Errors
/// Returns the reason why the text cannot be the head of a function.
pub fn head(text: &str) -> Option<(&str, Result<Vec<&str>, String>)> {
    let (name, rest) = text.split_once('(')?;
    let arguments = || {
        let rest = rest.trim_end().strip_suffix(')').ok_or("its arguments end with `)`")?;
        let arguments: Vec<_> = rest.split(',').map(str::trim).collect();
        for (index, argument) in arguments.iter().enumerate() {
            let is_name = argument.starts_with(char::is_alphabetic) && argument.chars().all(is_in_name);
            let is_taken = ["pi", "π"].contains(argument)
                || function::find(argument).is_some_and(function::FormulaFunction::is_reserved);
            if !is_name || is_taken {
                return Err(format!("`{}` cannot be the name of an argument", argument.escape_debug()));
            }
            if arguments[..index].contains(argument) {
                return Err(format!("`{argument}` is an argument twice"));
            }
        }
        if arguments.len() > MAX_ARGUMENTS {
            return Err(format!("it has more than {MAX_ARGUMENTS} arguments"));
        }
        Ok(arguments)
    };
    Some((name.trim(), arguments()))
}

/// A part of the text of a formula.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Piece {
    Text(String),
    /// A variable, by its index, and as written.
    Variable(usize, String),
}

/// Joins pieces into a text.
pub(super) fn joined(pieces: &[Piece]) -> String {
    let of = |piece: &Piece| match piece {
        Piece::Text(text) | Piece::Variable(_, text) => text.clone(),
    };
    pieces.iter().map(of).collect()
}

fn length(pieces: &[Piece]) -> usize {
    let of = |piece: &Piece| match piece {
        Piece::Text(text) | Piece::Variable(_, text) => text.len(),
    };
    pieces.iter().map(of).sum()
}

/// The replacements for names in a text, in the order of the text.
#[derive(Default)]
pub(super) struct Edits {
    all: Vec<(Range<usize>, Vec<Piece>)>,
    /// Whether any replacement is for a call.
    pub has_calls: bool,
}

impl Edits {
    /// Replaces the name of a number by the number.
    pub fn number(&mut self, text: &str, place: Range<usize>, number: f64) {
        let number = text::shortest(number);
        // In `2n`, the digits of the number would continue the number before it.
        let before = text[..place.start].trim_end();
        let is_factor = before.ends_with(|c: char| c.is_alphanumeric() || ".)|".contains(c));
        let written = if number.starts_with('-') || is_factor { format!("({number})") } else { number };
        self.all.push((place, vec![Piece::Text(written)]));
    }

    /// Notes a variable.
    pub fn variable(&mut self, place: Range<usize>, index: usize) {
        self.all.push((place, vec![Piece::Variable(index, String::new())]));
    }

    /// Replaces a call by the formula of its function. Returns whether the result is short enough.
    pub fn call(&mut self, place: Range<usize>, of: &[Piece], arguments: &[Vec<Piece>]) -> bool {
        let bracket = |text: &str| Piece::Text(text.to_owned());
        let mut pieces = vec![bracket("(")];
        let mut left = LONGEST;
        for piece in of {
            let long = match piece {
                Piece::Variable(index, _) => length(&arguments[*index]) + 2,
                Piece::Text(text) => text.len(),
            };
            left = match left.checked_sub(long) {
                Some(left) => left,
                None => return false,
            };
            match piece {
                Piece::Variable(index, _) => {
                    pieces.push(bracket("("));
                    pieces.extend(arguments[*index].iter().cloned());
                    pieces.push(bracket(")"));
                }
                text => pieces.push(text.clone()),
            }
        }
        pieces.push(bracket(")"));
        self.all.push((place, pieces));
        self.has_calls = true;
        true
    }

    /// Removes the replacements in a range of the text, and returns the text of the range with these replacements made.
    pub fn take(&mut self, text: &str, range: Range<usize>) -> Vec<Piece> {
        let first = self.all.partition_point(|(place, _)| place.start < range.start);
        let (mut pieces, mut at) = (Vec::new(), range.start);
        for (place, edit) in self.all.drain(first..) {
            pieces.push(Piece::Text(text[at..place.start].to_owned()));
            pieces.extend(edit.into_iter().map(|piece| match piece {
                Piece::Variable(index, written) if written.is_empty() => {
                    Piece::Variable(index, text[place.clone()].to_owned())
                }
                piece => piece,
            }));
            at = place.end;
        }
        pieces.push(Piece::Text(text[at..range.end].to_owned()));
        pieces
    }
}
