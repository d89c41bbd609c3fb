//! Rays, brackets of their hits, and bounds of their errors.

use glam::DVec3;
use std::ops::Deref;

pub use tabray_exact::roots::range::{MISS, RayRange, Side};

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

/// Bounds of the distance of a ray's first hit of a shape in a range, in world units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bracket {
    /// A lower bound of the first hit's distance, or [`MISS`] if there is certainly no hit.
    pub near: f64,
    /// An upper bound of the first hit's distance if there certainly is a hit, or otherwise [`MISS`].
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

    /// Returns whether the bracket leaves the existence of a hit open.
    #[inline(always)]
    pub fn is_doubtful(&self) -> bool {
        (self.near < MISS) & (self.far == MISS)
    }

    /// The bracket of a ray about which plain arithmetic tells nothing.
    pub const UNKNOWN: Self = Self { near: 0.0, far: MISS };
}

/// A ray, and the maximum distance between it and the rays that it stands for.
///
/// A ray in a copy's own coordinates stands for all rays that may have been rounded to it. A ray in world space stands
/// for itself. The rounding of a camera ray's direction, 3 units of 2^-53 in each component, is not included here, and
/// shapes account for it.
#[derive(Clone, Copy, Debug)]
pub struct RayBall {
    /// The ray.
    pub ray: Ray,
    /// The maximum distance of the rays that it stands for.
    pub drift: RayError,
}

impl RayBall {
    /// Returns whether the ray stands only for itself.
    #[inline(always)]
    pub fn is_single(&self) -> bool {
        self.drift.is_none()
    }
}

impl From<Ray> for RayBall {
    #[inline(always)]
    fn from(ray: Ray) -> Self {
        Self { ray, drift: RayError::NONE }
    }
}

impl From<&Ray> for RayBall {
    #[inline(always)]
    fn from(ray: &Ray) -> Self {
        Self::from(*ray)
    }
}

impl Deref for RayBall {
    type Target = Ray;

    #[inline(always)]
    fn deref(&self) -> &Ray {
        &self.ray
    }
}

/// The maximum distance between a transformed and rounded ray and the exact ray.
#[derive(Clone, Copy, Debug)]
pub struct RayError {
    /// A bound of the distance between the origins, in units of the new coordinates.
    pub origin: f64,
    /// A bound of the length of the difference between the directions, which are unit vectors.
    pub dir: f64,
}

impl RayError {
    /// The drift of a ray that was not transformed.
    pub const NONE: Self = Self { origin: 0.0, dir: 0.0 };

    /// Returns whether this is the drift of a ray that was not transformed.
    #[inline(always)]
    pub fn is_none(&self) -> bool {
        (self.origin == 0.0) & (self.dir == 0.0)
    }
}
