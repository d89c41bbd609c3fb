//! Hits of quadrics, and their certainty.

use super::Quadric;
use glam::DVec3;
use tabray_exact::scalar::Scalar;
use tabray_world::accuracy::{AccuracyTag, NotClassic};
use tabray_world::certify::Equation;
use tabray_world::geometry::ray::{Bracket, Ray, RayBall, RayRange, Side};
use tabray_world::hittable::{Bracketed, Certified, Facts, Hittable, Sides};

impl<A: AccuracyTag> Hittable for Quadric<A> {
    /// Returns the nearer of the roots in the box.
    #[inline(always)]
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        if A::IS_CLASSIC {
            return self.classic_distance(ray, range);
        }
        let quick = self.fast_distance(ray, range);
        if quick.is_nan() { range.keep(self.exact_hit(ray, range.near)) } else { quick }
    }

    #[inline]
    fn normal(&self, at: DVec3) -> DVec3 {
        self.unit_normal(at)
    }

    #[inline]
    fn facts(&self) -> Facts {
        Facts {
            // The box only clips, and may be far larger than the visible part of the surface. Its corners thus do not
            // count.
            max_coordinate: self.center.abs().max_element(),
            can_hit_itself: Sides::both_if(!A::IS_CLASSIC),
            is_two_sided: !A::IS_CLASSIC,
            ..Facts::within(self.around())
        }
    }

    fn why_not_closed(&self) -> Option<&'static str> {
        (!self.is_closed())
            .then_some("it is not an ellipsoid within its box whose equation is below J inside")
    }

    fn method(&self) -> String {
        Self::METHOD.to_owned()
    }

    fn clearance(&self, from: DVec3) -> Option<f64> {
        Some(self.clearance_by_value(from).max(self.clearance_by_box(from)))
    }
}

impl<A: NotClassic> Bracketed for Quadric<A> {
    #[inline(always)]
    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        let may_leave = range.origin_error > 0.0 && range.origin_side.is_none();
        if may_leave && self.is_on_surface(ray.origin, range.origin_error) {
            return Bracket::UNKNOWN;
        }
        Quadric::t_bounds(self, ray, range)
    }

    #[inline(always)]
    fn refine(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        self.fast_distance(ray, &RayRange { origin_side, ..RayRange::ALL })
    }
}

impl<A: NotClassic> Certified for Quadric<A> {}

impl<A> Equation for Quadric<A> {
    const IS_QUADRATIC: bool = true;

    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        Quadric::value(self, at)
    }

    fn inside_trim<N: Scalar>(&self, at: [N; 3]) -> N {
        self.inside_box(at)
    }
}
