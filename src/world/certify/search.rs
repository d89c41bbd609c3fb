//! First hits of any surface, by halving a line until each piece has no hit for certain, or one.

use super::equation::{Equation, Found, is_kept};
use crate::geometry::sight::Line;
use crate::numeric::dual::Dual;
use crate::numeric::interval::{Float, Interval};
use crate::numeric::scalar::Scalar;

/// The pieces of a line that are looked at before it is given up.
const PIECES: usize = 2000;

/// The first hit from t = 0 on.
pub fn first_hit<F: Float>(shape: &impl Equation, line: &Line<Interval<F>>) -> Found<F> {
    let zero = F::of(0.0);
    let Some((from, to)) = clip(shape, line) else { return Found::Misses };
    if !to.is_finite() {
        return Found::Doubtful(from);
    }
    // Counted from near the shape, so that a piece of the line is not a small difference of large numbers.
    let base = Interval::point(from + F::of(0.5) * (to - from));
    let near = Line { origin: line.at(base), dir: line.dir };
    let (from, to) = ((Interval::point(from) - base).low, (Interval::point(to) - base).high);
    let shortest = F::of(8.0) * F::EPSILON * (to - from);
    let search = Search { shape, line: &near };
    let mut waiting = vec![(from, to)];
    for _ in 0..PIECES {
        let Some((low, high)) = waiting.pop() else { return Found::Misses };
        let piece = Interval { low, high };
        let start = || (base + Interval::point(low)).low.max(zero);
        match search.judge(piece) {
            Judgement::Free => {}
            Judgement::Root(root) => {
                let distance = base + root;
                if distance.high <= zero {
                    continue;
                }
                if distance.low <= zero {
                    return Found::Doubtful(zero);
                }
                match is_kept(shape, &near, root) {
                    Some(true) => return Found::Hits(distance),
                    Some(false) => {}
                    None => return Found::Edge(distance),
                }
            }
            Judgement::Open if high - low > shortest => {
                // Not the middle, where the numbers of scenes like to have something.
                let cut = low + F::of(0.493) * (high - low);
                waiting.extend([(cut, high), (low, cut)]);
            }
            // What is cut off there in any case is no hit.
            Judgement::Open => {
                if is_kept(shape, &near, piece) != Some(false) {
                    return Found::Doubtful(start());
                }
            }
        }
    }
    Found::Doubtful(waiting.last().map_or(zero, |(low, _)| (base + Interval::point(*low)).low.max(zero)))
}

/// The part of a line, from t = 0 on, outside of which nothing of the shape is.
fn clip<F: Float>(shape: &impl Equation, line: &Line<Interval<F>>) -> Option<(F, F)> {
    let [low, high] = shape.extent();
    let (mut from, mut to) = (F::of(0.0), F::INFINITY);
    for axis in 0..3 {
        let (origin, dir) = (line.origin[axis], line.dir[axis]);
        let (low, high) = (Interval::<F>::constant(low[axis]), Interval::<F>::constant(high[axis]));
        if dir.has_zero() {
            if dir.is_zero() && (origin.high < low.low || origin.low > high.high) {
                return None;
            }
            continue;
        }
        let (one, other) = ((low - origin) / dir, (high - origin) / dir);
        from = from.max(one.low.min(other.low));
        to = to.min(one.high.max(other.high));
    }
    (from <= to).then_some((from, to))
}

struct Search<'s, S, F> {
    shape: &'s S,
    line: &'s Line<Interval<F>>,
}

/// What is certain of a piece of a line.
enum Judgement<F> {
    /// The equation has no solution there.
    Free,
    /// It has one, and no other, at one of these distances.
    Root(Interval<F>),
    /// Neither.
    Open,
}

impl<S: Equation, F: Float> Search<'_, S, F> {
    fn value(&self, t: Interval<F>) -> Interval<F> {
        self.shape.value(self.line.at(t))
    }

    /// The value, with its slope.
    fn slope(&self, t: Interval<F>) -> Dual<Interval<F>> {
        self.shape.value(self.line.along(Dual::variable(t)))
    }

    /// How fast the slope changes.
    fn bend(&self, t: Interval<F>) -> Interval<F> {
        let t = Dual::variable_twice(t);
        let Line { origin, dir } = self.line;
        let at = [0, 1, 2].map(|axis| Dual::fixed_twice(origin[axis]) + t * Dual::fixed_twice(dir[axis]));
        self.shape.value(at).second()
    }

    fn judge(&self, piece: Interval<F>) -> Judgement<F> {
        let Dual { value, slope } = self.slope(piece);
        if !value.has_zero() {
            return Judgement::Free;
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
        let by_bend = at_middle.slope + self.bend(piece) * around;
        if !(at_middle.value + by_bend * around).has_zero() {
            return Judgement::Free;
        }
        if by_bend.has_zero() { Judgement::Open } else { self.only(piece, by_bend) }
    }

    /// What a piece has on which the value rises or falls all the way, with these slopes: one solution at most.
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
        // It may lie where two pieces meet. On a wider piece Newton's method proves that it is there.
        let room = piece.width();
        let wide = Interval { low: piece.low - room, high: piece.high + room };
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

    /// Where a piece with these slopes can have a solution: a step of the interval Newton method. Where all of that is
    /// inside of the piece there is one.
    fn step(&self, piece: Interval<F>, slope: Interval<F>) -> Interval<F> {
        let middle = Interval::point(piece.middle());
        middle - self.value(middle) / slope
    }

    /// The solution that a piece has, as narrow as rounding allows.
    fn narrowed(&self, mut piece: Interval<F>, mut slope: Interval<F>) -> Interval<F> {
        loop {
            let step = self.step(piece, slope);
            let next = Interval { low: step.low.max(piece.low), high: step.high.min(piece.high) };
            // Written so that what is not a number ends it, too.
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
