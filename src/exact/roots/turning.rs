//! Samples of the function and its slope, and of possible turning points between two samples of the same sign.
//!
//! This follows the course notes' advice to look for the minimum between two samples. It finds single silhouettes, but
//! loses features that turn more than once between two samples: ripples and thin discs.

use super::newton;
use super::refiner::{Refiner, evenly, value_and_slope};
use super::taylor::FunctionOnLine;
use crate::dual::Dual;
use crate::jet::Jet;
use crate::roots::range::Side;
use std::ops::Range;

pub fn first_root(
    line: &impl FunctionOnLine,
    span: Range<f64>,
    shortest: f64,
    origin_side: Option<Side>,
    count: u32,
) -> Option<f64> {
    let mut places = evenly(&span, count);
    let mut low = places.next()?;
    let (value, mut slope) = value_and_slope(line, low);
    let is_outside = origin_side.map_or(value >= 0.0, |side| side == Side::Outside);
    let has_crossed = |value: f64| (value >= 0.0) != is_outside;
    let refined = |low, high| Some(Refiner::Newton.root(line, (low, high), is_outside, shortest));
    for high in places {
        let (value, slope_there) = value_and_slope(line, high);
        if has_crossed(value) {
            return refined(low, high);
        }
        // The function first approaches 0, and finally moves away from it.
        if (slope < 0.0) == is_outside && (slope_there > 0.0) == is_outside {
            let slope_and_bend = |t| {
                let Jet { first, second, .. } = line.at(Jet::variable(t));
                Dual { value: first, slope: second }
            };
            let turn = newton::root(slope_and_bend, (low, high), !is_outside, 0.5 * (low + high), shortest);
            if has_crossed(line.at(turn)) {
                return refined(low, turn);
            }
        }
        (low, slope) = (high, slope_there);
    }
    None
}
