//! From places along a line to a root: the first two between which the function changes its sign, and how the root is
//! narrowed down there.

use super::taylor::FunctionOnLine;
use super::{bisection, chandrupatla, newton};
use crate::geometry::ray::Side;
use crate::numeric::dual::Dual;
use std::fmt;
use std::ops::Range;

/// A way to narrow down a root between two places where the function's signs differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refiner {
    /// Halving, to 1/1000: `bisection`.
    Bisection3,
    /// Halving, to 1/1000000.
    Bisection6,
    /// Halving, to the last place.
    Bisection,
    /// Parabolas and halving: `chandrupatla`.
    Chandrupatla,
    /// Slopes and halving: [`newton`].
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
    /// The root between two places, where the function is positive at the first if `falls`.
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

/// The first two of some places between which the function's sign changes, and whether it falls there.
///
/// On which side a line starts is known where it leaves the surface, whatever rounding says.
pub(super) fn sign_change(
    line: &impl FunctionOnLine,
    mut places: impl Iterator<Item = f64>,
    origin_side: Option<Side>,
) -> Option<(f64, f64, bool)> {
    let mut low = places.next()?;
    let is_outside = origin_side.map_or_else(|| line.at(low) >= 0.0, |side| side == Side::Outside);
    for high in places {
        if (line.at(high) >= 0.0) != is_outside {
            return Some((low, high, is_outside));
        }
        low = high;
    }
    None
}

/// The value of a function along a line, and how fast it grows.
pub(super) fn value_and_slope(line: &impl FunctionOnLine, t: f64) -> (f64, f64) {
    let Dual { value, slope } = line.at(Dual::variable(t));
    (value, slope)
}

/// So many places at equal distances, from the first to the last of a span.
pub(super) fn evenly(span: &Range<f64>, parts: u32) -> impl Iterator<Item = f64> + use<> {
    let Range { start, end } = *span;
    let part = (end - start) / f64::from(parts);
    (0..=parts).map(move |index| if index == parts { end } else { start + f64::from(index) * part })
}
