//! Rays, distances along them, and the sides of surfaces that they hit.

use glam::DVec3;

/// A ray: a half-line.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// The origin, in world coordinates.
    pub origin: DVec3,
    /// The direction, a unit vector.
    pub dir: DVec3,
}

impl Ray {
    /// Returns the point at a distance from the origin, in world units.
    #[inline(always)]
    pub fn at(&self, distance: f64) -> DVec3 {
        self.origin + distance * self.dir
    }
}

/// A side of a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// The side that the normal points to.
    #[default]
    Outside,
    /// The other side.
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
    /// A bracket from [`t_bounds`](crate::world::hittable::Bracketed::t_bounds) is certain only where the shape is
    /// farther from the origin than this.
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

/// Bounds of the distance of a ray's first hit of a shape in a range, in world units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bracket {
    /// A lower bound of the first hit's distance; [`MISS`] where there is certainly no hit.
    pub near: f64,
    /// An upper bound of the first hit's distance where there certainly is a hit; else [`MISS`].
    pub far: f64,
}

impl Bracket {
    /// The bracket of a ray that certainly misses.
    pub const MISS: Self = Self { near: MISS, far: MISS };

    /// Returns the bracket of a hit at a known distance.
    #[inline(always)]
    pub fn exactly(distance: f64) -> Self {
        Self { near: distance, far: distance }
    }

    /// Returns whether the bracket leaves open if there is a hit.
    #[inline(always)]
    pub fn is_doubtful(&self) -> bool {
        (self.near < MISS) & (self.far == MISS)
    }

    /// The bracket of a ray about which plain arithmetic says nothing.
    pub const UNKNOWN: Self = Self { near: 0.0, far: MISS };
}

/// The maximum distance of a ray that was transformed and rounded from the ray that it stands for.
#[derive(Clone, Copy, Debug)]
pub struct Drift {
    /// A bound on the distance between the origins, in units of the coordinates that the ray was taken to.
    pub origin: f64,
    /// A bound on the length of the difference between the directions, which are unit vectors.
    pub dir: f64,
}

impl Drift {
    /// The drift of a ray that was not transformed.
    pub const NONE: Self = Self { origin: 0.0, dir: 0.0 };
}
