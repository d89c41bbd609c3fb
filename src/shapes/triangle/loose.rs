//! A triangle in little memory: a scene may have millions of them.

use super::normals::remembered_normal;
use super::{Triangle, passed, passed_by_eight};
use crate::plane::Plane;
use glam::DVec3;
use std::marker::PhantomData;
use tabray_exact::double_double::DoubleDouble;
use tabray_world::accuracy::{AccuracyTag, Classic, NotClassic};
use tabray_world::geometry::ray::{Bracket, MISS, RayBall, RayError, RayRange};
use tabray_world::geometry::ray_packet::RayPacket;
use tabray_world::simd::soa::LANES;

/// A triangle with few precomputed values, in 104 bytes. Reading more from memory would take longer than all tests of a
/// ray.
#[derive(Clone, Copy, Debug)]
pub struct LooseTriangle<A> {
    /// The corners in world coordinates, counterclockwise as seen from the lit side.
    pub corners: [DVec3; 3],
    /// The unit normal, rounded. It points to the lit side.
    pub(super) normal: DVec3,
    /// The z, in world units, at which the triangle ends.
    max_z: f64,
    accuracy: PhantomData<A>,
}

impl LooseTriangle<Classic> {
    /// Returns the triangle with these corners, ending at a z, in world units, if one is given. Returns `None` if `f64`
    /// cannot distinguish the corners from collinear ones.
    pub fn classic(corners: [DVec3; 3], max_z: Option<f64>) -> Option<Self> {
        Triangle::classic(corners).map(|triangle| Self::of(&triangle, max_z))
    }
}

impl<A: NotClassic> LooseTriangle<A> {
    /// Returns the triangle with these corners, ending at a z, in world units, if one is given. Returns `None` if the
    /// corners are collinear.
    pub fn new(corners: [DVec3; 3], max_z: Option<f64>) -> Option<Self> {
        Triangle::new(corners).map(|triangle| Self::of(&triangle, max_z))
    }
}

impl<A: AccuracyTag> LooseTriangle<A> {
    fn of(Triangle { plane, corners }: &Triangle<A>, max_z: Option<f64>) -> Self {
        let max_z = plane.up_to(max_z).max_z;
        Self { corners: *corners, normal: plane.normal, max_z, accuracy: PhantomData }
    }

    /// Returns the triangle with all values computed from its corners.
    #[inline]
    pub(super) fn whole(&self) -> Triangle<A> {
        let mut plane = Plane::new(self.normal, remembered_normal(self.corners), self.corners[0]);
        plane.max_z = self.max_z;
        Triangle { plane, corners: self.corners }
    }

    /// Returns the plane of the triangle for brackets, without the exact normal, which is the slowest part.
    #[inline(always)]
    pub(super) fn rough_plane(&self) -> Plane<A> {
        let [a, b, c] = self.corners;
        // The normal is along an axis exactly if the corners have one coordinate in common.
        let is_level = |axis: usize| (a[axis] == b[axis]) & (a[axis] == c[axis]);
        let mut plane = Plane::new(self.normal, [DoubleDouble { high: 0.0, low: 0.0 }; 3], a);
        plane.is_upright = is_level(0) | is_level(1) | is_level(2);
        plane.max_z = self.max_z;
        plane
    }
}

impl<A: NotClassic> LooseTriangle<A> {
    /// Returns a bracket of the distance at which a ray crosses the triangle.
    #[inline(always)]
    pub fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        let plane = self.rough_plane();
        let rough = plane.rough_crossing(ray, range.origin_error);
        let Bracket { near, far } = plane.t_bounds(&rough, ray, range);
        let passed = passed(self.corners, ray, ray.drift);
        Bracket {
            near: if passed == Some(false) { MISS } else { near },
            far: if passed == Some(true) { far } else { MISS },
        }
    }

    /// Tells whether eight rays certainly miss the triangle.
    #[inline(always)]
    pub(super) fn is_missed_by(&self, rays: RayPacket) -> bool {
        passed_by_eight(self.corners, rays, RayError::NONE).0 == [1; LANES]
    }
}
