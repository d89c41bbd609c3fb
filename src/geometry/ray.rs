//! Rays, the distances along them, and the sides of what they meet.

use glam::DVec3;

/// A half line.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Where it starts, in world coordinates.
    pub origin: DVec3,
    /// Where it goes, a unit vector.
    pub dir: DVec3,
}

impl Ray {
    /// The point at this distance from the origin.
    #[inline(always)]
    pub fn at(&self, distance: f64) -> DVec3 {
        self.origin + distance * self.dir
    }
}

/// A side of a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// The one that its normal points to.
    #[default]
    Outside,
    /// The other one.
    Inside,
}

impl Side {
    /// The side of a surface with this normal from which something comes that moves along `dir`.
    #[inline(always)]
    pub fn seen_along(dir: DVec3, normal: DVec3) -> Self {
        if dir.dot(normal) < 0.0 { Self::Outside } else { Self::Inside }
    }

    /// The other side.
    #[inline(always)]
    pub fn opposite(self) -> Self {
        match self {
            Self::Outside => Self::Inside,
            Self::Inside => Self::Outside,
        }
    }
}

/// Distances along a ray, both ends excluded.
#[derive(Clone, Copy, Debug)]
pub struct RayRange {
    /// Hits must lie farther.
    pub near: f64,
    /// Hits must lie nearer.
    pub far: f64,
    /// The side of the shape's own surface that the ray starts on and leaves, if it does: where it starts is no hit,
    /// however rounding has it. Only shapes that may meet themselves on that side are asked then.
    pub origin_side: Option<Side>,
    /// How far at most the ray's origin is from the point that it stands for, in world units. 0 for a ray from the
    /// viewer. A bracket from [`t_bounds`](crate::world::hittable::Bracketed::t_bounds) is certain only where the shape does not touch the origin within it.
    pub origin_error: f64,
}

/// The distance of a ray that hits nothing.
pub const MISS: f64 = f64::INFINITY;

impl RayRange {
    /// All of a ray but its origin.
    pub const ALL: RayRange =
        RayRange { near: 0.0, far: f64::INFINITY, origin_side: None, origin_error: 0.0 };

    /// The distance itself if it lies in the span, else [`MISS`]; so is a NaN.
    #[inline(always)]
    pub fn keep(&self, distance: f64) -> f64 {
        // One after the other: both at once become a question after the kind of number, of one number at a time.
        let distance = if distance < self.far { distance } else { MISS };
        if self.near < distance { distance } else { MISS }
    }
}

/// Between which distances a ray's first hit of a shape within a span is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bracket {
    /// It is no nearer than this; [`MISS`] where there is certainly none.
    pub near: f64,
    /// It is certainly there and no farther than this; [`MISS`] where that is not certain.
    pub far: f64,
}

impl Bracket {
    /// Of a ray that certainly misses.
    pub const MISS: Self = Self { near: MISS, far: MISS };

    /// Of a ray whose hit is known.
    #[inline(always)]
    pub fn exactly(distance: f64) -> Self {
        Self { near: distance, far: distance }
    }

    /// Whether it leaves open if there is a hit.
    #[inline(always)]
    pub fn is_doubtful(&self) -> bool {
        (self.near < MISS) & (self.far == MISS)
    }

    /// Of a ray of which plain arithmetic tells nothing.
    pub const UNKNOWN: Self = Self { near: 0.0, far: MISS };
}
