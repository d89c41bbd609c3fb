//! Profiles: the lines that surfaces of revolution are turned from.

use crate::choice::{Choice, ChoiceName};
use std::panic::Location;

/// A line x = g(y), which a scene chooses by name or by number. A plugin registers one with
/// `inventory::submit!`.
pub struct Profile {
    name: &'static str,
    meaning: &'static str,
    number: Option<i64>,
    /// The distance from the axis at a height.
    pub radius: fn(f64) -> f64,
    /// How fast that distance grows with the height.
    pub slope: fn(f64) -> f64,
    place: &'static Location<'static>,
}

inventory::collect!(Profile);

impl Profile {
    /// A profile with a name and no number: the line and its derivative.
    #[track_caller]
    pub const fn new(
        name: &'static str,
        meaning: &'static str,
        radius: fn(f64) -> f64,
        slope: fn(f64) -> f64,
    ) -> Self {
        Self { name, meaning, number: None, radius, slope, place: Location::caller() }
    }

    /// With the number that the notes give it.
    pub const fn number(mut self, number: i64) -> Self {
        self.number = Some(number);
        self
    }
}

impl Choice for &'static Profile {
    const WHAT: &'static str = "profile";

    fn all() -> Vec<Self> {
        inventory::iter::<Profile>().collect()
    }

    fn option(&self) -> ChoiceName {
        ChoiceName { name: self.name, number: self.number, meaning: self.meaning, place: self.place }
    }
}
