//! Hits of planes, and their certainty.

use super::Plane;
use glam::DVec3;
use tabray_exact::double_double::DoubleDouble;
use tabray_world::accuracy::{AccuracyTag, NotClassic};
use tabray_world::geometry::aabb::{Aabb, SLACK};
use tabray_world::geometry::ray::{Bracket, Ray, RayBall, RayRange, Side};
use tabray_world::geometry::ray_packet::RayPacket;
use tabray_world::hittable::{Bracketed, Certified, Facts, Hittable, Sides};

impl<A: AccuracyTag> Hittable for Plane<A> {
    #[inline(always)]
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        self.keep(self.crossing(ray), ray, range)
    }

    #[inline]
    fn normal(&self, _at: DVec3) -> DVec3 {
        self.normal
    }

    #[inline]
    fn facts(&self) -> Facts {
        Facts {
            can_hit_itself: Sides::NONE,
            plane: Some([self.point, self.normal]),
            ends_as_planes: true,
            ..Facts::unbounded(self.point.abs().max_element())
        }
    }

    fn is_clear_of(&self, region: &Aabb) -> bool {
        Plane::is_clear_of(self, region)
    }

    fn clearance(&self, from: DVec3) -> Option<f64> {
        let rounding = SLACK * (from.length() + self.point.length());
        Some((self.normal.dot(from - self.point).abs() - rounding).max(0.0))
    }

    fn method(&self) -> String {
        Plane::method(self).to_owned()
    }
}

impl<A: NotClassic> Bracketed for Plane<A> {
    #[inline(always)]
    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        Plane::t_bounds(self, &self.rough_crossing(ray, range.origin_error), ray, range)
    }

    #[inline(always)]
    fn refine(&self, ray: &Ray, _origin_side: Option<Side>) -> f64 {
        self.quick_crossing(ray)
    }

    #[inline(always)]
    fn refine_each(&self, rays: RayPacket, out: &mut [f64]) -> bool {
        Plane::refine_each(self, rays, out);
        true
    }
}

impl<A: NotClassic> Certified for Plane<A> {
    fn is_on_surface(&self, at: DVec3, error: f64) -> bool {
        Plane::is_on_surface(self, at, error)
    }

    fn fine_distance(&self, ray: &Ray, _distance: f64) -> Option<DoubleDouble> {
        Some(self.exact_crossing(ray))
    }
}
