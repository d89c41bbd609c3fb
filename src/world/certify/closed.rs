//! First hits of surfaces whose equation is a quadratic along a line: planes, balls, cones and the like.

use super::equation::{Equation, Found, is_kept};
use crate::geometry::sight::Line;
use crate::numeric::dual::Dual;
use crate::numeric::interval::{Float, Interval};
use crate::numeric::scalar::Scalar;

/// What may be a hit.
enum Candidate<F> {
    /// A root that is there, at one of these distances.
    Root(Interval<F>),
    /// One that may be there, at one of these.
    Perhaps(Interval<F>),
}

/// The first hit from t = 0 on, where the line itself starts on nothing.
pub fn first_hit<F: Float>(shape: &impl Equation, line: &Line<Interval<F>>) -> Found<F> {
    let zero = F::of(0.0);
    for candidate in candidates(coefficients(shape, line)).into_iter().flatten() {
        let (is_there, at) = match candidate {
            Candidate::Root(at) => (true, at),
            Candidate::Perhaps(at) => (false, at),
        };
        if at.high <= zero {
            continue;
        }
        if at.low <= zero {
            return Found::Doubtful(zero);
        }
        match is_kept(shape, line, at) {
            Some(true) if is_there => return Found::Hits(at),
            None if is_there => return Found::Edge(at),
            Some(false) => {}
            _ => return Found::Doubtful(at.low),
        }
    }
    Found::Misses
}

/// The coefficients of `a t^2 + 2 b t + c`, the value along the line.
fn coefficients<F: Float>(shape: &impl Equation, line: &Line<Interval<F>>) -> [Interval<F>; 3] {
    // The line itself with its derivatives, so that where it starts nothing is rounded.
    let zero = Interval::constant(0.0);
    let at = [0, 1, 2].map(|axis| {
        let (origin, dir) = (line.origin[axis], line.dir[axis]);
        Dual { value: Dual { value: origin, slope: dir }, slope: Dual { value: dir, slope: zero } }
    });
    let value = shape.value(at);
    let half = Interval::constant(0.5);
    [half * value.second(), half * value.first(), value.value.value]
}

/// The roots, the nearer one first. A line within the surface, or that starts on it, does not meet it there.
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
    let discriminant = b * b - a * c;
    if discriminant.high < F::of(0.0) {
        return [None, None];
    }
    let root = discriminant.sqrt();
    // Of the two forms of each root, the one whose sum does not cancel.
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
        // The other one is far away, on either side.
        let far = farther_than(sum, a);
        if near.high >= far {
            return [Some(Perhaps(anywhere)), None];
        }
        let near = if is_there { Root(near) } else { Perhaps(near) };
        return [Some(near), Some(Perhaps(beyond(far)))];
    }
    in_order(near, sum / a, is_there)
}

/// Two roots, the nearer one first.
fn in_order<F: Float>(one: Interval<F>, other: Interval<F>, is_there: bool) -> [Option<Candidate<F>>; 2] {
    let (near, far) = if one.low < other.low { (one, other) } else { (other, one) };
    if is_there && near.high < far.low {
        return [Some(Candidate::Root(near)), Some(Candidate::Root(far))];
    }
    // Which is which is not certain.
    [Some(Candidate::Perhaps(Interval { low: near.low, high: near.high.max(far.high) })), None]
}

/// How far away the root of `a + b t` is at least, where b may be 0.
fn farther_than<F: Float>(a: Interval<F>, b: Interval<F>) -> F {
    let least = if a.has_zero() { F::of(0.0) } else { a.low.abs().min(a.high.abs()) };
    (Interval::point(least) / Interval::point(b.magnitude())).low.max(F::of(0.0))
}
