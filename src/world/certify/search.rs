//! First hits of any surface, by splitting a line until each piece certainly has no root, or exactly one.

mod judgement;
#[cfg(test)]
mod tests;

use super::check::{self, Trail};
use super::equation::{HitEnclosure, Values, hit_at, may_be_hit};
use crate::geometry::sight::Line;
use judgement::{Judgement, Search};
use tabray_exact::dual::Dual;
use tabray_exact::formula::field::Field;
use tabray_exact::interval::{Float, Fraction, Interval, Wide};

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
    let mut trail = Trail::default();
    let found = unchecked(shape, line, leaves, &mut pieces, Stretch::From(F::of(0.0)), &mut trail).0;
    check::first(shape, line, found, &trail)
}

/// Finds the first hit with t > 0 in 237 bits. Only what 53 bits leave open is examined with 237, and from there on,
/// 53 bits go on. Each search is given up after a number of pieces; with `leaves`, the line's true start lies on the
/// surface, and is not a hit. The shape is given in both numbers, as a `dyn` to compile the search only once.
pub fn first_hit_in_turns(
    (rough, shape): (&dyn Values<Interval>, &dyn Values<Wide>),
    line: &Line<Wide>,
    leaves: bool,
    [mut pieces, mut fine_pieces]: [usize; 2],
) -> HitEnclosure<Fraction> {
    let coarse = Line { origin: line.origin.map(Interval::coarse), dir: line.dir.map(Interval::coarse) };
    let (mut trail, mut from, mut width, mut is_spent) = (Trail::default(), 0.0, DOUBTFUL, false);
    let found = loop {
        let stretch = Stretch::From(from);
        let (found, end) = unchecked(rough, &coarse, leaves, &mut pieces, stretch, &mut trail);
        let Some(at) = first_possible(found) else { break HitEnclosure::Misses };
        if let (0, false, Some(end), Some([start, to])) = (pieces, is_spent, end, trail.clipped) {
            // What is too much for 53 bits although pieces are far longer than their rounding is so for 237, too.
            if end - at.low > ROUNDED * end {
                break HitEnclosure::Doubtful(at.low.into());
            }
            // From here on, 53 bits examine nothing: 237 begin with pieces of the same length.
            (is_spent, width) = (true, WIDENING * (end - at.low) / (to - start));
        }
        let near = Stretch::Near(at.into(), width);
        let (found, rest) = unchecked(shape, line, leaves, &mut fine_pieces, near, &mut trail);
        let (HitEnclosure::Misses, Some(rest)) = (found, rest) else { break found };
        let next = rest.to_f64().next_down();
        if next <= from {
            break HitEnclosure::Doubtful(rest);
        }
        (from, width) = (next, WIDENING * width);
    };
    trail.places.sort_by(f64::total_cmp);
    check::first(shape, line, found, &trail)
}

/// The part of a line in which a hit is searched.
enum Stretch<F> {
    /// All from a place on. There is no hit before it.
    From(F),
    /// The bounds of the first hit that is possible, and what is next to them, as a fraction of the whole line.
    Near(Interval<F>, f64),
}

/// Finds the first hit in a stretch, and notes the ends of the pieces that have none. Also returns the place from which
/// on nothing was examined, if there is one, or the end of the piece at which the search was given up.
fn unchecked<F: Float>(
    shape: &dyn Values<Interval<F>>,
    line: &Line<Interval<F>>,
    leaves: bool,
    pieces: &mut usize,
    stretch: Stretch<F>,
    trail: &mut Trail,
) -> (HitEnclosure<F>, Option<F>) {
    let zero = F::of(0.0);
    let part = clipped(shape, line);
    trail.clip(part);
    let Some((mut from, mut to)) = part else { return (HitEnclosure::Misses, None) };
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
    let [low, high] = shape.widened_extent();
    let is_lost = (0..3).any(|axis| near.origin[axis].width() > F::of(high[axis] - low[axis]));
    if is_lost {
        *pieces = FEW_PIECES.min(*pieces);
    }
    let ends = ((Interval::point(from) - base).low, (Interval::point(to) - base).high);
    let (found, end) = search_pieces(shape, &near, ends, length, base, pieces, &mut trail.places);
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
    let [low, high] = shape.widened_extent();
    line.clip(low, high)
}
