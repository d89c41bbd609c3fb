//! The methods by which a scene's hits can be found, each as a model of the scene.

use super::data::Family;
use crate::geometry::aabb::Aabb;
use crate::geometry::ray::{MISS, Ray, RayRange, Side};
use crate::geometry::roots::Method;
use crate::geometry::sight::Sight;
use crate::numeric::double_double::DoubleDouble;
use crate::scene::choice::Choice;
use crate::scene::model::{Model, Object};
use crate::world::accuracy::Accuracy;
use crate::world::any_shape::AnyShape;
use crate::world::certify::{Enclosure, Precision, Premise};
use crate::world::hittable::Hittable;
use crate::world::packets::shape::{Coincidence, Proofs};
use crate::world::shape::{ByDistance, Shape};
use glam::DVec3;
use std::io;

/// Loads the scene again, with the given accuracy or with its own.
pub type Load<'l> = &'l dyn Fn(Option<Accuracy>) -> io::Result<Model>;

/// A scene, and a method of finding its hits.
pub struct Candidate {
    pub name: String,
    pub family: Family,
    pub model: Model,
    /// The accuracy, where a scene can choose it.
    pub accuracy: Option<Accuracy>,
    pub is_default: bool,
    /// The greatest error of a hit's distance, or of its distance from the surface, that the method allows itself beside
    /// rounding, in world units.
    pub promise: f64,
}

/// Returns all candidates: the accuracies that a scene can choose, and, where a shape's hits are roots of a function
/// along a ray, other root finders.
pub fn all(load: Load) -> io::Result<Vec<Candidate>> {
    let default = load(None)?.camera.value.accuracy;
    let mut candidates = Vec::new();
    for accuracy in Accuracy::all() {
        let (family, promise) = match accuracy {
            Accuracy::Classic => (Family::Notes, 1e-3),
            Accuracy::Draft => (Family::Own, 1e-3),
            Accuracy::Exact | Accuracy::Strict => (Family::Own, 0.0),
        };
        candidates.push(Candidate {
            name: accuracy.option().name.to_owned(),
            family,
            model: load(Some(accuracy))?,
            accuracy: Some(accuracy),
            is_default: accuracy == default,
            promise,
        });
    }
    for method in Method::ALL {
        let mut model = load(Some(Accuracy::Exact))?;
        if !model.objects.iter().any(|object| is_searched(&object.shape)) {
            break;
        }
        let by = |object: Object| match is_searched(&object.shape) {
            true => Object {
                shape: Shape::new(WithMethod { shape: object.shape, method })
                    .by::<ByDistance, OriginalProofs>()
                    .into(),
                ..object
            },
            false => object,
        };
        model.objects = model.objects.into_iter().map(by).collect();
        candidates.push(Candidate {
            name: method.to_string(),
            family: match method {
                Method::Steps => Family::Notes,
                Method::Samples(..) | Method::Turning(_) => Family::Sampling,
                Method::Tracing => Family::Tracing,
                Method::Intervals | Method::Taylor => Family::Bounds,
            },
            model,
            accuracy: None,
            is_default: false,
            promise: method.promise(),
        });
    }
    Ok(candidates)
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

/// Takes the proofs of its hits from the original shape.
struct OriginalProofs;

impl Hittable for WithMethod {
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        self.shape.packets().distance_by(self.method, ray, range).unwrap_or(MISS)
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        self.shape.normal(at)
    }

    fn bounds(&self) -> Option<Aabb> {
        self.shape.bounds()
    }

    fn can_hit_itself(&self, leaving: Side) -> bool {
        self.shape.can_hit_itself(leaving)
    }

    fn is_two_sided(&self) -> bool {
        self.shape.is_two_sided()
    }
}

impl Coincidence for OriginalProofs {}

impl Proofs for Shape<WithMethod, ByDistance, OriginalProofs> {
    fn touches(&self, at: DVec3, error: f64) -> bool {
        self.shape.shape.touches(at, error)
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
