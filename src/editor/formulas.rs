//! The words of formulas, and the names among them.

use std::ops::Range;
use tabray_exact::formula::{is_in_name, is_taken};

/// The kinds of a formula's words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WordKind {
    /// A number, with its exponent.
    Number,
    /// A name, whatever its meaning.
    Name,
    /// Any other character except white space.
    Sign,
}

/// Returns the words of a formula with their places, in bytes.
pub fn words(formula: &str) -> Vec<(Range<usize>, WordKind)> {
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(first) = formula[at..].chars().next() {
        let rest = &formula[at..];
        let (length, kind) = if first.is_ascii_digit() || first == '.' {
            let digits = rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(rest.len());
            let mut exponent = rest[digits..].chars().skip(1);
            let is_exponent = rest[digits..].starts_with(['e', 'E'])
                && exponent.next().is_some_and(|next| next.is_ascii_digit() || "+-".contains(next));
            let more = &rest[digits + 2 * usize::from(is_exponent)..];
            let more =
                if is_exponent { more.find(|c: char| !c.is_ascii_digit()).unwrap_or(more.len()) } else { 0 };
            (digits + 2 * usize::from(is_exponent) + more, WordKind::Number)
        } else if is_in_name(first) {
            (rest.find(|c: char| !is_in_name(c)).unwrap_or(rest.len()), WordKind::Name)
        } else {
            (first.len_utf8(), WordKind::Sign)
        };
        if !first.is_whitespace() {
            found.push((at..at + length, kind));
        }
        at += length;
    }
    found
}

/// Returns the places, in bytes, of the names in a formula other than its variables, its functions and `pi`.
pub fn names(formula: &str) -> Vec<Range<usize>> {
    let names =
        words(formula).into_iter().filter(|(_, kind)| *kind == WordKind::Name).map(|(place, _)| place);
    names.filter(|place| is_name(&formula[place.clone()])).collect()
}

/// Tells whether a scene can give this name to a number.
pub fn is_name(name: &str) -> bool {
    name.starts_with(char::is_alphabetic) && name.chars().all(is_in_name) && !is_taken(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_told_from_numbers_functions_and_variables() {
        let named =
            |formula: &'static str| -> Vec<_> { names(formula).into_iter().map(|at| &formula[at]).collect() };
        assert_eq!(named("4 + 2*cos(turn)/beads - 1e5 + 2e-3*x_1"), ["turn", "beads", "x_1"]);
        assert_eq!(named("2x + π*sin(y) + 1.5E+7"), [""; 0]);
        assert_eq!(named("2n² - |a|b"), ["n", "a", "b"]);
        assert_eq!(named("r(ä) + ((a"), ["r", "ä", "a"]);
    }
}
