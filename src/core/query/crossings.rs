//! All crossings of a ray and the surfaces of a scene.

use super::answer::{Answer, Surroundings, Verdict};
use super::ray::ExactRay;
use super::scene::Query;
use crate::shapes::solid;
use crate::world::any_shape::AnyShape;
use crate::world::certify::{Enclosure, Precise, Precision};
use f256::f256;
use std::collections::BTreeSet;
use tabray_exact::interval::{Float, Fraction, Interval, Wide};

/// A crossing of a ray and a surface, or what is known behind the last one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// `Hit` for a crossing; `Tie` for each of several whose order 237 bits do not tell. The last one is a `Miss`
    /// where there are no more, or `Undecided` where nothing is known from its lower bound on.
    pub answer: Answer,
    /// Whether the ray enters the shape there, if the shape is closed.
    pub enters: Option<bool>,
    /// The index of the face, from 0, where the proof tells it.
    pub face: Option<u32>,
}

/// A crossing of a ray and an object.
#[derive(Clone, Copy)]
struct Found {
    object: usize,
    /// Bounds of the distance, in lengths of the sight's direction.
    at: Wide,
    enters: bool,
    face: Option<u32>,
    precision: Precision,
}

/// What is known of the crossings of a ray and an object.
struct Known {
    found: Vec<Found>,
    precision: Precision,
    /// The distance from which on nothing is known; infinite where all crossings are.
    open: f256,
}

impl Query<'_> {
    /// Returns all crossings of a ray and the scene's surfaces before a t, in the order in which the ray meets them.
    /// The last entry tells what is known behind them: nothing, where the ray touches a surface or passes through an
    /// edge. `is_tight` narrows all bounds with 237 bits.
    pub fn crossings(&self, ray: &ExactRay, t_max: f64, is_tight: bool) -> Vec<Crossing> {
        let first = if is_tight { Precision::Octuple } else { Precision::Double };
        let objects = self.near(ray, f256::INFINITY);
        let mut known: Vec<_> = objects.iter().map(|object| self.known(*object, ray, first)).collect();
        if !is_tight {
            let tied = in_order(&known).into_iter().filter(|(_, is_tied)| *is_tied);
            let tied: BTreeSet<_> = tied.map(|(found, _)| found.object).collect();
            for (object, of) in objects.iter().zip(&mut known) {
                if of.open.is_finite() || tied.contains(object) {
                    *of = self.known(*object, ray, Precision::Octuple);
                }
            }
        }
        let open = known.iter().map(|of| of.open).fold(f256::INFINITY, Float::min);
        let mut crossings = Vec::new();
        for (found, is_tied) in in_order(&known).into_iter().filter(|(found, _)| found.at.high < open) {
            let Found { object, at, enters, face, precision } = found;
            let verdict = if is_tied { Verdict::Tie } else { Verdict::Hit };
            let answer = Answer::at(ray, verdict, Some(object), at, precision).within(t_max);
            let is_last = matches!(answer.verdict, Verdict::Miss | Verdict::Undecided);
            let enters = (!is_last && self.shape(object).why_not_closed().is_none()).then_some(enters);
            crossings.push(Crossing { answer, enters, face: face.filter(|_| !is_last) });
            if is_last {
                return crossings;
            }
        }
        let is_hard = known.iter().any(|of| of.precision == Precision::Octuple);
        let miss = Answer::miss(Some(if is_hard { Precision::Octuple } else { Precision::Double }));
        let answer = match open.is_finite() {
            false => miss,
            true => {
                let bounds = ray.t(Wide { low: open, high: f256::INFINITY });
                Answer { verdict: Verdict::Undecided, bounds, ..miss }.within(t_max)
            }
        };
        crossings.push(Crossing { answer, enters: None, face: None });
        crossings
    }

    /// Returns the surface at a crossing; `None` behind the last one.
    pub fn surroundings_at(&self, ray: &ExactRay, crossing: &Crossing) -> Option<Surroundings> {
        let surface = self.surroundings(ray, &crossing.answer)?;
        Some(Surroundings { face: crossing.face.or(surface.face), ..surface })
    }

    fn known(&self, object: usize, ray: &ExactRay, precision: Precision) -> Known {
        let shape = self.shape(object);
        let (found, open) = match precision {
            Precision::Double => along::<f64>(shape, ray),
            Precision::Octuple => match along::<f256>(shape, ray) {
                (found, open) if open.is_finite() => exactly(shape, ray).unwrap_or((found, open)),
                known => known,
            },
        };
        let found = found.into_iter().map(|(at, enters, face)| Found { object, at, enters, face, precision });
        Known { found: found.collect(), precision, open }
    }
}

/// The crossings of a ray and a shape, each with its bounds, whether the ray enters, and its face; and the distance
/// beyond which nothing is known.
type Along = (Vec<(Wide, bool, Option<u32>)>, f256);

/// Returns the crossings of a ray and a shape in one precision.
fn along<F: Precise>(shape: &AnyShape, ray: &ExactRay) -> Along {
    let line = ray.sight().line::<Interval<F>>();
    let Some(proven) = shape.proven() else { return (Vec::new(), f256::of(0.0)) };
    let (mut crossings, mut found) = (solid::Crossings::new(proven, &line, None), Vec::new());
    loop {
        match crossings.get(found.len()) {
            Ok(solid::Crossing { at, part, enters }) => {
                found.push((F::widen(at).wide(), enters, F::proofs(proven).face_of(part)));
            }
            Err(end) if end == F::INFINITY => return (found, f256::INFINITY),
            Err(end) => return (found, F::widen(Interval::point(end)).wide().low),
        }
    }
}

/// Returns all crossings of a ray and a shape, found with fractions, which recognise a ray that passes exactly
/// through an edge; `None` where they do not find all.
fn exactly(shape: &AnyShape, ray: &ExactRay) -> Option<Along> {
    if shape.certify(ray.sight(), Precision::Octuple) == Enclosure::Misses {
        return Some((Vec::new(), f256::INFINITY));
    }
    let (found, open) = along::<Fraction>(shape, ray);
    // At an edge, a ray that passes by seems to enter or to leave.
    let is_in_turns =
        found.is_sorted_by(|one, other| one.1 != other.1) && found.last().is_none_or(|last| !last.1);
    let is_plain = is_in_turns || shape.why_not_closed().is_some();
    (!open.is_finite() && is_plain).then_some((found, open))
}

/// Returns all crossings in the order of their lower bounds, each with whether its bounds meet those of another.
fn in_order(known: &[Known]) -> Vec<(Found, bool)> {
    let mut all: Vec<_> = known.iter().flat_map(|of| &of.found).map(|found| (*found, false)).collect();
    all.sort_by(|(one, _), (other, _)| {
        one.at.low.total_cmp(&other.at.low).then(one.object.cmp(&other.object))
    });
    let mut farthest = 0;
    for index in 1..all.len() {
        if all[index].0.at.low <= all[farthest].0.at.high {
            (all[index].1, all[farthest].1) = (true, true);
        }
        if all[index].0.at.high > all[farthest].0.at.high {
            farthest = index;
        }
    }
    all
}
