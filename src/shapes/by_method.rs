//! Shapes whose hits are found by another root-finding method, for comparison.

use glam::DVec3;
use tabray_exact::roots::Method;
use tabray_world::any_shape::AnyShape;
use tabray_world::certify::{Enclosure, Precision, Premise};
use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayBall, RayRange};
use tabray_world::geometry::sight::Sight;
use tabray_world::hittable::{Facts, Hittable};
use tabray_world::packets::shape::{HitQueries, ScalarIntersect, by_distance};

/// Returns a shape whose hits are found by this method, if they are [searched](is_searched). Its proofs are those of
/// the original.
pub fn by_method(shape: AnyShape, method: Method) -> AnyShape {
    AnyShape::of_packets(WithMethod { shape, method })
}

/// Tells whether a shape's hits are roots of a function along a ray.
pub fn is_searched(shape: &AnyShape) -> bool {
    let any = Ray { origin: DVec3::ZERO, dir: DVec3::Z };
    shape.packets().distance_by(Method::Steps, &any, &RayRange::ALL).is_some()
}

/// A shape whose hits are found by another method.
struct WithMethod {
    shape: AnyShape,
    method: Method,
}

impl Hittable for WithMethod {
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        self.shape.packets().distance_by(self.method, ray, range).unwrap_or(MISS)
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        self.shape.normal(at)
    }

    fn facts(&self) -> Facts {
        // The searches of other methods are not counted.
        Facts { may_be_costly: false, ..self.shape.facts() }
    }
}

impl ScalarIntersect for WithMethod {
    type Author = Self;

    fn author(&self) -> &Self {
        self
    }

    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        let is_on_surface = || self.is_on_surface(ray.origin, range.origin_error);
        by_distance(ray, range, is_on_surface, |range| Some(self.distance(ray, range)))
    }
}

impl HitQueries for WithMethod {
    fn is_on_surface(&self, at: DVec3, error: f64) -> bool {
        self.shape.is_on_surface(at, error)
    }

    fn premises(&self, of: &'static str, each: &mut dyn FnMut(&'static str, Premise)) {
        self.shape.premises(of, each);
    }

    fn certify(&self, sight: &Sight, precision: Precision) -> (Enclosure, usize) {
        self.shape.certify_part(sight, precision)
    }
}
