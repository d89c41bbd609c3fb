//! Queries about the hits of rays in a scene.

use super::answer::{Answer, Surroundings, Verdict};
use super::first::{FirstHits, first_by, first_of, last_end};
use super::ray::ExactRay;
use crate::geometry::aabb::{Aabb, SLACK};
use crate::geometry::sight::{Line, Sight};
use crate::render::observer::Hit;
use crate::render::plan::Plan;
use crate::render::trace;
use crate::scene::model::Model;
use crate::world::any_shape::AnyShape;
use crate::world::certify::{Enclosure, HitEnclosure, Precise, Precision};
use crate::world::hittable::SurfaceHit;
use f256::f256;
use tabray_exact::interval::{Float, Fraction, Interval, Wide};

/// A scene, prepared for queries about hits.
pub struct Query<'m> {
    plan: Plan<'m>,
}

impl<'m> Query<'m> {
    /// Prepares a scene: many objects get a tree. The rays need not be its camera's.
    pub fn new(model: &'m Model) -> Self {
        Self { plan: Plan::new(model) }
    }

    /// Returns the scene.
    pub fn model(&self) -> &'m Model {
        self.plan.model
    }

    /// Returns the ray through the middle of a pixel of the scene's camera, by column and row from the lower left
    /// corner.
    pub fn camera_ray(&self, x: usize, y: usize) -> ExactRay {
        ExactRay::of_camera(self.plan.camera.sight(x as f64, y as f64))
    }

    /// Finds the first hit of each ray as the tracer does, many rays at a time.
    pub fn first_hits(&self, rays: &[ExactRay]) -> Vec<Option<Hit<'m>>> {
        let sights: Vec<_> = rays.iter().map(|ray| ray.sight().clone()).collect();
        trace::first_hits(&self.plan, &sights)
    }

    /// Proves what a ray hits first. `found` is what the tracer finds, where that is known; the proof does not depend
    /// on it, but is faster with it.
    ///
    /// A proof is about the real numbers of the scene and of the ray ([`certify`](crate::world::certify)). In a scene
    /// with many objects, it leaves out those whose bounding boxes the ray certainly misses or meets later.
    pub fn first(&self, ray: &ExactRay, found: Option<&Hit>) -> (FirstHits, Precision) {
        let shape = |index: usize| (index, self.shape(index));
        let end = match (&self.plan.tree, found) {
            (Some(_), Some(hit)) => last_end([shape(hit.index)], ray.sight()),
            _ => f256::INFINITY,
        };
        first_of(self.near(ray, end).into_iter().map(shape), ray.sight())
    }

    /// Returns the objects that a ray may meet at or before a distance in lengths of the sight's direction, in the
    /// order of the scene; all of them where there are few.
    pub(super) fn near(&self, ray: &ExactRay, end: f256) -> Vec<usize> {
        near(&self.plan, ray.sight(), end)
    }

    /// Returns the shape of an object.
    pub fn shape(&self, object: usize) -> &'m AnyShape {
        &self.plan.model.objects[object].shape
    }
}

impl Query<'_> {
    /// Returns the first hits of rays as the tracer finds them, without a proof.
    pub fn traced(&self, rays: &[ExactRay]) -> Vec<Answer> {
        let answer = |(ray, hit): (&ExactRay, Option<Hit>)| match hit {
            None => Answer::miss(None),
            Some(Hit { index, distance, .. }) => Answer {
                verdict: Verdict::Hit,
                proof: None,
                object: Some(index),
                t: ray.t_at(distance),
                bounds: Interval { low: f64::NEG_INFINITY, high: f64::INFINITY },
                distance,
            },
        };
        rays.iter().zip(self.first_hits(rays)).map(answer).collect()
    }

    /// Returns what is proven about the first hits of rays. With 53 bits, bounds are some units in the last place of
    /// t wide. `is_tight` narrows them with 237 bits, which takes many times as long.
    pub fn proven(&self, rays: &[ExactRay], is_tight: bool) -> Vec<Answer> {
        let found = self.first_hits(rays);
        rays.iter().zip(found).map(|(ray, found)| self.proof(ray, found.as_ref(), is_tight)).collect()
    }

    /// Tells for each ray whether anything may be hit before its end, a t, as for shadows. `false` is proven.
    pub fn occluded(&self, rays: &[ExactRay], ends: &[f64]) -> Vec<bool> {
        let answers = self.proven(rays, false).into_iter().zip(ends);
        answers.map(|(answer, end)| answer.any_within(*end).verdict != Verdict::Miss).collect()
    }

    fn proof(&self, ray: &ExactRay, found: Option<&Hit>, is_tight: bool) -> Answer {
        let (first, precision) = self.first(ray, found);
        let answer = |verdict, object, at, precision| Answer::at(ray, verdict, object, at, precision);
        let (any, end) = match first {
            FirstHits::Certain(None) => return Answer::miss(Some(precision)),
            FirstHits::Certain(Some((object, at))) => {
                if is_tight
                    && precision == Precision::Double
                    && let Enclosure::Hits(at) = self.shape(object).certify(ray.sight(), Precision::Octuple)
                {
                    return answer(Verdict::Hit, Some(object), at, Precision::Octuple);
                }
                let same = found.filter(|hit| hit.index == object && precision == Precision::Double);
                // The tracer's distance is more accurate than the middle of bounds by 53 bits.
                return match same {
                    Some(Hit { distance, .. }) => Answer::traced(ray, object, ray.t(at), *distance),
                    None => answer(Verdict::Hit, Some(object), at, precision),
                };
            }
            FirstHits::OneOf { any, end } => (any, end),
        };
        let low = any.iter().filter_map(|(_, enclosure)| match enclosure {
            Enclosure::Misses => None,
            Enclosure::Hits(at) | Enclosure::Edge(at) => Some(at.low),
            Enclosure::Doubtful(from) => Some(*from),
        });
        let low = low.fold(end, Float::min);
        let first = any.first().map(|(index, _)| *index);
        if let [(object, Enclosure::Edge(at))] = any[..] {
            return answer(Verdict::Edge, Some(object), at, precision);
        }
        if any.iter().all(|(_, enclosure)| matches!(enclosure, Enclosure::Hits(_))) {
            return answer(Verdict::Tie, first, Wide { low, high: end }, precision);
        }
        // The tracer finds one of the objects in question.
        let (object, at) = (found.map(|hit| hit.index), Wide { low, high: end });
        let open = answer(Verdict::Undecided, object, at, precision);
        match found {
            None => open,
            Some(Hit { distance, .. }) => open.near(ray.t_at(*distance), *distance),
        }
    }

    /// Returns the surface at the hit of an answer; `None` for an answer without a hit. If a first hit is proven, so
    /// is its face, where the shape's faces are parts of its proofs. Where the ray passes through an edge, the face
    /// is one of those that share the edge.
    pub fn surroundings(&self, ray: &ExactRay, answer: &Answer) -> Option<Surroundings> {
        let shape = self.shape(answer.object.filter(|_| answer.distance.is_finite())?);
        let point = ray.at(answer.distance);
        let proven = answer.proof.filter(|_| answer.verdict == Verdict::Hit).and_then(|_| {
            let by_more =
                || face::<f256>(shape, ray, answer).or_else(|| face::<Fraction>(shape, ray, answer));
            face::<f64>(shape, ray, answer).or_else(by_more)
        });
        let SurfaceHit { normal, uv, face } = shape.surface_hit(&ray.sight().ray(), answer.distance, point);
        Some(Surroundings { point, normal, uv, face: proven.or(face) })
    }
}

/// Tells whether the first hit that the tracer finds through a plan is certainly not the first, by proofs of 53 bits.
pub fn is_contradicted(plan: &Plan, sight: &Sight) -> bool {
    let found = trace::first_hit(plan, sight).map(|hit| hit.index);
    let shape = |index: usize| (index, &plan.model.objects[index].shape);
    let end = last_end(found.map(shape), sight);
    let objects = near(plan, sight, end).into_iter().map(shape);
    !first_by(Precision::Double, objects, sight).may_be(found)
}

/// Returns the objects that a ray may meet at or before a distance, as [`Query::near`] does.
fn near(plan: &Plan, sight: &Sight, end: f256) -> Vec<usize> {
    let Some(tree) = &plan.tree else { return (0..plan.model.objects.len()).collect() };
    let line = sight.line::<Interval>();
    let mut near = plan.unbounded.clone();
    tree.within(|bounds| enters(&line, bounds).is_some_and(|from| from <= end), |index| near.push(index));
    near.sort_unstable();
    near
}

/// Returns the face of a shape that a ray certainly hits first, if that is the hit of an answer.
fn face<F: Precise>(shape: &AnyShape, ray: &ExactRay, answer: &Answer) -> Option<u32> {
    let proofs = F::proofs(shape.proven()?);
    // Most shapes have no faces.
    proofs.face_of(0)?;
    let (HitEnclosure::Hits(at), part) = proofs.first_hit(&ray.sight().line(), None) else { return None };
    let bounds = ray.t(F::widen(at).wide());
    let is_this = bounds.low <= answer.bounds.high && answer.bounds.low <= bounds.high;
    proofs.face_of(part).filter(|_| is_this)
}

/// Returns a lower bound on the distance at which a line is in a box, which is widened for its rounding; `None` if it
/// certainly misses the box.
fn enters(line: &Line<Interval>, Aabb { low, high }: &Aabb) -> Option<f256> {
    let slack = SLACK * low.abs().max(high.abs()).max_element();
    line.clip(*low - slack, *high + slack).map(|(from, _)| f256::of(from))
}
