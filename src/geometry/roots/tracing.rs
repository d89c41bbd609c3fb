//! Steps that are as long as the function's value divided by a bound of its slope: none can go past a root.
//!
//! J. C. Hart, "Sphere tracing" (1996); what shaders with distance fields do. Here the bound comes from intervals over
//! all of the span; programs that ask the user for it, as POV-Ray's isosurfaces do, lose what a guess too low steps
//! over. A step below 1e-6 counts as a hit: a ray that only comes near is one, too, and one that runs along the
//! surface takes steps without end.

use super::taylor::FunctionOnLine;
use crate::geometry::ray::Side;
use crate::numeric::dual::Dual;
use crate::numeric::interval::Interval;
use std::ops::Range;

/// A step that counts as a hit.
const NEAR: f64 = 1e-6;

/// The steps after which a ray is given up.
const MOST: usize = 10_000;

pub fn first_root(line: &impl FunctionOnLine, span: Range<f64>, origin_side: Option<Side>) -> Option<f64> {
    let over = line.at(Dual::variable(Interval { low: span.start, high: span.end }));
    let steepest = over.slope.magnitude();
    if !steepest.is_finite() {
        return None;
    }
    let is_outside = origin_side.map_or_else(|| line.at(span.start) >= 0.0, |side| side == Side::Outside);
    let away = |t: f64| if is_outside { line.at(t) } else { -line.at(t) };
    // A line that starts on the surface has to get away from it first.
    let mut is_away = origin_side.is_none();
    let mut t = span.start;
    for _ in 0..MOST {
        let step = away(t) / steepest;
        is_away |= step > NEAR;
        if is_away && step <= NEAR {
            return Some(t);
        }
        t += step.max(NEAR);
        if t >= span.end {
            return None;
        }
    }
    None
}
