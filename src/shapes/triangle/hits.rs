//! Hits of triangles, and their certainty.

use super::loose::LooseTriangle;
use crate::uv;
use glam::{DVec2, DVec3};
use tabray_exact::double_double::DoubleDouble;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::{Scalar, dot, per_axis};
use tabray_world::accuracy::{AccuracyTag, NotClassic};
use tabray_world::certify::Equation;
use tabray_world::geometry::aabb::Aabb;
use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayBall, RayRange, Side};
use tabray_world::geometry::ray_packet::RayPacket;
use tabray_world::hittable::{Bracketed, Certified, Facts, Hittable};

impl<A: AccuracyTag> Hittable for LooseTriangle<A> {
    #[inline(always)]
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        let whole = self.whole();
        let distance = whole.plane.distance(ray, range);
        let is_hit = if A::IS_CLASSIC { whole.contains(ray.at(distance)) } else { whole.is_passed_by(ray) };
        if is_hit { distance } else { MISS }
    }

    #[inline]
    fn normal(&self, _at: DVec3) -> DVec3 {
        self.normal
    }

    #[inline]
    fn facts(&self) -> Facts {
        let Facts { bounds, max_coordinate, .. } = Facts::within(Aabb::around(&self.corners));
        Facts { bounds, max_coordinate, ..self.rough_plane().facts() }
    }

    fn uv(&self, at: DVec3) -> Option<DVec2> {
        Some(uv::on_triangle(self.corners, at))
    }

    fn is_clear_of(&self, region: &Aabb) -> bool {
        self.rough_plane().is_clear_of(region) || !Aabb::around(&self.corners).overlaps(region)
    }

    fn method(&self) -> String {
        self.rough_plane().method().to_owned()
    }
}

impl<A: NotClassic> Bracketed for LooseTriangle<A> {
    #[inline(always)]
    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        LooseTriangle::t_bounds(self, ray, range)
    }

    #[inline(always)]
    fn refine(&self, ray: &Ray, _origin_side: Option<Side>) -> f64 {
        // A certain hit lies inside the triangle.
        self.whole().plane.quick_crossing(ray)
    }

    #[inline(always)]
    fn is_missed_by(&self, rays: RayPacket) -> bool {
        LooseTriangle::is_missed_by(self, rays)
    }

    #[inline(always)]
    fn refine_each(&self, rays: RayPacket, out: &mut [f64]) -> bool {
        self.whole().plane.refine_each(rays, out);
        true
    }
}

impl<A: NotClassic> Certified for LooseTriangle<A> {
    fn is_on_surface(&self, at: DVec3, error: f64) -> bool {
        self.rough_plane().is_on_surface(at, error)
    }

    fn fine_distance(&self, ray: &Ray, _distance: f64) -> Option<DoubleDouble> {
        Some(self.whole().plane.exact_crossing(ray))
    }
}

impl<A: AccuracyTag> Equation for LooseTriangle<A> {
    const IS_QUADRATIC: bool = true;

    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        let corner = self.corners[0].to_array();
        dot(self.whole().area_normal(), per_axis(|axis| at[axis] - N::constant(corner[axis])))
    }

    fn inside_trim<N: Scalar>(&self, at: [N; 3]) -> N {
        self.rough_plane().inside_trim(at).min(self.whole().inside(at))
    }
    fn uv_bounds(&self, at: [Interval; 3]) -> Option<[Interval; 2]> {
        Some(uv::bounds_on_triangle(self.corners, at))
    }
}
