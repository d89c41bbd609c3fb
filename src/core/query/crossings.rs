//! All crossings of a ray and the surfaces of a scene.

use super::answer::{Answer, Verdict};
use super::ray::QueryRay;
use super::scene::Query;
use std::cmp::Ordering;
use std::collections::BTreeSet;
use tabray_exact::interval::{Float, Fraction, Interval, Wide};
use tabray_shapes::solid;
use tabray_world::any_shape::AnyShape;
use tabray_world::certify::{Enclosure, Precise, Precision};

/// A crossing of a ray and a surface, or what is known behind the last one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// `Hit` for a crossing; `Tie` for each of several whose order 237 bits do not tell. The last one is a `Miss`
    /// where there are no more, or `Undecided` where nothing is known from its lower bound on.
    pub answer: Answer,
    /// Whether the ray enters the object there, if that is closed.
    pub enters: Option<bool>,
}

/// A crossing of a ray and an object.
#[derive(Clone, Copy)]
struct Found {
    object: usize,
    /// Bounds of the distance, in lengths of the sight's direction.
    at: Wide,
    enters: bool,
    part: usize,
    precision: Precision,
}

/// What is known of the crossings of a ray and an object, which may be several of the model.
struct Known {
    found: Vec<Found>,
    precision: Precision,
    /// The distance from which on nothing is known; infinite where all crossings are.
    open: Fraction,
}

impl Query<'_> {
    /// Returns all crossings of a ray and the scene's surfaces before a t, in the order in which the ray meets them.
    /// The last entry tells what is known behind them: nothing, where the ray touches a surface or passes through an
    /// edge. `is_tight` narrows all bounds with 237 bits.
    pub fn crossings(&self, ray: &QueryRay, t_max: f64, is_tight: bool) -> Vec<Crossing> {
        let first = if is_tight { Precision::Octuple } else { Precision::Double };
        let near = self.near(ray, Fraction::INFINITY);
        let objects: Vec<_> = near.chunk_by(|one, other| self.number(*one) == self.number(*other)).collect();
        let mut known: Vec<_> = objects.iter().map(|parts| self.known(parts, ray, first)).collect();
        if !is_tight {
            let tied = in_order(&known).into_iter().filter(|(_, is_tied)| *is_tied);
            let tied: BTreeSet<_> = tied.map(|(found, _)| self.number(found.object)).collect();
            for (parts, of) in objects.iter().zip(&mut known) {
                if of.open.is_finite() || tied.contains(&self.number(parts[0])) {
                    *of = self.known(parts, ray, Precision::Octuple);
                }
            }
        }
        let open = known.iter().map(|of| of.open).fold(Fraction::INFINITY, Float::min);
        let mut crossings = Vec::new();
        for (found, is_tied) in in_order(&known).into_iter().filter(|(found, _)| found.at.high < open) {
            let Found { object, at, enters, part, precision } = found;
            let verdict = if is_tied { Verdict::Tie } else { Verdict::Hit };
            let answer = Answer::at(ray, verdict, (Some(object), Some(part)), at, precision).within(t_max);
            let is_last = matches!(answer.verdict, Verdict::Miss | Verdict::Undecided);
            let enters = (!is_last && self.shape(object).bounds_body()).then_some(enters);
            crossings.push(Crossing { answer, enters });
            if is_last {
                return crossings;
            }
        }
        let is_hard = known.iter().any(|of| of.precision == Precision::Octuple);
        let miss = Answer::miss(Some(if is_hard { Precision::Octuple } else { Precision::Double }));
        let answer = match open.is_finite() {
            false => miss,
            true => {
                let bounds = ray.t(Wide { low: open, high: Fraction::INFINITY });
                Answer { verdict: Verdict::Undecided, bounds, ..miss }.within(t_max)
            }
        };
        crossings.push(Crossing { answer, enters: None });
        crossings
    }

    /// Returns what is known of the crossings of a ray and an object, given its parts.
    fn known(&self, parts: &[usize], ray: &QueryRay, precision: Precision) -> Known {
        let (mut all, mut open) = (Vec::new(), Fraction::INFINITY);
        for object in parts.iter().copied() {
            let shape = self.shape(object);
            let (found, end) = match precision {
                Precision::Double => along::<f64>(shape, ray),
                Precision::Octuple => match along::<Fraction>(shape, ray) {
                    (_, open) if open.is_finite() && misses(shape, ray) => (Vec::new(), Fraction::INFINITY),
                    known => known,
                },
            };
            let found =
                found.into_iter().map(|(at, enters, part)| Found { object, at, enters, part, precision });
            all.extend(found);
            open = Float::min(open, end);
        }
        all.sort_by(nearer);
        if parts.iter().all(|object| self.shape(*object).bounds_body()) {
            // At an edge, a ray that passes by may seem to enter or to leave.
            let broken =
                all.windows(2).find(|pair| pair[0].enters == pair[1].enters).map(|pair| pair[0].at.low);
            let left = all.last().filter(|last| last.enters && !open.is_finite()).map(|last| last.at.low);
            open = broken.into_iter().chain(left).fold(open, Float::min);
        }
        Known { found: all, precision, open }
    }
}

/// Compares the places of two crossings.
fn nearer(one: &Found, other: &Found) -> Ordering {
    one.at.low.partial_cmp(&other.at.low).unwrap_or(Ordering::Equal).then(one.object.cmp(&other.object))
}

/// The crossings of a ray and a shape, each with its bounds, whether the ray enters, and the part; and the distance
/// beyond which nothing is known.
type Along = (Vec<(Wide, bool, usize)>, Fraction);

/// Returns the crossings of a ray and a shape in one precision.
fn along<F: Precise>(shape: &AnyShape, ray: &QueryRay) -> Along {
    let line = ray.sight().line::<Interval<F>>();
    let Some(proven) = shape.proven() else { return (Vec::new(), Fraction::of(0.0)) };
    let (mut crossings, mut found) = (solid::Crossings::new(proven, &line, None), Vec::new());
    loop {
        match crossings.get(found.len()) {
            Ok(solid::Crossing { at, part, enters }) => {
                found.push((F::widen(at), enters, part));
            }
            Err(end) if end == F::INFINITY => return (found, Fraction::INFINITY),
            Err(end) => return (found, F::widen(Interval::point(end)).low),
        }
    }
}

/// Tells whether a ray misses a shape, as one does that passes exactly through an edge.
fn misses(shape: &AnyShape, ray: &QueryRay) -> bool {
    shape.certify(ray.sight(), Precision::Octuple) == Enclosure::Misses
}

/// Returns all crossings in the order of their lower bounds, each with whether its bounds meet those of another.
fn in_order(known: &[Known]) -> Vec<(Found, bool)> {
    let mut all: Vec<_> = known.iter().flat_map(|of| &of.found).map(|found| (*found, false)).collect();
    all.sort_by(|(one, _), (other, _)| nearer(one, other));
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
