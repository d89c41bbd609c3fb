//! First hits of any surface, by splitting a line until each piece certainly has no root, or exactly one.

use super::check;
use super::equation::{HitEnclosure, Values, hit_at, may_be_hit};
use crate::geometry::sight::Line;
use f256::f256;
use tabray_exact::dual::Dual;
use tabray_exact::formula::field::Field;
use tabray_exact::interval::{Float, Interval, Wide};
use tabray_exact::jet::Jet;
use tabray_exact::scalar::{Scalar, per_axis};

/// The length below which a piece is not cut where the value jumps, as a fraction of the whole line: about that of the
/// shortest piece with `f64`. A ray that passes through a jump stays undecided however short the piece is, and 237 bits
/// of exponential functions take a long time.
const JUMP: f64 = 16.0 * f64::EPSILON;

/// The number of pieces after which a search is given up if the shape is smaller than the rounding of the line.
const FEW_PIECES: usize = 16;

/// The width of what is examined next to a place where coarser numbers leave a hit in doubt, as a fraction of the whole
/// line: a little less than that of a piece that is not cut where the value jumps.
const DOUBTFUL: f64 = 0.99 * JUMP;

/// How much wider that is each time that coarser numbers leave another place in doubt: beside a pole, they may do so
/// for thousands of such widths.
const WIDENING: f64 = 64.0;

/// The length of pieces of a line up to which rounding may be why a search with 53 bits takes too many of them, as a
/// fraction of the distance.
const ROUNDED: f64 = 1e-8;

/// Returns the bounds of the first possible hit with t > 0, with no hit before them.
fn first_possible<F: Float>(hit: HitEnclosure<F>) -> Option<Interval<F>> {
    match hit {
        HitEnclosure::Misses => None,
        HitEnclosure::Hits(at) | HitEnclosure::Edge(at) => Some(at),
        HitEnclosure::Doubtful(from) => Some(Interval::point(from)),
    }
}

/// Finds the first hit with t > 0. The search is given up after `pieces` pieces of the line. With `leaves`, the line's
/// true start lies on the surface, and is not a hit.
pub fn first_hit<F: Float>(
    shape: &dyn Values<Interval<F>>,
    line: &Line<Interval<F>>,
    leaves: bool,
    mut pieces: usize,
) -> HitEnclosure<F> {
    let mut places = Vec::new();
    let found = unchecked(shape, line, leaves, &mut pieces, Stretch::From(F::of(0.0)), &mut places).0;
    check::first(shape, line, found, &places)
}

/// Finds the first hit with t > 0 in 237 bits. Only what 53 bits leave open is examined with 237, and from there on,
/// 53 bits go on. Each search is given up after a number of pieces; with `leaves`, the line's true start lies on the
/// surface, and is not a hit.
pub fn first_hit_in_turns(
    shape: &(impl Values<Interval> + Values<Wide>),
    line: &Line<Wide>,
    leaves: bool,
    [mut pieces, mut fine_pieces]: [usize; 2],
) -> HitEnclosure<f256> {
    let coarse = Line { origin: line.origin.map(Interval::coarse), dir: line.dir.map(Interval::coarse) };
    let (mut places, mut from, mut width) = (Vec::new(), 0.0, DOUBTFUL);
    let found = loop {
        let stretch = Stretch::From(from);
        let (found, end) = unchecked(shape, &coarse, leaves, &mut pieces, stretch, &mut places);
        let Some(at) = first_possible(found) else { break HitEnclosure::Misses };
        if pieces == 0 {
            // What is too much for 53 bits although pieces are far longer than their rounding is so for 237, too.
            if end.is_some_and(|end| end - at.low > ROUNDED * end) {
                break HitEnclosure::Doubtful(at.low.into());
            }
            width = 1.0;
        }
        let near = Stretch::Near(at.into(), width);
        let (found, rest) = unchecked(shape, line, leaves, &mut fine_pieces, near, &mut places);
        let (HitEnclosure::Misses, Some(rest)) = (found, rest) else { break found };
        let next = rest.to_f64().next_down();
        if next <= from {
            break HitEnclosure::Doubtful(rest);
        }
        (from, width) = (next, WIDENING * width);
    };
    places.sort_by(f64::total_cmp);
    check::first(shape, line, found, &places)
}

/// The part of a line in which a hit is searched.
enum Stretch<F> {
    /// All from a place on. There is no hit before it.
    From(F),
    /// The bounds of the first hit that is possible, and what is next to them, as a fraction of the whole line.
    Near(Interval<F>, f64),
}

/// Finds the first hit in a stretch, and adds the ends of the pieces that have none. Also returns the place from which
/// on nothing was examined, if there is one, or the end of the piece at which the search was given up.
fn unchecked<F: Float>(
    shape: &dyn Values<Interval<F>>,
    line: &Line<Interval<F>>,
    leaves: bool,
    pieces: &mut usize,
    stretch: Stretch<F>,
    places: &mut Vec<f64>,
) -> (HitEnclosure<F>, Option<F>) {
    let zero = F::of(0.0);
    let Some((mut from, mut to)) = clipped(shape, line) else { return (HitEnclosure::Misses, None) };
    let length = to - from;
    from = from.max(match &stretch {
        Stretch::From(place) => *place,
        Stretch::Near(possible, _) => possible.low,
    });
    if from > to {
        return (HitEnclosure::Misses, None);
    }
    if !to.is_finite() {
        return (HitEnclosure::Doubtful(from), None);
    }
    if leaves && from == zero {
        match left(shape, line, to) {
            Some(length) => from = length,
            None => return (HitEnclosure::Doubtful(zero), None),
        }
        if from == to {
            return (HitEnclosure::Misses, None);
        }
    }
    let rest = match stretch {
        Stretch::From(_) => None,
        Stretch::Near(possible, width) => {
            Some(possible.high.max(from + F::of(width) * length)).filter(|rest| *rest < to)
        }
    };
    to = rest.unwrap_or(to);
    // The parameter counts from near the shape, so a piece of the line is not a small difference of large numbers.
    let base = Interval::point(from + F::of(0.5) * (to - from));
    let near = Line { origin: line.at(base), dir: line.dir };
    // Where rounding moves the line by more than the shape's size, a hit cannot be proven, and a miss is proven at once
    // or not at all.
    let [low, high] = shape.extent();
    let is_lost = (0..3).any(|axis| near.origin[axis].width() > F::of(high[axis] - low[axis]));
    if is_lost {
        *pieces = FEW_PIECES.min(*pieces);
    }
    let ends = ((Interval::point(from) - base).low, (Interval::point(to) - base).high);
    let (found, end) = search_pieces(shape, &near, ends, length, base, pieces, places);
    (found, end.or(rest))
}

/// Finds the first hit between two ends of a line whose parameter counts from `base`. The line is of this length in the
/// box of the shape. Also returns the end of the piece at which the search was given up.
fn search_pieces<F: Float>(
    shape: &dyn Values<Interval<F>>,
    near: &Line<Interval<F>>,
    (from, to): (F, F),
    length: F,
    base: Interval<F>,
    pieces: &mut usize,
    places: &mut Vec<f64>,
) -> (HitEnclosure<F>, Option<F>) {
    let zero = F::of(0.0);
    // A piece shorter than about 8 ulps of the whole is too short to split.
    let shortest = F::of(8.0) * F::EPSILON * length;
    let shortest_jump = shortest.max(F::of(JUMP) * length);
    let search = Search { shape, line: near };
    let mut pending = open_pieces(shape, near, (from, to));
    while *pieces > 0 {
        let Some((low, high)) = pending.pop() else { return (HitEnclosure::Misses, None) };
        *pieces -= 1;
        let piece = Interval { low, high };
        let start = || (base + Interval::point(low)).low.max(zero);
        match search.judge(piece) {
            Judgement::Free => places.push((base.low + low).to_f64()),
            Judgement::Root(root) => {
                let distance = base + root;
                if distance.high <= zero {
                    continue;
                }
                if distance.low <= zero {
                    return (HitEnclosure::Doubtful(zero), None);
                }
                if let Some(hit) = hit_at(shape, near, root, distance) {
                    return (hit, None);
                }
            }
            // A value that is exactly 0 where a short piece ends is hardly doubted less where a shorter one does.
            Judgement::Open
                if high - low > shortest_jump || high - low > shortest && !search.is_zero_at(high) =>
            {
                pending.extend(cut(low, high))
            }
            Judgement::Jump if high - low > shortest_jump => pending.extend(cut(low, high)),
            // A root that is certainly cut off is no hit.
            Judgement::Open | Judgement::Jump => {
                if may_be_hit(shape, near, piece) {
                    return (HitEnclosure::Doubtful(start()), None);
                }
            }
            Judgement::Touch(at) => {
                if may_be_hit(shape, near, at) {
                    return (HitEnclosure::Doubtful((base + at).low.max(zero)), None);
                }
            }
        }
    }
    let (low, high) = pending.pop().unwrap_or((zero, zero));
    let place = |t: F| (base + Interval::point(t)).low.max(zero);
    (HitEnclosure::Doubtful(place(low)), Some(place(high)))
}

/// Returns the pieces of a line between two places on which the value may be 0, the nearest one last.
fn open_pieces<F: Float>(
    shape: &dyn Values<Interval<F>>,
    line: &Line<Interval<F>>,
    (from, to): (F, F),
) -> Vec<(F, F)> {
    let Some(cells) = shape.field().and_then(Field::cells) else { return vec![(from, to)] };
    let [base, dir] = [line.origin, line.dir].map(|of| of.map(|axis| axis.middle().to_f64()));
    let mut pieces = Vec::new();
    let nothing: Option<()> = cells.visit(base, dir, (from.to_f64(), to.to_f64()), &mut |low, high| {
        pieces.push((F::of(low), F::of(high)));
        None
    });
    debug_assert_eq!(nothing, None);
    pieces.reverse();
    pieces
}

/// Returns a length from a line's start, which lies on the surface, within which the value is strictly monotonic, and
/// so has no other root; at most `to`. `None` where the line touches the surface, as far as intervals tell.
fn left<F: Float>(shape: &dyn Values<Interval<F>>, line: &Line<Interval<F>>, to: F) -> Option<F> {
    let shortest = F::of(1024.0) * F::EPSILON * to;
    let mut length = to;
    while length > shortest {
        let piece = Interval { low: F::of(0.0), high: length };
        let slope = shape.slope(line.along(Dual::variable(piece))).slope;
        if slope.is_bounded() && !slope.has_zero() {
            return Some(length);
        }
        length = F::of(0.5) * length;
    }
    None
}

/// Cuts a piece in two, the nearer one last. Not in the middle, where the round numbers of scenes often put a root.
fn cut<F: Float>(low: F, high: F) -> [(F, F); 2] {
    let cut = low + F::of(0.493) * (high - low);
    [(cut, high), (low, cut)]
}

/// Clips a line to the extent of a shape, from t = 0 on.
fn clipped<F: Float>(shape: &dyn Values<Interval<F>>, line: &Line<Interval<F>>) -> Option<(F, F)> {
    let [low, high] = shape.extent();
    line.clip(low, high)
}

/// The search for roots of an equation along a line.
struct Search<'s, F> {
    shape: &'s dyn Values<Interval<F>>,
    line: &'s Line<Interval<F>>,
}

/// What is proven about the roots in a piece of a line.
enum Judgement<F> {
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

    fn is_zero_at(&self, t: F) -> bool {
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
        let jumps = |field: &Field| field.jumps_past_0(self.line.at(piece));
        self.shape.field().is_some_and(jumps) || !may_be_hit(self.shape, self.line, piece)
    }

    /// Judges a piece by the mean value theorem of first and then of second order.
    fn judge(&self, piece: Interval<F>) -> Judgement<F> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::certify::equation::Equation;
    use glam::DVec3;
    use std::cell::Cell;

    /// A profile's step at x = 0.3, and the number of times that it was evaluated.
    struct Step(Cell<usize>);

    impl Equation for Step {
        fn value<N: Scalar>(&self, [x, _, _]: [N; 3]) -> N {
            self.0.set(self.0.get() + 1);
            (x - N::constant(0.3)).floor() + N::constant(0.5)
        }

        fn extent(&self) -> [DVec3; 2] {
            [DVec3::NEG_ONE, DVec3::ONE]
        }
    }

    #[test]
    fn a_shape_smaller_than_rounding_is_in_doubt_after_a_few_pieces() {
        let step = Step(Cell::new(0));
        let third = |x| Interval::<f256>::constant(x) / Interval::constant(3.0);
        let line = Line {
            origin: [third(1e90), third(0.5), third(0.5)],
            dir: [third(-1.0), third(0.0), third(0.0)],
        };
        let found = first_hit(&step, &line, false, 2000);
        assert!(matches!(found, HitEnclosure::Doubtful(_)), "{found:?}");
        assert!(step.0.get() < 100, "{} evaluations", step.0.get());
    }

    #[test]
    fn a_jump_is_left_in_doubt_after_a_few_pieces() {
        let step = Step(Cell::new(0));
        let [origin, dir] = [[-2.0, 0.0, 0.0], [1.0, 0.0, 0.0]].map(|of| of.map(Interval::<f256>::constant));
        let HitEnclosure::Doubtful(from) = first_hit(&step, &Line { origin, dir }, false, 2000) else {
            panic!("a jump is no root")
        };
        assert!((from.to_f64() - 2.3).abs() < 1e-14, "{from:?}");
        assert!(step.0.get() < 200, "{} evaluations", step.0.get());
    }

    /// A plane whose equation is squared, at x = 1/3, and the number of times that it was evaluated.
    struct Squared(Cell<usize>);

    impl Equation for Squared {
        fn value<N: Scalar>(&self, [x, y, _]: [N; 3]) -> N {
            self.0.set(self.0.get() + 1);
            (x - N::constant(1.0) / N::constant(3.0)).powi(2) * (y + N::constant(7.0))
        }

        fn extent(&self) -> [DVec3; 2] {
            [DVec3::NEG_ONE, DVec3::ONE]
        }
    }

    #[test]
    fn a_touch_is_left_in_doubt_after_a_few_pieces() {
        let squared = Squared(Cell::new(0));
        let [origin, dir] = [[-2.0, 0.5, 0.5], [1.0, 0.1, 0.0]].map(|of| of.map(Interval::<f256>::constant));
        let HitEnclosure::Doubtful(from) = first_hit(&squared, &Line { origin, dir }, false, 2000) else {
            panic!("no digits tell a touch from a miss")
        };
        let third = f256::from(7.0) / f256::from(3.0);
        assert!(from <= third && third - from < f256::from(1e-30), "{from:?}");
        assert!(squared.0.get() < 100, "{} evaluations", squared.0.get());
    }

    #[test]
    fn many_digits_are_spent_only_where_few_leave_a_hit_in_doubt() {
        let step = Step(Cell::new(0));
        let [origin, dir] = [[-2.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
        let line = Line { origin: origin.map(Interval::constant), dir: dir.map(Interval::constant) };
        first_hit::<f64>(&step, &line, false, 2000);
        let few = step.0.replace(0);
        let line = Line { origin: origin.map(Interval::constant), dir: dir.map(Interval::constant) };
        let found = first_hit_in_turns(&step, &line, false, [2000; 2]);
        assert!(
            matches!(found, HitEnclosure::Doubtful(from) if (from.to_f64() - 2.3).abs() < 1e-14),
            "{found:?}"
        );
        assert!(step.0.get() < few + 20, "{} evaluations, {few} of them with 53 bits", step.0.get());
    }

    /// A wave without zeros, whose crests come closer and closer together at x = 0, and the number of times that it was
    /// evaluated, with 53 bits and with more.
    struct Waves([Cell<usize>; 2]);

    impl Equation for Waves {
        fn value<N: Scalar>(&self, [x, y, _]: [N; 3]) -> N {
            count_by_size::<N>(&self.0);
            let wave = (N::constant(1.0) / x).sin();
            wave * wave + N::constant(0.5) + N::constant(0.1) * y
        }

        fn extent(&self) -> [DVec3; 2] {
            [DVec3::NEG_ONE, DVec3::ONE]
        }
    }

    fn count_by_size<N>(counts: &[Cell<usize>; 2]) {
        let count = &counts[usize::from(size_of::<N>() >= size_of::<Interval<f256>>())];
        count.set(count.get() + 1);
    }

    #[test]
    fn waves_without_end_are_given_up() {
        let waves = Waves(Default::default());
        let [origin, dir] = [[-2.0, 1.5, 0.5], [1.0, -0.25, 0.0]].map(|of| of.map(Interval::constant));
        let found = first_hit_in_turns(&waves, &Line { origin, dir }, false, [400, 20]);
        assert!(matches!(found, HitEnclosure::Doubtful(_)), "{found:?}");
        let [few, more] = waves.0.map(Cell::into_inner);
        assert!(few <= 4 * 400 && more <= 4 * 20, "{few} and {more} evaluations");
    }

    /// A plane at x = 0.7, and what is nearly one at x = 1/3, with the numbers of evaluations.
    struct Planes([Cell<usize>; 2]);

    impl Equation for Planes {
        fn value<N: Scalar>(&self, [x, y, _]: [N; 3]) -> N {
            count_by_size::<N>(&self.0);
            let third = x - N::constant(1.0) / N::constant(3.0);
            (third.powi(2) + N::constant(1e-20)) * (x - N::constant(0.7)) * (y + N::constant(7.0))
        }

        fn extent(&self) -> [DVec3; 2] {
            [DVec3::NEG_ONE, DVec3::ONE]
        }
    }

    #[test]
    fn what_few_digits_leave_open_is_decided_by_more_and_from_there_few_go_on() {
        let planes = Planes(Default::default());
        let [origin, dir] = [[-2.0, 0.5, 0.5], [1.0, 0.1, 0.0]].map(|of| of.map(Interval::constant));
        let found = first_hit_in_turns(&planes, &Line { origin, dir }, false, [2000; 2]);
        let HitEnclosure::Hits(at) = found else { panic!("{found:?}") };
        assert!((at.low.to_f64() - 2.7).abs() < 1e-15, "{at:?}");
        let [few, more] = planes.0.map(Cell::into_inner);
        assert!(few < 400 && more < 120, "{few} and {more} evaluations");
    }

    /// A formula that is 0 on one side of a plane, and the number of times that it was evaluated.
    struct Half(Cell<usize>);

    impl Equation for Half {
        fn value<N: Scalar>(&self, [x, _, _]: [N; 3]) -> N {
            self.0.set(self.0.get() + 1);
            x.max(N::constant(0.0))
        }

        fn extent(&self) -> [DVec3; 2] {
            [DVec3::NEG_ONE, DVec3::ONE]
        }
    }

    #[test]
    fn where_a_formula_is_0_all_along_a_piece_it_is_not_cut() {
        let half = Half(Cell::new(0));
        let [origin, dir] = [[-2.0, 0.0, 0.0], [1.0, 0.1, 0.0]].map(|of| of.map(Interval::<f256>::constant));
        let found = first_hit(&half, &Line { origin, dir }, false, 2000);
        assert!(
            // The box is a little larger than the extent.
            matches!(found, HitEnclosure::Doubtful(from) if (from.to_f64() - 1.0).abs() < 1e-11),
            "{found:?}"
        );
        assert!(half.0.get() < 10, "{} evaluations", half.0.get());
    }
}
