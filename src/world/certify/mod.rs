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
use crate::numeric::double_double::DoubleDouble;
use crate::numeric::interval::{Float, Interval, Wide};
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
pub fn in_world_units(distance: Wide, sight: &Sight) -> DoubleDouble {
    rounded(distance.middle() * root(sight.squared_length::<Wide>().middle()))
}

/// Bounds of a distance in lengths of a sight's direction, in world units.
pub fn bounds_in_world_units(distance: Wide, sight: &Sight) -> Interval {
    let length = root(sight.squared_length::<Wide>().middle());
    // A unit in the last place of `f64` holds all that is rounded with so many bits.
    Interval {
        low: (distance.low * length).to_f64().next_down(),
        high: (distance.high * length).to_f64().next_up(),
    }
}

/// The middle of an interval, in twice the precision of `f64`.
pub fn middle(of: Wide) -> DoubleDouble {
    rounded(of.middle())
}

/// A number in twice the precision of `f64`.
fn rounded(of: f256) -> DoubleDouble {
    let high = of.to_f64();
    DoubleDouble { high, low: (of - f256::from(high)).to_f64() }
}

/// The square root to some 200 bits: a step of Newton's method from half of them takes a part of the time that all 237 do.
fn root(of: f256) -> f256 {
    let DoubleDouble { high, low } = rounded(of).sqrt();
    // The low parts of what is smaller, or squared in between, underflow.
    if !(1e-120..1e120).contains(&high) {
        return of.sqrt();
    }
    let start = f256::from(high) + f256::from(low);
    f256::from(0.5) * (start + of / start)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::interval::Float;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn roots_have_far_more_digits_than_twice_the_precision(high in 1.0..4.0, low in 0.0..1e-20, power in -1000..1000) {
            let scale = 2_f64.powi(power);
            let of = f256::from(scale) * (f256::from(high) + f256::from(low));
            let (found, truth) = (root(of), Float::sqrt(of));
            prop_assert!(Float::abs(found - truth) <= f256::from(2_f64.powi(-195)) * truth, "{:?}", of);
        }
    }
}
