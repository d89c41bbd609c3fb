//! Why the first hit of a ray stays open.

use super::hit_proofs::{HitProofs, ProofMethods};
use crate::geometry::sight::Sight;
use std::fmt;
use std::iter::successors;
use std::sync::Arc;
use tabray_exact::dual::Dual;
use tabray_exact::formula::written::Obstacle;
use tabray_exact::interval::{Float, Fraction, Wide};

/// Why a proof with 237 bits leaves a ray's first hit of a shape open.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Doubt {
    /// The equation and its slope along the ray are 0 at one point, as far as 237 bits tell: where the ray touches the
    /// surface, or where a factor of the equation is squared.
    Touched,
    /// The formula may not be defined there, by this operation.
    Undefined(Arc<str>),
    /// The equation jumps; in a formula, by this operation.
    Jumps(Option<Arc<str>>),
    /// The equation does not jump there, but its slope has no bound.
    Steep,
    /// The ray does not touch the surface, and the equation does not jump: the search needs more digits or more steps.
    /// What the ray comes to next is where this operation of the formula is not defined, or jumps.
    Long(Option<Arc<str>>),
    /// The surface is given by u and v, without an equation. Krawczyk's test decides nothing where the derivatives by
    /// u and v are parallel or 0, or where two sheets are equally far, as far as 237 bits tell.
    Singular,
}

/// Displays the reason, phrased to follow the name of an object.
impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Touched => f.write_str("is 0 without a change of sign"),
            Self::Undefined(operation) => write!(f, "may be undefined, by `{operation}`"),
            Self::Jumps(None) => f.write_str("is not continuous there"),
            Self::Jumps(Some(operation)) => write!(f, "may not be continuous there, by `{operation}`"),
            Self::Steep => f.write_str("has no bounded slope"),
            Self::Singular => f.write_str("has a pole or a fold there, or meets itself"),
            Self::Long(None) => f.write_str("takes more than 237 bits, or more steps than are tried"),
            Self::Long(Some(operation)) => {
                write!(f, "takes more than 237 bits, or more steps than are tried, near `{operation}`")
            }
        }
    }
}

/// The widths of the places that are examined, as fractions of the distance. The first is far wider than the
/// uncertainty of a root with 237 bits, and far narrower than that with `f64`. The second is wider than the pieces to
/// which a search cuts a jump.
const TOUCH: f64 = 1e-30;
const JUMP: f64 = 128.0 * f64::EPSILON;

/// The number of halvings of a place in which the value may jump, each of which keeps the half with the larger change.
/// The change of a continuous value soon falls below half of the first.
const HALVINGS: usize = 24;

/// How much wider the next place is where an obstacle is looked for.
const WIDENING: f64 = 16.0;

/// The maximum number of letters of an operation.
const MAX_LETTERS: usize = 48;

impl Doubt {
    /// Returns why the first hit of a shape is open from a distance on, in lengths of the sight's direction.
    pub fn of(shape: &dyn ProofMethods, sight: &Sight, from: Fraction) -> Self {
        if !HitProofs::<Fraction>::has_equation(shape, 0) {
            return Self::Singular;
        }
        let line = sight.line::<Wide>();
        let within = |width: f64| {
            let place = Wide { low: from, high: from * (Fraction::of(1.0) + Fraction::from(width)) };
            let at = line.along(Dual::variable(place));
            let Dual { value, slope }: Dual<Wide> = HitProofs::<Fraction>::slope(shape, at, 0);
            (value.has_zero(), slope)
        };
        if let (true, slope) = within(TOUCH)
            && slope.is_bounded()
            && slope.has_zero()
        {
            return Self::Touched;
        }
        let obstacle = |width: f64| {
            let place = Wide { low: from, high: from * (Fraction::of(1.0) + Fraction::from(width)) };
            HitProofs::<Fraction>::obstacle(shape, line.at(place), 0)
        };
        match within(JUMP) {
            (true, slope) if !slope.is_bounded() => {
                let value = |at: Fraction| {
                    let at = line.along(Dual::variable(Wide::point(at)));
                    HitProofs::<Fraction>::slope(shape, at, 0).value.middle()
                };
                let jumps = || jumps(value, from, from * (Fraction::of(1.0) + Fraction::from(JUMP)));
                match obstacle(JUMP) {
                    Some(Obstacle::Undefined(operation)) => Self::Undefined(shortened(&operation)),
                    Some(Obstacle::Jump(operation)) if jumps() => Self::Jumps(Some(shortened(&operation))),
                    None if jumps() => Self::Jumps(None),
                    _ => Self::Steep,
                }
            }
            _ => {
                let widths = successors(Some(JUMP), |width| Some(width * WIDENING));
                let near = widths.take_while(|width| *width < 1.0).find_map(|width| match obstacle(width) {
                    Some(Obstacle::Undefined(operation) | Obstacle::Jump(operation)) => Some(operation),
                    _ => None,
                });
                Self::Long(near.as_deref().map(shortened))
            }
        }
    }
}

/// Tells whether a value changes between two places however near they are.
fn jumps(value: impl Fn(Fraction) -> Fraction, mut low: Fraction, mut high: Fraction) -> bool {
    let change = |one: Fraction, other: Fraction| (other - one).abs();
    let (mut below, mut above) = (value(low), value(high));
    let mut largest = change(below, above);
    for _ in 0..HALVINGS {
        let middle = Fraction::from(0.5) * (low + high);
        let at = value(middle);
        let (one, other) = (change(below, at), change(at, above));
        if one > other {
            (high, above) = (middle, at);
        } else {
            (low, below) = (middle, at);
        }
        let most = one.max(other);
        largest = largest.max(most);
        // False for NaN.
        let is_large = most > Fraction::from(0.5) * largest;
        if !is_large {
            return false;
        }
    }
    true
}

/// Returns the text of an operation, without what is beyond [`MAX_LETTERS`].
fn shortened(operation: &str) -> Arc<str> {
    match operation.char_indices().nth(MAX_LETTERS) {
        Some((end, _)) => format!("{}...", &operation[..end]).into(),
        None => operation.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::certify::{Enclosure, Equation, Precision, first_hit};
    use glam::{DVec2, DVec3};
    use tabray_exact::scalar::Scalar;

    /// Surfaces across x, cut out of a box.
    #[derive(Clone, Copy)]
    enum Case {
        Squared,
        Step,
        Root,
    }

    impl Equation for Case {
        fn value<N: Scalar>(&self, [x, _, _]: [N; 3]) -> N {
            let third = x - N::constant(1.0) / N::constant(3.0);
            match self {
                Self::Squared => third.powi(2) * (x + N::constant(7.0)),
                Self::Step => third.floor() + N::constant(0.5),
                Self::Root => third.abs().sqrt(),
            }
        }

        fn extent(&self) -> [DVec3; 2] {
            [DVec3::NEG_ONE, DVec3::ONE]
        }
    }

    #[test]
    fn what_is_touched_and_what_jumps_are_told_apart() {
        let toward = DVec2::new(0.3, 0.4);
        let sight = Sight::through(DVec3::new(0.5, 0.5, 3.0), toward, DVec2::ONE, DVec2::ONE);
        for (case, doubt) in
            [(Case::Squared, Doubt::Touched), (Case::Step, Doubt::Jumps(None)), (Case::Root, Doubt::Steep)]
        {
            let Enclosure::Doubtful(from) = first_hit(&case, &sight, Precision::Octuple) else {
                panic!("237 bits do not decide it")
            };
            assert_eq!(Doubt::of(&case, &sight, from), doubt);
            let before = from * Fraction::from(0.99);
            assert_eq!(Doubt::of(&case, &sight, before), Doubt::Long(None));
        }
    }
}
