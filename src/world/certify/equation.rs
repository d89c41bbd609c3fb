//! Shapes as the solutions of equations, and what can be proven about their hits.

use crate::geometry::aabb::Aabb;
use crate::geometry::sight::Line;
use glam::DVec3;
use tabray_exact::dual::Dual;
use tabray_exact::formula::along::AlongLines;
use tabray_exact::formula::field::Field;
use tabray_exact::formula::written::Obstacle;
use tabray_exact::interval::{Float, Interval, Wide};
use tabray_exact::jet::Jet;
use tabray_exact::scalar::Scalar;

/// A shape given by an equation. Some of its solutions may be cut off.
///
/// The equation is written in the numbers of the scene. A plane's equation uses the normal as given, not a unit vector:
/// otherwise the proof would be about the rounded vector.
pub trait Equation {
    /// Whether [`value`](Self::value) is a polynomial of at most second degree, whose roots are found in closed form.
    const IS_QUADRATIC: bool = false;

    /// Transforms a line into the coordinates that the equation is written in; by default, those are world coordinates.
    fn to_local<N: Scalar>(&self, line: Line<N>) -> Line<N> {
        line
    }

    /// Encloses the coordinates u and v that [`Hittable::uv`] returns, before any rounding, of the points of the
    /// surface in a box; `None` where they are not known, which is always correct. Proofs of colours ask for them.
    ///
    /// [`Hittable::uv`]: crate::hittable::Hittable::uv
    fn uv_bounds(&self, _at: [Interval; 3]) -> Option<[Interval; 2]> {
        None
    }

    /// Returns the equation's value at a point: 0 on the surface, with opposite signs on the two sides.
    fn value<N: Scalar>(&self, at: [N; 3]) -> N;

    /// Returns a polynomial that has the sign of [`value`](Self::value) everywhere, if there is one within the degree
    /// limit of a [`Polynomial`](tabray_exact::polynomial::Polynomial).
    fn polynomial(&self) -> Option<&AlongLines> {
        None
    }

    /// Returns the formula that [`value`](Self::value) evaluates, if it is a formula of the scene.
    fn field(&self) -> Option<&Field> {
        None
    }

    /// Returns what keeps proofs from looking past the points of a box, if a formula of the scene tells.
    fn obstacle(&self, at: [Interval; 3]) -> Option<Obstacle> {
        Some(self.field()?.obstacle(&at))
    }

    /// Returns the estimated number of arithmetic operations of [`value`](Self::value), if that is a formula of the
    /// scene.
    fn cost(&self) -> usize {
        self.field().map_or(1, |field| field.formula().cost() as usize)
    }

    /// Returns a positive number where the surface is kept, 0 at its edge, which belongs to it, and a negative number
    /// where it is cut off.
    fn inside_trim<N: Scalar>(&self, _at: [N; 3]) -> N {
        N::constant(1.0)
    }

    /// Returns a positive number where a condition of the scene keeps the surface, and a negative one where it cuts the
    /// surface off, although the formula is defined there. It is part of [`inside_trim`](Self::inside_trim).
    fn condition<N: Scalar>(&self, _at: [N; 3]) -> N {
        N::constant(1.0)
    }

    /// Returns the low and the high corner of a box, in the equation's coordinates, that contains what
    /// [`inside_trim`](Self::inside_trim) keeps of the surface, up to rounding: proofs widen it. Surfaces that are not
    /// quadratic need a box. The box may be infinite along an axis, but the hits of a ray parallel to that axis are then
    /// in doubt.
    fn extent(&self) -> [DVec3; 2] {
        [DVec3::NEG_INFINITY, DVec3::INFINITY]
    }
}

/// An equation in one type of enclosing numbers. Proofs take it as a `dyn`, so that they are compiled once for each
/// number type, not once for each shape.
pub trait Values<N: Scalar> {
    /// Returns [`Equation::IS_QUADRATIC`].
    fn is_quadratic(&self) -> bool;

    /// Transforms a line into the coordinates that the equation is written in.
    fn to_local(&self, line: Line<N>) -> Line<N>;

    /// Returns [`Equation::polynomial`].
    fn polynomial(&self) -> Option<&AlongLines>;

    /// Returns [`Equation::field`].
    fn field(&self) -> Option<&Field>;

    /// Returns [`Equation::cost`].
    fn cost(&self) -> usize;

    /// Encloses the value.
    fn value(&self, at: [N; 3]) -> N;

    /// Encloses the value and its first derivative.
    fn slope(&self, at: [Dual<N>; 3]) -> Dual<N>;

    /// Encloses the value and its first two derivatives.
    fn bend(&self, at: [Jet<N>; 3]) -> Jet<N>;

    /// Returns a positive number where the surface is kept, and a negative one where it is cut off.
    fn inside_trim(&self, at: [N; 3]) -> N;

    /// Returns [`Equation::condition`].
    fn condition(&self, at: [N; 3]) -> N;

    /// Returns [`Equation::extent`].
    fn extent(&self) -> [DVec3; 2];

    /// Returns [`Equation::extent`], widened by the rounding of its numbers.
    fn widened_extent(&self) -> [DVec3; 2] {
        let [low, high] = self.extent();
        let Aabb { low, high } = Aabb { low, high }.with_slack(0.0);
        [low, high]
    }
}

impl<E: Equation, N: Scalar> Values<N> for E {
    fn is_quadratic(&self) -> bool {
        E::IS_QUADRATIC
    }

    fn to_local(&self, line: Line<N>) -> Line<N> {
        Equation::to_local(self, line)
    }

    fn polynomial(&self) -> Option<&AlongLines> {
        Equation::polynomial(self)
    }

    fn field(&self) -> Option<&Field> {
        Equation::field(self)
    }

    fn cost(&self) -> usize {
        Equation::cost(self)
    }

    fn value(&self, at: [N; 3]) -> N {
        Equation::value(self, at)
    }

    fn slope(&self, at: [Dual<N>; 3]) -> Dual<N> {
        Equation::value(self, at)
    }

    fn bend(&self, at: [Jet<N>; 3]) -> Jet<N> {
        Equation::value(self, at)
    }

    fn inside_trim(&self, at: [N; 3]) -> N {
        Equation::inside_trim(self, at)
    }

    fn condition(&self, at: [N; 3]) -> N {
        Equation::condition(self, at)
    }

    fn extent(&self) -> [DVec3; 2] {
        Equation::extent(self)
    }
}

/// An equation in the numbers of both precisions in which proofs are tried.
pub trait AnyNumber: Values<Interval> + Values<Wide> {}

impl<E: Equation> AnyNumber for E {}

/// What is certain about a first hit, with numbers of one precision; see [`Enclosure`](super::Enclosure).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HitEnclosure<F> {
    /// There is no hit.
    Misses,
    /// There is a hit at a t in this interval.
    Hits(Interval<F>),
    /// There is a hit at a t in this interval if the edge belongs to the surface.
    Edge(Interval<F>),
    /// There may be a hit, at no smaller t than this.
    Doubtful(F),
}

/// Tells whether the surface is kept at all distances of an interval along a line; `None` where that is uncertain.
pub(super) fn is_kept<F: Float>(
    shape: &dyn Values<Interval<F>>,
    line: &Line<Interval<F>>,
    distance: Interval<F>,
) -> Option<bool> {
    let kept = shape.inside_trim(line.at(distance));
    // The edge belongs to the surface.
    if kept.low >= F::of(0.0) {
        Some(true)
    } else if kept.has_zero() {
        None
    } else {
        Some(false)
    }
}

/// Tells whether the formula of a surface, as it was written, is defined at all distances of an interval along a line;
/// `None` where that is uncertain. Roots and logarithms of negative numbers are cut off by
/// [`inside_trim`](Equation::inside_trim).
fn is_defined<F: Float>(
    shape: &dyn Values<Interval<F>>,
    line: &Line<Interval<F>>,
    distance: Interval<F>,
) -> Option<bool> {
    match shape.field().filter(|field| field.divides()) {
        Some(field) => {
            let at = line.at(distance);
            // 53 bits, which take a hundredth of the time, decide nearly all.
            let coarsely = field.written().at(&at.map(Interval::coarse)).is_defined();
            let finely = || field.written().at(&at).is_defined();
            coarsely.or_else(|| if F::IS_LONG { finely() } else { None })
        }
        None => Some(true),
    }
}

/// Tells whether there may be a hit at the distances of an interval along a line, where the value may be 0.
pub(super) fn may_be_hit<F: Float>(
    shape: &dyn Values<Interval<F>>,
    line: &Line<Interval<F>>,
    distance: Interval<F>,
) -> bool {
    is_kept(shape, line, distance) != Some(false) && is_defined(shape, line, distance) != Some(false)
}

/// Returns what is certain about a hit at a root that exists at a place of a line, given its distance from the line's
/// start; `None` if it is no hit.
pub(super) fn hit_at<F: Float>(
    shape: &dyn Values<Interval<F>>,
    line: &Line<Interval<F>>,
    root: Interval<F>,
    distance: Interval<F>,
) -> Option<HitEnclosure<F>> {
    match (is_kept(shape, line, root), is_defined(shape, line, root)) {
        (Some(false), _) | (_, Some(false)) => None,
        (Some(true), Some(true)) => Some(HitEnclosure::Hits(distance)),
        (None, Some(true)) => Some(HitEnclosure::Edge(distance)),
        (_, None) => Some(HitEnclosure::Doubtful(distance.low)),
    }
}
