//! The first root of a function along a line, proven to be the first.
//!
//! A piece of the line is examined by the function's value and slope at its midpoint, and by bounds of the curvature
//! over the whole piece. This is Taylor's theorem of second order, computed with [`Interval`]s, and so the proof
//! includes rounding. There are three cases: the piece has no root; the function is monotonic, the signs at the ends
//! decide, and Newton's method refines the root; or the rest of the piece is cut in two. No step along the line is
//! guessed, and so no root is skipped. D. P. Mitchell, "Robust ray intersection with interval arithmetic" (1990), uses
//! bounds of first order, which shrink more slowly for grazing rays.
//!
//! If the function is a polynomial, the signs of its [`bernstein`](super::bernstein) coefficients are examined instead,
//! on shorter and shorter pieces.

mod function;
mod polynomial;

pub use function::FunctionOnLine;

use crate::dual::Dual;
use crate::interval::Interval;
use crate::polynomial::{FEW, MAX_COEFFICIENTS, SOME};
use crate::roots::range::{RayRange, Side};
use crate::roots::{newton, stretch::Stretch};
use crate::scalar::Scalar;
use std::ops::Range;

/// The result of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstRoot {
    /// The first root.
    pub root: Option<f64>,
    /// Whether bounds in `f64` prove this first root, or that there is none, for all lines that may have been rounded
    /// to this one.
    pub is_certain: bool,
}

/// The maximum number of examined pieces before the proof is given up. Only the wildest functions take more.
pub const MAX_PIECES: usize = 16_384;

/// After this many pieces, a piece where the bounds of values are infinite is not cut further.
const MANY_PIECES: usize = 512;

/// After this many pieces, a piece where plain values exceed the range of `f64` is not cut further.
const SOME_PIECES: usize = 16;

/// The maximum number of pieces that one search passes to [`undecided`](FunctionOnLine::undecided), which takes up to
/// 0.1 ms for each. Only a line with a rounding error larger than a shape has more such pieces, and its search ends
/// there.
const MAX_UNDECIDED: usize = 256;

/// A piece is not cut if its bounds are below this many times the rounding error of one evaluation. The part of the
/// bounds that shrinks with the length of the piece is then at most three times the part that does not.
const HIDDEN: f64 = 4.0;

/// The capacity of the stack of pieces. A cut leaves pieces of at most half the length, and pieces of a few ulps are
/// not cut. At most about 53 pieces thus wait.
const STACK_SIZE: usize = 64;

/// Returns the first root on a stretch of a line with a distance `base + root` in the range.
///
/// The stretch is divided in a way that does not depend on the range. A root is thus the same in each range that
/// contains it.
///
/// If the line starts on the surface, the range gives the side that it leaves to, and the root at its start does not
/// count. For a line that leaves to the outside, only roots where the function falls count, and to the inside, only
/// roots where it rises.
///
/// Pieces of at most `shortest`, a few ulps of the largest numbers on the line, are not cut.
///
/// Pieces that bounds in `f64` do not decide are passed to [`undecided`](FunctionOnLine::undecided).
pub fn first_root(
    line: &impl FunctionOnLine,
    stretch: &Stretch,
    base: f64,
    range: &RayRange,
    shortest: f64,
) -> FirstRoot {
    first_root_within(line, stretch, base, range, shortest, &mut MAX_PIECES.clone())
}

/// Finds the same root as [`first_root`]. Subtracts the number of examined pieces from `pieces`, and stops cutting when
/// it is 0.
pub fn first_root_within(
    line: &impl FunctionOnLine,
    stretch: &Stretch,
    base: f64,
    range: &RayRange,
    shortest: f64,
    pieces: &mut usize,
) -> FirstRoot {
    let Range { start, end } = stretch.outer;
    if !(start <= end && start.is_finite() && end.is_finite()) {
        return FirstRoot { root: None, is_certain: true };
    }
    // Inside of `inner`, the line is certainly between the ends. Outside, it may be beyond them.
    let inner = stretch.inner.start.clamp(start, end)..stretch.inner.end.clamp(start, end);
    let most = *pieces;
    let mut search = Search {
        line,
        start,
        inner: inner.clone(),
        base,
        range,
        shortest,
        most,
        pieces,
        undecided: 0,
        is_certain: true,
        hidden: None,
    };
    let root = match line.degree() {
        Some(degree) if degree < FEW => search.expand::<FEW>(start, end),
        Some(degree) if degree < SOME => search.expand::<SOME>(start, end),
        Some(_) => search.expand::<MAX_COEFFICIENTS>(start, end),
        None if inner.start < inner.end || start == end => {
            let before = search.at_an_end(start, inner.start);
            let root = before.or_else(|| {
                line.pieces((inner.start, inner.end), range.far - base, &mut |low, high| {
                    search.on_a_piece(low, high)
                })
            });
            root.or_else(|| search.at_an_end(inner.end, end))
        }
        None => search.at_an_end(start, end),
    };
    FirstRoot { root, is_certain: search.is_certain }
}

/// Two places with different signs of a function.
#[derive(Clone, Copy, Debug)]
pub struct SignChange {
    /// The first place.
    pub low: f64,
    /// The last one.
    pub high: f64,
    /// Whether the function rises from one to the other.
    pub rises: bool,
}

/// The maximum number of times that the bracket of a root is widened by a factor of 4, to find certain signs at both
/// ends.
const WIDENINGS: usize = 8;

/// Returns two places around a certain root, at least `width` from it. All lines that may have been rounded to this one
/// cross 0 between them. Returns `None` if bounds in `f64` do not prove that.
pub fn bracket(line: &impl FunctionOnLine, root: f64, mut width: f64) -> Option<SignChange> {
    let value = |t: f64| line.at(Interval::<f64>::constant(t));
    for _ in 0..WIDENINGS {
        let (low, high) = (root - width, root + width);
        let (before, after) = (value(low), value(high));
        let rises = before.high < 0.0 && after.low > 0.0;
        if rises || before.low > 0.0 && after.high < 0.0 {
            return Some(SignChange { low, high, rises });
        }
        width *= 4.0;
    }
    None
}

struct Search<'l, L> {
    line: &'l L,
    start: f64,
    /// The part where the line is certainly between its ends.
    inner: Range<f64>,
    base: f64,
    range: &'l RayRange,
    /// Pieces of at most this length are not cut.
    shortest: f64,
    /// The number of pieces that may be examined, and how many of them are left.
    most: usize,
    pieces: &'l mut usize,
    /// The number of undecided pieces so far.
    undecided: usize,
    is_certain: bool,
    /// A piece where rounding hides a polynomial, and which the next one may extend.
    hidden: Option<(f64, f64)>,
}

enum Judgement {
    /// The piece has no root that counts.
    Free,
    /// The first root on the piece.
    Root(f64),
    /// Only these parts of the piece can have roots.
    Open { left: (f64, f64), right: (f64, f64) },
}

impl<L: FunctionOnLine> Search<'_, L> {
    /// Returns the first root on a piece.
    fn on_a_piece(&mut self, start: f64, end: f64) -> Option<f64> {
        let RayRange { near, far, .. } = *self.range;
        let mut waiting = [(0.0, 0.0); STACK_SIZE];
        waiting[0] = (start, end);
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let (low, high) = waiting[count];
            // Rounded sums keep their order.
            if self.base + high <= near {
                continue;
            }
            if self.base + low >= far {
                return None;
            }
            *self.pieces = self.pieces.saturating_sub(1);
            let may_cut = *self.pieces > 0 && count + 2 <= STACK_SIZE && high - low > self.shortest;
            let judgement = if may_cut { self.judge(low, high) } else { self.judge_uncut(low, high) };
            match judgement {
                Judgement::Root(root) if self.is_in_range(root) => return Some(root),
                Judgement::Free | Judgement::Root(_) => {}
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

    fn is_in_range(&self, root: f64) -> bool {
        let distance = self.base + root;
        self.range.near < distance && distance < self.range.far
    }

    /// Tells whether a root counts where the function rises, or falls. It does not if the ray leaves the surface to
    /// that side.
    fn counts(&self, rises: bool) -> bool {
        self.range.origin_side.is_none_or(|side| rises == (side == Side::Inside))
    }

    /// Returns the first root where rounding hides whether the line is still between the ends. Such roots are not
    /// certain.
    fn at_an_end(&mut self, low: f64, high: f64) -> Option<f64> {
        let end = Interval { low, high };
        // The first two conditions are cheap, even for formulas with expensive values.
        if low >= high
            || self.line.is_left_out(end)
            || !self.line.at(end).has_zero()
            || self.line.is_broken(end)
        {
            return None;
        }
        self.is_certain = false;
        self.on_a_piece(low, high)
    }

    fn judge(&mut self, low: f64, high: f64) -> Judgement {
        let piece = Interval { low, high };
        if L::VALUES_FIRST && !self.line.at(piece).has_zero() {
            return Judgement::Free;
        }
        if self.line.is_left_out(piece) {
            return Judgement::Free;
        }
        let Some([slopes, curvature]) = self.line.slopes(piece) else { return Judgement::Free };
        // If these bounds are enough, those around the midpoint are not needed.
        if L::VALUES_FIRST && curvature.is_bounded() && !slopes.has_zero() {
            return self.judge_monotone(low, high, slopes.low > 0.0, f64::NAN);
        }
        let middle = low + 0.5 * (high - low);
        let half = (middle - low).max(high - middle).next_up();
        let around = Interval { low: -half, high: half };
        let Dual { value, slope } = self.line.at(Dual::variable(Interval::constant(middle)));
        // If values exceed the range of f64, shorter pieces would not help. Beside a pole, they do not exceed it.
        let place = |part: f64| low + part * (high - low);
        let is_beyond = |part: f64| !self.line.at(Interval::<f64>::constant(place(part))).is_bounded();
        let is_infinite = |part: f64| {
            let at = place(part);
            !self.line.at(at).is_finite() && !self.line.is_left_out(Interval::constant(at))
        };
        let (quarters, judged) = ([0.25, 0.5, 0.75], self.most.saturating_sub(*self.pieces));
        let has_no_value = || {
            judged > SOME_PIECES && quarters.into_iter().all(is_infinite)
                || judged > MANY_PIECES && quarters.into_iter().all(is_beyond)
        };
        if value.has_zero() && has_no_value() {
            return self.undecided(low, high);
        }
        // This is Taylor's theorem of second order, or of first order if the curvature is unbounded.
        let (values, slopes) = if curvature.is_bounded() {
            let bend = curvature * around;
            (value + (slope + Interval::constant(0.5) * bend) * around, slope + bend)
        } else {
            let over = self.line.at(Dual::variable(piece));
            if !over.value.has_zero() || !over.slope.is_bounded() && self.line.is_broken(piece) {
                return Judgement::Free;
            }
            // At a jump, the bounds at a place are as wide as those of the piece, and shorter pieces would not help.
            if value.has_zero() && over.value.is_bounded() && 2.0 * value.width() >= over.value.width() {
                // However, there may be roots beside a jump past 0.
                let jumps = self.line.is_broken(Interval::constant(middle));
                let halves = Judgement::Open { left: (low, middle), right: (middle, high) };
                return if jumps { halves } else { self.undecided(low, high) };
            }
            // Across a pole, even a rising function falls.
            let slopes = if over.value.is_bounded() { over.slope } else { Interval::WHOLE };
            (value + over.slope * around, slopes)
        };
        if !values.has_zero() {
            return Judgement::Free;
        }
        if !slopes.has_zero() {
            return self.judge_monotone(low, high, slopes.low > 0.0, middle - value.low / slope.low);
        }
        // The bounds are little more than rounding error, and shorter pieces would not help.
        if value.is_bounded() && value.has_zero() && values.magnitude() <= HIDDEN * value.magnitude() {
            return self.undecided(low, high);
        }
        // On the right of the midpoint, |value| is at least `away + slope u + curvature u²/2`, and on the left at least
        // its mirror image.
        let (away, slope, bend) = if value.low > 0.0 {
            (value.low, slope, curvature.low)
        } else {
            (-value.high, -slope, -curvature.high)
        };
        let (to_left, to_right) = if away > 0.0 && bend.is_finite() {
            (clear_up_to(away, -slope.high, bend), clear_up_to(away, slope.low, bend))
        } else {
            (0.0, 0.0)
        };
        Judgement::Open {
            left: (low, (middle - to_left).next_up().min(middle)),
            right: ((middle + to_right).next_down().max(middle), high),
        }
    }

    /// Examines a piece where the function is monotonic. The guess may be any number.
    fn judge_monotone(&mut self, low: f64, high: f64, rises: bool, guess: f64) -> Judgement {
        if !self.counts(rises) {
            return Judgement::Free;
        }
        let at = |t| if rises { self.value(t) } else { -self.value(t) };
        let (at_low, at_high) = (at(low), at(high));
        // A line that leaves the surface starts on it.
        let starts = self.range.origin_side.is_some() && low == self.start && at_low.has_zero();
        if at_low.low > 0.0 || at_high.high < 0.0 || starts {
            Judgement::Free
        } else if at_low.high < 0.0 && at_high.low > 0.0 {
            let part = at_low.high / (at_low.high - at_high.low);
            let guess = if guess.is_nan() { low + part * (high - low) } else { guess };
            Judgement::Root(self.newton(low, high, rises, guess))
        } else {
            self.undecided(low, high)
        }
    }

    /// Returns the root on a piece by Newton's method. The guess may be any number.
    fn newton(&self, low: f64, high: f64, rises: bool, guess: f64) -> f64 {
        let guess = if low < guess && guess < high { guess } else { low + 0.5 * (high - low) };
        let line = |t| self.line.at(Dual::variable(t));
        newton::root(line, (low, high), !rises, guess, 0.5 * self.shortest)
    }

    /// Examines a piece that is not cut further. It has a root if the sign changes. It has none if it is so short that
    /// its bounds only contain 0 because of a jump or a pole.
    fn judge_uncut(&mut self, low: f64, high: f64) -> Judgement {
        let piece = Interval { low, high };
        let over = self.line.at(piece);
        if !over.has_zero() {
            return Judgement::Free;
        }
        let is_short = high - low <= self.shortest;
        let jumps = || !self.line.at(Dual::variable(piece)).slope.is_bounded();
        let is_broken = is_short && (!over.is_bounded() || jumps());
        if is_broken && self.line.is_broken(piece) {
            return Judgement::Free;
        }
        self.is_certain = false;
        // A line that leaves the surface starts on it.
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
        if is_broken {
            return Judgement::Free;
        }
        self.undecided(low, high)
    }

    /// Decides a piece by [`FunctionOnLine::undecided`].
    fn undecided(&mut self, low: f64, high: f64) -> Judgement {
        // A line that leaves the surface starts on it.
        if self.range.origin_side.is_some() && low == self.start {
            return Judgement::Free;
        }
        if self.line.is_broken(Interval { low, high }) {
            return Judgement::Free;
        }
        self.is_certain = false;
        if self.line.wants_proof() {
            // The remaining pieces are not cut further.
            *self.pieces = 0;
            return Judgement::Free;
        }
        self.undecided += 1;
        if self.undecided > MAX_UNDECIDED {
            return Judgement::Free;
        }
        match self.line.undecided(Interval { low, high }, self.range.origin_side) {
            Some(root) => Judgement::Root(root.clamp(low, high)),
            None => Judgement::Free,
        }
    }

    /// Returns bounds of the value at a place, including its rounding error.
    fn value(&self, t: f64) -> Interval {
        self.line.at(Interval::constant(t))
    }
}

/// Returns a number up to which, from u = 0 on, `away + slope u + bend u²/2` is certainly positive.
fn clear_up_to(away: f64, slope: f64, bend: f64) -> f64 {
    let [away, slope, bend] = [away, slope, bend].map(Interval::<f64>::constant);
    let two = Interval::constant(2.0);
    let discriminant = slope * slope - two * bend * away;
    if discriminant.high < 0.0 {
        return f64::INFINITY;
    }
    let root = discriminant.sqrt();
    // Each root has two forms. The code uses the one that does not cancel.
    if slope.low <= 0.0 {
        (two * away / (root - slope)).low.max(0.0)
    } else if bend.high < 0.0 {
        ((slope + root) / -bend).low.max(0.0)
    } else {
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests;
