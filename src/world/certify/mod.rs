//! What is certain about a ray's first hit, proven in outward-rounded interval arithmetic. Rendering asks for these
//! proofs only where its own arithmetic leaves a hit open.
//!
//! A proof starts from the numbers of the scene: a shape's [`Equation`] is written in them, not in what its
//! constructor derived from them, and the ray is a [`Sight`]. Everything after that is computed with intervals, so a
//! proof holds for the real numbers.

mod algebraic;
mod along;
mod check;
mod closed;
mod doubt;
mod equation;
mod footprint;
mod hit_proofs;
mod premise;
mod search;

pub use algebraic::exact_line;
pub use doubt::Doubt;
pub use equation::{Equation, HitEnclosure};
pub use footprint::{FootprintHit, OverFootprint, coarse, gradient_over};
pub use hit_proofs::{HitProofs, Precise, ProofMethods, gradient, shading_normals};
pub use premise::{Assumption, Premise};

use crate::geometry::aabb::Aabb;
use crate::geometry::sight::{Line, Sight};
use equation::AnyNumber;
use glam::DVec3;
use tabray_exact::affine::Affine;
use tabray_exact::double_double::DoubleDouble;
use tabray_exact::interval::{Float, Fraction, Interval, Wide};
use tabray_exact::scalar::{Scalar, per_axis};

/// What is proven about a ray's first hit of a shape. Distances are multiples of the length of the sight's direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Enclosure {
    /// There is no hit.
    Misses,
    /// There is a hit, and this interval encloses its distance.
    Hits(Wide),
    /// The ray passes through the edge of the surface: there is a hit in this interval if the edge belongs to the
    /// surface.
    Edge(Wide),
    /// There may be a hit, no nearer than this distance.
    Doubtful(Fraction),
}

impl From<HitEnclosure<f64>> for Enclosure {
    fn from(of: HitEnclosure<f64>) -> Self {
        match of {
            HitEnclosure::Misses => Self::Misses,
            HitEnclosure::Hits(at) => Self::Hits(at.into()),
            HitEnclosure::Edge(at) => Self::Edge(at.into()),
            HitEnclosure::Doubtful(from) => Self::Doubtful(from.into()),
        }
    }
}

impl From<HitEnclosure<Fraction>> for Enclosure {
    fn from(of: HitEnclosure<Fraction>) -> Self {
        match of {
            HitEnclosure::Misses => Self::Misses,
            HitEnclosure::Hits(at) => Self::Hits(at),
            HitEnclosure::Edge(at) => Self::Edge(at),
            HitEnclosure::Doubtful(from) => Self::Doubtful(from),
        }
    }
}

/// Converts the midpoint of an enclosed distance from lengths of a sight's direction to world units.
pub fn in_world_units(distance: Wide, sight: &Sight) -> DoubleDouble {
    rounded(distance.middle() * root(sight.squared_length::<Wide>().middle()))
}

/// Converts the bounds of an enclosed distance from lengths of a sight's direction to world units, rounded outward.
pub fn bounds_in_world_units(distance: Wide, sight: &Sight) -> Interval {
    let length = root(sight.squared_length::<Wide>().middle());
    // One ulp of `f64` covers the rounding errors of arithmetic with some 200 bits.
    Interval {
        low: (distance.low * length).to_f64().next_down(),
        high: (distance.high * length).to_f64().next_up(),
    }
}

/// Returns the midpoint of an interval as a double-double number.
pub fn middle(of: Wide) -> DoubleDouble {
    rounded(of.middle())
}

/// Rounds a number to a double-double number.
fn rounded(of: Fraction) -> DoubleDouble {
    let high = of.to_f64();
    DoubleDouble { high, low: (of - Fraction::from(high)).to_f64() }
}

/// Computes the square root to some 195 bits. One step of Newton's method from a double-double root is faster than the
/// root to all 237 bits.
fn root(of: Fraction) -> Fraction {
    let DoubleDouble { high, low } = rounded(of).sqrt();
    // Outside of this range, the low parts of intermediate results may underflow.
    if !(1e-120..1e120).contains(&high) {
        return of.sqrt();
    }
    let start = Fraction::from(high) + Fraction::from(low);
    Fraction::from(0.5) * (start + of / start)
}

/// The precision in which a proof is tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// 53 bits, which decide nearly all rays.
    Double,
    /// 237 bits. What they leave open counts as a tie.
    Octuple,
}

/// Returns what is proven about a ray's first hit of a shape.
pub fn first_hit(shape: &impl Equation, sight: &Sight, precision: Precision) -> Enclosure {
    first_hit_of(shape, sight, precision)
}

/// Returns the result of [`first_hit`]. It takes a `dyn`, to be compiled once and not for each shape.
fn first_hit_of(shape: &dyn AnyNumber, sight: &Sight, precision: Precision) -> Enclosure {
    match precision {
        Precision::Double => f64::along(shape, &sight.line(), false).into(),
        Precision::Octuple => {
            let exact = algebraic::exact_hit(shape, sight);
            exact.unwrap_or_else(|| Fraction::along(shape, &sight.line(), false)).into()
        }
    }
}

/// Returns what is proven about a ray's first hit of a shape, and the part that is hit.
pub fn first_part(shape: &dyn ProofMethods, sight: &Sight, precision: Precision) -> (Enclosure, usize) {
    first_part_from(shape, sight, precision, (None, 0.0))
}

/// Returns what is proven about the first hit of a shape, and the part that is hit, by each ray that starts at most `error`
/// world units along each axis from the origin of the sight; of those that start on a part of this shape, if one is given.
/// That start is no hit.
pub fn first_part_from(
    shape: &dyn ProofMethods,
    sight: &Sight,
    precision: Precision,
    (part, error): (Option<usize>, f64),
) -> (Enclosure, usize) {
    fn found<F: Precise>(
        shape: &dyn ProofMethods,
        sight: &Sight,
        (part, error): (Option<usize>, f64),
    ) -> (Enclosure, usize)
    where
        Enclosure: From<HitEnclosure<F>>,
    {
        let (found, part) = F::proofs(shape).first_hit(&line_from(sight, error), part);
        (found.into(), part)
    }
    match precision {
        Precision::Double => found::<f64>(shape, sight, (part, error)),
        Precision::Octuple => found::<Fraction>(shape, sight, (part, error)),
    }
}

/// Returns the line of each ray that starts at most `error` world units along each axis from the origin of a sight.
pub fn line_from<F: Float>(sight: &Sight, error: f64) -> Line<Interval<F>> {
    let line = sight.line::<Interval<F>>();
    if error == 0.0 {
        return line;
    }
    let off = Interval::<F>::point(F::of(error));
    let origin = line.origin.map(|at| Interval { low: (at - off).low, high: (at + off).high });
    Line { origin, ..line }
}

/// Returns what a bounding box says about a line's first hit of a shape without an equation: nothing nearer than the
/// box, and nothing where the line misses it.
pub(crate) fn first_hit_in(bounds: Option<Aabb>, line: &Line<Interval>) -> HitEnclosure<f64> {
    let Some(Aabb { low, high }) = bounds else { return HitEnclosure::Doubtful(0.0) };
    match line.clip(low, high) {
        Some((from, _)) => HitEnclosure::Doubtful(from),
        None => HitEnclosure::Misses,
    }
}

/// Tells whether a point lies inside of a closed surface, where the equation is below 0; `None` where the surface may
/// pass through the box that extends `error` world units from the point along each axis.
pub fn contains<E: Equation>(shape: &E, at: DVec3, error: f64) -> Option<bool> {
    let origin = at.to_array().map(|place| Interval { low: place - error, high: place + error });
    let Line { origin, .. } = shape.to_local(Line { origin, dir: [Interval::constant(0.0); 3] });
    let [low, high] = shape.extent();
    if (0..3).any(|axis| origin[axis].high < low[axis] || origin[axis].low > high[axis]) {
        return Some(false);
    }
    let mut value = shape.value(origin);
    if value.has_zero() && !E::IS_QUADRATIC && error > 0.0 {
        // Intervals are far too wide where terms cancel, as they do near a node.
        let origin = per_axis(|axis| Affine::variable(axis, at[axis], error));
        let line = shape.to_local(Line { origin, dir: [Affine::constant(0.0); 3] });
        value = shape.value(line.origin).range();
    }
    let is_inside = value.high < 0.0;
    // Where the box cuts off the inside, its faces are part of the surface.
    let is_cut =
        is_inside && (0..3).any(|axis| origin[axis].low < low[axis] || origin[axis].high > high[axis]);
    (!value.has_zero() && !is_cut).then_some(is_inside)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use tabray_exact::interval::Float;

    proptest! {
        #![proptest_config(crate::properties())]

        #[test]
        fn roots_have_far_more_digits_than_twice_the_precision(high in 1.0..4.0, low in 0.0..1e-20, power in -1000..1000) {
            let scale = 2_f64.powi(power);
            let of = Fraction::from(scale) * (Fraction::from(high) + Fraction::from(low));
            let (found, truth) = (root(of), Float::sqrt(of));
            prop_assert!(Float::abs(found - truth) <= Fraction::from(2_f64.powi(-195)) * truth, "{:?}", of);
        }
    }
}
