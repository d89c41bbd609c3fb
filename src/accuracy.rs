//! How exactly a scene is traced: by the notes' own methods, or by stable ones of a chosen accuracy.

use crate::choice::{Choice, ChoiceName};
use std::fmt;
use std::panic::Location;

/// How exactly shapes find their hits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Accuracy {
    /// The course notes' methods, with the hits that they lose and the artefacts that they make.
    Classic,
    /// As exact, with points only within about 1/1000 of a unit of the surface where that saves time.
    Draft,
    /// First hits by error bounds, their points on the surface but for rounding.
    #[default]
    Exact,
    /// As exact, and in twice the precision wherever that exists.
    Strict,
}

impl Accuracy {
    const ALL: [Self; 4] = [Self::Classic, Self::Draft, Self::Exact, Self::Strict];
    const PLACE: &'static Location<'static> = Location::caller();
}

/// What choosing it does, in a few words.
impl fmt::Display for Accuracy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let option = self.option();
        write!(f, "{}: {}", option.name, option.meaning)
    }
}

impl Choice for Accuracy {
    const WHAT: &'static str = "accuracy";

    fn all() -> Vec<Self> {
        Self::ALL.to_vec()
    }

    fn option(&self) -> ChoiceName {
        let (name, meaning) = match self {
            Self::Classic => ("classic", "the course notes' methods"),
            Self::Draft => {
                ("draft", "like exact, but with hit points only within about 1/1000 of a unit of the surface")
            }
            Self::Exact => {
                ("exact", "first hits found with error bounds, hit points on the surface up to rounding")
            }
            Self::Strict => ("strict", "like exact, in twice the precision wherever a shape supports it"),
        };
        ChoiceName { name, number: None, meaning, place: Self::PLACE }
    }
}
