//! The rules of light, in any type of numbers: the numbers of images, and numbers that enclose them.
//!
//! A ray that hits a point returns the point's own light, which is its ambient light and the light of each lamp, and
//! the light that is seen through the point and mirrored in it. Under the notes' rules, the own light is divided by the
//! length of the path, and the light of a lamp is divided once more by the lamp's distance. Under the free rules,
//! neither is divided, and a lamp weakens only as its falloff says. A number is one channel, or a colour where only
//! sums and products are needed.

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

impl Rules {
    /// Returns a surface's own light, or a bound on it, as a ray of this path length returns it.
    #[inline(always)]
    pub fn after<N: Scalar>(self, travelled: N, light: N) -> N {
        match self {
            Self::Notes => light * attenuation(travelled),
            Self::Free => light,
        }
    }

    /// Returns a bound on light. `most` bounds the light times the length of its path under the notes' rules, and the
    /// light itself under the free rules.
    #[inline]
    pub fn over_path(self, most: f64, travelled: f64) -> f64 {
        match self {
            Self::Notes => most / travelled,
            Self::Free => most,
        }
    }

    /// Returns the factor of the light that a lamp sends to a point, from the cosine of the angle at which it arrives
    /// and the reciprocal of the lamp's distance.
    #[inline(always)]
    pub fn received<N: Scalar>(self, cosine: N, inverse_distance: N) -> N {
        match self {
            Self::Notes => cosine * inverse_distance,
            Self::Free => cosine,
        }
    }
}

/// How the light of a lamp weakens with the distance, under the free rules.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Falloff {
    /// Not at all.
    #[default]
    None,
    /// In proportion to the reciprocal of the distance.
    Distance,
    /// In proportion to the reciprocal of the squared distance, as that of a real lamp.
    Square,
}

/// A lamp's falloff, and the distance, in world units, at which it sends its emissivity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fading {
    /// How the light weakens.
    pub falloff: Falloff,
    /// The distance, in world units, at which the lamp's light equals its emissivity; above 0.
    pub at: f64,
}

impl Fading {
    /// The fraction of [`at`](Self::at) up to which all distances count as the same, which keeps light bounded.
    const NEAREST: f64 = 0.01;

    /// No falloff.
    pub const NONE: Self = Self { falloff: Falloff::None, at: 1.0 };

    /// Returns the factor of the light at a distance, in world units.
    pub fn factor<N: Scalar>(self, distance: N) -> N {
        let part = || N::constant(self.at) / distance.max(N::constant(Self::NEAREST * self.at));
        match self.falloff {
            Falloff::None => N::constant(1.0),
            Falloff::Distance => part(),
            Falloff::Square => part() * part(),
        }
    }
}

/// The path length from the viewer, in world units, beyond which no reflected or transmitted ray is followed.
pub const MAX_DIST: f64 = 20.0;

/// Returns the rest of the longest path under the notes' rules. A ray is followed unless the rest is below 0.
#[inline(always)]
pub fn path_left<N: Scalar>(travelled: N) -> N {
    N::constant(MAX_DIST) - travelled
}

/// Returns the factor of the light of a surface under the notes' rules, from the length of the path to it.
#[inline(always)]
pub fn attenuation<N: Scalar>(travelled: N) -> N {
    N::constant(1.0) / travelled
}

/// Returns the light of a transparent surface, from its own, the fraction of it that is kept, the light from behind,
/// and the fraction of the latter that passes.
#[inline(always)]
pub fn transmitted<C: Mul<Output = C> + Add<Output = C>>(own: C, kept: C, behind: C, tint: C) -> C {
    kept * own + tint * behind
}

/// Returns the light of a surface that mirrors other light, too.
#[inline(always)]
pub fn reflected<C: Mul<Output = C> + Add<Output = C>>(own: C, seen: C, specular: C) -> C {
    own + specular * seen
}

/// Mirrors a direction, given a unit normal. Its length does not change.
#[inline(always)]
pub fn mirrored<N: Scalar>(dir: [N; 3], normal: [N; 3]) -> [N; 3] {
    let across = dir[0] * normal[0] + dir[1] * normal[1] + dir[2] * normal[2];
    let twice = across + across;
    per_axis(|axis| dir[axis] - twice * normal[axis])
}
