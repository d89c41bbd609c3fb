//! Proofs about rays that continue from a point of a surface: mirrored, transmitted and shadow rays.
//!
//! No number of such a ray comes from the scene. The coefficients of its line are intervals, and the line starts at the
//! true point on the surface, somewhere in an enclosure. The point is known to lie on the surface, although no interval
//! shows that.

use super::algebraic;
use super::along::{COARSE, FINE, first_along};
use super::equation::{AnyNumber, Equation, HitEnclosure, Values};
use super::footprint::OverFootprint;
use super::search;
use crate::emitter::{Chooses, EnclosedEmitter};
use crate::geometry::sight::Line;
use crate::packets::light::{PacketLight, Sends};
use crate::shader::{EnclosedShader, Looks};
use f256::f256;
use tabray_exact::affine::Affine;
use tabray_exact::dual::Dual;
use tabray_exact::formula::written::Obstacle;
use tabray_exact::interval::{Float, Fraction, Interval, Wide};
use tabray_exact::scalar::{Scalar, per_axis};

/// Proofs about a shape's hits along any line, in one precision.
pub trait HitProofs<F: Float> {
    /// Returns what is proven about a line's first hit with t > 0, and the part of the shape that is hit. The line is
    /// in world coordinates; `leaves` is the part on which the line's true start lies, if it lies on the shape.
    fn first_hit(&self, line: &Line<Interval<F>>, leaves: Option<usize>) -> (HitEnclosure<F>, usize);

    /// Returns what is proven about each of a line's hits with t > 0, in order, up to the first that is open; `None`
    /// where each hit can only be found from the one before. Each has the part that is hit.
    fn all_hits(
        &self,
        _line: &Line<Interval<F>>,
        _leaves: Option<usize>,
    ) -> Option<Vec<(HitEnclosure<F>, usize)>> {
        None
    }

    /// Encloses the value of the equation of a part at a point in world coordinates, and its derivative.
    fn slope(&self, at: [Dual<Interval<F>>; 3], part: usize) -> Dual<Interval<F>>;

    /// Returns the shape whose part a part of this one is, with the number that the part has there. Nothing more is said
    /// of the part than is known of that one. `None` for a shape of its own, and for one made of a shape without proofs: it
    /// has no proven hits, and so nothing is asked of its parts.
    fn source(&self, _part: usize) -> Option<(&dyn HitProofs<F>, usize)> {
        None
    }

    /// Transforms points to the world coordinates of the [source](Self::source).
    fn to_source(&self, at: [Interval<F>; 3]) -> [Interval<F>; 3] {
        at
    }

    /// Returns what keeps proofs from looking past the points of a part in a box in world coordinates, as far as its
    /// equation is a formula of the scene.
    fn obstacle(&self, at: [Interval<F>; 3], part: usize) -> Option<Obstacle> {
        let (source, part) = self.source(part)?;
        source.obstacle(self.to_source(at), part)
    }

    /// Tells whether a part has an equation. For a part without one, [`slope`](Self::slope) knows no value.
    fn has_equation(&self, part: usize) -> bool {
        self.source(part).is_none_or(|(source, part)| source.has_equation(part))
    }

    /// Encloses the unit normal with which a point of a part is shaded, where that normal differs from `normal`, the
    /// normal of the surface. It is turned to the ray where both sides are lit; `None` where it is open.
    fn shading_normal(
        &self,
        at: [Interval<F>; 3],
        part: usize,
        normal: [Interval<F>; 3],
    ) -> Option<[Interval<F>; 3]> {
        match self.source(part) {
            Some((source, part)) => source.shading_normal(self.to_source(at), part, normal),
            None => Some(normal),
        }
    }

    /// Encloses the coordinates u and v of the points of a part in a box in world coordinates; `None` where they are
    /// not known.
    fn uv_bounds(&self, at: [Interval<F>; 3], part: usize) -> Option<[Interval; 2]> {
        let (source, part) = self.source(part)?;
        source.uv_bounds(self.to_source(at), part)
    }

    /// Returns the index of a part's face, as [`Hittable::face`] tells it, if the parts of the shape are faces.
    ///
    /// [`Hittable::face`]: crate::hittable::Hittable::face
    fn face_of(&self, part: usize) -> Option<u32> {
        let (source, part) = self.source(part)?;
        source.face_of(part)
    }

    /// Returns the index of the face on which the points of a part in a box in world coordinates lie, as
    /// [`Hittable::face`] tells it; `None` where it is not known.
    ///
    /// [`Hittable::face`]: crate::hittable::Hittable::face
    fn face(&self, at: [Interval<F>; 3], part: usize) -> Option<u32> {
        let (source, part) = self.source(part)?;
        source.face(self.to_source(at), part)
    }
}

/// Proofs about a shape's hits along any line, in every precision.
pub trait ProofMethods: HitProofs<f64> + HitProofs<Fraction> + OverFootprint {}

impl<T: HitProofs<f64> + HitProofs<Fraction> + OverFootprint> ProofMethods for T {}

impl<E: Equation, F: Precise> HitProofs<F> for E {
    fn first_hit(&self, line: &Line<Interval<F>>, leaves: Option<usize>) -> (HitEnclosure<F>, usize) {
        (F::along(self, line, leaves.is_some()), 0)
    }

    fn all_hits(
        &self,
        line: &Line<Interval<F>>,
        leaves: Option<usize>,
    ) -> Option<Vec<(HitEnclosure<F>, usize)>> {
        let all = F::all_along(self, line, leaves.is_some())?;
        Some(all.into_iter().map(|hit| (hit, 0)).collect())
    }

    fn slope(&self, at: [Dual<Interval<F>>; 3], _part: usize) -> Dual<Interval<F>> {
        let point = Line { origin: at, dir: [Dual::constant(0.0); 3] };
        self.value(self.to_local(point).origin)
    }

    fn obstacle(&self, at: [Interval<F>; 3], _part: usize) -> Option<Obstacle> {
        Equation::obstacle(self, own_box(self, at))
    }

    fn uv_bounds(&self, at: [Interval<F>; 3], _part: usize) -> Option<[Interval; 2]> {
        Equation::uv_bounds(self, own_box(self, at))
    }
}

/// Transforms a box into the coordinates that an equation is written in.
fn own_box<F: Float>(shape: &impl Equation, at: [Interval<F>; 3]) -> [Interval; 3] {
    let point = Line { origin: at.map(Interval::coarse), dir: [Interval::constant(0.0); 3] };
    shape.to_local(point).origin
}

/// Encloses the gradient of a part's equation at a point: a vector along the normal.
pub fn gradient<F: Float>(
    shape: &(impl HitProofs<F> + ?Sized),
    at: [Interval<F>; 3],
    part: usize,
) -> [Interval<F>; 3] {
    per_axis(|axis| {
        let along = |other: usize| {
            if other == axis { Dual::variable(at[other]) } else { Dual::fixed(at[other]) }
        };
        shape.slope([along(0), along(1), along(2)], part).slope
    })
}

/// Encloses the unit normals with which points of a part are shaded; `None` where they are open.
pub fn shading_normals(
    shape: &(impl HitProofs<f64> + ?Sized),
    at: [Affine; 3],
    part: usize,
    normal: [Affine; 3],
) -> Option<[Affine; 3]> {
    let given = normal.map(|axis| axis.range());
    let shaded = shape.shading_normal(at.map(|axis| axis.range()), part, given)?;
    Some(if shaded == given { normal } else { shaded.map(Affine::from) })
}

/// A precision that proofs are tried in.
pub trait Precise: Float {
    /// Returns a shape's proofs in this precision.
    fn proofs(shape: &dyn ProofMethods) -> &dyn HitProofs<Self>;

    /// Returns what is proven about a line's first hit. With `leaves`, the line's true start lies on the shape.
    fn along(shape: &dyn AnyNumber, line: &Line<Interval<Self>>, leaves: bool) -> HitEnclosure<Self>;

    /// Returns what is proven about each of a line's hits, as [`HitProofs::all_hits`] does.
    fn all_along(
        shape: &dyn AnyNumber,
        line: &Line<Interval<Self>>,
        leaves: bool,
    ) -> Option<Vec<HitEnclosure<Self>>>;

    /// Returns a shader of any type, to be asked in intervals of this precision.
    fn looks(of: &dyn EnclosedShader) -> &dyn Looks<Interval<Self>>;

    /// Returns a light of any type, to be asked in intervals of this precision.
    fn sends(of: &dyn PacketLight) -> &dyn Sends<Interval<Self>>;

    /// Returns an extended light of any type, to be asked in intervals of this precision.
    fn chooses(of: &dyn EnclosedEmitter) -> &dyn Chooses<Interval<Self>>;

    /// Converts an interval, rounded outward. Numbers that need no rounding stay as they are.
    fn narrow(of: Wide) -> Interval<Self>;

    /// Converts an interval, exactly.
    fn widen(of: Interval<Self>) -> Wide;
}

impl Precise for f64 {
    fn proofs(shape: &dyn ProofMethods) -> &dyn HitProofs<Self> {
        shape
    }

    fn along(shape: &dyn AnyNumber, line: &Line<Interval>, leaves: bool) -> HitEnclosure<Self> {
        let hit = algebraic::first_hit::<f64>(shape, line, leaves);
        hit.unwrap_or_else(|| first_along(shape, line, leaves, COARSE.pieces(shape)))
    }

    fn all_along(
        shape: &dyn AnyNumber,
        line: &Line<Interval>,
        leaves: bool,
    ) -> Option<Vec<HitEnclosure<Self>>> {
        algebraic::all_hits::<f64>(shape, line, leaves)
    }

    fn looks(of: &dyn EnclosedShader) -> &dyn Looks<Interval<Self>> {
        of
    }

    fn sends(of: &dyn PacketLight) -> &dyn Sends<Interval<Self>> {
        of
    }

    fn chooses(of: &dyn EnclosedEmitter) -> &dyn Chooses<Interval<Self>> {
        of
    }

    fn narrow(of: Wide) -> Interval {
        of.coarse()
    }

    fn widen(of: Interval) -> Wide {
        of.into()
    }
}

impl Precise for Fraction {
    fn proofs(shape: &dyn ProofMethods) -> &dyn HitProofs<Self> {
        shape
    }

    fn along(shape: &dyn AnyNumber, line: &Line<Wide>, leaves: bool) -> HitEnclosure<Self> {
        if let Some(hit) = algebraic::first_hit::<f256>(shape, line, leaves) {
            return hit;
        }
        if Values::<Wide>::is_quadratic(shape) {
            return first_along(shape, line, leaves, 0);
        }
        let pieces = [COARSE.pieces(shape), FINE.pieces(shape)];
        search::first_hit_in_turns((shape, shape), &Values::<Wide>::to_local(shape, *line), leaves, pieces)
    }

    fn all_along(shape: &dyn AnyNumber, line: &Line<Wide>, leaves: bool) -> Option<Vec<HitEnclosure<Self>>> {
        algebraic::all_hits::<f256>(shape, line, leaves)
    }

    fn looks(of: &dyn EnclosedShader) -> &dyn Looks<Interval<Self>> {
        of
    }

    fn sends(of: &dyn PacketLight) -> &dyn Sends<Interval<Self>> {
        of
    }

    fn chooses(of: &dyn EnclosedEmitter) -> &dyn Chooses<Interval<Self>> {
        of
    }

    fn narrow(of: Wide) -> Wide {
        of
    }

    fn widen(of: Wide) -> Wide {
        of
    }
}
