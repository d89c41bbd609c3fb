//! The truth that tests compare the program with: first hits in twice the precision of `f64`, and rays to test.
#![allow(dead_code, reason = "each test program uses a part of it")]

pub mod hard;
pub mod rays;
pub mod revolution;
pub mod shapes;
pub mod tally;

use glam::{DVec2, DVec3};
use tabray::exact::double_double::DoubleDouble;

/// The first hit of a ray on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Truth {
    /// The ray hits the surface.
    Hit(Hit),
    /// The ray misses the surface.
    Miss,
    /// The ray is so close to the boundary between a hit and a miss that the numbers of the scene do not decide.
    Undecided,
}

/// A hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The distance along the ray, in lengths of its direction.
    pub t: DoubleDouble,
    /// The derivative of the surface's function along the ray: negative where the ray enters. At a ledge, where the
    /// derivative is unbounded, it is 1 or -1.
    pub slope: f64,
}

/// Writes a vector as scenes do.
pub fn spelt(vector: DVec3) -> String {
    format!("{:?} {:?} {:?}", vector.x, vector.y, vector.z)
}

/// Returns the text of an fplane.
pub fn fplane_text(normal: DVec3, point: DVec3, xdir: DVec3, DVec2 { x, y }: DVec2) -> String {
    let [normal, point, xdir] = [normal, point, xdir].map(spelt);
    format!("fplane f {{ material m normal {normal} point {point} xdir {xdir} dimensions {x:?} {y:?} }}")
}

impl Truth {
    /// Returns the hit, if there is one.
    pub fn hit(self) -> Option<Hit> {
        match self {
            Self::Hit(hit) => Some(hit),
            Self::Miss | Self::Undecided => None,
        }
    }
}

/// The crossings of a surface that count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crossings {
    /// All crossings.
    All,
    /// Crossings from outside to inside: the ones that a ray leaving the outside can meet.
    Entries,
    /// Crossings from inside to outside.
    Exits,
}

impl Crossings {
    /// Tells whether a crossing counts at which the surface's function has this slope.
    pub fn count(self, slope: f64) -> bool {
        match self {
            Self::All => true,
            Self::Entries => slope < 0.0,
            Self::Exits => slope > 0.0,
        }
    }
}
