//! Roots on short pieces where bounds in f64 end: in twice the precision.
//!
//! Where a line only touches a surface, as far as f64 tells, the function has one turn there: its value at the turn
//! tells whether the line goes in. What twice the precision does not tell from 0 either counts as a touch: a line that
//! touches meets the surface, and one that leaves it does not.

use crate::geometry::ray::Side;
use crate::geometry::roots::bisection::bisect;
use crate::geometry::roots::{chandrupatla, newton};
use crate::numeric::double_double::DoubleDouble;
use crate::numeric::dual::Dual;
use crate::numeric::interval::Interval;

/// How much of what rounding in f64 hides is hidden in twice the precision, too: 2^-53 but for five digits.
const STILL_HIDDEN: f64 = 1.0 / 281_474_976_710_656.0;

/// A slope that is still this part of what it was where a piece begins does not go through 0 but jumps.
const KINK: f64 = 1.0 / 1024.0;

/// The first root on a piece that has at most one turn, where rounding in f64 hides values up to `hidden`; of a line that
/// leaves a surface, the first one where the function falls (from outside) or rises (from inside).
pub fn first_root(
    f: impl Fn(Dual<DoubleDouble>) -> Dual<DoubleDouble>,
    piece: Interval,
    origin_side: Option<Side>,
    hidden: f64,
) -> Option<f64> {
    let Interval { low, high } = piece;
    let precise = f64::EPSILON * piece.magnitude();
    // What cancels in the value and in the slope needs twice the precision; the places do not.
    let at = |t: f64| {
        let Dual { value, slope } = f(Dual::variable(DoubleDouble::from(t)));
        Dual { value: value.high, slope: slope.high }
    };
    let (first, last) = (at(low), at(high));
    let is_outside = first.value >= 0.0;
    let is_in = |value: f64| (value < 0.0) == is_outside;
    let is_wanted = |falls: bool| origin_side.is_none_or(|side| falls == (side == Side::Outside));
    if is_in(last.value) {
        let root = || newton::root(at, (low, high), is_outside, piece.middle(), precise);
        return is_wanted(is_outside).then(root);
    }
    // Toward 0 first, and away from it in the end.
    let approaches = |slope: f64| (slope < 0.0) == is_outside;
    if !approaches(first.slope) || approaches(last.slope) {
        return None;
    }
    let still_hidden = STILL_HIDDEN * hidden;
    // The value so near to the turn is the turn's, but for what is hidden.
    let bend = ((last.slope - first.slope) / (high - low)).abs();
    let near = 0.125 * (still_hidden / bend).sqrt();
    let mut turn = chandrupatla::root(|t| at(t).slope, (low, high), near);
    let mut at_turn = at(turn);
    // At a kink the value is as far from 0 as the place is from the kink: that is taken to its last digit.
    if at_turn.slope.abs() > KINK * first.slope.abs() {
        turn = bisect(|t| !approaches(at(t).slope), (low, high), 0.0).1;
        at_turn = at(turn);
    }
    let at_turn = at_turn.value;
    if at_turn.abs() <= still_hidden {
        return origin_side.is_none().then_some(turn);
    }
    if !is_in(at_turn) {
        return None;
    }
    let is_first = is_wanted(is_outside);
    let (end, slope) = if is_first { (low, first.slope) } else { (high, last.slope) };
    // About a parabola: that is where it crosses 0.
    let guess = turn + (2.0 * (at_turn * (end - turn) / slope).abs()).sqrt().copysign(end - turn);
    let (low, high) = (end.min(turn), end.max(turn));
    let guess = if low < guess && guess < high { guess } else { 0.5 * (low + high) };
    let precise = precise.min(still_hidden / (bend * (guess - turn).abs()));
    Some(newton::root(at, (low, high), is_first == is_outside, guess, precise))
}
