//! Ranges of distances along a ray, and the sides of surfaces.

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
    /// Returns the side of a surface with this normal that a ray along `dir` hits.
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
    /// The side of the shape's own surface that the ray starts on and leaves, if it does. The origin itself is then not
    /// a hit, regardless of rounding. Such rays are passed only to shapes that they may hit again from that side.
    pub origin_side: Option<Side>,
    /// The maximum distance between the ray's origin and the exact point that it was rounded from, in world units. It
    /// is 0 for a camera ray. A bracket of a hit is certain only if the shape is farther from the origin than this.
    pub origin_error: f64,
}

/// The distance of a ray without a hit.
pub const MISS: f64 = f64::INFINITY;

impl RayRange {
    /// All of a ray except its origin.
    pub const ALL: RayRange =
        RayRange { near: 0.0, far: f64::INFINITY, origin_side: None, origin_error: 0.0 };

    /// Returns the distance if it is in the range, or [`MISS`] if it is not, or is NaN.
    #[inline(always)]
    pub fn keep(&self, distance: f64) -> f64 {
        // A combined comparison would compile to a classification of the number, one lane at a time.
        let distance = if distance < self.far { distance } else { MISS };
        if self.near < distance { distance } else { MISS }
    }
}
