//! What is known about the first hit of a ray.

use super::first::FirstHits;
use super::{ExactRay, FirstHit, Query};
use crate::world::certify::{self, Enclosure, Precision};
use glam::{DVec2, DVec3};
use tabray_exact::interval::{Float, Interval, Wide};

/// What is proven about a ray's first hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// The ray hits this object first.
    Hit,
    /// The ray hits nothing.
    Miss,
    /// The ray passes exactly through the edge of this object, as far as 237 bits tell, and hits nothing else before it.
    Edge,
    /// The ray hits several objects first at once, as far as 237 bits tell.
    Tie,
    /// Neither is known, as where a ray touches a surface and does not cross it, or where a shape has no equation.
    Undecided,
}

/// The first hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// What is known.
    pub verdict: Verdict,
    /// The precision of the proof; `None` for what the tracer finds, without a proof.
    pub proof: Option<Precision>,
    /// The object by its index; the first of several in the scene. `None` where nothing is hit.
    pub object: Option<usize>,
    /// Where the hit is, in the ray's own unit; NaN where there is none.
    pub t: f64,
    /// Bounds of the real t. Without a proof they are -∞ and ∞.
    pub bounds: Interval,
    /// The distance in world units, rounded; NaN where there is no hit.
    pub distance: f64,
}

/// The surface at a hit, rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surroundings {
    /// The point, in world units.
    pub point: DVec3,
    /// The unit normal of the surface, as the shape has it.
    pub normal: DVec3,
    /// The coordinates u and v, where the shape has some.
    pub uv: Option<DVec2>,
    /// The index of the face, from 0, where the shape has several.
    pub face: Option<u32>,
}

impl Answer {
    /// Nothing is hit.
    fn miss(proof: Option<Precision>) -> Self {
        let bounds = Interval { low: f64::NAN, high: f64::NAN };
        Self { verdict: Verdict::Miss, proof, object: None, t: f64::NAN, bounds, distance: f64::NAN }
    }

    /// Returns the answer with no hit that lies beyond a t, in the ray's unit.
    #[must_use]
    pub fn within(self, t_max: f64) -> Self {
        let (is_beyond, is_within) = match self.proof {
            None => (self.t >= t_max, self.t < t_max),
            Some(_) => (self.bounds.low >= t_max, self.bounds.high < t_max),
        };
        match self.verdict {
            Verdict::Miss => self,
            _ if is_within => self,
            _ if is_beyond => Self::miss(self.proof),
            _ => Self { verdict: Verdict::Undecided, ..self },
        }
    }
}

impl Query<'_> {
    /// Returns the first hits of rays as the tracer finds them, without a proof.
    pub fn traced(&self, rays: &[ExactRay]) -> Vec<Answer> {
        let answer = |(ray, hit): (&ExactRay, Option<FirstHit>)| match hit {
            None => Answer::miss(None),
            Some(FirstHit { object, distance }) => Answer {
                verdict: Verdict::Hit,
                proof: None,
                object: Some(object),
                t: ray.t_at(distance),
                bounds: Interval { low: f64::NEG_INFINITY, high: f64::INFINITY },
                distance,
            },
        };
        rays.iter().zip(self.first_hits(rays)).map(answer).collect()
    }

    /// Returns what is proven about the first hits of rays. Bounds that 53 bits give are some units in the last place of t
    /// wide; `is_tight` narrows them with 237 bits, in many times the time.
    pub fn proven(&self, rays: &[ExactRay], is_tight: bool) -> Vec<Answer> {
        let found = self.first_hits(rays);
        rays.iter().zip(found).map(|(ray, found)| self.proof(ray, found, is_tight)).collect()
    }

    fn proof(&self, ray: &ExactRay, found: Option<FirstHit>, is_tight: bool) -> Answer {
        let (first, precision) = self.first(ray, found);
        let answer = |verdict, object: Option<usize>, at: Wide, precision| {
            let bounds = ray.t(at);
            let t = if at.high.is_finite() { ray.rounded_t(at.middle()) } else { f64::NAN };
            let distance = certify::in_world_units(at, ray.sight()).high;
            Answer { verdict, proof: Some(precision), object, t, bounds, distance }
        };
        let (any, end) = match first {
            FirstHits::Certain(None) => return Answer::miss(Some(precision)),
            FirstHits::Certain(Some((object, at))) => {
                if is_tight
                    && precision == Precision::Double
                    && let Enclosure::Hits(at) = self.shape(object).certify(ray.sight(), Precision::Octuple)
                {
                    return answer(Verdict::Hit, Some(object), at, Precision::Octuple);
                }
                return answer(Verdict::Hit, Some(object), at, precision);
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
        // What the tracer finds is one of those in question.
        let (object, at) = (found.map(|hit| hit.object), Wide { low, high: end });
        let open = answer(Verdict::Undecided, object, at, precision);
        match found {
            None => open,
            Some(FirstHit { distance, .. }) => {
                let t = ray.t_at(distance).clamp(open.bounds.low, open.bounds.high);
                Answer { t, distance, ..open }
            }
        }
    }

    /// Returns the surface where a ray hits an object, as an answer has it; `None` for an answer without a hit.
    pub fn surroundings(&self, ray: &ExactRay, answer: &Answer) -> Option<Surroundings> {
        let shape = self.shape(answer.object.filter(|_| answer.distance.is_finite())?);
        let point = ray.at(answer.distance);
        let face = shape.face_hit(&ray.sight().ray(), answer.distance);
        Some(Surroundings { point, normal: shape.normal(point), uv: shape.uv(point), face })
    }
}
