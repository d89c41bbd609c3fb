//! Proofs of where a line crosses the boundary of the inside of a closed mesh.
//!
//! A part of the boundary is a face. Its index is twice that of the face, plus 1 where the inside lies on the face's
//! outer side.

use super::Boundary;
use crate::mesh::along::{Met, everywhere, together};
use std::cmp::Ordering;
use tabray_exact::affine::Affine;
use tabray_exact::dual::Dual;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::dot;
use tabray_world::accuracy::{Exact, NotClassic};
use tabray_world::certify::{FootprintHit, HitEnclosure, HitProofs, OverFootprint, Precise};
use tabray_world::geometry::orientation::side_of_plane;
use tabray_world::geometry::sight::Line;

impl<A: NotClassic> Boundary<A> {
    /// Tells whether two faces lie in one plane, where a line crosses both at the same place.
    fn are_in_plane(&self, one: usize, other: usize) -> bool {
        let plane = self.mesh.surface.corners(one);
        let is_in_it = |corner| side_of_plane(plane, corner) == Ordering::Equal;
        one == other || self.mesh.surface.corners(other).into_iter().all(is_in_it)
    }

    /// Returns the winding number of the points just after a line's start, or `None` if it is uncertain. `met` are all
    /// faces that the line may hit. If the line's exact start lies on the boundary, `leaves` is the part it lies on.
    fn winding_at_start<F: Precise>(
        &self,
        line: &Line<Interval<F>>,
        leaves: Option<usize>,
        met: &[Met<F>],
    ) -> Option<i32> {
        let (surface, zero) = (&self.mesh.surface, F::of(0.0));
        let [low, high] = surface.bounds();
        let origin = line.origin.map(Interval::coarse);
        if (0..3).any(|axis| origin[axis].high < low[axis] || origin[axis].low > high[axis]) {
            return Some(0);
        }
        let known = leaves.and_then(|part| {
            let outward = dot(surface.triangle::<Exact>(part >> 1).area_normal(), line.dir);
            let depth = self.depths[part >> 1]?;
            (!outward.has_zero()).then(|| if outward.low > zero { depth } else { depth + 1 })
        });
        known.or_else(|| surface.winding(line, met))
    }

    /// Returns the enclosure of a line's first crossing of the boundary with t > 0, and the part.
    fn first_along<F: Precise>(
        &self,
        line: &Line<Interval<F>>,
        leaves: Option<usize>,
    ) -> (HitEnclosure<F>, usize) {
        let surface = &self.mesh.surface;
        let is_left = |face| leaves.is_some_and(|part| self.are_in_plane(part >> 1, face));
        let mut met = surface.met::<A, F>(line, is_left, everywhere);
        if met.is_empty() {
            return (HitEnclosure::Misses, 0);
        }
        met.sort_by(|((one, _), _), ((other, _), _)| one.partial_cmp(other).unwrap_or(Ordering::Equal));
        let Some(mut winding) = self.winding_at_start(line, leaves, &met) else {
            return (HitEnclosure::Doubtful(F::of(0.0)), 0);
        };
        let mut left = &met[..];
        while let Some(((low, _), first)) = left.first().copied() {
            let (here, beyond) = left.split_at(together(left));
            let doubtful = (HitEnclosure::Doubtful(low), 2 * first);
            let enters: Option<Vec<_>> = here.iter().map(|met| surface.enters(line, met)).collect();
            let Some(enters) = enters else { return doubtful };
            let count = |is: bool| enters.iter().filter(|enters| **enters == is).count() as i32;
            let (before, after) = (winding, winding + count(true) - count(false));
            if here.iter().all(|(_, face)| self.are_in_plane(first, *face)) {
                if (before == 0) != (after == 0) {
                    let bounding =
                        here.iter().zip(&enters).filter(|(_, enters)| **enters == (after > before));
                    let chosen = bounding.min_by_key(|((_, face), _)| surface.order[*face]);
                    let Some((((_, found), face), enters)) = chosen else { return doubtful };
                    return (*found, 2 * face + usize::from(*enters != (before == 0)));
                }
            } else if before - count(false) <= 0 && before + count(true) >= 0 {
                // In some order of these faces, the line may reach or leave the outside between them.
                return doubtful;
            }
            (winding, left) = (after, beyond);
        }
        (HitEnclosure::Misses, 0)
    }
}

impl<A: NotClassic, F: Precise> HitProofs<F> for Boundary<A> {
    fn first_hit(&self, line: &Line<Interval<F>>, leaves: Option<usize>) -> (HitEnclosure<F>, usize) {
        self.first_along(line, leaves)
    }

    fn slope(&self, at: [Dual<Interval<F>>; 3], part: usize) -> Dual<Interval<F>> {
        let slope = HitProofs::<F>::slope(&self.mesh, at, part >> 1);
        if part & 1 == 1 { -slope } else { slope }
    }

    fn source(&self, part: usize) -> Option<(&dyn HitProofs<F>, usize)> {
        Some((&self.mesh, part >> 1))
    }
}

impl<A: NotClassic> OverFootprint for Boundary<A> {
    fn hits(&self, line: &Line<Affine>, leaves: Option<usize>, met: &mut dyn FnMut(FootprintHit, usize)) {
        let leaves = leaves.map(|part| part >> 1);
        self.mesh.surface.hits_of_footprint::<A>(line, leaves, &mut |one, face| match self.depths[face] {
            Some(depth @ (0 | -1)) => met(one, 2 * face + usize::from(depth != 0)),
            Some(_) => {}
            None => met(FootprintHit::Doubtful(one.low()), 2 * face),
        });
    }

    fn slope(&self, at: [Dual<Affine>; 3], part: usize) -> Dual<Affine> {
        let slope = OverFootprint::slope(&self.mesh, at, part >> 1);
        if part & 1 == 1 { -slope } else { slope }
    }
}
