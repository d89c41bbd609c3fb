//! The names in formulas.

use std::ops::Range;
use tabray_exact::formula::{is_in_name, is_taken};

/// Returns the places, in bytes, of the names in a formula other than its variables, its functions and `pi`.
pub fn names(formula: &str) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(first) = formula[at..].chars().next() {
        let rest = &formula[at..];
        let length = if first.is_ascii_digit() || first == '.' {
            // A number, with its exponent.
            let digits = rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(rest.len());
            let mut exponent = rest[digits..].chars().skip(1);
            let is_exponent = rest[digits..].starts_with(['e', 'E'])
                && exponent.next().is_some_and(|next| next.is_ascii_digit() || "+-".contains(next));
            digits + 2 * usize::from(is_exponent)
        } else if is_in_name(first) {
            let length = rest.find(|c: char| !is_in_name(c)).unwrap_or(rest.len());
            if is_name(&rest[..length]) {
                found.push(at..at + length);
            }
            length
        } else {
            first.len_utf8()
        };
        at += length;
    }
    found
}

/// Tells whether a scene can give a number this name.
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
