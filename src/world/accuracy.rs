//! How exactly a scene is traced: by the course notes' own methods, or by stable ones of a chosen accuracy.

use std::fmt;

/// The accuracy with which shapes find their hits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Accuracy {
    /// The course notes' methods, with the hits that they lose and the artefacts that they make.
    Classic,
    /// Like `Exact`, but with hit points only within about 1/1000 of a world unit of the surface where that saves time: on
    /// surfaces of revolution, spheres and ellipsoids.
    Draft,
    /// First hits found with error bounds, and hit points on the surface up to rounding.
    #[default]
    Exact,
    /// Like `Exact`, but in double-double arithmetic where a hit has a closed form. Shapes whose hits are searched
    /// for give the same numbers as with `Exact`.
    Strict,
}

impl Accuracy {
    /// All accuracies, in the order of their declaration.
    pub const ALL: [Self; 4] = [Self::Classic, Self::Draft, Self::Exact, Self::Strict];

    /// Returns the accuracy's name, and what choosing it does, in a few words.
    pub fn named(self) -> (&'static str, &'static str) {
        match self {
            Self::Classic => ("classic", "the course notes' methods"),
            Self::Draft => {
                ("draft", "like exact, but with hit points only within about 1/1000 of a unit of the surface")
            }
            Self::Exact => {
                ("exact", "first hits found with error bounds, hit points on the surface up to rounding")
            }
            Self::Strict => (
                "strict",
                "like exact, in twice the precision where a hit has a closed form; elsewhere the same numbers as exact",
            ),
        }
    }
}

/// The accuracy's name, and what choosing it does, in a few words.
impl fmt::Display for Accuracy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, meaning) = self.named();
        write!(f, "{name}: {meaning}")
    }
}

/// Marks a shape that uses the course notes' formula. The marker is a type, so the choice is made once, when the shape
/// is constructed.
#[derive(Clone, Copy, Debug)]
pub struct Classic;

/// Marks a shape whose hits are found with error bounds and left unrefined where that saves time.
#[derive(Clone, Copy, Debug)]
pub struct Draft;

/// Marks a shape whose hits are found with error bounds and refined to the surface up to rounding.
#[derive(Clone, Copy, Debug)]
pub struct Exact;

/// Marks a shape whose hits are computed in double-double arithmetic.
#[derive(Clone, Copy, Debug)]
pub struct Strict;

/// A marker of an accuracy: [`Classic`], [`Draft`], [`Exact`] or [`Strict`].
pub trait AccuracyTag: Copy + Send + Sync + 'static {
    /// The accuracy that the marker stands for.
    const ACCURACY: Accuracy;

    /// Whether hits are found by the course notes' formula. As a constant, it selects code at compile time.
    const IS_CLASSIC: bool = matches!(Self::ACCURACY, Accuracy::Classic);
}

impl AccuracyTag for Classic {
    const ACCURACY: Accuracy = Accuracy::Classic;
}

impl AccuracyTag for Draft {
    const ACCURACY: Accuracy = Accuracy::Draft;
}

impl AccuracyTag for Exact {
    const ACCURACY: Accuracy = Accuracy::Exact;
}

impl AccuracyTag for Strict {
    const ACCURACY: Accuracy = Accuracy::Strict;
}

/// A marker of an accuracy that finds first hits with error bounds: [`Draft`], [`Exact`] or [`Strict`].
pub trait NotClassic: AccuracyTag {}

impl NotClassic for Draft {}
impl NotClassic for Exact {}
impl NotClassic for Strict {}
