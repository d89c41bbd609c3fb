//! The premises of proofs, besides the numbers of the scene.

use std::fmt;

/// A premise of all proofs about a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Premise {
    /// The proofs treat these numbers as exact.
    Assumed(Assumption),
    /// There is no equation to prove hits by. All that is known is that a hit lies in the bounds of the shape.
    NoEquation,
}

/// Numbers that a proof starts from but that are not in the scene: they were computed from the scene's numbers, and
/// rounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Assumption {
    /// The camera rays.
    Rays,
    /// The points where camera rays start; their directions are exact.
    Starts,
    /// The vertices of triangles, which were moved, scaled or turned.
    Vertices,
    /// The normals at the vertices of a mesh that looks smooth. Only proofs of colours ask for them.
    Normals,
    /// The bounding box of a shape without an equation. Its plugin promises that the shape lies inside.
    Bounds,
}

/// Displays the assumption, phrased to follow "assumed: ".
impl fmt::Display for Assumption {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Rays => "rays as computed, rounded to f64",
            Self::Starts => "starts of rays as computed, rounded to f64",
            Self::Vertices => "vertices as placed, rounded to f64",
            Self::Normals => "normals at vertices as computed, rounded to f32",
            Self::Bounds => "the bounding box as the plugin gives it",
        })
    }
}
