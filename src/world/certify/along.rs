//! The first hit of a line, by the method that fits the equation.

use super::equation::{Equation, HitEnclosure, Values};
use super::{closed, search};
use crate::geometry::sight::Line;
use std::ops::RangeInclusive;
use tabray_exact::interval::{Float, Interval};

/// The number of arithmetic operations after which a search with 53 bits is given up, if each piece is evaluated once.
/// Of the rays of 180 wild formulas, those that were decided took at most an eighth of the pieces that this leaves.
pub(super) const OPERATIONS: usize = 20_000;

/// The same with 237 bits, where an operation takes as long as a hundred: a hit that 53 bits have left in doubt is
/// known to within a few units in the last place.
pub(super) const FINE_OPERATIONS: usize = 2_000;

/// The number of pieces that are examined however many operations a formula has, and the number after which the
/// search of any equation is given up.
const PIECES: RangeInclusive<usize> = 32..=2000;

/// Returns the number of pieces after which a search that may take so many operations is given up.
pub(super) fn most_pieces(shape: &impl Equation, operations: usize) -> usize {
    (operations / shape.cost().max(1)).clamp(*PIECES.start(), *PIECES.end())
}

/// Finds the first hit of a line given in world coordinates. With `leaves`, the line's true start lies on the shape.
pub(super) fn first_along<F: Float>(
    shape: &dyn Values<Interval<F>>,
    line: &Line<Interval<F>>,
    leaves: bool,
    mut pieces: usize,
) -> HitEnclosure<F> {
    let line = shape.to_local(*line);
    if shape.is_quadratic() {
        closed::first_hit(shape, &line, leaves)
    } else {
        search::first_hit(shape, &line, leaves, &mut pieces)
    }
}
