//! Answers about the first hits of rays.

use super::ray::QueryRay;
use glam::{DVec2, DVec3};
use tabray_exact::interval::{Float, Interval, Wide};
use tabray_world::certify::{self, Precision};

/// What is proven about a ray's first hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// The ray hits this object first.
    Hit,
    /// The ray hits nothing.
    Miss,
    /// The ray passes exactly through the edge of this object, as far as 237 bits tell, and hits nothing else before
    /// it.
    Edge,
    /// The ray hits several objects first at once, as far as 237 bits tell.
    Tie,
    /// None of these is known, as where a ray touches a surface and does not cross it, or where a shape has no
    /// equation.
    Undecided,
}

/// The first hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// The outcome.
    pub verdict: Verdict,
    /// The precision of the proof; `None` for what the tracer finds, without a proof.
    pub proof: Option<Precision>,
    /// The object by its index; the first of several in the scene. `None` where nothing is hit.
    pub object: Option<usize>,
    /// The part of the object that the proof names, such as a face, by its index among the parts of its proofs.
    pub part: Option<usize>,
    /// The t of the hit, in the ray's own unit; NaN where there is none.
    pub t: f64,
    /// Bounds of the real t. Without a proof they are -∞ and ∞.
    pub bounds: Interval,
    /// The distance in world units, rounded; NaN where there is no hit.
    pub distance: f64,
}

/// The surface at a hit, rounded. All of it is that of one face.
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
    /// The fraction of what is behind the point that the surface covers, from 0 to 1; `None` where it covers all.
    pub coverage: Option<f64>,
}

impl Answer {
    /// Returns the answer that nothing is hit.
    pub(super) fn miss(proof: Option<Precision>) -> Self {
        let bounds = Interval { low: f64::NAN, high: f64::NAN };
        let (t, distance) = (f64::NAN, f64::NAN);
        Self { verdict: Verdict::Miss, proof, object: None, part: None, t, bounds, distance }
    }

    /// Returns what is proven about a hit in these bounds, in lengths of the sight's direction.
    pub(super) fn at(
        ray: &QueryRay,
        verdict: Verdict,
        (object, part): (Option<usize>, Option<usize>),
        at: Wide,
        precision: Precision,
    ) -> Self {
        let bounds = ray.t(at);
        let t = if at.high.is_finite() { ray.rounded_t(at.middle()) } else { f64::NAN };
        let distance = certify::in_world_units(at, ray.sight()).high;
        Self { verdict, proof: Some(precision), object, part, t, bounds, distance }
    }

    /// Returns what 53 bits prove about a hit of a part in these bounds of the ray's t, at the distance that the tracer
    /// found.
    pub(super) fn traced(
        ray: &QueryRay,
        (object, part): (usize, usize),
        bounds: Interval,
        distance: f64,
    ) -> Self {
        let (verdict, proof) = (Verdict::Hit, Some(Precision::Double));
        let (object, part) = (Some(object), Some(part));
        Self { verdict, proof, object, part, t: f64::NAN, bounds, distance }
            .near(ray.t_at(distance), distance)
    }

    /// Returns the answer with its hit at a t, or as near to it as the bounds allow.
    pub(super) fn near(self, t: f64, distance: f64) -> Self {
        Self { t: t.max(self.bounds.low).min(self.bounds.high), distance, ..self }
    }

    /// Returns the answer without hits beyond a t, in the ray's unit.
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

    /// Returns only whether anything is hit before a t, in the ray's unit. The object that is hit first need not be
    /// decided for that.
    #[must_use]
    pub fn any_within(self, t_max: f64) -> Self {
        let is_certain =
            matches!(self.verdict, Verdict::Tie | Verdict::Undecided) && self.bounds.high < t_max;
        let verdict = if is_certain { Verdict::Hit } else { self.verdict };
        Self { object: None, part: None, ..Self { verdict, ..self }.within(t_max) }
    }
}
