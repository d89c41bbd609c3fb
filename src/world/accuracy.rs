//! How exactly a scene is traced: by the notes' own methods, or by stable ones of a chosen accuracy.

use std::fmt;

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
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Classic, Self::Draft, Self::Exact, Self::Strict];

    /// Its name, and what choosing it does, in a few words.
    pub fn named(self) -> (&'static str, &'static str) {
        match self {
            Self::Classic => ("classic", "the course notes' methods"),
            Self::Draft => {
                ("draft", "like exact, but with hit points only within about 1/1000 of a unit of the surface")
            }
            Self::Exact => {
                ("exact", "first hits found with error bounds, hit points on the surface up to rounding")
            }
            Self::Strict => ("strict", "like exact, in twice the precision wherever a shape supports it"),
        }
    }
}

/// What choosing it does, in a few words.
impl fmt::Display for Accuracy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, meaning) = self.named();
        write!(f, "{name}: {meaning}")
    }
}

/// The course notes' formula, as a type of a shape's: it is chosen when the shape is made.
#[derive(Clone, Copy, Debug)]
pub struct Classic;

/// As [`Classic`], of hits by error bounds that are not finished.
#[derive(Clone, Copy, Debug)]
pub struct Draft;

/// As [`Classic`], of hits by error bounds that are finished.
#[derive(Clone, Copy, Debug)]
pub struct Exact;

/// As [`Classic`], of hits in twice the precision.
#[derive(Clone, Copy, Debug)]
pub struct Strict;

/// Those of the types that find first hits by error bounds.
pub trait Bounded: Copy + Send + Sync + 'static {
    /// The accuracy that it stands for.
    const ACCURACY: Accuracy;
}

impl Bounded for Draft {
    const ACCURACY: Accuracy = Accuracy::Draft;
}

impl Bounded for Exact {
    const ACCURACY: Accuracy = Accuracy::Exact;
}

impl Bounded for Strict {
    const ACCURACY: Accuracy = Accuracy::Strict;
}
