//! What is proven about the roots in a piece of a line, by bounds of the value, of its slope and of its bend.

use crate::certify::equation::{Values, may_be_hit};
use crate::geometry::sight::Line;
use tabray_exact::dual::Dual;
use tabray_exact::formula::field::Field;
use tabray_exact::interval::{Float, Interval};
use tabray_exact::jet::Jet;
use tabray_exact::scalar::{Scalar, per_axis};

/// The search for roots of an equation along a line.
pub(super) struct Search<'s, F> {
    pub shape: &'s dyn Values<Interval<F>>,
    pub line: &'s Line<Interval<F>>,
}

/// What is proven about the roots in a piece of a line.
pub(super) enum Judgement<F> {
    /// The piece has no root.
    Free,
    /// The piece has exactly one root, enclosed by this interval.
    Root(Interval<F>),
    /// The value may be 0 only in this interval, where its slope is 0. Shorter pieces do not tell whether it is.
    Touch(Interval<F>),
    /// It is certain neither that the piece has no root nor that it has exactly one.
    Open,
    /// As for `Open`, and the slope has no bound, as where the value jumps.
    Jump,
}

impl<F: Float> Search<'_, F> {
    fn value(&self, t: Interval<F>) -> Interval<F> {
        self.shape.value(self.line.at(t))
    }

    pub fn is_zero_at(&self, t: F) -> bool {
        self.value(Interval::point(t)).is_zero()
    }

    /// Encloses the value and its first derivative.
    fn slope(&self, t: Interval<F>) -> Dual<Interval<F>> {
        self.shape.slope(self.line.along(Dual::variable(t)))
    }

    /// Encloses the second derivative.
    fn bend(&self, t: Interval<F>) -> Interval<F> {
        let t = Jet::variable(t);
        let Line { origin, dir } = self.line;
        let at = per_axis(|axis| Jet::fixed(origin[axis]) + t * Jet::fixed(dir[axis]));
        self.shape.bend(at).second
    }

    /// Tells whether a piece has no hit although the slope has no bounds: the surface is cut off there, as where its
    /// formula is not defined, or the formula jumps past 0.
    fn is_broken(&self, piece: Interval<F>) -> bool {
        let at = self.line.at(piece);
        // 53 bits, which take a hundredth of the time, decide nearly all.
        let jumps = |field: &Field| {
            field.jumps_past_0(at.map(Interval::coarse)) || F::IS_LONG && field.jumps_past_0(at)
        };
        self.shape.field().is_some_and(jumps) || !may_be_hit(self.shape, self.line, piece)
    }

    /// Judges a piece by the mean value theorem of first and then of second order.
    pub fn judge(&self, piece: Interval<F>) -> Judgement<F> {
        let Dual { value, slope } = self.slope(piece);
        if !value.has_zero() {
            return Judgement::Free;
        }
        // Where the value is 0 all along a piece, so it is along shorter ones.
        if value.is_zero() {
            return Judgement::Touch(piece);
        }
        // Without bounds of the value and the slope, no mean value theorem helps.
        if !(slope.is_bounded() && value.is_bounded()) {
            return if self.is_broken(piece) { Judgement::Free } else { Judgement::Jump };
        }
        let middle = Interval::point(piece.middle());
        let around = piece - middle;
        let at_middle = self.slope(middle);
        if !(at_middle.value + slope * around).has_zero() {
            return Judgement::Free;
        }
        if !slope.has_zero() {
            return self.only(piece, slope);
        }
        // The slope on the whole piece, by the second derivative.
        let bend = self.bend(piece);
        let mean_slope = at_middle.slope + bend * around;
        if !(at_middle.value + mean_slope * around).has_zero() {
            return Judgement::Free;
        }
        if !mean_slope.has_zero() {
            return self.only(piece, mean_slope);
        }
        if bend.has_zero() || !bend.is_bounded() { Judgement::Open } else { self.turning(piece, bend) }
    }

    /// Judges a piece on which the second derivative has these bounds. They do not contain 0, so the slope is 0 at no
    /// more than one place. If there is such a place, the value there decides. Where no number of digits tells that
    /// value from 0, shorter pieces would not help.
    fn turning(&self, piece: Interval<F>, bend: Interval<F>) -> Judgement<F> {
        let (mut place, mut exists) = (piece, false);
        loop {
            let middle = Interval::point(place.middle());
            let step = middle - self.slope(middle).slope / bend;
            exists |= step.low > place.low && step.high < place.high;
            let next = Interval { low: step.low.max(place.low), high: step.high.min(place.high) };
            // Written so that a NaN ends the loop, too.
            if !(next.low <= next.high && next.width() < F::of(0.75) * place.width()) {
                break;
            }
            place = next;
        }
        if !exists {
            return Judgement::Open;
        }
        let (middle, zero) = (Interval::point(place.middle()), F::of(0.0));
        let Dual { value, slope } = self.slope(middle);
        let around = place - middle;
        let extreme = value + (slope + bend * around) * around;
        if !extreme.has_zero() {
            // An extreme beyond 0 has a root on each side of it.
            let is_away = (extreme.low > zero) == (bend.low > zero);
            return if is_away { Judgement::Free } else { Judgement::Open };
        }
        // The value is at least that far from its extreme: bend / 2 times the square of the distance.
        let least = Interval::point(bend.low.abs().min(bend.high.abs()));
        let reach = (Interval::constant(2.0) * Interval::point(extreme.magnitude()) / least).sqrt().high;
        let reach = Interval { low: -reach, high: reach };
        let at = place + reach;
        Judgement::Touch(Interval { low: at.low.max(piece.low), high: at.high.min(piece.high) })
    }

    /// Judges a piece on which the value is strictly monotonic, with these slopes, and has at most one root.
    fn only(&self, piece: Interval<F>, slope: Interval<F>) -> Judgement<F> {
        let sign = |at: F| self.value(Interval::point(at));
        let (first, last) = (sign(piece.low), sign(piece.high));
        if !first.has_zero() && !last.has_zero() {
            let zero = F::of(0.0);
            return if (first.low > zero) == (last.low > zero) {
                Judgement::Free
            } else {
                Judgement::Root(self.narrowed(piece, slope))
            };
        }
        // The root may lie where two pieces meet. On a wider piece, the interval Newton method proves that it exists.
        let margin = piece.width();
        let wide = Interval { low: piece.low - margin, high: piece.high + margin };
        let slope = self.slope(wide).slope;
        if slope.has_zero() {
            return Judgement::Open;
        }
        let step = self.step(wide, slope);
        if step.low > wide.low && step.high < wide.high {
            let root = self.narrowed(step, slope);
            let is_here = root.high >= piece.low && root.low <= piece.high;
            return if is_here { Judgement::Root(root) } else { Judgement::Free };
        }
        Judgement::Open
    }

    /// Encloses the root that a piece with these slopes may have, by a step of the interval Newton method. If the
    /// result lies inside the piece, the root exists.
    fn step(&self, piece: Interval<F>, slope: Interval<F>) -> Interval<F> {
        let middle = Interval::point(piece.middle());
        middle - self.value(middle) / slope
    }

    /// Narrows the enclosure of a piece's root as far as rounding allows.
    fn narrowed(&self, mut piece: Interval<F>, mut slope: Interval<F>) -> Interval<F> {
        loop {
            let step = self.step(piece, slope);
            let next = Interval { low: step.low.max(piece.low), high: step.high.min(piece.high) };
            // Written so that a NaN ends the loop, too.
            if !(next.low <= next.high && next.width() < F::of(0.75) * piece.width()) {
                return piece;
            }
            piece = next;
            let nearer = self.slope(piece).slope;
            if !nearer.has_zero() {
                slope = nearer;
            }
        }
    }
}
