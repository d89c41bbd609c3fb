//! Roots on short pieces where bounds in f64 end: in twice the precision.
//!
//! Where a line only touches a surface, as far as f64 tells, the function has one turn there: its value at the turn
//! tells whether the line goes in. What twice the precision does not tell from 0 either counts as a touch: a line that
//! touches meets the surface, and one that leaves it does not.

use crate::geometry::ray::Side;
use crate::numeric::dual::Dual;
use crate::numeric::interval::Interval;
use crate::numeric::twofold::Twofold;

/// How much of what rounding in f64 hides is hidden in twice the precision, too: 2^-53 but for five digits.
const STILL_HIDDEN: f64 = 1.0 / 281_474_976_710_656.0;

/// Steps that halve a piece below what twice the precision tells apart, even where the piece is 10^80 times as long as the
/// surface is wide.
const MOST: usize = 400;

/// The first root on a piece that has at most one turn, where rounding in f64 hides values up to `hidden`; of a line that
/// leaves a surface, the first one where the function falls (from outside) or rises (from inside).
pub fn first_root(
    f: impl Fn(Dual<Twofold>) -> Dual<Twofold>,
    piece: Interval,
    leaves: Option<Side>,
    hidden: f64,
) -> Option<f64> {
    let at = |t: Twofold| f(Dual::variable(t));
    let (low, high) = (Twofold::from(piece.low), Twofold::from(piece.high));
    let (first, last) = (at(low), at(high));
    let is_outside = first.value.high >= 0.0;
    let is_in = |value: Twofold| (value.high < 0.0) == is_outside;
    let is_wanted = |falls: bool| leaves.is_none_or(|side| falls == (side == Side::Outside));
    let way_in = |t: Twofold| is_in(at(t).value);
    if is_in(last.value) {
        return is_wanted(is_outside).then(|| change(way_in, low, high));
    }
    // Toward 0 first, and away from it in the end.
    let approaches = |slope: Twofold| (slope.high < 0.0) == is_outside;
    if !approaches(first.slope) || approaches(last.slope) {
        return None;
    }
    let turn = Twofold::from(change(|t| !approaches(at(t).slope), low, high));
    let at_turn = at(turn).value;
    if at_turn.high.abs() <= STILL_HIDDEN * hidden {
        return leaves.is_none().then_some(turn.high);
    }
    if !is_in(at_turn) {
        return None;
    }
    if is_wanted(is_outside) {
        Some(change(way_in, low, turn))
    } else {
        Some(change(|t| !way_in(t), turn, high))
    }
}

/// Where something becomes true that is not true of `low` and is of `high`.
fn change(is_true: impl Fn(Twofold) -> bool, mut low: Twofold, mut high: Twofold) -> f64 {
    for _ in 0..MOST {
        let middle = (low + high) * Twofold::from(0.5);
        if is_true(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high.high
}
