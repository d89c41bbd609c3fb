//! A plane: flat and infinite.

use crate::numeric::double_double::scaled;
use crate::prelude::*;
use crate::shapes::plane::{Flat, Plane};

pub static NORMAL: Pparm<DVec3> =
    Pparm::required("normal", "a vector perpendicular to the plane, pointing to its lit side")
        .nonzero()
        .shown(|normal| scaled(normal).normalize());
pub static POINT: Pparm<DVec3> = Pparm::required("point", "a point on the plane").unit("world coordinates");

/// The rows of every kind of plane.
pub const TABLE: Table = &[&NORMAL, &POINT];

inventory::submit! {
    Entity::shape("plane", "an infinite plane", &[TABLE], |args| Ok(body(args, shape(args))))
}

/// Makes an object of a plane, or of a part of one, of an entity whose table has the rows of [`TABLE`].
pub fn body(args: &Args, shape: AnyShape) -> Body {
    Body::plain(shape).anchored(args.get(&POINT), 1.0)
}

/// Makes the plane of an entity whose table has the rows of [`TABLE`].
pub fn shape(args: &Args) -> AnyShape {
    match args.accuracy() {
        Accuracy::Classic => Shape::new(plane::<Classic>(args)).classic().into(),
        Accuracy::Draft | Accuracy::Exact => exact(plane::<Exact>(args)),
        Accuracy::Strict => exact(plane::<Strict>(args)),
    }
}

fn exact<A: Bounded>(plane: Plane<A>) -> AnyShape {
    Shape::new(plane.from_nearest_point()).flat().certified().into()
}

/// Makes the plane of an entity whose table has the rows of [`TABLE`], with hits of accuracy `A`.
pub fn plane<A>(args: &Args) -> Plane<A> {
    Plane::with_normal(args.get(&NORMAL), args.get(&POINT)).up_to(args.planes_end_at())
}

impl<A: Marker> Hittable for Plane<A> {
    #[inline(always)]
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        self.keep(self.crossing(ray), ray, range)
    }

    #[inline]
    fn normal(&self, _at: DVec3) -> DVec3 {
        self.normal
    }

    #[inline]
    fn can_hit_itself(&self, _leaving: Side) -> bool {
        false
    }

    fn is_clear_of(&self, region: &Aabb) -> bool {
        Plane::is_clear_of(self, region)
    }

    fn clearance(&self, from: DVec3) -> Option<f64> {
        let rounding = SLACK * (from.length() + self.point.length());
        Some((self.normal.dot(from - self.point).abs() - rounding).max(0.0))
    }

    fn ends_as_planes(&self) -> bool {
        true
    }

    fn plane(&self) -> Option<[DVec3; 2]> {
        Some([self.point, self.normal])
    }

    fn reach(&self) -> f64 {
        self.point.abs().max_element()
    }

    fn method(&self) -> String {
        Plane::method(self).to_owned()
    }
}

impl<A: Bounded> Bracketed for Plane<A> {
    #[inline(always)]
    fn t_bounds(&self, ray: &Ray, range: &RayRange) -> Bracket {
        Plane::t_bounds(self, &self.rough_crossing(ray, range.origin_error), ray, range)
    }

    #[inline(always)]
    fn refine(&self, ray: &Ray, _origin_side: Option<Side>) -> f64 {
        self.quick_crossing(ray)
    }
}

impl<A: Bounded> Flat for Plane<A> {
    type Accuracy = A;

    #[inline(always)]
    fn flat(&self) -> &Plane<A> {
        self
    }
}

impl<A: Bounded> Certified for Plane<A> {
    fn touches(&self, at: DVec3, error: f64) -> bool {
        Plane::touches(self, at, error)
    }

    fn fine_distance(&self, ray: &Ray, _distance: f64) -> Option<DoubleDouble> {
        Some(self.exact_crossing(ray))
    }
}
