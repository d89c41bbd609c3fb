//! Hits of ellipsoids, and their certainty.

use super::Ellipsoid;
use crate::{sphere, uv};
use glam::{DVec2, DVec3};
use tabray_exact::interval::Interval;
use tabray_exact::scalar::{Scalar, per_axis};
use tabray_world::accuracy::{AccuracyTag, NotClassic};
use tabray_world::certify::Equation;
use tabray_world::geometry::ray::{Bracket, Ray, RayBall, RayRange, Side};
use tabray_world::hittable::{Bracketed, Certified, Facts, Hittable, Sides};

impl<A: AccuracyTag> Hittable for Ellipsoid<A> {
    #[inline(always)]
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        if A::IS_CLASSIC {
            let (from, dir) = self.scaled(ray);
            return range.keep(sphere::classic(from, dir, self.radius));
        }
        range.keep(sphere::distance::<A>(&self.line(ray), self.radius, range.origin_side))
    }

    #[inline]
    fn normal(&self, at: DVec3) -> DVec3 {
        self.unit_normal(at)
    }

    #[inline]
    fn facts(&self) -> Facts {
        Facts {
            can_hit_itself: if A::IS_CLASSIC { Sides::NONE } else { Sides::INSIDE },
            is_two_sided: !A::IS_CLASSIC,
            ..Facts::within(self.around())
        }
    }

    fn uv(&self, at: DVec3) -> Option<DVec2> {
        Some(uv::on_sphere(((at - self.center) / self.scale).normalize_or_zero()))
    }

    fn why_not_closed(&self) -> Option<&'static str> {
        None
    }

    fn method(&self) -> String {
        sphere::method::<A>().to_owned()
    }
}

impl<A: NotClassic> Bracketed for Ellipsoid<A> {
    #[inline(always)]
    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        Ellipsoid::t_bounds(self, ray, range)
    }

    #[inline(always)]
    fn refine(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        sphere::refine::<A>(&self.line(ray), self.radius, origin_side)
    }
}

impl<A: NotClassic> Certified for Ellipsoid<A> {
    fn is_on_surface(&self, at: DVec3, error: f64) -> bool {
        Ellipsoid::is_on_surface(self, at, error)
    }
}

impl<A> Equation for Ellipsoid<A> {
    const IS_QUADRATIC: bool = true;

    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        Ellipsoid::value(self, at)
    }
    fn uv_bounds(&self, at: [Interval; 3]) -> Option<[Interval; 2]> {
        let n = Interval::constant;
        Some(uv::bounds_on_sphere(per_axis(|axis| (at[axis] - n(self.center[axis])) / n(self.scale[axis]))))
    }
}
