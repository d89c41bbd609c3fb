//! Shapes as the solutions of equations, and what can be certain about their hits.

use crate::geometry::sight::Line;
use crate::numeric::interval::{Float, Interval};
use crate::numeric::scalar::Scalar;
use glam::DVec3;

/// A shape as the solutions of an equation, of which a part is kept.
///
/// It is written in the numbers of the scene: a plane's equation has its normal as it is given, not a unit vector, whose
/// rounding would be proven along with it.
pub trait Equation {
    /// Whether [`value`](Self::value) is a polynomial of the second degree at most: its roots are found in closed form.
    const IS_QUADRATIC: bool = false;

    /// A line in the coordinates that the equation is written in; by default the world's.
    fn own<N: Scalar>(&self, line: Line<N>) -> Line<N> {
        line
    }

    /// 0 on the surface, and of different signs on its two sides.
    fn value<N: Scalar>(&self, at: [N; 3]) -> N;

    /// Above 0 where the surface is kept, below 0 where it is cut off.
    fn kept<N: Scalar>(&self, _at: [N; 3]) -> N {
        N::constant(1.0)
    }

    /// The low and the high corner of a box, in the equation's coordinates, outside of which nothing is kept. Surfaces
    /// that are no quadratics need one; it may be infinite in a direction that no ray has to itself.
    fn extent(&self) -> [DVec3; 2] {
        [DVec3::NEG_INFINITY, DVec3::INFINITY]
    }
}

/// What is certain, with numbers of one precision.
pub(super) enum Found<F> {
    Misses,
    Hits(Interval<F>),
    Edge(Interval<F>),
    Doubtful(F),
}

/// Whether the surface is kept where a line has one of these distances; nothing where that is not certain.
pub(super) fn is_kept<F: Float>(
    shape: &impl Equation,
    line: &Line<Interval<F>>,
    distance: Interval<F>,
) -> Option<bool> {
    let kept = shape.kept(line.at(distance));
    if kept.has_zero() { None } else { Some(kept.low > F::of(0.0)) }
}
