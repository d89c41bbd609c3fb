//! First hits of surfaces whose equation is a quadratic along a line: planes, spheres, cones and the like.

use super::equation::{HitEnclosure, Values, is_kept};
use crate::geometry::sight::Line;
use tabray_exact::interval::{Float, Interval};
use tabray_exact::jet::Jet;
use tabray_exact::scalar::{Scalar, per_axis};

/// A possible hit.
enum Candidate<F> {
    /// A root that exists, enclosed by this interval.
    Root(Interval<F>),
    /// A root that may exist; if it does, this interval encloses it.
    Perhaps(Interval<F>),
}

/// Finds the first hit with t > 0. The start of the line itself is not a hit; with `leaves`, the line's true start lies
/// on the surface, although its enclosure does not tell.
pub fn first_hit<F: Float>(
    shape: &dyn Values<Interval<F>>,
    line: &Line<Interval<F>>,
    leaves: bool,
) -> HitEnclosure<F> {
    let zero = F::of(0.0);
    let [a, b, c] = coefficients(shape, line);
    let c = if leaves { Interval::constant(0.0) } else { c };
    for candidate in candidates([a, b, c]).into_iter().flatten() {
        let (is_there, at) = match candidate {
            Candidate::Root(at) => (true, at),
            Candidate::Perhaps(at) => (false, at),
        };
        if at.high <= zero {
            continue;
        }
        match is_kept(shape, line, at) {
            Some(false) => {}
            _ if at.low <= zero => return HitEnclosure::Doubtful(zero),
            Some(true) if is_there => return HitEnclosure::Hits(at),
            None if is_there => return HitEnclosure::Edge(at),
            _ => return HitEnclosure::Doubtful(at.low),
        }
    }
    HitEnclosure::Misses
}

/// Computes the coefficients of `a t^2 + 2 b t + c`, the equation's value along the line.
fn coefficients<F: Float>(shape: &dyn Values<Interval<F>>, line: &Line<Interval<F>>) -> [Interval<F>; 3] {
    // The value and its derivatives are computed at t = 0, so that the start of the line is not rounded.
    let zero = Interval::constant(0.0);
    let at = per_axis(|axis| {
        let (origin, dir) = (line.origin[axis], line.dir[axis]);
        Jet { value: origin, first: dir, second: zero }
    });
    let value = shape.bend(at);
    let half = Interval::constant(0.5);
    [half * value.second, half * value.first, value.value]
}

/// Returns the roots, the nearer one first. A line that lies in the surface has none; for one that starts on the
/// surface, the start is an exact root at 0.
fn candidates<F: Float>([a, b, c]: [Interval<F>; 3]) -> [Option<Candidate<F>>; 2] {
    use Candidate::{Perhaps, Root};
    let beyond = |low: F| Interval { low, high: F::INFINITY };
    let anywhere = beyond(-F::INFINITY);
    let start = Interval::constant(0.0);
    if a.is_zero() {
        let two = Interval::constant(2.0);
        return if b.is_zero() {
            [(c.has_zero() && !c.is_zero()).then_some(Perhaps(anywhere)), None]
        } else if c.is_zero() {
            [Some(Root(start)), None]
        } else if b.has_zero() {
            [Some(Perhaps(beyond(farther_than(c, two * b)))), None]
        } else {
            [Some(Root(-c / (two * b))), None]
        };
    }
    if c.is_zero() && !a.has_zero() {
        return [Some(Root(start)), Some(Root(-(b + b) / a))];
    }
    let discriminant = b * b - a * c;
    if discriminant.high < F::of(0.0) {
        return [None, None];
    }
    let root = discriminant.sqrt();
    // Each root has two forms; this is the one whose sum does not cancel.
    let sum = if b.low > F::of(0.0) {
        -(b + root)
    } else if b.high < F::of(0.0) {
        root - b
    } else if a.has_zero() {
        return [Some(Perhaps(anywhere)), None];
    } else {
        return in_order((root - b) / a, (-root - b) / a, discriminant.low > F::of(0.0));
    };
    let near = if c.is_zero() { start } else { c / sum };
    let is_there = discriminant.low > F::of(0.0);
    if a.has_zero() {
        // Where the quadratic coefficient may be 0, the root other than `near` is far away, on either side.
        let far = farther_than(sum, a);
        if near.high >= far {
            return [Some(Perhaps(anywhere)), None];
        }
        let near = if is_there { Root(near) } else { Perhaps(near) };
        return [Some(near), Some(Perhaps(beyond(far)))];
    }
    in_order(near, sum / a, is_there)
}

/// Returns two roots, the nearer one first, or one enclosure of both where their order is uncertain.
fn in_order<F: Float>(one: Interval<F>, other: Interval<F>, is_there: bool) -> [Option<Candidate<F>>; 2] {
    let (near, far) = if one.low < other.low { (one, other) } else { (other, one) };
    if is_there && near.high < far.low {
        return [Some(Candidate::Root(near)), Some(Candidate::Root(far))];
    }
    // The order of the roots is uncertain, or they may not exist.
    [Some(Candidate::Perhaps(Interval { low: near.low, high: near.high.max(far.high) })), None]
}

/// Returns a lower bound on the magnitude of the root of `a + b t`, where b may be 0.
fn farther_than<F: Float>(a: Interval<F>, b: Interval<F>) -> F {
    let min_magnitude = if a.has_zero() { F::of(0.0) } else { a.low.abs().min(a.high.abs()) };
    (Interval::point(min_magnitude) / Interval::point(b.magnitude())).low.max(F::of(0.0))
}
