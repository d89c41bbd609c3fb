//! Rotations as values of attributes.

use crate::geometry::placement::Rotation;
use crate::scene::counts::Counts;
use crate::scene::value::{Datum, Type, Value};
use glam::DVec3;

/// A rotation, written as its three angles in degrees, around x, then y, then z, or as an axis and the angle around it.
impl Value for Rotation {
    const TYPE: Type = Type::Rotation;
    const ARITY: Counts = Counts::Of(&[3, 4]);
    const EACH: &[&str] = &["x", "y", "z", "angle"];

    fn to_datum(&self) -> Datum {
        match self {
            Self::Angles(degrees) => degrees.to_datum(),
            Self::Around { axis, degrees } => Datum::Numbers([&axis.to_array()[..], &[*degrees]].concat()),
        }
    }

    fn from_datum(datum: &Datum) -> Option<Self> {
        match datum {
            Datum::Numbers(numbers) => match numbers[..] {
                [x, y, z] => Some(Self::Angles(DVec3::new(x, y, z))),
                [x, y, z, degrees] => Some(Self::Around { axis: DVec3::new(x, y, z), degrees }),
                _ => None,
            },
            _ => None,
        }
    }
}

impl Type {
    /// Tells whether the values are numbers, in whose place formulas may stand.
    pub fn is_numeric(self) -> bool {
        matches!(self, Self::Whole | Self::Number | Self::Rotation)
    }

    /// Returns the unit of the values, where the type has one.
    pub fn unit(self) -> &'static str {
        if matches!(self, Self::Rotation) { "degrees" } else { "" }
    }

    /// Returns the least and the greatest number that makes a difference, where there are such numbers: an angle and
    /// one that differs from it by a full turn are the same.
    pub fn period(self) -> Option<[f64; 2]> {
        matches!(self, Self::Rotation).then_some([-180.0, 180.0])
    }
}
