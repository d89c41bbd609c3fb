//! The truth that tests compare the program with: first hits in twice the precision of `f64`, and rays to ask for.
#![allow(dead_code, reason = "each test program uses a part of it")]

pub mod hard;
pub mod rays;
pub mod revolution;
pub mod shapes;
pub mod tally;

use tabray::numeric::double_double::DoubleDouble;

/// Where a ray first meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Truth {
    /// There.
    Hit(Hit),
    /// Nowhere.
    Miss,
    /// So close to the edge between the two that the numbers of the scene do not say.
    Undecided,
}

/// A hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// How far along the ray, in lengths of its direction.
    pub t: DoubleDouble,
    /// How fast the surface's function grows along the ray there: negative where the ray enters. At a ledge, where
    /// that has no bound, 1 or -1.
    pub slope: f64,
}

impl Truth {
    /// The hit, if it is one.
    pub fn hit(self) -> Option<Hit> {
        match self {
            Self::Hit(hit) => Some(hit),
            Self::Miss | Self::Undecided => None,
        }
    }
}

/// Which crossings of a surface count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crossings {
    /// All.
    All,
    /// Those from outside to inside: what a ray that leaves the outside can meet.
    Entries,
    /// Those from inside to outside.
    Exits,
}

impl Crossings {
    /// Whether a crossing counts at which the surface's function has this slope.
    pub fn count(self, slope: f64) -> bool {
        match self {
            Self::All => true,
            Self::Entries => slope < 0.0,
            Self::Exits => slope > 0.0,
        }
    }
}
