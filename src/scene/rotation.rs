//! Rotations as values of attributes.

use crate::geometry::placement::Rotation;
use crate::scene::counts::Counts;
use crate::scene::value::{Datum, Type, Value};
use glam::DVec3;

/// A rotation, written as its three angles in degrees: around x, then y, then z.
impl Value for Rotation {
    const TYPE: Type = Type::Rotation;
    const ARITY: Counts = Counts::Of(&[3]);
    const EACH: &[&str] = DVec3::EACH;

    fn to_datum(&self) -> Datum {
        self.degrees.to_datum()
    }

    fn from_datum(datum: &Datum) -> Option<Self> {
        DVec3::from_datum(datum).map(|degrees| Self { degrees })
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

    /// Returns the least and the greatest number that makes a difference, where there are such numbers: an angle and one
    /// that differs from it by a full turn are the same.
    pub fn period(self) -> Option<[f64; 2]> {
        matches!(self, Self::Rotation).then_some([-180.0, 180.0])
    }
}
