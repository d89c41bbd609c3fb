//! An ellipsoid: a sphere stretched along the axes.

use super::sphere::{TABLE as SPHERE, center_and_radius};
use crate::numeric::double_double::{exponent_to_one, times_power_of_two};
use crate::prelude::*;
use crate::shapes::sphere::{self, SphereLine};
use std::marker::PhantomData;

static SCALE: Pparm<DVec3> = Pparm::required("scale", "the scale factors along x, y and z")
    .must("positive in each dimension", |scale: &DVec3| scale.min_element() > 0.0);

const TABLE: Table = &[&SCALE as &dyn Row];

inventory::submit! {
    Entity::shape("ellipsoid", "a sphere scaled along the coordinate axes", &[SPHERE, TABLE], |args| {
        Ok(Body::plain(shape(args)))
    })
}

fn shape(args: &Args) -> AnyShape {
    let ((center, radius), scale) = (center_and_radius(args), args.get(&SCALE));
    match args.accuracy() {
        Accuracy::Classic => Shape::new(Ellipsoid::<Classic>::new(center, radius, scale)).classic().into(),
        Accuracy::Draft => exact::<Draft>(center, radius, scale),
        Accuracy::Exact => exact::<Exact>(center, radius, scale),
        Accuracy::Strict => exact::<Strict>(center, radius, scale),
    }
}

fn exact<A: Bounded>(center: DVec3, radius: f64, scale: DVec3) -> AnyShape {
    // Moving a power of two from the scale to the radius changes nothing but the size of the squares, which then do not
    // overflow or underflow as easily.
    let exponent = exponent_to_one(scale.min_element());
    let scale = DVec3::from(scale.to_array().map(|part| times_power_of_two(part, exponent)));
    let ellipsoid = Ellipsoid::<A>::new(center, times_power_of_two(radius, -exponent), scale);
    Shape::new(ellipsoid).bracketed().certified().into()
}

/// A sphere in a space that is divided by `scale` around the ellipsoid's centre.
struct Ellipsoid<A> {
    center: DVec3,
    radius: f64,
    scale: DVec3,
    /// The reciprocals of `scale`, in double-double arithmetic.
    squeeze: [DoubleDouble; 3],
    /// The reciprocal of the smallest component of `scale`.
    most_squeezed: f64,
    accuracy: PhantomData<A>,
}

impl<A> Ellipsoid<A> {
    fn new(center: DVec3, radius: f64, scale: DVec3) -> Self {
        let squeeze = scale.to_array().map(|part| DoubleDouble::from(1.0) / DoubleDouble::from(part));
        let most_squeezed = 1.0 / scale.min_element();
        Self { center, radius, scale, squeeze, most_squeezed, accuracy: PhantomData }
    }

    /// Returns the origin and the direction of a ray in the divided space. The direction is no longer a unit vector, so
    /// distances along the ray are unchanged.
    #[inline(always)]
    fn squeezed(&self, ray: &Ray) -> (DVec3, DVec3) {
        ((ray.origin - self.center) / self.scale, ray.dir / self.scale)
    }

    /// Returns a ray in the divided space, in double-double arithmetic.
    #[inline(always)]
    fn line(&self, ray: &Ray) -> SphereLine {
        SphereLine::squeezed(ray, self.center, &self.squeeze)
    }

    fn around(&self) -> Aabb {
        let reach = self.radius * self.scale;
        Aabb { low: self.center - reach, high: self.center + reach }
    }

    #[inline(always)]
    fn normal_at(&self, at: DVec3) -> DVec3 {
        ((at - self.center) / (self.scale * self.scale)).normalize()
    }
}

impl Hittable for Ellipsoid<Classic> {
    #[inline(always)]
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        let (from, dir) = self.squeezed(ray);
        range.keep(sphere::classic(from, dir, self.radius))
    }

    #[inline]
    fn normal(&self, at: DVec3) -> DVec3 {
        self.normal_at(at)
    }

    fn bounds(&self) -> Option<Aabb> {
        Some(self.around())
    }

    #[inline]
    fn can_hit_itself(&self, _leaving: Side) -> bool {
        false
    }

    fn method(&self) -> String {
        sphere::CLASSIC_METHOD.to_owned()
    }
}

impl<A: Bounded> Hittable for Ellipsoid<A> {
    #[inline(always)]
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        range.keep(sphere::distance::<A>(&self.line(ray), self.radius, range.origin_side))
    }

    #[inline]
    fn normal(&self, at: DVec3) -> DVec3 {
        self.normal_at(at)
    }

    fn bounds(&self) -> Option<Aabb> {
        Some(self.around())
    }

    #[inline]
    fn can_hit_itself(&self, leaving: Side) -> bool {
        leaving == Side::Inside
    }

    fn is_two_sided(&self) -> bool {
        true
    }

    fn method(&self) -> String {
        sphere::method::<A>().to_owned()
    }
}

impl<A: Bounded> Bracketed for Ellipsoid<A> {
    #[inline(always)]
    fn t_bounds(&self, ray: &Ray, range: &RayRange) -> Bracket {
        let (from, dir) = self.squeezed(ray);
        let (inverse, error) = (1.0 / dir.dot(dir), range.origin_error / self.scale.min_element());
        let spread = self.most_squeezed * inverse.sqrt();
        sphere::t_bounds(from, dir, inverse, spread, self.radius, range.origin_side, error)
    }

    #[inline(always)]
    fn t_bounds_within(&self, ray: &Ray, _range: &RayRange, drift: Drift) -> Bracket {
        let (from, dir) = self.squeezed(ray);
        let inverse = 1.0 / dir.dot(dir);
        let spread = self.most_squeezed * inverse.sqrt();
        let drift = Drift { origin: drift.origin * self.most_squeezed, dir: drift.dir * spread };
        let spread = spread + sphere::spread_within(from, self.radius, drift);
        sphere::t_bounds(from, dir, inverse, spread, self.radius, None, 0.0)
    }

    #[inline(always)]
    fn refine(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        sphere::refine::<A>(&self.line(ray), self.radius, origin_side)
    }
}

impl<A: Bounded> Certified for Ellipsoid<A> {
    fn touches(&self, at: DVec3, error: f64) -> bool {
        // To first order, an error moves the distance from the centre of the divided space by at most the error times
        // this distance's gradient.
        let from = (at - self.center) / self.scale;
        let gradient = (from / self.scale).length() / from.length();
        sphere::touches(from, self.radius, error * gradient)
    }
}

impl<A> Equation for Ellipsoid<A> {
    const IS_QUADRATIC: bool = true;

    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        let part = |axis: usize| {
            ((at[axis] - N::constant(self.center[axis])) / N::constant(self.scale[axis])).powi(2)
        };
        part(0) + part(1) + part(2) - N::constant(self.radius).powi(2)
    }
}
