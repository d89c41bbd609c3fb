//! Proven crossings of a line and a closed shape, in order.

use std::vec;
use tabray_exact::dual::Dual;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::Scalar;
use tabray_world::certify::{HitEnclosure, Precise, ProofMethods};
use tabray_world::geometry::sight::Line;

/// A crossing of a line and a closed shape.
#[derive(Clone, Copy, Debug)]
pub struct Crossing<F> {
    /// The position of the crossing on the line.
    pub at: Interval<F>,
    /// The part of the shape that the line crosses.
    pub part: usize,
    /// Whether the line enters the shape there.
    pub enters: bool,
}

/// The crossings of a line and a closed shape.
pub struct Crossings<'l, F> {
    shape: &'l dyn ProofMethods,
    line: &'l Line<Interval<F>>,
    /// The hits from the line's start, where the shape knows them at once. Searching each from the one before would
    /// accumulate errors of position.
    listed: Option<vec::IntoIter<(HitEnclosure<F>, usize)>>,
    start: Line<Interval<F>>,
    gone: Interval<F>,
    leaves: Option<usize>,
    known: Vec<Crossing<F>>,
    /// The t from which on nothing is known, or infinity if all crossings are known.
    end: Option<F>,
}

impl<'l, F: Precise> Crossings<'l, F> {
    /// Prepares the search along a line. If its exact start lies on the shape, `leaves` is the part it lies on.
    pub fn new(shape: &'l dyn ProofMethods, line: &'l Line<Interval<F>>, leaves: Option<usize>) -> Self {
        let (gone, listed) =
            (Interval::constant(0.0), F::proofs(shape).all_hits(line, leaves).map(Vec::into_iter));
        Self { shape, line, listed, start: *line, gone, leaves, known: Vec::new(), end: None }
    }

    /// Returns the crossing with an index, counted from the start of the line.
    ///
    /// # Errors
    /// Returns the t beyond which nothing is known, or infinity if there are no more crossings.
    pub fn get(&mut self, index: usize) -> Result<Crossing<F>, F> {
        while self.known.len() <= index {
            if let Some(end) = self.end {
                return Err(end);
            }
            match self.next() {
                Ok(crossing) => self.known.push(crossing),
                Err(end) => self.end = Some(end),
            }
        }
        Ok(self.known[index])
    }

    fn next(&mut self) -> Result<Crossing<F>, F> {
        let (found, part) = match &mut self.listed {
            Some(listed) => listed.next().unwrap_or((HitEnclosure::Misses, 0)),
            None => F::proofs(self.shape).first_hit(&self.start, self.leaves),
        };
        let at = match found {
            HitEnclosure::Misses => return Err(F::INFINITY),
            HitEnclosure::Hits(at) => self.gone + at,
            HitEnclosure::Edge(at) => return Err((self.gone + at).low),
            HitEnclosure::Doubtful(from) => return Err((self.gone + Interval::point(from)).low),
        };
        let slope = F::proofs(self.shape).slope(self.line.along(Dual::variable(at)), part).slope;
        if slope.has_zero() {
            return Err(at.low);
        }
        if self.listed.is_none() {
            self.start.origin = self.line.at(at);
            (self.gone, self.leaves) = (at, Some(part));
        }
        Ok(Crossing { at, part, enters: slope.high < F::of(0.0) })
    }

    /// Tells whether the line is in the shape just before and just after a place, or `None` if that is undecided. In
    /// low precision, any crossing that may be at the place leaves it undecided. In high precision, two of them do.
    pub fn around(&mut self, place: Interval<F>) -> Option<[bool; 2]> {
        for index in 0.. {
            match self.get(index) {
                Ok(crossing) if crossing.at.high < place.low => {}
                Ok(Crossing { at, enters, .. }) if place.high < at.low => return Some([!enters; 2]),
                Ok(Crossing { enters, .. }) => {
                    let is_alone = match self.get(index + 1) {
                        Ok(next) => place.high < next.at.low,
                        Err(end) => place.high < end,
                    };
                    return (F::IS_LONG && is_alone).then_some([!enters, enters]);
                }
                Err(end) => return (end == F::INFINITY).then_some([false; 2]),
            }
        }
        None
    }
}
