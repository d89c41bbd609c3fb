//! Cases where the formulas of the course notes fail and the program's must not.
//!
//! Each test is a row of the measured list of failures, F01 to F24, or a lesson of the prototype. It first shows that
//! the naive form fails on the numbers of the row, and then that the program's shapes do not. Distances are compared in
//! ulps of the true distance, which is a literal computed with 50 digits.

#![allow(clippy::approx_constant, reason = "6.28 is the height of the rows' surfaces, and no turn")]
#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "it is what NaN does to a comparison that rows are about"
)]

mod leaning;
mod leaving;
mod lessons;
mod looks;
mod planes;
mod profiles;
mod revolved;
mod spheres;
mod together;

use crate::common::{model, registry};
use glam::{DVec3, dvec3};
use std::path::Path;
use tabray::geometry::{Ray, RayRange};
use tabray::scene::{self, Model};
use tabray::world::{AnyShape, Hittable};

const DOWN_Z: DVec3 = DVec3::NEG_Z;

/// Returns a scene with a single object; `camera` contains attributes of the camera, such as its accuracy.
fn text(camera: &str, object: &str) -> String {
    format!(
        "camera c {{ pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 {camera} }}
         material m {{ ambient 1 1 1 diffuse 1 1 1 }}
         {object}"
    )
}

/// Returns the shape of the last object, with the exact accuracy.
fn shape(object: &str) -> AnyShape {
    shape_of("", object)
}

/// Returns the shape of the last object, with the accuracy given to the camera.
fn shape_of(camera: &str, object: &str) -> AnyShape {
    last(model(&text(camera, object)))
}

fn last(mut model: Model) -> AnyShape {
    model.objects.pop().expect("a scene with an object").shape
}

/// Returns the loader's message about an object that it refuses.
fn refusal(object: &str) -> String {
    match scene::read(registry(), "scene", Path::new(""), text("", object).as_bytes(), None) {
        Ok(_) => panic!("nothing is wrong with {object}"),
        Err(report) => report.to_string(),
    }
}

/// Returns the distance of a ray's first hit; the row gives its direction as a unit vector.
fn distance(shape: &dyn Hittable, origin: DVec3, dir: DVec3) -> f64 {
    shape.distance(&Ray { origin, dir }, &RayRange::ALL)
}

/// Writes a vector as a scene's text, to the last bit.
fn words(v: DVec3) -> String {
    format!("{} {} {}", v.x, v.y, v.z)
}

/// Returns the difference from the true value, in ulps of that value.
fn ulps(actual: f64, truth: f64) -> f64 {
    (actual - truth).abs() / (truth.abs().next_up() - truth.abs())
}

/// Asserts that a value differs from the true one by at most a few ulps.
#[track_caller]
fn holds(actual: f64, truth: f64, few: f64) {
    assert!(ulps(actual, truth) <= few, "{actual:?} is not {truth:?}: {:.1e} ulps off", ulps(actual, truth));
}

/// A generator of random numbers that are the same everywhere (SplitMix64).
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.bits() >> 11) as f64 / (1_u64 << 53) as f64)
    }

    /// Returns an integer from `low` to `high`.
    fn whole(&mut self, low: i64, high: i64) -> i64 {
        low + (self.bits() % (high - low + 1) as u64) as i64
    }

    /// Returns a direction with this cosine to a unit vector.
    fn around(&mut self, axis: DVec3, cosine: f64) -> DVec3 {
        let (across, up) = axis.any_orthonormal_pair();
        let turn = self.between(0.0, std::f64::consts::TAU);
        let sine = (1.0 - cosine * cosine).sqrt();
        (cosine * axis + sine * (turn.cos() * across + turn.sin() * up)).normalize()
    }
}

#[test]
fn ulps_count_from_the_true_value() {
    assert_eq!(ulps(1.0_f64.next_up(), 1.0), 1.0);
    assert_eq!(ulps(3.0, 3.0), 0.0);
    assert!(ulps(f64::INFINITY, 3.0) > 1e300, "a miss is far from any distance");
    assert_eq!(words(dvec3(0.1, -1e-300, 2.0)).split(' ').next(), Some("0.1"));
}
