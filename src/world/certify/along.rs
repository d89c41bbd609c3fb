//! The first hit of a line, by the method that fits the equation.

use super::equation::{AnyNumber, HitEnclosure, Values};
use super::{closed, search};
use crate::geometry::sight::Line;
use std::ops::RangeInclusive;
use tabray_exact::interval::{Float, Interval};

/// When a search is given up.
pub(super) struct Budget {
    /// The number of arithmetic operations, if each piece of the line is evaluated once.
    operations: usize,
    /// The number of operations at a formula of a scene. A curve that is turned about an axis has more, as rounding may
    /// hide its rim.
    of_formulas: usize,
    /// The numbers of pieces that are examined at least and at most, whatever their operations.
    pieces: RangeInclusive<usize>,
}

/// The budget with 53 bits. Of 768 rays for each of 180 wild formulas, those that were decided took fewer than
/// 512 pieces. With as many operations for formulas as for the rest, 3 more of 3,792 rays at 250 random formulas were
/// decided, in up to three times the time; 237 bits had a quarter then, too.
pub(super) const COARSE: Budget = Budget { operations: 20_000, of_formulas: 5_000, pieces: 32..=2000 };

/// The budget with 237 bits, where an operation takes as long as a hundred. Those rays took fewer than 64.
pub(super) const FINE: Budget = Budget { operations: 2_000, of_formulas: 1_600, pieces: 16..=128 };

impl Budget {
    /// Returns the number of pieces after which a search is given up.
    pub fn pieces(&self, shape: &dyn AnyNumber) -> usize {
        let shape: &dyn Values<Interval> = shape;
        let operations = if shape.field().is_some() { self.of_formulas } else { self.operations };
        (operations / shape.cost().max(1)).clamp(*self.pieces.start(), *self.pieces.end())
    }
}

/// Finds the first hit of a line given in world coordinates. With `leaves`, the line's true start lies on the shape.
pub(super) fn first_along<F: Float>(
    shape: &dyn Values<Interval<F>>,
    line: &Line<Interval<F>>,
    leaves: bool,
    pieces: usize,
) -> HitEnclosure<F> {
    let line = shape.to_local(*line);
    if shape.is_quadratic() {
        closed::first_hit(shape, &line, leaves)
    } else {
        search::first_hit(shape, &line, leaves, pieces)
    }
}
