//! Profiles: the curves that surfaces of revolution are turned from.

use crate::scene::choice::{Choice, ChoiceName};
use crate::text;
use std::panic::Location;
use tabray_exact::dual::Dual;
use tabray_exact::formula::Formula;

/// A curve x = g(y), which a scene chooses by name or by number. A plugin registers one with `inventory::submit!`.
pub struct Profile {
    name: &'static str,
    meaning: &'static str,
    number: Option<i64>,
    formula: &'static str,
    slope: Option<&'static str>,
    place: &'static Location<'static>,
}

inventory::collect!(Profile);

impl Profile {
    /// Describes a profile that has a name and no number; the formula gives the distance from the axis at height y.
    #[track_caller]
    pub const fn new(name: &'static str, meaning: &'static str, formula: &'static str) -> Self {
        Self { name, meaning, number: None, formula, slope: None, place: Location::caller() }
    }

    /// Sets the number that the notes give the profile.
    pub const fn number(mut self, number: i64) -> Self {
        self.number = Some(number);
        self
    }

    /// Sets a slope that differs from the formula's derivative, for the normals of the classic method.
    pub const fn slope(mut self, formula: &'static str) -> Self {
        self.slope = Some(formula);
        self
    }

    /// Returns the profile's curve.
    ///
    /// # Panics
    /// If the plugin's text is not a formula. The registry refuses such plugins before a scene is read.
    pub fn line(&self) -> ProfileLine {
        let parse = |text| Formula::parse(text).expect("the registry refuses what is no formula");
        ProfileLine { radius: parse(self.formula), slope: self.slope.map(parse) }
    }

    /// Returns the error of the formulas, if there is one.
    pub fn fault(&self) -> Option<String> {
        let fault = |text| Formula::parse(text).err().map(|fault| (text, fault));
        let (text, fault) = fault(self.formula).or_else(|| self.slope.and_then(fault))?;
        let place = text::place(self.place);
        Some(format!(
            "the profile `{}` at {place} is not a formula: {} in `{text}`",
            self.name, fault.message
        ))
    }
}

/// A curve x = g(y), ready to be turned about an axis.
#[derive(Clone, Debug)]
pub struct ProfileLine {
    /// The distance from the axis as a function of the height.
    pub radius: Formula,
    /// The derivative of the radius, where the classic method uses another one than the formula's.
    pub slope: Option<Formula>,
}

impl ProfileLine {
    /// Returns the derivative of the radius at height `y`.
    pub fn slope_at(&self, y: f64) -> f64 {
        match &self.slope {
            Some(slope) => slope.at(y),
            None => self.radius.at(Dual::variable(y)).slope,
        }
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
