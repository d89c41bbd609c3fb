//! Crossings of lines whose numbers are fractions, decided with integers. Rays through edges and corners take no more
//! digits than others that way.

use super::face::Face;
use super::surface::Surface;
use glam::DVec3;
use tabray_exact::interval::{Interval, Wide};
use tabray_exact::scalar::{Scalar, cross, dot, per_axis};
use tabray_exact::whole_line::{Crossing, Seen, WholeLine};
use tabray_world::accuracy::NotClassic;
use tabray_world::certify::{HitEnclosure, HitProofs, Precise, exact_line};
use tabray_world::geometry::sight::Line;

/// The faces that a line crosses with t > 0, in the order of their places.
pub(super) struct ExactCrossings {
    line: WholeLine,
    faces: Vec<(Crossing, usize)>,
}

impl ExactCrossings {
    /// Returns the groups of crossings at the same place, each with the t of the place.
    pub fn places(&self) -> impl Iterator<Item = (Wide, &[(Crossing, usize)])> {
        let same = self.faces.chunk_by(|one, other| one.0 == other.0);
        same.map(|here| (self.line.t(&here[0].0), here))
    }
}

impl Surface {
    /// Returns the faces that a line crosses with t > 0; `None` if its numbers are no fractions, or of too different
    /// magnitudes. If `only_first`, faces behind the first may be omitted.
    pub(super) fn exact_crossings<F: Precise>(
        &self,
        line: &Line<Interval<F>>,
        only_first: bool,
    ) -> Option<ExactCrossings> {
        let fine = Line { origin: line.origin.map(F::widen), dir: line.dir.map(F::widen) };
        let exact = exact_line(&fine)?;
        let coarse = Line { origin: line.origin.map(Interval::coarse), dir: line.dir.map(Interval::coarse) };
        let line = WholeLine::new(&exact)?;
        let mut seen: Vec<(u32, Seen)> = Vec::with_capacity(8);
        let mut faces: Vec<(Crossing, usize)> = Vec::with_capacity(8);
        let (mut end, mut is_known) = (f64::INFINITY, true);
        self.tree.along(&coarse, &mut |face| {
            if is_missed(&coarse, self.corners(face)) {
                return end;
            }
            let places = self.faces[face].map(|vertex| {
                // Neighbouring faces come one after the other.
                seen.iter().rposition(|(other, _)| *other == vertex).or_else(|| {
                    seen.push((vertex, line.seen(self.vertices[vertex as usize].to_array())?));
                    Some(seen.len() - 1)
                })
            });
            let [Some(a), Some(b), Some(c)] = places else {
                is_known = false;
                return f64::NEG_INFINITY;
            };
            if let Some(crossing) = line.crossing([a, b, c].map(|place| &seen[place].1)) {
                if only_first && faces.iter().all(|(other, _)| crossing < *other) {
                    end = line.t(&crossing).coarse().high;
                }
                faces.push((crossing, face));
            }
            end
        });
        faces.sort_by(|(one, _), (other, _)| one.cmp(other));
        is_known.then_some(ExactCrossings { line, faces })
    }

    /// Returns the enclosure of a line's first hit with t > 0, and the hit face, like
    /// [`first_along`](Self::first_along); `None` if the line's numbers are no fractions.
    pub(super) fn first_exactly<A: NotClassic, F: Precise>(
        &self,
        line: &Line<Interval<F>>,
    ) -> Option<(HitEnclosure<F>, usize)> {
        let crossings = self.exact_crossings::<F>(line, true)?;
        let Some((at, here)) = crossings.places().next() else { return Some((HitEnclosure::Misses, 0)) };
        let hit = HitEnclosure::Hits(F::narrow(at));
        if let [(_, face)] = here {
            return Some((hit, *face));
        }
        // Of several faces at the same place, `face_along` chooses this one.
        let rank = |(crossing, face): &(Crossing, usize)| {
            (self.is_closed() && !crossing.enters, self.order[*face], *face)
        };
        let mut places: Vec<_> = here.iter().map(rank).collect();
        places.sort_unstable();
        let coarse = Line { origin: line.origin.map(Interval::coarse), dir: line.dir.map(Interval::coarse) };
        for (_, _, face) in &places {
            let is_hidden = self.is_certainly_hidden::<A, f64>(*face, &coarse, at.coarse(), None);
            match is_hidden.or_else(|| self.is_certainly_hidden::<A, F>(*face, line, F::narrow(at), None)) {
                Some(true) => {}
                Some(false) => return Some((hit, *face)),
                None => return Some((HitEnclosure::Doubtful(F::narrow(at).low), *face)),
            }
        }
        let first = places.into_iter().min_by_key(|(_, order, _)| *order);
        Some((hit, first.map_or(0, |(_, _, face)| face)))
    }

    /// Returns what is proven about each of a line's hits with t > 0, and the hit faces, like
    /// [`all_along`](Self::all_along); `None` if the line's numbers are no fractions. At an edge or a corner of a closed
    /// mesh, a line that crosses the surface does so once. It is open whether one that touches it does.
    pub(super) fn all_exactly<A: NotClassic, F: Precise>(
        &self,
        line: &Line<Interval<F>>,
    ) -> Option<Vec<(HitEnclosure<F>, usize)>> {
        let crossings = self.exact_crossings::<F>(line, false)?;
        let mut all = Vec::new();
        for (at, here) in crossings.places() {
            let at = self.place::<A, F>(here[0].1, line, at);
            let beside = here.iter().filter(|(crossing, _)| crossing.is_beside);
            let net: i32 = beside.map(|(crossing, _)| if crossing.enters { 1 } else { -1 }).sum();
            let is_bounding = |crossing: &Crossing| !self.is_closed() || crossing.enters == (net > 0);
            let chosen = here.iter().filter(|(crossing, _)| is_bounding(crossing));
            let chosen = chosen.map(|(_, face)| *face).min_by_key(|face| self.order[*face]);
            match chosen.filter(|_| net != 0 || !self.is_closed()) {
                Some(face) => all.push((HitEnclosure::Hits(at), face)),
                None => {
                    all.push((HitEnclosure::Doubtful(at.low), here[0].1));
                    break;
                }
            }
        }
        Some(all)
    }

    /// Encloses the t at which a line crosses a face, given 237 bits of it. Fractions may know it exactly, and so
    /// whether something else is there.
    fn place<A: NotClassic, F: Precise>(
        &self,
        face: usize,
        line: &Line<Interval<F>>,
        near: Wide,
    ) -> Interval<F> {
        match Face(self.triangle::<A>(face)).first_hit(line, None).0 {
            HitEnclosure::Hits(at) | HitEnclosure::Edge(at) if at.low == at.high => at,
            _ => F::narrow(near),
        }
    }
}

/// Tells whether a line certainly does not cross a triangle: it passes the edges on different sides, or lies in the
/// plane of the triangle, across an axis.
fn is_missed(line: &Line<Interval>, corners: [DVec3; 3]) -> bool {
    let is_level = |axis: usize| {
        let is_there = |corner: &DVec3| line.origin[axis] == Interval::constant(corner[axis]);
        line.dir[axis].is_zero() && corners.iter().all(is_there)
    };
    if (0..3).any(is_level) {
        return true;
    }
    let [a, b, c] =
        corners.map(|corner| per_axis(|axis| Interval::constant(corner[axis]) - line.origin[axis]));
    let sides = [[a, b], [b, c], [c, a]].map(|[from, to]| dot(cross(from, to), line.dir));
    sides.iter().any(|side| side.low > 0.0) && sides.iter().any(|side| side.high < 0.0)
}
