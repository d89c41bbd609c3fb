//! What rays hit, without an image: as the tracer finds it, and as it is proven.
//!
//! ```
//! use tabray_core::glam::DVec3;
//! use tabray_core::prelude::*;
//! use tabray_core::query::first::{FirstHits, first_of};
//! # struct Ball;
//! # impl Implicit for Ball {
//! #     fn value<N: Scalar>(&self, at: [N; 3]) -> N { dot(at, at) - N::constant(4.0) }
//! #     fn bounds(&self) -> [DVec3; 2] { [DVec3::splat(-2.0), DVec3::splat(2.0)] }
//! # }
//! let ray = tabray_core::query::ExactRay::new(DVec3::new(5.0, 0.0, 0.0), DVec3::new(-2.0, 0.0, 0.0)).expect("a ray");
//! let ball = Body::implicit(Ball, Frame::at(DVec3::ZERO)).shape;
//! let (FirstHits::Certain(Some((0, at))), _) = first_of([(0, &ball)], ray.sight()) else { panic!("the ball is hit") };
//! assert_eq!(ray.t(at).low, 1.5);
//! ```

pub mod answer;
pub mod first;
mod ray;

pub use answer::{Answer, Surroundings, Verdict};
pub use ray::ExactRay;

use crate::geometry::aabb::{Aabb, SLACK};
use crate::geometry::sight::Line;
use crate::render::plan::Plan;
use crate::render::trace;
use crate::scene::model::Model;
use crate::world::any_shape::AnyShape;
use crate::world::certify::Precision;
use f256::f256;
use first::{FirstHits, first_of, last_end};
use tabray_exact::interval::{Float, Interval};

/// A scene that is asked what rays hit.
pub struct Query<'m> {
    plan: Plan<'m>,
}

/// The first hit of a ray, as the tracer finds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstHit {
    /// The index of the object in the scene.
    pub object: usize,
    /// The distance, in world units, rounded.
    pub distance: f64,
}

impl<'m> Query<'m> {
    /// Prepares a scene: many objects get a tree. Its camera is of no importance.
    pub fn new(model: &'m Model) -> Self {
        Self { plan: Plan::new(model) }
    }

    /// Returns the scene.
    pub fn model(&self) -> &'m Model {
        self.plan.model
    }

    /// Returns the ray through the middle of a pixel of the scene's camera, by column and row from the lower left corner.
    pub fn camera_ray(&self, x: usize, y: usize) -> ExactRay {
        ExactRay::of_camera(self.plan.camera.sight(x as f64, y as f64))
    }

    /// Finds the first hit of each ray as the tracer does, many rays at a time.
    pub fn first_hits(&self, rays: &[ExactRay]) -> Vec<Option<FirstHit>> {
        let sights: Vec<_> = rays.iter().map(|ray| ray.sight().clone()).collect();
        let hits = trace::first_hits(&self.plan, &sights).into_iter();
        hits.map(|hit| hit.map(|hit| FirstHit { object: hit.index, distance: hit.distance })).collect()
    }

    /// Proves what a ray hits first. `found` is what the tracer finds, where that is known; the proof does not depend on
    /// it, but is faster with it.
    ///
    /// A proof is about the real numbers of the scene and of the ray ([`certify`](crate::world::certify)). Where a scene has
    /// many objects, those are left out whose bounding boxes the ray certainly misses or meets later.
    pub fn first(&self, ray: &ExactRay, found: Option<FirstHit>) -> (FirstHits, Precision) {
        let (plan, sight) = (&self.plan, ray.sight());
        let shape = |index: usize| (index, &plan.model.objects[index].shape);
        let Some(tree) = &plan.tree else { return first_of((0..plan.model.objects.len()).map(shape), sight) };
        let end = found.map_or(f256::INFINITY, |hit| last_end([shape(hit.object)], sight));
        let line = sight.line::<Interval>();
        let mut near = plan.unbounded.clone();
        tree.within(|bounds| enters(&line, bounds).is_some_and(|from| from <= end), |index| near.push(index));
        // Of objects in one place, those that come first in the scene do so in the answer.
        near.sort_unstable();
        first_of(near.into_iter().map(shape), sight)
    }

    /// Returns the shape of an object.
    pub fn shape(&self, object: usize) -> &'m AnyShape {
        &self.plan.model.objects[object].shape
    }
}

/// Returns a lower bound on the distance at which a line is in a box, which is widened for its rounding; `None` if it
/// certainly misses the box.
fn enters(line: &Line<Interval>, Aabb { low, high }: &Aabb) -> Option<f256> {
    let slack = SLACK * low.abs().max(high.abs()).max_element();
    line.clip(*low - slack, *high + slack).map(|(from, _)| f256::of(from))
}
