//! The hits of all lines through a footprint at once. The lines' coefficients depend on the place in the footprint.
//!
//! The equations are those of the proofs of single lines, evaluated in [`Affine`] numbers.

use super::equation::{Equation, Values};
use crate::geometry::sight::Line;
use tabray_exact::affine::{Affine, VARIABLES};
use tabray_exact::dual::Dual;
use tabray_exact::interval::Interval;
use tabray_exact::jet::Jet;
use tabray_exact::scalar::Scalar;

/// The variable of [`Affine`] numbers that stands for the place in a piece of the lines.
const ALONG: usize = VARIABLES - 1;

/// The maximum number of pieces of the lines that are examined before a search is given up.
const PIECES: usize = 80;

/// The length below which a piece is not cut, as a fraction of the part of the lines that may meet the shape.
const SHORTEST: f64 = 1.0 / 256.0;

/// The maximum number of times that the piece in which a line leaves the shape is halved.
const HALVINGS: usize = 20;

/// What is proven about a hit of the lines of a footprint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FootprintHit {
    /// Each line has a hit at this t.
    Hits(Affine),
    /// A line may have a hit, and if it has one, at this t.
    Perhaps(Affine),
    /// A line may have hits, at no smaller t than this.
    Doubtful(f64),
}

impl FootprintHit {
    /// Returns a lower bound on t.
    pub fn low(&self) -> f64 {
        match self {
            Self::Hits(at) | Self::Perhaps(at) => at.range().low.max(0.0),
            Self::Doubtful(low) => *low,
        }
    }
}

/// Proofs about a shape's hits along all lines of a footprint.
pub trait OverFootprint {
    /// Calls `met` with the possible hits with t > 0, each with its part of the shape. For each part, these are the
    /// hits up to the first one that every line certainly has. `leaves` is the part on which the lines' true starts
    /// lie, if they lie on the shape.
    fn hits(&self, line: &Line<Affine>, leaves: Option<usize>, met: &mut dyn FnMut(FootprintHit, usize));

    /// Encloses the value of the equation of a part at points in world coordinates, and its derivative.
    fn slope(&self, at: [Dual<Affine>; 3], part: usize) -> Dual<Affine>;
}

impl<E: Equation> OverFootprint for E {
    fn hits(&self, line: &Line<Affine>, leaves: Option<usize>, met: &mut dyn FnMut(FootprintHit, usize)) {
        hits_along(self, line, leaves.is_some(), &mut |one| met(one, 0));
    }

    fn slope(&self, at: [Dual<Affine>; 3], _part: usize) -> Dual<Affine> {
        let point = Line { origin: at, dir: [Dual::constant(0.0); 3] };
        self.value(self.to_local(point).origin)
    }
}

/// Encloses the gradient of a part's equation at points: vectors along the normals.
pub fn gradient_over(shape: &(impl OverFootprint + ?Sized), at: [Affine; 3], part: usize) -> [Affine; 3] {
    [0, 1, 2].map(|axis| {
        let along = |other: usize| {
            if other == axis { Dual::variable(at[other]) } else { Dual::fixed(at[other]) }
        };
        shape.slope([along(0), along(1), along(2)], part).slope
    })
}

/// Calls `met` with the possible hits of a shape with t > 0, in order.
fn hits_along(
    shape: &dyn Values<Affine>,
    line: &Line<Affine>,
    leaves: bool,
    met: &mut dyn FnMut(FootprintHit),
) {
    let line = shape.to_local(*line);
    if shape.is_quadratic() {
        closed(shape, &line, leaves, met);
    } else {
        search(shape, &line, leaves, met);
    }
}

/// Tells whether the surface is kept at these t of all lines; `None` where that is uncertain.
fn is_kept(shape: &dyn Values<Affine>, line: &Line<Affine>, at: Affine) -> Option<bool> {
    let kept = shape.inside_trim(line.at(at)).range();
    if kept.low >= 0.0 {
        Some(true)
    } else if kept.has_zero() {
        None
    } else {
        Some(false)
    }
}

/// Finds the hits of a surface whose equation is a quadratic along a line.
fn closed(shape: &dyn Values<Affine>, line: &Line<Affine>, leaves: bool, met: &mut dyn FnMut(FootprintHit)) {
    for root in roots(coefficients(shape, line, leaves)).into_iter().flatten() {
        let (is_there, at) = match root {
            FootprintHit::Hits(at) => (true, at),
            FootprintHit::Perhaps(at) => (false, at),
            FootprintHit::Doubtful(_) => {
                met(root);
                continue;
            }
        };
        let range = at.range();
        if range.high <= 0.0 {
            continue;
        }
        match is_kept(shape, line, at) {
            Some(false) => {}
            _ if range.low <= 0.0 => met(FootprintHit::Doubtful(0.0)),
            Some(true) if is_there => return met(FootprintHit::Hits(at)),
            _ => met(FootprintHit::Perhaps(at)),
        }
    }
}

/// Computes the coefficients of `a t^2 + 2 b t + c`, the equation's value along the lines.
fn coefficients(shape: &dyn Values<Affine>, line: &Line<Affine>, leaves: bool) -> [Affine; 3] {
    let zero = Affine::constant(0.0);
    let at = [0, 1, 2].map(|axis| {
        let (origin, dir) = (line.origin[axis], line.dir[axis]);
        Jet { value: origin, first: dir, second: zero }
    });
    let value = shape.bend(at);
    let half = Affine::constant(0.5);
    [half * value.second, half * value.first, if leaves { zero } else { value.value }]
}

/// Returns the roots of a quadratic that may be positive, the nearer one first.
fn roots([a, b, c]: [Affine; 3]) -> [Option<FootprintHit>; 2] {
    let anywhere = [Some(FootprintHit::Doubtful(0.0)), None];
    if a.is_zero() {
        let twice = b + b;
        return if b.is_zero() {
            if c.has_zero() && !c.is_zero() { anywhere } else { [None, None] }
        } else if c.is_zero() {
            [None, None]
        } else if b.has_zero() {
            [Some(FootprintHit::Doubtful(farther_than(c, twice))), None]
        } else {
            [Some(FootprintHit::Hits(-c / twice)), None]
        };
    }
    if c.is_zero() && !a.has_zero() {
        // The start itself is the other root.
        return [Some(FootprintHit::Hits(-(b + b) / a)), None];
    }
    let discriminant = b * b - a * c;
    let range = discriminant.range();
    if range.high < 0.0 {
        return [None, None];
    }
    let is_there = range.low > 0.0;
    let root = |at: Affine| if is_there { FootprintHit::Hits(at) } else { FootprintHit::Perhaps(at) };
    let (length, side) = (discriminant.sqrt(), b.range());
    // Each root has two forms; this is the one whose sum does not cancel.
    let sum = if side.low > 0.0 {
        -(b + length)
    } else if side.high < 0.0 {
        length - b
    } else if a.has_zero() {
        return anywhere;
    } else {
        return in_order(root((length - b) / a), root((-length - b) / a));
    };
    let near = c / sum;
    if a.has_zero() {
        // Where the quadratic coefficient may be 0, the root other than `near` is far away, on either side.
        let far = farther_than(sum, a);
        if near.range().high >= far {
            return anywhere;
        }
        return [Some(root(near)), Some(FootprintHit::Doubtful(far))];
    }
    in_order(root(near), root(sum / a))
}

/// Returns two roots, the nearer one first. Where their order is uncertain, neither is certain to be the first.
fn in_order(one: FootprintHit, other: FootprintHit) -> [Option<FootprintHit>; 2] {
    let (near, far) = if lowest(&one) < lowest(&other) { (one, other) } else { (other, one) };
    match (near, far) {
        (FootprintHit::Hits(at), FootprintHit::Hits(next)) if at.range().high >= next.range().low => {
            [Some(FootprintHit::Perhaps(at)), Some(FootprintHit::Perhaps(next))]
        }
        _ => [Some(near), Some(far)],
    }
}

fn lowest(root: &FootprintHit) -> f64 {
    match root {
        FootprintHit::Hits(at) | FootprintHit::Perhaps(at) => at.range().low,
        FootprintHit::Doubtful(low) => *low,
    }
}

/// Returns a lower bound on the magnitude of the root of `a + b t`, where b may be 0.
fn farther_than(a: Affine, b: Affine) -> f64 {
    let (a, b) = (a.range(), b.range());
    let least = if a.has_zero() { 0.0 } else { a.low.abs().min(a.high.abs()) };
    let far = (Interval::point(least) / Interval::point(b.magnitude())).low;
    if far > 0.0 { far } else { 0.0 }
}

/// Finds the hits of any surface, by splitting the lines until each piece certainly has no root, or exactly one on
/// each line.
fn search(shape: &dyn Values<Affine>, line: &Line<Affine>, leaves: bool, met: &mut dyn FnMut(FootprintHit)) {
    let [low, high] = shape.widened_extent();
    let coarse = coarse(line);
    let Some((mut from, to)) = coarse.clip(low, high) else { return };
    if !to.is_finite() {
        return met(FootprintHit::Doubtful(from));
    }
    if leaves && from == 0.0 {
        match left(shape, line, to) {
            Some(length) => from = length,
            None => return met(FootprintHit::Doubtful(0.0)),
        }
    }
    let shortest = SHORTEST * (to - from);
    let mut pending = vec![(from, to)];
    // The pieces in which it is unknown whether there is a root.
    let mut open: Option<(f64, f64)> = None;
    for _ in 0..PIECES {
        let Some((low, high)) = pending.pop() else { break };
        let value = slope_at(shape, line, piece(low, high));
        if !value.value.has_zero() {
            continue;
        }
        if !value.slope.has_zero()
            && let Some(outcome) = only(shape, line, (low, high))
        {
            let Some(root) = outcome else { continue };
            let range = root.range();
            match is_kept(shape, line, root) {
                _ if range.high <= 0.0 => {}
                Some(false) => {}
                _ if range.low <= 0.0 => met(FootprintHit::Doubtful(0.0)),
                Some(true) => {
                    perhaps(shape, line, open, met);
                    return met(FootprintHit::Hits(root));
                }
                None => met(FootprintHit::Perhaps(root)),
            }
            continue;
        }
        if high - low < shortest {
            open = Some(open.map_or((low, high), |(from, _)| (from, high)));
            continue;
        }
        // Not in the middle, where the round numbers of scenes often put a root.
        let cut = low + 0.493 * (high - low);
        pending.extend([(cut, high), (low, cut)]);
    }
    perhaps(shape, line, open, met);
    if let Some((low, _)) = pending.last() {
        met(FootprintHit::Doubtful(*low));
    }
}

/// Calls `met` with a root that may be in a piece of the lines.
fn perhaps(
    shape: &dyn Values<Affine>,
    line: &Line<Affine>,
    open: Option<(f64, f64)>,
    met: &mut dyn FnMut(FootprintHit),
) {
    let Some((low, high)) = open else { return };
    let at = piece(low, high).absorbing(ALONG);
    match is_kept(shape, line, at) {
        Some(false) => {}
        _ if at.range().low <= 0.0 => met(FootprintHit::Doubtful(0.0)),
        _ => met(FootprintHit::Perhaps(at)),
    }
}

/// Returns a piece of the lines as a quantity of its own variable.
fn piece(low: f64, high: f64) -> Affine {
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    // A little longer, so that rounding leaves nothing out.
    Affine::variable(ALONG, middle, half + 2.0 * f64::EPSILON * (low.abs() + high.abs()))
}

fn slope_at(shape: &dyn Values<Affine>, line: &Line<Affine>, t: Affine) -> Dual<Affine> {
    shape.slope(line.along(Dual::variable(t)))
}

/// Encloses the only root that each line may have in a piece on which the value is strictly monotonic; `Some(None)`
/// where there is none, and `None` where that is open.
fn only(shape: &dyn Values<Affine>, line: &Line<Affine>, (low, high): (f64, f64)) -> Option<Option<Affine>> {
    let sign = |at: f64| {
        let value = shape.value(line.at(Affine::constant(at))).range();
        (!value.has_zero()).then_some(value.low > 0.0)
    };
    let (mut low, mut high) = (low, high);
    for _ in 0..3 {
        if let (Some(first), Some(last)) = (sign(low), sign(high)) {
            return Some((first != last).then(|| root(shape, line, low, high)).flatten());
        }
        // A root may lie where two pieces meet, for some of the lines.
        let margin = 0.5 * (high - low);
        (low, high) = (low - margin, high + margin);
        if slope_at(shape, line, piece(low, high)).slope.has_zero() {
            return None;
        }
    }
    None
}

/// Encloses the root that each line has in a piece, on which the slope is not 0, by the mean value theorem.
fn root(shape: &dyn Values<Affine>, line: &Line<Affine>, low: f64, high: f64) -> Option<Affine> {
    let (mut low, mut high) = (low, high);
    let mut root = None;
    for _ in 0..3 {
        let slope = slope_at(shape, line, piece(low, high)).slope;
        if slope.has_zero() {
            break;
        }
        let middle = 0.5 * (low + high);
        let next = Affine::constant(middle)
            - shape.value(line.at(Affine::constant(middle))) / slope.absorbing(ALONG);
        let range = next.range();
        root = Some(next);
        (low, high) = (low.max(range.low), high.min(range.high));
    }
    // The piece at least contains the root.
    root.or_else(|| Some(piece(low, high).absorbing(ALONG)))
}

/// Returns a length from the lines' starts, which lie on the surface, within which the value is strictly monotonic and
/// so has no other root; at most `to`. `None` where a line touches the surface, as far as is known.
fn left(shape: &dyn Values<Affine>, line: &Line<Affine>, to: f64) -> Option<f64> {
    let mut length = to;
    for _ in 0..HALVINGS {
        let slope = slope_at(shape, line, piece(0.0, length)).slope;
        if slope.is_bounded() && !slope.has_zero() {
            return Some(length);
        }
        length *= 0.5;
    }
    None
}

/// Encloses the coefficients of the lines.
pub fn coarse(line: &Line<Affine>) -> Line<Interval> {
    Line { origin: line.origin.map(|axis| axis.range()), dir: line.dir.map(|axis| axis.range()) }
}
