//! What can be proven of a mesh's hits along any line.

use super::face::Face;
use super::surface::Surface;
use crate::geometry::sight::Line;
use crate::numeric::affine::Affine;
use crate::numeric::interval::Interval;
use crate::numeric::scalar::dot;
use crate::world::accuracy::Bounded;
use crate::world::certify::{self, Found, Met, Onward, OverFootprint, Precise};

impl Surface {
    /// Returns what is certain about a line's first hit with t > 0, and the face that is hit. `leaves` is the face on which
    /// the line's true start lies.
    pub(super) fn first_along<A: Bounded, F: Precise>(
        &self,
        line: &Line<Interval<F>>,
        leaves: Option<usize>,
    ) -> (Found<F>, usize) {
        let coarse = Line { origin: line.origin.map(Interval::coarse), dir: line.dir.map(Interval::coarse) };
        let mut met = Vec::new();
        self.tree.within(
            |bounds| coarse.clip(bounds.low, bounds.high).is_some(),
            |face| {
                let leaves = (leaves == Some(face)).then_some(0);
                let found = match Face(self.triangle::<A>(face)).first_hit(line, leaves).0 {
                    Found::Misses => return,
                    found @ (Found::Hits(at) | Found::Edge(at)) => (at.low, found),
                    found @ Found::Doubtful(low) => (low, found),
                };
                met.push((found, face));
            },
        );
        let first = met.iter().copied().reduce(|one, other| if other.0.0 < one.0.0 { other } else { one });
        let Some(((low, first), face)) = first else { return (Found::Misses, 0) };
        let Found::Hits(at) = first else { return (Found::Doubtful(low), face) };
        let rivals = || met.iter().filter(|((low, _), _)| *low <= at.high);
        // Of several faces at exactly the same distance, that which `face_along` chooses.
        if rivals().all(|((_, found), other)| *other == face || *found == first && at.low == at.high) {
            let place =
                |face: usize| Some((!self.is_certainly_outside::<A, F>(face, line)?, self.order[face]));
            let places: Option<Vec<_>> = rivals().map(|(_, face)| Some((place(*face)?, *face))).collect();
            if let Some((_, face)) = places.and_then(|places| places.into_iter().min()) {
                return (first, face);
            }
        }
        (Found::Doubtful(low), face)
    }

    /// Calls `met` with the possible first hits of each face.
    pub(super) fn hits_of_footprint<A: Bounded>(
        &self,
        line: &Line<Affine>,
        leaves: Option<usize>,
        met: &mut dyn FnMut(Met, usize),
    ) {
        let coarse = certify::coarse(line);
        self.tree.within(
            |bounds| coarse.clip(bounds.low, bounds.high).is_some(),
            |face| {
                let leaves = (leaves == Some(face)).then_some(0);
                Face(self.triangle::<A>(face)).hits(line, leaves, &mut |one, _| met(one, face));
            },
        );
    }

    /// Tells whether a line hits the outside of a face, or whether that makes no difference; `None` where it is open.
    fn is_certainly_outside<A: Bounded, F: Precise>(
        &self,
        face: usize,
        line: &Line<Interval<F>>,
    ) -> Option<bool> {
        if self.open_edges > 0 {
            return Some(true);
        }
        let slope = dot(self.triangle::<A>(face).upright(), line.dir);
        if slope.has_zero() { None } else { Some(slope.high < F::of(0.0)) }
    }
}
