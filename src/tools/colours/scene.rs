//! A scene as proofs of colours look at it: what a line may hit.

use std::cell::Cell;
use tabray_core::geometry::aabb::{Aabb, SLACK};
use tabray_core::geometry::sight::Line;
use tabray_core::render::plan::Plan;
use tabray_core::scene::model::Object;
use tabray_core::world::certify::{HitEnclosure, Precise};
use tabray_core::world::packets::light::{EncloseLight, PacketLight};
use tabray_core::world::packets::shader::{EncloseLook, PacketShader};
use tabray_core::world::shader::{LookBounds, PointBounds};
use tabray_exact::interval::Interval;

/// The number of edges of one object on a line after which its hits are in doubt.
const MAX_EDGES: usize = 4;

/// A colour in intervals.
pub(super) type Colour<F> = [Interval<F>; 3];

/// A place on an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    /// The object's index.
    pub object: usize,
    /// The part of the object, as proofs count them.
    pub part: usize,
}

/// A precision in which colours are proven.
pub(super) trait Number: Precise {
    /// Encloses the look of an object at a point.
    fn look(object: &Object, at: &PointBounds<Self>) -> Option<LookBounds<Self>>;

    /// Encloses what a light sends toward a point.
    fn sent(light: &(dyn PacketLight + 'static), toward: [Interval<Self>; 3]) -> Option<Colour<Self>>;
}

impl<F: Precise> Number for F
where
    dyn PacketShader: EncloseLook<F>,
    dyn PacketLight: EncloseLight<F>,
{
    fn look(object: &Object, at: &PointBounds<Self>) -> Option<LookBounds<Self>> {
        EncloseLook::<F>::look(&*object.shader, &object.material, at)
    }

    fn sent(light: &(dyn PacketLight + 'static), toward: [Interval<Self>; 3]) -> Option<Colour<Self>> {
        EncloseLight::<F>::sent(light, toward)
    }
}

/// A box around each object that has bounds.
pub(super) struct Boxes(Vec<Option<Aabb>>);

impl Boxes {
    pub fn around(objects: &[Object]) -> Self {
        let around = |object: &Object| {
            let Aabb { low, high } = object.shape.bounds()?;
            let slack = SLACK * low.abs().max(high.abs()).max_element();
            Some(Aabb { low: low - slack, high: high + slack })
        };
        Self(objects.iter().map(around).collect())
    }
}

/// A plan as the proof of one pixel looks at it.
pub(super) struct Scene<'p, 'm> {
    pub plan: &'p Plan<'m>,
    pub objects: &'m [Object],
    pub boxes: &'p Boxes,
    /// Whether what glass lets pass of a channel is known to lie between none of it and all.
    pub passes_fractions: bool,
    /// Whether a ray may have met a shape without an equation first.
    pub meets_uncertified: Cell<bool>,
}

/// The first hit of a line.
pub(super) enum FirstHit<F> {
    /// Nothing, for certain.
    Nothing,
    /// This place, at a t in this interval, for certain.
    Hit(Interval<F>, Place),
    /// One of these places, at a t in the interval beside it, or nothing.
    OneOf(Vec<(Interval<F>, Place)>, MayMiss),
    /// An unknown hit.
    Open,
}

/// Whether a line may hit nothing.
pub(super) type MayMiss = bool;

/// A line, and the place that it leaves.
#[derive(Clone, Copy)]
pub(super) struct Path<F> {
    pub line: Line<Interval<F>>,
    /// The place on which the line's true start lies, if it lies on an object.
    pub leaves: Option<Place>,
}

impl<'p, 'm> Scene<'p, 'm> {
    /// Notes that the hits of the object of this index are open; of a shape without an equation, they always are.
    pub fn note_open(&self, object: usize) {
        if !self.objects[object].shape.is_certified() {
            self.meets_uncertified.set(true);
        }
    }

    /// Returns what is proven about the first hit of a line with the object of this index.
    pub fn hit<F: Precise>(
        &self,
        path: &Path<F>,
        coarse: &Line<Interval>,
        index: usize,
    ) -> (HitEnclosure<F>, usize) {
        let mut from = 0.0;
        if let Some(Aabb { low, high }) = self.boxes.0[index] {
            let Some((start, _)) = coarse.clip(low, high) else { return (HitEnclosure::Misses, 0) };
            from = start;
        }
        let leaves = path.leaves.filter(|place| place.object == index).map(|place| place.part);
        match self.objects[index].shape.proven() {
            Some(proven) => F::proofs(proven).first_hit(&path.line, leaves),
            None => (HitEnclosure::Doubtful(F::of(from)), 0),
        }
    }

    /// Returns what is proven about the next hit of a line with an object, behind a hit that it may pass through.
    fn behind<F: Precise>(
        &self,
        path: &Path<F>,
        start: Interval<F>,
        place: Place,
    ) -> (HitEnclosure<F>, usize) {
        let line = Line { origin: path.line.at(start), dir: path.line.dir };
        let onward = Path { line, leaves: Some(place) };
        let (found, part) = self.hit(&onward, &coarse(&line), place.object);
        let found = match found {
            HitEnclosure::Misses => HitEnclosure::Misses,
            HitEnclosure::Hits(at) => HitEnclosure::Hits(start + at),
            HitEnclosure::Edge(at) => HitEnclosure::Edge(start + at),
            HitEnclosure::Doubtful(low) => HitEnclosure::Doubtful((start + Interval::point(low)).low),
        };
        (found, part)
    }

    /// Returns the first hit of a line.
    pub fn first<F: Precise>(&self, path: &Path<F>) -> FirstHit<F> {
        let coarse = coarse(&path.line);
        let mut found = Vec::new();
        let mut end = F::INFINITY;
        for object in 0..self.objects.len() {
            let (mut hit, mut part) = self.hit(path, &coarse, object);
            for round in 0..=MAX_EDGES {
                let low = match hit {
                    HitEnclosure::Misses => break,
                    HitEnclosure::Hits(at) => {
                        end = end.min(at.high);
                        at.low
                    }
                    // Too many to follow.
                    HitEnclosure::Edge(Interval { low, .. }) if round == MAX_EDGES => {
                        hit = HitEnclosure::Doubtful(low);
                        low
                    }
                    HitEnclosure::Edge(at) => at.low,
                    HitEnclosure::Doubtful(low) => low,
                };
                let place = Place { object, part };
                found.push((low, hit, place));
                // What is cut off at its edge does not hide what lies behind.
                let HitEnclosure::Edge(start) = hit else { break };
                (hit, part) = self.behind(path, start, place);
            }
        }
        let mut nearest = found.iter().filter(|(low, ..)| *low <= end);
        match (nearest.next(), nearest.next()) {
            (None, _) => FirstHit::Nothing,
            (Some((_, HitEnclosure::Hits(at), place)), None) => FirstHit::Hit(*at, *place),
            // Of several at exactly the same distance, the first in the file is seen.
            (Some((_, first @ HitEnclosure::Hits(at), place)), Some((_, second, _)))
                if at.low == at.high && first == second && nearest.all(|(_, other, _)| other == first) =>
            {
                FirstHit::Hit(*at, *place)
            }
            _ => {
                let at = |hit: &HitEnclosure<F>| match hit {
                    HitEnclosure::Hits(at) | HitEnclosure::Edge(at) => Some(*at),
                    HitEnclosure::Misses | HitEnclosure::Doubtful(_) => None,
                };
                let among = found.iter().filter(|(low, ..)| *low <= end);
                among.clone().for_each(|(_, _, place)| self.note_open(place.object));
                let among = among.map(|(_, hit, place)| Some((at(hit)?, *place))).collect::<Option<Vec<_>>>();
                among.map_or(FirstHit::Open, |among| FirstHit::OneOf(among, !end.is_finite()))
            }
        }
    }
}

/// Converts a line to `f64`, rounded outward.
pub(super) fn coarse<F: Precise>(line: &Line<Interval<F>>) -> Line<Interval> {
    Line { origin: line.origin.map(Interval::coarse), dir: line.dir.map(Interval::coarse) }
}
