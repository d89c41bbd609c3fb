//! Sphere tracing: steps of the function's value divided by a bound of its slope, which cannot step past a root.
//!
//! J. C. Hart, "Sphere tracing" (1996), as used by shaders with distance fields. Here, the bound comes from interval
//! arithmetic over the whole span. Programs that ask the user for it, like POV-Ray for isosurfaces, may step over
//! surfaces if it is too low. A step below 1e-6 counts as a hit. A ray that only comes close thus counts as a hit, too,
//! and a ray along the surface takes very many steps.

use super::taylor::FunctionOnLine;
use crate::dual::Dual;
use crate::interval::Interval;
use crate::roots::range::Side;
use std::ops::Range;

/// The maximum step that counts as a hit, in world units.
const NEAR: f64 = 1e-6;

/// The number of steps after which the search gives up.
const MAX_STEPS: usize = 10_000;

pub fn first_root(line: &impl FunctionOnLine, span: Range<f64>, origin_side: Option<Side>) -> Option<f64> {
    let over = line.at(Dual::variable(Interval { low: span.start, high: span.end }));
    let steepest = over.slope.magnitude();
    if !steepest.is_finite() {
        return None;
    }
    let is_outside = origin_side.map_or_else(|| line.at(span.start) >= 0.0, |side| side == Side::Outside);
    let away = |t: f64| if is_outside { line.at(t) } else { -line.at(t) };
    // A line that starts on the surface must first move away from it.
    let mut is_away = origin_side.is_none();
    let mut t = span.start;
    for _ in 0..MAX_STEPS {
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
