//! The rules of light, in any numbers: those of images, and those that enclose what images should show.
//!
//! A ray that hits a point returns `attenuation * (ambient + light of each lamp)`, and what it sees through the point and
//! in it. Numbers are one channel each, or colours where no more than sums and products are asked of them.

use serde::{Deserialize, Serialize};
use std::ops::{Add, Mul};
use tabray_exact::scalar::{Scalar, per_axis};

/// The rules of light of a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Rules {
    /// The course notes': all light is divided by the length of its path, the viewer's part included, and paths end at
    /// [`MAX_DIST`].
    #[default]
    Notes,
    /// Light that does not depend on the lengths of a scene.
    Free,
}

/// The path length from the viewer, in world units, beyond which no reflected or transmitted ray is followed.
pub const MAX_DIST: f64 = 20.0;

/// Returns how much of the longest path is left: a ray is followed unless it is below 0.
#[inline(always)]
pub fn path_left<N: Scalar>(travelled: N) -> N {
    N::constant(MAX_DIST) - travelled
}

/// Returns the factor of the light of a surface, from the length of the path to it.
#[inline(always)]
pub fn attenuation<N: Scalar>(travelled: N) -> N {
    N::constant(1.0) / travelled
}

/// Returns the factor of the light that a lamp sends to a point, from the cosine of the angle at which it arrives and the
/// reciprocal of the lamp's distance.
#[inline(always)]
pub fn received<N: Scalar>(cosine: N, inverse_distance: N) -> N {
    cosine * inverse_distance
}

/// Returns the light of a transparent surface, from its own, the fraction of it that is kept, the light from behind, and the
/// fraction of that which passes.
#[inline(always)]
pub fn transmitted<C: Mul<Output = C> + Add<Output = C>>(own: C, kept: C, behind: C, tint: C) -> C {
    kept * own + tint * behind
}

/// Returns the light of a surface that mirrors other light, too.
#[inline(always)]
pub fn reflected<C: Mul<Output = C> + Add<Output = C>>(own: C, seen: C, specular: C) -> C {
    own + specular * seen
}

/// Returns the direction in which a direction is mirrored, as long as it, given a unit normal.
#[inline(always)]
pub fn mirrored<N: Scalar>(dir: [N; 3], normal: [N; 3]) -> [N; 3] {
    let across = dir[0] * normal[0] + dir[1] * normal[1] + dir[2] * normal[2];
    let twice = across + across;
    per_axis(|axis| dir[axis] - twice * normal[axis])
}
