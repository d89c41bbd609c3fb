//! The first root of a function along a line, proven to be the first.
//!
//! A piece of the line is judged by the function's value and slope at its middle and by bounds of its curvature over
//! all of the piece: Taylor's theorem of the second order, computed with [`Interval`]s, so that rounding is part of
//! what is proven. Either no root is there, or the function rises or falls all along and the signs at its ends tell
//! (then Newton's method finishes), or what is left of the piece is cut in two. No step in the line is guessed, so
//! no root is stepped over: D. P. Mitchell, "Robust ray intersection with interval arithmetic" (1990), whose bounds
//! are of the first order and which shrink more slowly where a ray grazes.

use crate::geometry::frame::BLUR;
use crate::geometry::ray::{RayRange, Side};
use crate::geometry::roots::{newton, twice};
use crate::numeric::dual::Dual;
use crate::numeric::interval::Interval;
use crate::numeric::scalar::Scalar;
use std::ops::Range;

/// The values of a function along a line: above 0 outside of something, below 0 inside.
pub trait FunctionOnLine {
    /// The value at a place, with any number type.
    fn at<N: Scalar>(&self, t: N) -> N;

    /// Bounds of the second derivative on a piece.
    fn curvature(&self, piece: Interval) -> Interval {
        self.at(Dual::variable_twice(piece)).second()
    }

    /// The root on a piece of which bounds in f64 do not tell whether it has one, and more of them would not: where
    /// rounding hides the function's sign, or after more proofs than are made. A line that is itself rounded says it of
    /// the one that it stands for.
    fn undecided(&self, piece: Interval, origin_side: Option<Side>) -> Option<f64> {
        let hidden = self.at(Interval::constant(piece.middle())).width();
        twice::first_root(|t| self.at(t), piece, origin_side, hidden)
    }
}

/// The part of a line on which a search goes.
#[derive(Clone, Debug)]
pub struct Stretch {
    /// Nothing is outside of it, of the line and of those that it was rounded from.
    pub outer: Range<f64>,
    /// All of these lines are within the ends of what is looked for there.
    pub inner: Range<f64>,
}

impl From<Range<f64>> for Stretch {
    fn from(span: Range<f64>) -> Self {
        Self { outer: span.clone(), inner: span }
    }
}

impl Stretch {
    /// Cuts off what lies beyond two heights, where a line's height `t` along it is `start + t dir`. Rounding may have
    /// moved the start by `blur` and the direction by [`BLUR`], and the search goes no farther than `reach` from t = 0.
    pub fn cut(&mut self, (start, dir): (f64, f64), [low, high]: [f64; 2], blur: f64, reach: f64) {
        // The line that this one was rounded from may be parallel to the ends.
        if dir.abs() <= 2.0 * BLUR {
            let moved = blur + 3.0 * BLUR * reach;
            if start < low - moved || start > high + moved {
                self.outer.end = f64::NEG_INFINITY;
            }
            if start < low + moved || start > high - moved {
                self.inner.end = f64::NEG_INFINITY;
            }
            return;
        }
        let (one, other) = ((low - start) / dir, (high - start) / dir);
        // The direction is more than half of what it may be, and the division itself rounds by less than BLUR.
        let hair = |t: f64| 2.0 * (blur + BLUR * t.abs()) / dir.abs() + BLUR * t.abs();
        let (first, last) = (one.min(other), one.max(other));
        self.outer = self.outer.start.max(first - hair(first))..self.outer.end.min(last + hair(last));
        self.inner = self.inner.start.max(first + hair(first))..self.inner.end.min(last - hair(last));
    }
}

/// What a search finds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// The first root.
    pub root: Option<f64>,
    /// Whether every line that this one was rounded from has its first root there, or none, as bounds in f64 prove.
    pub is_certain: bool,
}

/// The pieces looked at before proofs are given up: far more than any but the wildest function takes.
const PIECES: usize = 16_384;

/// Bounds of this many times an evaluation's rounding error are not worth halving their piece for: the part that they
/// owe to its length is at most three times the part that stays.
const HIDDEN: f64 = 4.0;

/// The pieces that can wait: as a cut halves a piece at least, and few units in the last place are not cut, no more
/// ever wait.
const WAITING: usize = 64;

/// The first root on a stretch of a line whose distance, counted from `base`, lies within a span.
///
/// The stretch is cut in the same way whatever the span is, so that a root is the same in every span that holds it.
///
/// A line that starts on the surface itself leaves it on a side, which the span tells, and no root where it starts is
/// meant then: from outside, only a root where the values fall from above 0 to below, from inside only one where they rise.
///
/// Pieces not longer than `shortest` are not cut: a few units in the last place of the greatest numbers on the line.
///
/// What bounds in f64 do not tell, the line is [asked](Line::undecided).
pub fn first_root(
    line: &impl FunctionOnLine,
    stretch: &Stretch,
    base: f64,
    range: &RayRange,
    shortest: f64,
) -> Found {
    let Range { start, end } = stretch.outer;
    if !(start <= end && start.is_finite() && end.is_finite()) {
        return Found { root: None, is_certain: true };
    }
    let mut search = Search { line, start, base, range, shortest, is_certain: true };
    // Where the line may have come to the ends, and where it certainly is between them.
    let inner = stretch.inner.start.clamp(start, end)..stretch.inner.end.clamp(start, end);
    let root = if inner.start < inner.end || start == end {
        let before = search.at_an_end(start, inner.start);
        let root = before.or_else(|| search.on_a_piece(inner.start, inner.end));
        root.or_else(|| search.at_an_end(inner.end, end))
    } else {
        search.at_an_end(start, end)
    };
    Found { root, is_certain: search.is_certain }
}

struct Search<'l, L> {
    line: &'l L,
    start: f64,
    base: f64,
    range: &'l RayRange,
    /// What is not cut any more.
    shortest: f64,
    is_certain: bool,
}

enum Judgement {
    /// No root that is wanted is there.
    Free,
    /// The first root there.
    Root(f64),
    /// Only these parts can have roots.
    Open { left: (f64, f64), right: (f64, f64) },
}

impl<L: FunctionOnLine> Search<'_, L> {
    /// The first root on a piece.
    fn on_a_piece(&mut self, start: f64, end: f64) -> Option<f64> {
        let RayRange { near, far, .. } = *self.range;
        let mut waiting = [(0.0, 0.0); WAITING];
        waiting[0] = (start, end);
        let (mut count, mut judged) = (1, 0);
        while count > 0 {
            count -= 1;
            let (low, high) = waiting[count];
            // Sums that are rounded keep their order.
            if self.base + high <= near {
                continue;
            }
            if self.base + low >= far {
                return None;
            }
            judged += 1;
            let may_cut = judged < PIECES && count + 2 <= WAITING && high - low > self.shortest;
            let judgement = if may_cut { self.judge(low, high) } else { self.last_word(low, high) };
            match judgement {
                Judgement::Free => {}
                Judgement::Root(root) => {
                    let distance = self.base + root;
                    if near < distance && distance < far {
                        return Some(root);
                    }
                }
                Judgement::Open { left, right } => {
                    for (low, high) in [right, left] {
                        if low < high {
                            waiting[count] = (low, high);
                            count += 1;
                        }
                    }
                }
            }
        }
        None
    }

    /// The first root where rounding hides whether the line is still between the ends: nothing is certain of what is
    /// there.
    fn at_an_end(&mut self, low: f64, high: f64) -> Option<f64> {
        if low >= high || !self.line.at(Interval { low, high }).has_zero() {
            return None;
        }
        self.is_certain = false;
        self.on_a_piece(low, high)
    }

    fn judge(&mut self, low: f64, high: f64) -> Judgement {
        let piece = Interval { low, high };
        let middle = low + 0.5 * (high - low);
        let half = (middle - low).max(high - middle).next_up();
        let around = Interval { low: -half, high: half };
        let Dual { value, slope } = self.line.at(Dual::variable(Interval::constant(middle)));
        let curvature = self.line.curvature(piece);
        // Taylor's theorem of the second order, or where there is no bound for that, of the first.
        let (values, slopes) = if curvature.is_bounded() {
            let bend = curvature * around;
            (value + (slope + Interval::constant(0.5) * bend) * around, slope + bend)
        } else {
            let over = self.line.at(Dual::variable(piece));
            if !over.value.has_zero() {
                return Judgement::Free;
            }
            (value + over.slope * around, over.slope)
        };
        if !values.has_zero() {
            return Judgement::Free;
        }
        if !slopes.has_zero() {
            return self.cross(low, high, slopes.low > 0.0, middle - value.low / slope.low);
        }
        // Little more than rounding is left: shorter pieces say no more.
        if value.has_zero() && values.magnitude() <= HIDDEN * value.magnitude() {
            return self.undecided(low, high);
        }
        // |value| from the middle on is above `away + slope u + curvature u²/2`, as its mirror image is to the left.
        let (away, slope, bend) = if value.low > 0.0 {
            (value.low, slope, curvature.low)
        } else {
            (-value.high, -slope, -curvature.high)
        };
        let (to_left, to_right) = if away > 0.0 && bend.is_finite() {
            (reach(away, -slope.high, bend), reach(away, slope.low, bend))
        } else {
            (0.0, 0.0)
        };
        Judgement::Open {
            left: (low, (middle - to_left).next_up().min(middle)),
            right: ((middle + to_right).next_down().max(middle), high),
        }
    }

    /// What a piece has on which the function only rises or only falls.
    fn cross(&mut self, low: f64, high: f64, rises: bool, guess: f64) -> Judgement {
        let origin_side = self.range.origin_side;
        if origin_side.is_some_and(|side| rises == (side == Side::Outside)) {
            return Judgement::Free;
        }
        let at = |t| if rises { self.value(t) } else { -self.value(t) };
        let (at_low, at_high) = (at(low), at(high));
        // A line that leaves the surface starts there.
        let starts = origin_side.is_some() && low == self.start && at_low.has_zero();
        if at_low.low > 0.0 || at_high.high < 0.0 || starts {
            Judgement::Free
        } else if at_low.high < 0.0 && at_high.low > 0.0 {
            Judgement::Root(self.newton(low, high, rises, guess))
        } else {
            self.undecided(low, high)
        }
    }

    /// The root of a piece by Newton's method, from a guess that may be any number.
    fn newton(&self, low: f64, high: f64, rises: bool, guess: f64) -> f64 {
        let guess = if low < guess && guess < high { guess } else { low + 0.5 * (high - low) };
        let line = |t| self.line.at(Dual::variable(t));
        newton::root(line, (low, high), !rises, guess, 0.5 * self.shortest)
    }

    /// What a piece has that is not cut any more: a root if the sign changes; none if it is so short that only a jump
    /// or a pole makes bounds of it hold 0.
    fn last_word(&mut self, low: f64, high: f64) -> Judgement {
        let piece = Interval { low, high };
        let over = self.line.at(piece);
        if !over.has_zero() {
            return Judgement::Free;
        }
        self.is_certain = false;
        let is_short = high - low <= self.shortest;
        // A line that leaves the surface starts there.
        if is_short && self.range.origin_side.is_some() && low == self.start {
            return Judgement::Free;
        }
        let (at_low, at_high) = (self.line.at(low), self.line.at(high));
        let (falls, rises) = (at_low > 0.0 && at_high <= 0.0, at_low < 0.0 && at_high >= 0.0);
        let crosses = match self.range.origin_side {
            None => falls || rises,
            Some(Side::Outside) => falls,
            Some(Side::Inside) => rises,
        };
        if is_short && over.is_bounded() && crosses {
            return Judgement::Root(self.newton(low, high, rises, piece.middle()));
        }
        let jumps = || !self.line.at(Dual::variable(piece)).slope.is_bounded();
        if is_short && (!over.is_bounded() || jumps()) {
            return Judgement::Free;
        }
        self.undecided(low, high)
    }

    /// What the line itself says of a piece.
    fn undecided(&mut self, low: f64, high: f64) -> Judgement {
        // A line that leaves the surface starts there.
        if self.range.origin_side.is_some() && low == self.start {
            return Judgement::Free;
        }
        self.is_certain = false;
        match self.line.undecided(Interval { low, high }, self.range.origin_side) {
            Some(root) => Judgement::Root(root.clamp(low, high)),
            None => Judgement::Free,
        }
    }

    /// The value at a place and how far rounding can have moved it.
    fn value(&self, t: f64) -> Interval {
        self.line.at(Interval::constant(t))
    }
}

/// How far `away + slope u + bend u²/2` certainly stays above 0, for u from 0 on.
fn reach(away: f64, slope: f64, bend: f64) -> f64 {
    let [away, slope, bend] = [away, slope, bend].map(Interval::<f64>::constant);
    let two = Interval::constant(2.0);
    let discriminant = slope * slope - two * bend * away;
    if discriminant.high < 0.0 {
        return f64::INFINITY;
    }
    let root = discriminant.sqrt();
    // The same root in two forms, of which one does not cancel.
    if slope.low <= 0.0 {
        (two * away / (root - slope)).low.max(0.0)
    } else if bend.high < 0.0 {
        ((slope + root) / -bend).low.max(0.0)
    } else {
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two roots at 1, and one at 3.
    struct Cubic;

    impl FunctionOnLine for Cubic {
        fn at<N: Scalar>(&self, t: N) -> N {
            (t - N::constant(1.0)).powi(2) * (N::constant(3.0) - t)
        }
    }

    /// A kink at the root 2, a jump past 0 at 3 and a pole at 4.
    struct Broken;

    impl FunctionOnLine for Broken {
        fn at<N: Scalar>(&self, t: N) -> N {
            let n = N::constant;
            (t - n(2.0)).abs().min(n(2.5) - t.floor()) / (n(4.0) - t)
        }
    }

    fn first(line: &impl FunctionOnLine, span: Range<f64>, origin_side: Option<Side>) -> Option<f64> {
        let range = RayRange { origin_side, ..RayRange::ALL };
        first_root(line, &span.into(), 0.0, &range, f64::EPSILON * 36.0).root
    }

    #[test]
    fn a_touch_is_a_root_and_no_way_in() {
        let touch = first(&Cubic, 0.0..9.0, None).expect("a touch");
        assert!((touch - 1.0).abs() < 1e-7, "{touch:e}");
        assert_eq!(first(&Cubic, 0.0..9.0, Some(Side::Outside)), Some(3.0));
        assert_eq!(first(&Cubic, 0.0..9.0, Some(Side::Inside)), None);
        assert_eq!(first(&Cubic, 1.5..2.9, None), None);
    }

    #[test]
    fn kinks_and_jumps_are_met_and_poles_are_not() {
        let kink = first(&Broken, 0.3..9.0, None).expect("a kink");
        assert!((kink - 2.0).abs() < 1e-14, "{kink}");
        let jump = first(&Broken, 2.3..9.0, None).expect("a jump");
        assert!((jump - 3.0).abs() < 1e-14, "{jump}");
        assert_eq!(first(&Broken, 3.3..9.0, None), None);
    }
}
