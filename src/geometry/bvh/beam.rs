//! A ray, or a bundle of rays, prepared for tests against boxes.

use crate::geometry::aabb::{SLACK, larger};
use crate::geometry::ray::Ray;
use glam::DVec3;

/// The index of the low plane of a box along an axis.
pub const LOW: usize = 0;
/// The index of the high plane.
pub const HIGH: usize = 1;

/// The largest reciprocal of a direction's component.
///
/// It stands for that of 0. Within any distance that matters, such a ray moves less along the axis than the slack.
const STEEPEST: f64 = 1e150;

/// The slack of rays whose coordinates are all 0, in world units: not 0, so that a product with [`STEEPEST`] is large.
const LEAST_SLACK: f64 = 1e-100;

/// Rays that are tested together: bounds of their origins and of their directions.
///
/// The origins' bounds have a slack of [`SLACK`] times their largest coordinate. It is more than the rounding of the
/// distances to planes, and than the distance by which rounding moves a ray of that size. So where a beam misses a box,
/// so do the rays before anything was rounded.
pub struct Beam {
    /// The bounds of the origins: the high one is measured from to low planes, and the low one to high planes.
    pub from: [DVec3; 2],
    /// The reciprocals of the components of the directions: the largest component's for low planes, and the smallest
    /// one's for high planes.
    pub inverse: [DVec3; 2],
    /// The side of a box that the rays reach first along each axis, [`LOW`] or [`HIGH`].
    pub near: [usize; 3],
    /// Whether some rays rise along the axis and others fall. They enter a box through either plane, and may never leave
    /// it.
    pub is_mixed: [bool; 3],
}

impl Beam {
    /// Prepares one ray.
    #[inline(always)]
    pub fn of(ray: &Ray) -> Self {
        Self::between([ray.origin; 2], [ray.dir; 2])
    }

    /// Bounds rays by the least and the greatest coordinates of their origins, and components of their directions.
    #[inline(always)]
    fn between([low, high]: [DVec3; 2], [least, greatest]: [DVec3; 2]) -> Self {
        let slack = SLACK * larger(low.abs().max_element(), high.abs().max_element()) + LEAST_SLACK;
        let (mut near, mut is_mixed) = ([LOW; 3], [false; 3]);
        for axis in 0..3 {
            // Signs, not comparisons, as -0 has a negative reciprocal.
            let falls = [least[axis], greatest[axis]].map(f64::is_sign_negative);
            near[axis] = usize::from(falls == [true, true]);
            is_mixed[axis] = falls == [true, false];
        }
        let steepest =
            |inverse: f64| if inverse.abs() > STEEPEST { STEEPEST.copysign(inverse) } else { inverse };
        let inverse = |dir: DVec3| dir.recip().map(steepest);
        Self {
            from: [high + slack, low - slack],
            inverse: [inverse(greatest), inverse(least)],
            near,
            is_mixed,
        }
    }
}
