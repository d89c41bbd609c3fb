//! Shapes whose hits are found by another root-finding method, for comparison.

use crate::geometry::ray::{MISS, Ray, RayRange};
use crate::geometry::sight::Sight;
use crate::world::any_shape::AnyShape;
use crate::world::certify::{Enclosure, Precision, Premise};
use crate::world::hittable::{ByDistance, Facts, Hittable, Shape, TieBreaking};
use crate::world::packets::shape::HitQueries;
use glam::DVec3;
use tabray_exact::double_double::DoubleDouble;
use tabray_exact::roots::Method;

/// Returns a shape whose hits are found by this method, if they are [searched](is_searched). Its proofs are those of
/// the original.
pub fn by_method(shape: AnyShape, method: Method) -> AnyShape {
    Shape::new(WithMethod { shape, method }).by::<ByDistance, OriginalProofs>().into()
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

/// Takes the proofs of hits from the original shape.
struct OriginalProofs;

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

impl TieBreaking for OriginalProofs {}

impl HitQueries for Shape<WithMethod, ByDistance, OriginalProofs> {
    fn is_on_surface(&self, at: DVec3, error: f64) -> bool {
        self.shape.shape.is_on_surface(at, error)
    }

    fn fine_distance(&self, _ray: &Ray, _distance: f64) -> Option<DoubleDouble> {
        None
    }

    fn premises(&self, of: &'static str, each: &mut dyn FnMut(&'static str, Premise)) {
        self.shape.shape.premises(of, each);
    }

    fn certify(&self, sight: &Sight, precision: Precision) -> Enclosure {
        self.shape.shape.certify(sight, precision)
    }

    fn distance_by(&self, _method: Method, _ray: &Ray, _range: &RayRange) -> Option<f64> {
        None
    }
}
