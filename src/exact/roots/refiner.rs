//! Sampling and refinement: the first two places along a line with different signs of the function, and refiners of the
//! root between them.

use super::taylor::{FunctionOnLine, SignChange};
use super::{bisection, chandrupatla, newton};
use crate::dual::Dual;
use crate::roots::range::Side;
use std::fmt;
use std::ops::Range;

/// A method that refines a root between two places with different signs of the function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refiner {
    /// Bisection to 1/1000 of a world unit: `bisection`.
    Bisection3,
    /// Bisection to 1/1000000 of a world unit.
    Bisection6,
    /// Bisection to neighbouring numbers.
    Bisection,
    /// Inverse quadratic interpolation and bisection: `chandrupatla`.
    Chandrupatla,
    /// Newton's method and bisection: [`newton`].
    Newton,
}

impl fmt::Display for Refiner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Bisection3 => "bisection 1e-3",
            Self::Bisection6 => "bisection 1e-6",
            Self::Bisection => "bisection",
            Self::Chandrupatla => "Chandrupatla",
            Self::Newton => "Newton",
        })
    }
}

impl Refiner {
    /// Returns the root between two places. If `falls`, the function is positive at the first.
    pub(super) fn root(
        self,
        line: &impl FunctionOnLine,
        (low, high): (f64, f64),
        falls: bool,
        shortest: f64,
    ) -> f64 {
        let at = |t: f64| line.at(t);
        match self {
            Self::Bisection3 => bisection::root(at, (low, high), falls, 1e-3),
            Self::Bisection6 => bisection::root(at, (low, high), falls, 1e-6),
            Self::Bisection => bisection::root(at, (low, high), falls, 0.0),
            Self::Chandrupatla => chandrupatla::root(at, (low, high), shortest),
            Self::Newton => {
                let dual = |t| line.at(Dual::variable(t));
                newton::root(dual, (low, high), falls, 0.5 * (low + high), 0.5 * shortest)
            }
        }
    }
}

/// Returns the first two consecutive places with different signs of the function.
///
/// If the line leaves the surface, the side of its start is known, regardless of the computed sign.
pub(super) fn sign_change(
    line: &impl FunctionOnLine,
    mut places: impl Iterator<Item = f64>,
    origin_side: Option<Side>,
) -> Option<SignChange> {
    let mut low = places.next()?;
    let is_outside = origin_side.map_or_else(|| line.at(low) >= 0.0, |side| side == Side::Outside);
    for high in places {
        if (line.at(high) >= 0.0) != is_outside {
            return Some(SignChange { low, high, rises: !is_outside });
        }
        low = high;
    }
    None
}

/// Returns the value of a function along a line, and its slope.
pub(super) fn value_and_slope(line: &impl FunctionOnLine, t: f64) -> (f64, f64) {
    let Dual { value, slope } = line.at(Dual::variable(t));
    (value, slope)
}

/// Returns the ends of `parts` equal parts of a span, including both ends of the span.
pub(super) fn evenly(span: &Range<f64>, parts: u32) -> impl Iterator<Item = f64> + use<> {
    let Range { start, end } = *span;
    let part = (end - start) / f64::from(parts);
    (0..=parts).map(move |index| if index == parts { end } else { start + f64::from(index) * part })
}
