//! The searched part of a line.

use std::ops::Range;

/// The rounding error of each coordinate of a point that is transformed into a frame, as a fraction of the point's
/// distance from the frame's origin. In units of EPSILON, the axes contribute 3, the rotation 3/2 and the vector from
/// the origin 1. The error of a direction is smaller.
pub const BLUR: f64 = 6.0 * f64::EPSILON;

/// The searched part of a line.
#[derive(Clone, Debug)]
pub struct Stretch {
    /// Contains the part between the ends, for all lines that may have been rounded to this one.
    pub outer: Range<f64>,
    /// Certainly lies between the ends, for all of these lines.
    pub inner: Range<f64>,
}

impl From<Range<f64>> for Stretch {
    fn from(span: Range<f64>) -> Self {
        Self { outer: span.clone(), inner: span }
    }
}

impl Stretch {
    /// Cuts off the parts beyond two heights. The line's height at `t` is `start + t dir`. Rounding may have moved
    /// `start` by `blur` and `dir` by `turn`, at least [`BLUR`]. The search goes no farther than `reach` from t = 0.
    /// All are in world units.
    pub fn cut(
        &mut self,
        (start, dir): (f64, f64),
        [low, high]: [f64; 2],
        [blur, turn]: [f64; 2],
        reach: f64,
    ) {
        // The exact line may be parallel to the ends.
        if dir.abs() <= 2.0 * turn {
            let moved = blur + 3.0 * turn * reach;
            if start < low - moved || start > high + moved {
                self.outer.end = f64::NEG_INFINITY;
            }
            if start < low + moved || start > high - moved {
                self.inner.end = f64::NEG_INFINITY;
            }
            return;
        }
        let (one, other) = ((low - start) / dir, (high - start) / dir);
        // The exact direction is more than half of the rounded one, and the error of the division itself is less than
        // BLUR.
        let margin = |t: f64| 2.0 * (blur + turn * t.abs()) / dir.abs() + BLUR * t.abs();
        let (first, last) = (one.min(other), one.max(other));
        self.outer = self.outer.start.max(first - margin(first))..self.outer.end.min(last + margin(last));
        self.inner = self.inner.start.max(first + margin(first))..self.inner.end.min(last - margin(last));
    }
}
