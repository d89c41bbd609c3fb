//! Queries about the hits of rays in a scene.

use super::answer::{Answer, Surroundings, Verdict};
use super::first::{Candidate, FirstHit, FirstHits, first_among, first_by, last_end};
use super::ray::{QueryRay, Start};
use std::ops::Range;
use std::slice;
use tabray_exact::dual::Dual;
use tabray_exact::interval::{Float, Fraction, Interval, Wide};
use tabray_render::observer::Hit;
use tabray_render::plan::Plan;
use tabray_render::trace;
use tabray_world::any_shape::AnyShape;
use tabray_world::certify::{self, Enclosure, HitProofs, Precision, ProofMethods};
use tabray_world::geometry::aabb::{Aabb, SLACK};
use tabray_world::geometry::ray::Side;
use tabray_world::geometry::sight::{Line, Sight};
use tabray_world::hittable::SurfaceHit;
use tabray_world::scene::model::Model;

/// A scene, prepared for queries about hits.
pub struct Query<'m> {
    plan: Plan<'m>,
    /// For each object of the model, the number of its entity among those of all objects.
    numbers: Vec<usize>,
}

impl<'m> Query<'m> {
    /// Prepares a scene: many objects get a tree. The rays need not be its camera's.
    pub fn new(model: &'m Model) -> Self {
        Self { plan: Plan::new(model), numbers: model.numbers() }
    }

    /// Returns the scene.
    pub fn model(&self) -> &'m Model {
        self.plan.model
    }

    /// Returns the number of an object, from 0: objects of the model that are parts of one solid have one number.
    pub fn number(&self, object: usize) -> usize {
        self.numbers[object]
    }

    /// Returns the number of the surface that an answer names, among all parts of its entity, for [`start`](Self::start);
    /// `None` where no surface is known.
    pub fn surface(&self, answer: &Answer) -> Option<usize> {
        let object = answer.object?;
        let objects = self.objects(self.number(object));
        Some(answer.part? * objects.len() + object - objects.start)
    }

    /// Returns the surface of an entity, both by their numbers, on which rays may start; `None` if there is none.
    pub fn start(&self, number: usize, surface: usize) -> Option<Start> {
        let objects = self.objects(number);
        let object = objects.start + surface.checked_rem(objects.len())?;
        self.shape(object).proven().map(|_| Start { object, part: surface / objects.len() })
    }

    /// Returns the objects of the model that belong to an entity.
    fn objects(&self, number: usize) -> Range<usize> {
        let end = |is_before: &dyn Fn(&usize) -> bool| self.numbers.partition_point(is_before);
        end(&|own| *own < number)..end(&|own| *own <= number)
    }

    /// Returns the ray through the middle of a pixel of the scene's camera, by column and row from the lower left
    /// corner.
    pub fn camera_ray(&self, x: usize, y: usize) -> QueryRay {
        QueryRay::of_camera(self.plan.camera.sight(x as f64, y as f64))
    }

    /// Finds the first hit of each ray as the tracer does, many rays at a time.
    pub fn first_hits(&self, rays: &[QueryRay]) -> Vec<Option<Hit<'m>>> {
        self.found(rays, true)
    }

    /// Finds the first hits of rays that leave no surface, as the tracer does.
    fn found(&self, rays: &[QueryRay], decides: bool) -> Vec<Option<Hit<'m>>> {
        let sights: Vec<_> = rays.iter().map(|ray| ray.sight().clone()).collect();
        trace::first_hits(&self.plan, &sights, decides)
    }

    /// Proves what a ray hits first. `found` is what the tracer finds, where that is known; the proof does not depend
    /// on it, but is faster with it.
    ///
    /// A proof is about the real numbers of the scene and of the ray ([`certify`](tabray_world::certify)). In a scene
    /// with many objects, it leaves out those whose bounding boxes the ray certainly misses or meets later.
    pub fn first(&self, ray: &QueryRay, found: Option<&Hit>) -> (FirstHits, Precision) {
        let end = match (&self.plan.tree, found) {
            (Some(_), Some(hit)) => last_end([(hit.index, self.shape(hit.index))], ray.sight()),
            _ => Fraction::INFINITY,
        };
        let near = self.near(ray, end);
        first_among(&near, &|place, precision| self.certify(ray, near[place], precision))
    }

    /// Returns what is proven about a ray's first hit of an object, and the part that is hit.
    fn certify(&self, ray: &QueryRay, object: usize, precision: Precision) -> (Enclosure, usize) {
        let shape = self.shape(object);
        let as_given = || shape.certify_part(ray.sight(), precision);
        let (Some(start), Some(proven)) = (ray.leaves(), shape.proven()) else { return as_given() };
        let (error, part) = (ray.origin_error(), (start.object == object).then_some(start.part));
        let near = certify::first_part_from(proven, ray.sight(), precision, (part, error));
        match near.0 {
            Enclosure::Edge(_) | Enclosure::Doubtful(_) if part.is_none() => {}
            _ => return near,
        }
        // The start may lie on this shape, too, as on the other parts of a solid. The ray as it is given decides.
        match as_given() {
            (Enclosure::Hits(at), part) => {
                let moved = moved(proven, ray.sight(), (part, error), at);
                moved.map_or(near, |at| (Enclosure::Hits(at.into()), part))
            }
            given => given,
        }
    }

    /// Returns narrow bounds of a hit of a part that 53 bits prove, given their bounds. Whole numbers, which also decide
    /// what 237 bits leave open, take several times as long as these, except for the faces of a mesh.
    fn narrowed(&self, ray: &QueryRay, object: usize, part: usize, within: Wide) -> (Enclosure, usize) {
        let proven = self.shape(object).proven();
        // The start of a ray that leaves a surface is known to within an error, which no digits make smaller.
        if let Some(proven) = proven.filter(|_| ray.leaves().is_none())
            && let Some(at) = newton(proven, ray.sight(), part, within)
        {
            return (Enclosure::Hits(at), part);
        }
        let is_quick = |proven: &&dyn ProofMethods| {
            ray.leaves().is_none() && HitProofs::<f64>::face_of(*proven, part).is_none()
        };
        match proven
            .filter(is_quick)
            .map(|proven| certify::first_part(proven, ray.sight(), Precision::Octuple))
        {
            Some(found @ (Enclosure::Hits(_), _)) => found,
            _ => self.certify(ray, object, Precision::Octuple),
        }
    }

    /// Returns the objects that a ray may meet at or before a distance in lengths of the sight's direction, in the
    /// order of the scene; all of them where there are few.
    pub(super) fn near(&self, ray: &QueryRay, end: Fraction) -> Vec<usize> {
        near(&self.plan, ray.sight(), end)
    }

    /// Returns the shape of an object.
    pub fn shape(&self, object: usize) -> &'m AnyShape {
        &self.plan.model.objects[object].shape
    }
}

/// The width up to which one step of Newton's method has narrowed bounds enough, as a fraction of the distance.
const NARROW: f64 = f64::EPSILON / 16.0;

/// The number of times that the bounds of a root are widened until they hold it for all origins.
const WIDENINGS: usize = 8;

/// Narrows the bounds of a root by one step of Newton's method for intervals, if the equation has a slope between them. The
/// slope needs 53 bits, and the value at the middle more.
fn newton(proven: &dyn ProofMethods, sight: &Sight, part: usize, within: Wide) -> Option<Wide> {
    let line = sight.line::<Interval>();
    let Dual { slope, .. } =
        HitProofs::<f64>::slope(proven, line.along(Dual::variable(within.coarse())), part);
    if slope.has_zero() || !slope.is_bounded() {
        return None;
    }
    let middle = Wide::point(within.middle());
    let value =
        HitProofs::<Fraction>::slope(proven, sight.line::<Wide>().along(Dual::fixed(middle)), part).value;
    // A quotient of the value would be a fraction, which takes a division each time that it is used.
    let Wide { low, high } = middle - value * Wide::from_f64(Interval::point(1.0) / slope);
    let narrow = Wide { low: Float::max(low, within.low), high: Float::min(high, within.high) };
    let is_narrow = narrow.low <= narrow.high && narrow.width().to_f64() <= NARROW * narrow.low.to_f64();
    is_narrow.then_some(narrow)
}

/// Encloses the only root near a ray's root for each ray that starts at most an error, in world units along each axis, from
/// its origin, by Newton's method for intervals; `None` where there may be several.
fn moved(
    proven: &dyn ProofMethods,
    sight: &Sight,
    (part, error): (usize, f64),
    root: Wide,
) -> Option<Interval> {
    let line = certify::line_from::<f64>(sight, error);
    let slope = |t: Dual<Interval>| HitProofs::<f64>::slope(proven, line.along(t), part);
    let (mut within, mut margin) = (root.coarse(), error / sight.ray().dir.abs().max_element());
    for _ in 0..WIDENINGS {
        margin = 4.0 * (margin + within.width());
        let bounds = Interval { low: within.low - margin, high: within.high + margin };
        let rise = slope(Dual::variable(bounds)).slope;
        if rise.has_zero() || !rise.is_bounded() {
            return None;
        }
        let middle = Interval::point(bounds.middle());
        within = middle - slope(Dual::fixed(middle)).value / rise;
        if bounds.low <= within.low && within.high <= bounds.high {
            return Some(within);
        }
    }
    None
}

impl Query<'_> {
    /// Returns the first hits of rays as the tracer finds them, without a proof. Rays that leave surfaces are proven.
    pub fn traced(&self, rays: &[QueryRay]) -> Vec<Answer> {
        if rays.iter().any(|ray| ray.leaves().is_some()) {
            return self.proven(rays, false);
        }
        let answer = |(ray, hit): (&QueryRay, Option<Hit>)| match hit {
            None => Answer::miss(None),
            Some(Hit { index, distance, .. }) => Answer {
                verdict: Verdict::Hit,
                proof: None,
                object: Some(index),
                part: None,
                t: ray.t_at(distance),
                bounds: Interval { low: f64::NEG_INFINITY, high: f64::INFINITY },
                distance,
            },
        };
        rays.iter().zip(self.first_hits(rays)).map(answer).collect()
    }

    /// Returns what is proven about the first hits of rays. With 53 bits, bounds are some units in the last place of
    /// t wide. `is_tight` narrows them with 237 bits, which takes many times as long.
    pub fn proven(&self, rays: &[QueryRay], is_tight: bool) -> Vec<Answer> {
        // Where there is a tree, what the tracer finds shortens the search. Its own proofs would be made twice.
        let mut found: Vec<_> = match self.plan.tree {
            Some(_) => self.found(rays, false),
            None => rays.iter().map(|_| None).collect(),
        };
        // It knows of no surface that a ray leaves.
        let is_bare = |ray: &QueryRay| ray.leaves().is_none();
        found.iter_mut().zip(rays).filter(|(_, ray)| !is_bare(ray)).for_each(|(hit, _)| *hit = None);
        let firsts: Vec<_> =
            rays.iter().zip(&found).map(|(ray, found)| self.first(ray, found.as_ref())).collect();
        if self.plan.tree.is_none() {
            // The tracer's distance is more accurate than the middle of bounds by 53 bits, and these alone take it.
            let is_double = |index: &usize| {
                matches!(firsts[*index], (FirstHits::Certain(Some(_)), Precision::Double))
                    && !is_tight
                    && is_bare(&rays[*index])
            };
            let places: Vec<_> = (0..rays.len()).filter(is_double).collect();
            let traced: Vec<_> = places.iter().map(|index| rays[*index].clone()).collect();
            places.into_iter().zip(self.found(&traced, false)).for_each(|(index, hit)| found[index] = hit);
        }
        let proofs = rays.iter().zip(firsts).zip(found);
        proofs.map(|((ray, first), found)| self.proof(ray, first, found.as_ref(), is_tight)).collect()
    }

    /// Tells for each ray whether anything may be hit before its end, a t, as for shadows. `false` is proven.
    pub fn occluded(&self, rays: &[QueryRay], ends: &[f64]) -> Vec<bool> {
        let answers = self.proven(rays, false).into_iter().zip(ends);
        answers.map(|(answer, end)| answer.any_within(*end).verdict != Verdict::Miss).collect()
    }

    /// Tells whether a ray that starts on no surface, as far as is told, hits one so soon that its origin may have been
    /// computed as a point of it.
    pub fn starts_on_surface(&self, ray: &QueryRay, answer: &Answer) -> bool {
        ray.leaves().is_none() && answer.distance <= 4.0 * ray.origin_error()
    }

    fn proof(
        &self,
        ray: &QueryRay,
        (first, precision): (FirstHits, Precision),
        found: Option<&Hit>,
        is_tight: bool,
    ) -> Answer {
        let (any, end) = match first {
            FirstHits::Certain(None) => return Answer::miss(Some(precision)),
            FirstHits::Certain(Some(FirstHit { object, part, at })) => {
                let hit = |part, at, precision| {
                    Answer::at(ray, Verdict::Hit, (Some(object), Some(part)), at, precision)
                };
                if is_tight
                    && precision == Precision::Double
                    && let (Enclosure::Hits(at), part) = self.narrowed(ray, object, part, at)
                {
                    return hit(part, at, Precision::Octuple);
                }
                let same = found.filter(|hit| hit.index == object && precision == Precision::Double);
                return match same {
                    Some(Hit { distance, .. }) => Answer::traced(ray, (object, part), ray.t(at), *distance),
                    None => hit(part, at, precision),
                };
            }
            FirstHits::OneOf { any, end } => (any, end),
        };
        let low = any.iter().filter_map(|one| match one.enclosure {
            Enclosure::Misses => None,
            Enclosure::Hits(at) | Enclosure::Edge(at) => Some(at.low),
            Enclosure::Doubtful(from) => Some(from),
        });
        let low = low.fold(end, Float::min);
        let first = any.first().map_or((None, None), |one| (Some(one.object), Some(one.part)));
        if let [Candidate { enclosure: Enclosure::Edge(at), .. }] = any[..] {
            return Answer::at(ray, Verdict::Edge, first, at, precision);
        }
        if any.iter().all(|one| matches!(one.enclosure, Enclosure::Hits(_))) {
            // At an edge of a solid, its parts are hit at once.
            let is_one = any.iter().all(|one| self.number(one.object) == self.number(any[0].object));
            let verdict = if is_one { Verdict::Hit } else { Verdict::Tie };
            return Answer::at(ray, verdict, first, Wide { low, high: end }, precision);
        }
        // The tracer finds one of the objects in question.
        let found = match ray.leaves() {
            None => self.first_hits(slice::from_ref(ray)).pop().flatten(),
            Some(_) => None,
        };
        let (object, at) = (found.as_ref().map(|hit| hit.index), Wide { low, high: end });
        let open = Answer::at(ray, Verdict::Undecided, (object, None), at, precision);
        match found {
            None => open,
            Some(Hit { distance, .. }) => open.near(ray.t_at(distance), distance),
        }
    }

    /// Returns the surface at the hit of an answer; `None` for an answer without a hit. It is that of the part that the
    /// proof names, or without a proof, of the one that the tracer finds. Where the ray passes through an edge, that is
    /// one of those that share the edge.
    pub fn surroundings(&self, ray: &QueryRay, answer: &Answer) -> Option<Surroundings> {
        let index = answer.object.filter(|_| answer.distance.is_finite())?;
        let (object, shape) = (&self.model().objects[index], self.shape(index));
        let point = ray.at(answer.distance);
        let SurfaceHit { normal, uv, face } =
            shape.surface_hit(&ray.sight().ray(), answer.distance, point, answer.part);
        let coverage = object.shader.covers_in_part().then(|| {
            let side = Side::seen_along(ray.sight().ray().dir, normal);
            object.shader.coverage_at(&object.surface_point(point, side))
        });
        Some(Surroundings { point, normal, uv, face, coverage })
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
fn near(plan: &Plan, sight: &Sight, end: Fraction) -> Vec<usize> {
    let Some(tree) = &plan.tree else { return (0..plan.model.objects.len()).collect() };
    let line = sight.line::<Interval>();
    let mut near = plan.unbounded.clone();
    tree.within(|bounds| enters(&line, bounds).is_some_and(|from| from <= end), |index| near.push(index));
    near.sort_unstable();
    near
}

/// Returns a lower bound on the distance at which a line is in a box, which is widened for its rounding; `None` if it
/// certainly misses the box.
fn enters(line: &Line<Interval>, Aabb { low, high }: &Aabb) -> Option<Fraction> {
    let slack = SLACK * low.abs().max(high.abs()).max_element();
    line.clip(*low - slack, *high + slack).map(|(from, _)| Fraction::of(from))
}
