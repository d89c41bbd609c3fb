//! What is certain about a ray's first hit, proven with outward-rounded intervals, apart from the way in which
//! pictures are made.
//!
//! A proof starts from the numbers of the scene: a shape's [`Equation`] is written in them, not in what its constructor
//! made of them, and the ray is a [`Sight`]. All that follows is computed with intervals, so that what is proven is
//! proven of the real numbers.

mod closed;
mod equation;
mod search;

pub use equation::Equation;

use crate::geometry::sight::Sight;
use crate::numeric::interval::{Float, Interval, Wide};
use crate::numeric::twofold::Twofold;
use equation::Found;
use f256::f256;

/// What is certain about the first hit of a shape. Distances count in lengths of the sight's direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Enclosure {
    /// There is none.
    Misses,
    /// There is one, at one of these distances.
    Hits(Wide),
    /// There is one, at one of these distances, if the edge of the surface belongs to it: the ray goes through that.
    Edge(Wide),
    /// There may be one, not nearer than this.
    Doubtful(f256),
}

impl Enclosure {
    /// Of a shape that says nothing.
    pub const UNKNOWN: Self = Self::Doubtful(f256::ZERO);
}

/// A distance in lengths of a sight's direction, in world units: the middle of what it may be.
pub fn in_world_units(distance: Wide, sight: &Sight) -> Twofold {
    middle(distance * sight.length())
}

/// Bounds of a distance in lengths of a sight's direction, in world units.
pub fn bounds_in_world_units(distance: Wide, sight: &Sight) -> Interval {
    let Interval { low, high } = distance * sight.length();
    Interval { low: low.to_f64().next_down(), high: high.to_f64().next_up() }
}

/// The middle of an interval, in twice the precision of `f64`.
pub fn middle(of: Wide) -> Twofold {
    let middle = of.middle();
    let high = middle.to_f64();
    Twofold { high, low: (middle - f256::from(high)).to_f64() }
}

/// How many bits a proof is tried with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// 53: enough nearly everywhere.
    Double,
    /// 237. What they leave open is as good as a tie.
    Octuple,
}

/// What is certain about the first hit of a shape.
pub fn first_hit(shape: &impl Equation, sight: &Sight, precision: Precision) -> Enclosure {
    match precision {
        Precision::Double => match solve::<f64>(shape, sight) {
            Found::Misses => Enclosure::Misses,
            Found::Hits(at) => Enclosure::Hits(at.into()),
            Found::Edge(at) => Enclosure::Edge(at.into()),
            Found::Doubtful(from) => Enclosure::Doubtful(from.into()),
        },
        Precision::Octuple => match solve::<f256>(shape, sight) {
            Found::Misses => Enclosure::Misses,
            Found::Hits(at) => Enclosure::Hits(at),
            Found::Edge(at) => Enclosure::Edge(at),
            Found::Doubtful(from) => Enclosure::Doubtful(from),
        },
    }
}

fn solve<F: Float>(shape: &impl Equation, sight: &Sight) -> Found<F> {
    let line = shape.own(sight.line());
    if is_quadratic(shape) { closed::first_hit(shape, &line) } else { search::first_hit(shape, &line) }
}

fn is_quadratic<E: Equation>(_: &E) -> bool {
    E::IS_QUADRATIC
}
