//! Roots on short pieces with inconclusive bounds in `f64`, in double-double arithmetic.
//!
//! If a line touches a surface to within the rounding error of `f64`, the function has one turning point there. The
//! function's sign at that point tells whether the line enters the surface. A value that double-double arithmetic
//! cannot distinguish from 0 either counts as a touch: a tangent line hits the surface, except at the start of a line
//! that leaves the surface.

use crate::double_double::DoubleDouble;
use crate::dual::Dual;
use crate::interval::Interval;
use crate::roots::bisection::bisect;
use crate::roots::range::Side;
use crate::roots::{chandrupatla, newton};

/// The rounding error of double-double arithmetic as a fraction of that of `f64`: 2^-53, with five bits of margin.
pub const STILL_HIDDEN: f64 = 1.0 / 281_474_976_710_656.0;

/// A slope at a turning point above this fraction of the slope at the beginning of the piece counts as a jump, not a
/// zero. If the slope does have a zero, it is searched once more, to no avail.
const KINK: f64 = 1.0 / 1024.0;

/// Returns the first root on a piece with at most one turning point. Rounding in `f64` hides values up to `hidden`. For
/// a line that leaves a surface, returns the first root where the function falls (from outside) or rises (from inside).
pub fn first_root(
    f: impl Fn(Dual<DoubleDouble>) -> Dual<DoubleDouble>,
    piece: Interval,
    origin_side: Option<Side>,
    hidden: f64,
) -> Option<f64> {
    let Interval { low, high } = piece;
    let precise = f64::EPSILON * piece.magnitude();
    // The value and the slope cancel and need double-double arithmetic, but the places do not.
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
    // The function first approaches 0, and finally moves away from it.
    let approaches = |slope: f64| (slope < 0.0) == is_outside;
    if !approaches(first.slope) || approaches(last.slope) {
        return None;
    }
    let still_hidden = STILL_HIDDEN * hidden;
    // Within `near` of the turning point, the value changes by less than the hidden error.
    let bend = ((last.slope - first.slope) / (high - low)).abs();
    let near = 0.125 * (still_hidden / bend).sqrt();
    let mut turn = chandrupatla::root(|t| at(t).slope, (low, high), near);
    let mut at_turn = at(turn);
    // At a kink, the error of the value is proportional to that of the place, which is thus found to its last digit.
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
    // The function is approximately a parabola, which crosses 0 there.
    let guess = turn + (2.0 * (at_turn * (end - turn) / slope).abs()).sqrt().copysign(end - turn);
    let (low, high) = (end.min(turn), end.max(turn));
    let guess = if low < guess && guess < high { guess } else { 0.5 * (low + high) };
    let precise = precise.min(still_hidden / (bend * (guess - turn).abs()));
    Some(newton::root(at, (low, high), is_first == is_outside, guess, precise))
}
