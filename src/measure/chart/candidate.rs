//! The methods by which a scene's hits can be found, each as a model of the scene.

use super::data::Family;
use std::io;
use tabray_core::scene::choice::Choice;
use tabray_core::scene::model::{Model, Object};
use tabray_core::shapes::by_method::{by_method, is_searched};
use tabray_core::world::accuracy::Accuracy;
use tabray_exact::roots::Method;

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
    /// The greatest error of a hit's distance, or of its distance from the surface, that the method allows itself
    /// besides rounding, in world units.
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
            true => Object { shape: by_method(object.shape, method), ..object },
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
