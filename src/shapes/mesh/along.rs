//! Proofs of a mesh's hits along a line.

use super::face::Face;
use super::hits::BESIDE;
use super::surface::Surface;
use std::cmp::Ordering;
use tabray_exact::affine::Affine;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::{Scalar, dot, per_axis};
use tabray_world::accuracy::NotClassic;
use tabray_world::certify::{self, FootprintHit, HitEnclosure, HitProofs, OverFootprint, Precise};
use tabray_world::geometry::sight::Line;

/// A face that a line may hit: the minimum t of its first hit, the enclosure of that hit, and the face.
pub(super) type Met<F> = ((F, HitEnclosure<F>), usize);

/// All faces that a line may hit matter, wherever it does.
pub(super) fn everywhere<F: Precise>(_: HitEnclosure<F>) -> f64 {
    f64::INFINITY
}

impl Surface {
    /// Returns the enclosure of a line's first hit with t > 0, and the hit face. `leaves` is the face that the line's
    /// exact start lies on.
    pub(super) fn first_along<A: NotClassic, F: Precise>(
        &self,
        line: &Line<Interval<F>>,
        leaves: Option<usize>,
    ) -> (HitEnclosure<F>, usize) {
        let found = self.first_by_bounds::<A, F>(line, leaves);
        let is_open = !matches!(found.0, HitEnclosure::Hits(_) | HitEnclosure::Misses);
        // Integers know the place to 237 bits only, which fractions may know exactly.
        let exactly = || self.first_exactly::<A, F>(line);
        (F::IS_LONG && leaves.is_none() && is_open).then(exactly).flatten().unwrap_or(found)
    }

    fn first_by_bounds<A: NotClassic, F: Precise>(
        &self,
        line: &Line<Interval<F>>,
        leaves: Option<usize>,
    ) -> (HitEnclosure<F>, usize) {
        // Behind a place where there may be a hit, none is certainly the first.
        let end = |found: HitEnclosure<F>| match found {
            HitEnclosure::Hits(at) => at.coarse().high,
            HitEnclosure::Edge(Interval { low, .. }) | HitEnclosure::Doubtful(low) => {
                Interval::point(low).coarse().high
            }
            HitEnclosure::Misses => f64::INFINITY,
        };
        let met = self.met::<A, F>(line, |face| leaves == Some(face), end);
        let first = met.iter().copied().reduce(|one, other| if other.0.0 < one.0.0 { other } else { one });
        let Some(((low, first), face)) = first else { return (HitEnclosure::Misses, 0) };
        let HitEnclosure::Hits(at) = first else { return (HitEnclosure::Doubtful(low), face) };
        let rivals =
            || met.iter().filter(|((low, _), _)| *low <= at.high).map(|((_, found), face)| (*found, *face));
        if rivals().all(|(_, other)| other == face) {
            return (first, face);
        }
        // Of several faces at exactly the same distance, `face_along` chooses this one.
        if rivals().all(|(found, _)| found == first && at.low == at.high) {
            let place = |face: usize| {
                let rank = match self.is_certainly_hidden::<A, F>(face, line, at, leaves)? {
                    true => 2,
                    false => u8::from(!self.is_certainly_outside::<A, F>(face, line)?),
                };
                Some((rank, self.order[face]))
            };
            let places: Option<Vec<_>> = rivals().map(|(_, face)| Some((place(face)?, face))).collect();
            if let Some((_, face)) = places.and_then(|places| places.into_iter().min()) {
                return (first, face);
            }
        }
        (HitEnclosure::Doubtful(low), face)
    }

    /// Returns what is proven about each of a line's hits with t > 0, and the hit faces, in order, up to the first that
    /// is open.
    pub(super) fn all_along<A: NotClassic, F: Precise>(
        &self,
        line: &Line<Interval<F>>,
        leaves: Option<usize>,
    ) -> Vec<(HitEnclosure<F>, usize)> {
        if F::IS_LONG
            && leaves.is_none()
            && let Some(found) = self.all_exactly::<A, F>(line)
        {
            return found;
        }
        let mut met = self.met::<A, F>(line, |face| leaves == Some(face), everywhere);
        met.sort_by(|((one, _), _), ((other, _), _)| one.partial_cmp(other).unwrap_or(Ordering::Equal));
        let (mut all, mut left) = (Vec::new(), &met[..]);
        while let Some(((low, found), face)) = left.first() {
            match (found, together(left)) {
                (HitEnclosure::Hits(_), 1) => all.push((*found, *face)),
                _ => {
                    all.push((HitEnclosure::Doubtful(*low), *face));
                    break;
                }
            }
            left = &left[1..];
        }
        all
    }

    /// Returns the faces that a line may hit, each with the enclosure of its first hit and the minimum t of that hit.
    /// `is_left` tells whether the line's exact start lies in the plane of a face. `end_at` returns the t beyond which
    /// faces no longer matter, given what is known of a face; they may be omitted.
    pub(super) fn met<A: NotClassic, F: Precise>(
        &self,
        line: &Line<Interval<F>>,
        is_left: impl Fn(usize) -> bool,
        end_at: impl Fn(HitEnclosure<F>) -> f64,
    ) -> Vec<Met<F>> {
        let coarse = Line { origin: line.origin.map(Interval::coarse), dir: line.dir.map(Interval::coarse) };
        let (mut met, mut end) = (Vec::new(), f64::INFINITY);
        self.tree.along(&coarse, &mut |face| {
            let leaves = is_left(face).then_some(0);
            let found = match Face(self.triangle::<A>(face)).first_hit(line, leaves).0 {
                HitEnclosure::Misses => return end,
                found @ (HitEnclosure::Hits(at) | HitEnclosure::Edge(at)) => (at.low, found),
                found @ HitEnclosure::Doubtful(low) => (low, found),
            };
            end = end.min(end_at(found.1));
            met.push((found, face));
            end
        });
        met
    }

    /// Tells whether other faces hide a face beside the point where a line hits it, like
    /// [`is_hidden`](Self::is_hidden), or `None` if that is undecided.
    pub(super) fn is_certainly_hidden<A: NotClassic, F: Precise>(
        &self,
        face: usize,
        line: &Line<Interval<F>>,
        at: Interval<F>,
        leaves: Option<usize>,
    ) -> Option<bool> {
        if !self.is_closed() {
            return Some(false);
        }
        let ([a, b, c], met) = (self.corners(face), line.at(at));
        let number = Interval::constant;
        let way = per_axis(|axis| {
            let sum = number(a[axis]) + number(b[axis]) + number(c[axis]);
            met[axis] + number(BESIDE) * (sum / number(3.0) - met[axis]) - line.origin[axis]
        });
        // The point on the face is at t = 1.
        let (nearly, toward) = (F::of(1.0 - 256.0 * f64::EPSILON), Line { origin: line.origin, dir: way });
        let met = self.met::<A, F>(&toward, |face| leaves == Some(face), |_| 1.0);
        if met.iter().any(|((_, found), _)| matches!(found, HitEnclosure::Hits(at) if at.high < nearly)) {
            return Some(true);
        }
        met.iter().all(|((low, _), _)| *low >= nearly).then_some(false)
    }

    /// Calls `met` with the possible first hits of each face.
    pub(super) fn hits_of_footprint<A: NotClassic>(
        &self,
        line: &Line<Affine>,
        leaves: Option<usize>,
        met: &mut dyn FnMut(FootprintHit, usize),
    ) {
        let coarse = certify::coarse(line);
        self.tree.along(&coarse, &mut |face| {
            let leaves = (leaves == Some(face)).then_some(0);
            Face(self.triangle::<A>(face)).hits(line, leaves, &mut |one, _| met(one, face));
            f64::INFINITY
        });
    }

    /// Tells whether a line hits the outside of a face, or whether the mesh is open. Returns `None` if that is
    /// undecided.
    fn is_certainly_outside<A: NotClassic, F: Precise>(
        &self,
        face: usize,
        line: &Line<Interval<F>>,
    ) -> Option<bool> {
        if !self.is_closed() {
            return Some(true);
        }
        let slope = dot(self.triangle::<A>(face).area_normal(), line.dir);
        if slope.has_zero() { None } else { Some(slope.high < F::of(0.0)) }
    }
}

/// Returns how many of the first hits, in order, may share a place, directly or through others between them.
pub(super) fn together<F: Precise>(met: &[Met<F>]) -> usize {
    let high = |((_, found), _): &Met<F>| match found {
        HitEnclosure::Hits(at) | HitEnclosure::Edge(at) => at.high,
        _ => F::INFINITY,
    };
    let (mut count, mut end) = (1, high(&met[0]));
    while count < met.len() && met[count].0.0 <= end {
        let high = high(&met[count]);
        end = if high > end { high } else { end };
        count += 1;
    }
    count
}
