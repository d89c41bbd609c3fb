//! Ranges of distances along a ray, and the sides of surfaces that it hits.

use glam::DVec3;

/// A side of a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// The side that the normal points to.
    #[default]
    Outside,
    /// The side that the normal points away from.
    Inside,
}

impl Side {
    /// Returns the side of a surface with this normal that is hit by a ray along `dir`.
    #[inline(always)]
    pub fn seen_along(dir: DVec3, normal: DVec3) -> Self {
        if dir.dot(normal) < 0.0 { Self::Outside } else { Self::Inside }
    }

    /// Returns the opposite side.
    #[inline(always)]
    pub fn opposite(self) -> Self {
        match self {
            Self::Outside => Self::Inside,
            Self::Inside => Self::Outside,
        }
    }
}

/// An open range of distances along a ray, in world units.
#[derive(Clone, Copy, Debug)]
pub struct RayRange {
    /// The lower bound: hits must be farther.
    pub near: f64,
    /// The upper bound: hits must be nearer.
    pub far: f64,
    /// The side of the shape's own surface that the ray starts on and leaves, if it does: the origin itself is then not
    /// a hit, whatever rounding says. Such rays are passed only to shapes that they may hit again from that side.
    pub origin_side: Option<Side>,
    /// The largest distance of the ray's origin from the point that it stands for, in world units. 0 for a camera ray.
    /// A bracket of a hit is certain only where the shape is farther from the origin than this.
    pub origin_error: f64,
}

/// The distance of a ray that hits nothing.
pub const MISS: f64 = f64::INFINITY;

impl RayRange {
    /// All of a ray except its origin.
    pub const ALL: RayRange =
        RayRange { near: 0.0, far: f64::INFINITY, origin_side: None, origin_error: 0.0 };

    /// Returns the distance if it is in the range, else [`MISS`]; for NaN, too.
    #[inline(always)]
    pub fn keep(&self, distance: f64) -> f64 {
        // Two comparisons, one after the other: combined, they compile to a classification of the number, one lane at a
        // time.
        let distance = if distance < self.far { distance } else { MISS };
        if self.near < distance { distance } else { MISS }
    }
}
