//! Shapes as the solutions of equations, and what can be proven about their hits.

use crate::geometry::sight::Line;
use crate::numeric::interval::{Float, Interval};
use crate::numeric::scalar::Scalar;
use glam::DVec3;

/// A shape given by an equation, of whose solutions a part is kept.
///
/// The equation is written in the numbers of the scene. A plane's equation uses the normal as given, not a unit vector:
/// otherwise the proof would be about the rounded vector.
pub trait Equation {
    /// Whether [`value`](Self::value) is a polynomial of at most second degree, whose roots are found in closed form.
    const IS_QUADRATIC: bool = false;

    /// Transforms a line into the coordinates that the equation is written in; by default, those are world coordinates.
    fn own<N: Scalar>(&self, line: Line<N>) -> Line<N> {
        line
    }

    /// Returns the equation's value at a point: 0 on the surface, with opposite signs on the two sides.
    fn value<N: Scalar>(&self, at: [N; 3]) -> N;

    /// Returns the estimated number of arithmetic operations of [`value`](Self::value), if that is a formula of the scene.
    fn cost(&self) -> usize {
        1
    }

    /// Returns a positive number where the surface is kept, and a negative number where it is cut off.
    fn kept<N: Scalar>(&self, _at: [N; 3]) -> N {
        N::constant(1.0)
    }

    /// Returns the low and the high corner of a box, in the equation's coordinates, outside of which nothing is kept.
    /// Surfaces that are not quadratic need one. The box may be infinite along an axis, but the hits of a ray parallel
    /// to that axis are then in doubt.
    fn extent(&self) -> [DVec3; 2] {
        [DVec3::NEG_INFINITY, DVec3::INFINITY]
    }
}

/// What is certain about a first hit, with numbers of one precision; see [`Enclosure`](super::Enclosure).
pub(super) enum Found<F> {
    Misses,
    Hits(Interval<F>),
    Edge(Interval<F>),
    Doubtful(F),
}

/// Tells whether the surface is kept at all distances of an interval along a line; `None` where that is uncertain.
pub(super) fn is_kept<F: Float>(
    shape: &impl Equation,
    line: &Line<Interval<F>>,
    distance: Interval<F>,
) -> Option<bool> {
    let kept = shape.kept(line.at(distance));
    if kept.has_zero() { None } else { Some(kept.low > F::of(0.0)) }
}
