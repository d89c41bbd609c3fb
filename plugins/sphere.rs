//! A sphere: all points at one distance from a centre.

use super::ellipsoid;
use std::marker::PhantomData;
use tabray::prelude::*;
use tabray::shapes::sphere::{self, SphereLine};
use tabray::shapes::uv;

static CENTER: Pparm<DVec3> = Pparm::required("center", "the position of the centre")
    .alias(&["centre"])
    .unit("world coordinates")
    .known_as(&["position", "location"]);
static RADIUS: Pparm<f64> = Pparm::required("radius", "the distance from the centre to the surface")
    .unit("world units")
    .positive()
    .dumped("radius", "\n");

/// The scale of the notes' spheres: with it, a sphere is an ellipsoid.
static SCALE: Pparm<Option<DVec3>> =
    Pparm::or("scale", "the scale factors along x, y and z, with which it is an ellipsoid", None)
        .must("positive in each dimension", |scale| scale.is_none_or(|scale| scale.min_element() > 0.0));

/// The rows of every shape with a centre and a radius.
pub const TABLE: Table = &[&CENTER, &RADIUS];

const OWN: Table = &[&SCALE as &dyn Row];

inventory::submit! {
    Entity::shape("sphere", "a sphere", &[TABLE, OWN], |args| {
        Ok(args.get(&SCALE).map_or_else(|| body(args), |scale| ellipsoid::body(args, scale)))
    })
    .known_as(&["ball"])
}

/// Makes the object of an entity whose table has the rows of [`TABLE`].
pub fn body(args: &Args) -> Body {
    let (center, radius) = center_and_radius(args);
    Body::plain(shape(center, radius, args.accuracy())).anchored(center, 2.0 * radius)
}

/// Makes the shape of a sphere.
pub fn shape(center: DVec3, radius: f64, accuracy: Accuracy) -> AnyShape {
    match accuracy {
        Accuracy::Classic => Shape::new(Sphere::<Classic>::new(center, radius)).classic().into(),
        Accuracy::Draft => Shape::new(Sphere::<Draft>::new(center, radius)).bracketed().certified().into(),
        Accuracy::Exact => Shape::new(Sphere::<Exact>::new(center, radius)).bracketed().certified().into(),
        Accuracy::Strict => Shape::new(Sphere::<Strict>::new(center, radius)).bracketed().certified().into(),
    }
}

/// Returns the centre and the radius of an entity whose table has the rows of [`TABLE`].
pub fn center_and_radius(args: &Args) -> (DVec3, f64) {
    (args.get(&CENTER), args.get(&RADIUS))
}

struct Sphere<A> {
    center: DVec3,
    radius: f64,
    accuracy: PhantomData<A>,
}

impl<A> Sphere<A> {
    fn new(center: DVec3, radius: f64) -> Self {
        Self { center, radius, accuracy: PhantomData }
    }
}

impl<A: AccuracyTag> Hittable for Sphere<A> {
    #[inline(always)]
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        if A::IS_CLASSIC {
            return range.keep(sphere::classic(ray.origin - self.center, ray.dir, self.radius));
        }
        range.keep(sphere::distance::<A>(&SphereLine::new(ray, self.center), self.radius, range.origin_side))
    }

    #[inline]
    fn normal(&self, at: DVec3) -> DVec3 {
        (at - self.center).normalize()
    }

    #[inline]
    fn facts(&self) -> Facts {
        Facts {
            can_hit_itself: if A::IS_CLASSIC { Sides::NONE } else { Sides::INSIDE },
            is_two_sided: !A::IS_CLASSIC,
            ..Facts::within(sphere::bounds(self.center, self.radius))
        }
    }

    fn uv(&self, at: DVec3) -> Option<DVec2> {
        Some(uv::on_sphere((at - self.center).normalize_or_zero()))
    }

    fn clearance(&self, from: DVec3) -> Option<f64> {
        Some(sphere::clearance(self.center, self.radius, from))
    }

    fn luminous(&self) -> Option<Luminous> {
        Some(Luminous::Ball(Ball { middle: self.center, radius: self.radius }))
    }

    fn why_not_closed(&self) -> Option<&'static str> {
        None
    }

    fn method(&self) -> String {
        sphere::method::<A>().to_owned()
    }
}

impl<A: NotClassic> Bracketed for Sphere<A> {
    #[inline(always)]
    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        let from = ray.origin - self.center;
        let spread = 1.0 + sphere::spread(from, self.radius, ray.drift);
        sphere::t_bounds(from, ray.dir, 1.0, spread, self.radius, range.origin_side, range.origin_error)
    }

    #[inline(always)]
    fn refine(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        sphere::refine::<A>(&SphereLine::new(ray, self.center), self.radius, origin_side)
    }
}

impl<A: NotClassic> Certified for Sphere<A> {
    fn is_on_surface(&self, at: DVec3, error: f64) -> bool {
        sphere::is_on_surface(at - self.center, self.radius, error)
    }
}

impl<A> Equation for Sphere<A> {
    const IS_QUADRATIC: bool = true;

    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        let part = |axis: usize| (at[axis] - N::constant(self.center[axis])).powi(2);
        part(0) + part(1) + part(2) - N::constant(self.radius).powi(2)
    }
    fn uv_bounds(&self, at: [Interval; 3]) -> Option<[Interval; 2]> {
        Some(uv::bounds_on_sphere(per_axis(|axis| at[axis] - Interval::constant(self.center[axis]))))
    }
}
