//! Proofs of the hits of a part of a solid.

use super::crossings::Crossings;
use super::solid_part::SolidPart;
use tabray_exact::affine::Affine;
use tabray_exact::dual::Dual;
use tabray_exact::interval::Interval;
use tabray_world::certify::{
    FootprintHit, HitEnclosure, HitProofs, OverFootprint, Precise, ProofMethods, coarse,
};
use tabray_world::geometry::sight::Line;

impl SolidPart {
    fn proven(&self, part: usize) -> Option<&dyn ProofMethods> {
        self.parts[part].body.shape.proven()
    }

    /// Tells whether a line is in a part just before and just after a place, or `None` if that is undecided.
    fn beside<'l, F: Precise>(
        &'l self,
        part: usize,
        line: &'l Line<Interval<F>>,
        place: Interval<F>,
        crossings: &mut Option<Crossings<'l, F>>,
    ) -> Option<[bool; 2]> {
        let shape = self.proven(part)?;
        if self.parts[part].is_clipped {
            let value = F::proofs(shape).slope(line.at(place).map(Dual::fixed), 0).value;
            return (!value.has_zero()).then_some([value.high < F::of(0.0); 2]);
        }
        crossings.get_or_insert_with(|| Crossings::new(shape, line, None)).around(place)
    }

    /// Calls a function with the visible hits and their parts, in order, until it returns true. Returns the t beyond
    /// which nothing is known, or infinity if there are no more hits.
    fn proven_hits<F: Precise>(
        &self,
        line: &Line<Interval<F>>,
        leaves: Option<usize>,
        mut met: impl FnMut(Interval<F>, usize) -> bool,
    ) -> F {
        if let Some(around) = self.around()
            && line.clip(around.low, around.high).is_none()
        {
            return F::INFINITY;
        }
        let Some(proven) = self.proven(self.index) else { return F::of(0.0) };
        let mut own = Crossings::new(proven, line, leaves);
        let mut others: Vec<Option<Crossings<'_, F>>> = Vec::new();
        others.resize_with(self.parts.len(), || None);
        for index in 0.. {
            let crossing = match own.get(index) {
                Ok(crossing) => crossing,
                Err(end) => return end,
            };
            if let Ok(next) = own.get(index + 1)
                && next.at.low <= crossing.at.high
            {
                return crossing.at.low;
            }
            let mut around = [!crossing.enters, crossing.enters].map(|inside| {
                let mut of = vec![false; self.parts.len()];
                of[self.index] = inside;
                of
            });
            let mut is_known = true;
            self.tree.holds(&mut |part| {
                if part != self.index {
                    match self.beside(part, line, crossing.at, &mut others[part]) {
                        Some([before, after]) => {
                            (around[0][part], around[1][part]) = (before, after);
                        }
                        None => is_known = false,
                    }
                }
                // `None` keeps the evaluation from ending early, and so each part is visited.
                None
            });
            if !is_known {
                return crossing.at.low;
            }
            if self.tree.owner(&around[0], &around[1]) == Some(self.index) && met(crossing.at, crossing.part)
            {
                break;
            }
        }
        F::INFINITY
    }
}

/// Returns what is known from a t on; `None` if that is infinite.
fn open_from<F: Precise>(end: F) -> Option<HitEnclosure<F>> {
    let zero = F::of(0.0);
    (end != F::INFINITY).then(|| HitEnclosure::Doubtful(if end < zero { zero } else { end }))
}

impl<F: Precise> HitProofs<F> for SolidPart {
    fn first_hit(&self, line: &Line<Interval<F>>, leaves: Option<usize>) -> (HitEnclosure<F>, usize) {
        let mut first = None;
        let end = self.proven_hits(line, leaves, |at, part| {
            first = Some((HitEnclosure::Hits(at), part));
            true
        });
        first.unwrap_or_else(|| (open_from(end).unwrap_or(HitEnclosure::Misses), 0))
    }

    fn all_hits(
        &self,
        line: &Line<Interval<F>>,
        leaves: Option<usize>,
    ) -> Option<Vec<(HitEnclosure<F>, usize)>> {
        let mut all = Vec::new();
        let end = self.proven_hits(line, leaves, |at, part| {
            all.push((HitEnclosure::Hits(at), part));
            false
        });
        all.extend(open_from(end).map(|open| (open, 0)));
        Some(all)
    }

    fn slope(&self, at: [Dual<Interval<F>>; 3], part: usize) -> Dual<Interval<F>> {
        match self.proven(self.index) {
            Some(proven) if self.is_outer => -F::proofs(proven).slope(at, part),
            Some(proven) => F::proofs(proven).slope(at, part),
            None => Dual::fixed(Interval::whole()),
        }
    }

    fn source(&self, part: usize) -> Option<(&dyn HitProofs<F>, usize)> {
        Some((F::proofs(self.proven(self.index)?), part))
    }
}

/// Behind a hit that may be hidden, further hits are unknown.
impl OverFootprint for SolidPart {
    fn hits(&self, line: &Line<Affine>, leaves: Option<usize>, met: &mut dyn FnMut(FootprintHit, usize)) {
        if let Some(around) = self.around()
            && coarse(line).clip(around.low, around.high).is_none()
        {
            return;
        }
        let Some(proven) = self.proven(self.index) else { return met(FootprintHit::Doubtful(0.0), 0) };
        if self.is_whole() {
            return proven.hits(line, leaves, met);
        }
        let mut first: Option<f64> = None;
        proven.hits(line, leaves, &mut |one, _| {
            first = Some(first.map_or(one.low(), |first| first.min(one.low())))
        });
        if let Some(first) = first {
            met(FootprintHit::Doubtful(first), 0);
        }
    }

    fn slope(&self, at: [Dual<Affine>; 3], part: usize) -> Dual<Affine> {
        match self.proven(self.index) {
            Some(proven) if self.is_outer => -OverFootprint::slope(proven, at, part),
            Some(proven) => OverFootprint::slope(proven, at, part),
            None => Dual::fixed(Affine::WHOLE),
        }
    }
}
