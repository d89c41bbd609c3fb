//! The first hit of a line, by the method that fits the equation.

use super::equation::{Equation, HitEnclosure, Values};
use super::{closed, search};
use crate::geometry::sight::Line;
use tabray_exact::interval::{Float, Interval};

/// The maximum number of pieces of a line that are examined before a search is given up.
pub(super) const PIECES: usize = 2000;

/// The maximum number of operations with 237 bits that a search may take if each piece is evaluated once. Where most of
/// them are exponential functions, that is about 5 ms; only formulas are given up before [`PIECES`].
const OPERATIONS: usize = 2_000;

/// Returns the number of pieces after which a search with 237 bits is given up.
pub(super) fn most_pieces(shape: &impl Equation) -> usize {
    PIECES.min(OPERATIONS / shape.cost().max(1))
}

/// Finds the first hit of a line given in world coordinates. With `leaves`, the line's true start lies on the shape.
/// `possible` bounds the first possible hit, if coarser numbers have found it.
pub(super) fn first_along<F: Float>(
    shape: &dyn Values<Interval<F>>,
    line: &Line<Interval<F>>,
    leaves: bool,
    pieces: usize,
    possible: Option<Interval<F>>,
) -> HitEnclosure<F> {
    let line = shape.to_local(*line);
    if shape.is_quadratic() {
        closed::first_hit(shape, &line, leaves)
    } else {
        search::first_hit(shape, &line, leaves, pieces, possible)
    }
}
