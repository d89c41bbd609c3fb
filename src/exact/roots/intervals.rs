//! Bisection until bounds of the values exclude a root, or bounds of the slope show that the function is monotonic, and
//! the signs at the ends decide.
//!
//! D. P. Mitchell, "Robust ray intersection with interval arithmetic" (1990). It loses no root. But the bounds shrink
//! linearly with the length of a piece, not with its square, and so a grazing ray takes hundreds of pieces.

use super::refiner::{Refiner, value_and_slope};
use super::taylor::FunctionOnLine;
use crate::dual::Dual;
use crate::interval::Interval;
use crate::roots::range::Side;
use std::ops::Range;

/// The number of pieces after which the search gives up.
const MAX_PIECES: usize = 100_000;

pub fn first_root(
    line: &impl FunctionOnLine,
    span: Range<f64>,
    shortest: f64,
    origin_side: Option<Side>,
) -> Option<f64> {
    let wants = |falls: bool| origin_side.is_none_or(|side| falls == (side == Side::Outside));
    let mut waiting = vec![(span.start, span.end)];
    for _ in 0..MAX_PIECES {
        let (low, high) = waiting.pop()?;
        let over = line.at(Dual::variable(Interval { low, high }));
        if !over.value.has_zero() {
            continue;
        }
        let is_monotone = !over.slope.has_zero();
        if is_monotone || high - low <= shortest {
            let ((at_low, _), (at_high, _)) = (value_and_slope(line, low), value_and_slope(line, high));
            // A line that leaves the surface starts on it, regardless of the computed sign.
            let starts =
                origin_side.is_some() && low == span.start && line.at(Interval { low, high: low }).has_zero();
            let crosses = (at_low >= 0.0) != (at_high >= 0.0) && !starts;
            if crosses && wants(at_low >= 0.0) {
                return Some(Refiner::Newton.root(line, (low, high), at_low >= 0.0, shortest));
            }
            // The piece is too short to be divided, and contains a zero up to rounding: the ray is tangent.
            if !is_monotone && origin_side.is_none() && over.value.is_bounded() {
                return Some(low);
            }
        } else {
            let middle = low + 0.5 * (high - low);
            waiting.extend([(middle, high), (low, middle)]);
        }
    }
    None
}
