//! An ellipsoid: a sphere stretched along the axes.

use super::sphere::{TABLE as SPHERE, center_and_radius};
use crate::prelude::*;
use crate::shapes::Ellipsoid;
use crate::shapes::{sphere, uv};

static SCALE: Pparm<DVec3> = Pparm::required("scale", "the scale factors along x, y and z")
    .must("positive in each dimension", |scale: &DVec3| scale.min_element() > 0.0);

const TABLE: Table = &[&SCALE as &dyn Row];

inventory::submit! {
    Entity::shape("ellipsoid", "a sphere scaled along the coordinate axes", &[SPHERE, TABLE], |args| {
        Ok(body(args, args.get(&SCALE)))
    })
}

/// Makes the object of an entity whose table has the rows of a sphere.
pub fn body(args: &Args, scale: DVec3) -> Body {
    let (center, radius) = center_and_radius(args);
    Body::plain(match args.accuracy() {
        Accuracy::Classic => Shape::new(Ellipsoid::<Classic>::new(center, radius, scale)).classic().into(),
        Accuracy::Draft => exact(Ellipsoid::<Draft>::exact(center, radius, scale)),
        Accuracy::Exact => exact(Ellipsoid::<Exact>::exact(center, radius, scale)),
        Accuracy::Strict => exact(Ellipsoid::<Strict>::exact(center, radius, scale)),
    })
}

fn exact<A: Bounded>(ellipsoid: Ellipsoid<A>) -> AnyShape {
    Shape::new(ellipsoid).bracketed().certified().into()
}

impl<A: Marker> Hittable for Ellipsoid<A> {
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

    fn uv(&self, at: DVec3) -> Option<DVec2> {
        Some(uv::on_sphere(((at - self.center) / self.scale).normalize_or_zero()))
    }

    fn bounds(&self) -> Option<Aabb> {
        Some(self.around())
    }

    #[inline]
    fn can_hit_itself(&self, leaving: Side) -> bool {
        !A::IS_CLASSIC && leaving == Side::Inside
    }

    fn openness(&self) -> Option<&'static str> {
        None
    }

    fn is_two_sided(&self) -> bool {
        !A::IS_CLASSIC
    }

    fn method(&self) -> String {
        sphere::method::<A>().to_owned()
    }
}

impl<A: Bounded> Bracketed for Ellipsoid<A> {
    #[inline(always)]
    fn t_bounds(&self, ray: &Ray, range: &RayRange) -> Bracket {
        Ellipsoid::t_bounds(self, ray, range)
    }

    #[inline(always)]
    fn t_bounds_within(&self, ray: &Ray, _range: &RayRange, drift: Drift) -> Bracket {
        Ellipsoid::t_bounds_within(self, ray, drift)
    }

    #[inline(always)]
    fn refine(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        sphere::refine::<A>(&self.line(ray), self.radius, origin_side)
    }
}

impl<A: Bounded> Certified for Ellipsoid<A> {
    fn touches(&self, at: DVec3, error: f64) -> bool {
        Ellipsoid::touches(self, at, error)
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
