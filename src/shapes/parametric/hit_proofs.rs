//! Proofs of the hits of a parametric surface.

use super::patch::{Patches, PatchesIn, Rectangle};
use super::search::{Found, Hit, Search, meet};
use super::shape::ParametricShape;
use super::tree::halves;
use glam::DVec3;
use std::cell::Cell;
use tabray_exact::affine::Affine;
use tabray_exact::dual::Dual;
use tabray_exact::interval::{Float, Fraction, Interval};
use tabray_exact::scalar::{cross, dot};
use tabray_world::certify::{
    FootprintHit, HitEnclosure, HitProofs, OverFootprint, Premise, ProofMethods, coarse,
};
use tabray_world::geometry::sight::Line;
use tabray_world::packets::shape::HitQueries;

/// The maximum number of parts in which normals are enclosed.
const MAX_NORMALS: usize = 256;

impl ParametricShape {
    pub(super) fn proven_hit<F: Float>(
        &self,
        line: &Line<Interval<F>>,
        leaves: bool,
    ) -> (HitEnclosure<F>, usize)
    where
        dyn Patches: PatchesIn<F>,
    {
        // The only solution that may have t = 0 is the start of the line. Of several, any may be the start.
        let start: Cell<Option<Rectangle<F>>> = Cell::new(None);
        let is_left_out = |t: Interval<F>, place: &Rectangle<F>, is_certain: bool| {
            if !(leaves && is_certain && t.has_zero()) {
                return false;
            }
            let known = start.get().unwrap_or(*place);
            start.set(Some(known));
            meet(&known, place)
        };
        match Search::new(self, line, &is_left_out).first() {
            Found { hit: None, undecided: None, .. } => (HitEnclosure::Misses, 0),
            Found { hit: Some(hit), .. } if !self.is_on(line, &hit) => {
                (HitEnclosure::Doubtful(F::of(0.0)), 0)
            }
            Found { hit: Some(hit), undecided, .. } if undecided.is_none_or(|from| from > hit.t.high) => {
                let at = if hit.is_edge { HitEnclosure::Edge(hit.t) } else { HitEnclosure::Hits(hit.t) };
                (at, hit.leaf)
            }
            Found { hit, undecided, .. } => {
                let from = undecided.unwrap_or(F::of(0.0));
                (HitEnclosure::Doubtful(hit.map_or(from, |hit| from.min(hit.t.low))), 0)
            }
        }
    }

    /// Tells whether the line may be on the surface at a hit: the second opinion on its proof, by the formulas as they
    /// were written.
    fn is_on<F: Float>(&self, line: &Line<Interval<F>>, hit: &Hit<F>) -> bool
    where
        dyn Patches: PatchesIn<F>,
    {
        let (Some(surface), at) = (self.patches.as_written(&hit.place), line.at(hit.t)) else { return false };
        (0..3).all(|axis| {
            let off = surface[axis] - at[axis];
            // False for NaN.
            let is_off = off.low > F::of(0.0) || off.high < F::of(0.0);
            !is_off
        })
    }

    /// Encloses the normals, of any length, at those points of a leaf and its margin that are in a box. Returns `None`
    /// if that takes too many parts.
    fn normals<F: Float>(&self, at: &[Interval<F>; 3], leaf: usize) -> Option<[Interval<F>; 3]>
    where
        dyn Patches: PatchesIn<F>,
    {
        let whole = self.tree.leaf(leaf).map(|side| {
            let margin = 0.25 * side.width();
            Interval { low: side.low - margin, high: side.high + margin }
        });
        let (mut waiting, mut left) = (vec![whole], MAX_NORMALS);
        let mut all: Option<[Interval<F>; 3]> = None;
        while let Some(part) = waiting.pop() {
            let patch = PatchesIn::<F>::patch(&*self.patches, &part.map(Interval::from_f64));
            let meets =
                |axis: usize| patch.at[axis].low <= at[axis].high && at[axis].low <= patch.at[axis].high;
            if !(0..3).all(meets) {
                continue;
            }
            left = left.checked_sub(1)?;
            let is_narrow = (0..2).all(|axis| part[axis].width() < whole[axis].width() / 4096.0);
            if !is_narrow {
                waiting.extend(halves(&*self.patches, part));
                continue;
            }
            let normal = cross(patch.along[0], patch.along[1]);
            all = Some(match all {
                Some(known) => [0, 1, 2].map(|axis| known[axis].hull(normal[axis])),
                None => normal,
            });
        }
        all
    }
}

/// Implements proofs in a precision.
macro_rules! proofs {
    ($F:ty) => {
        impl HitProofs<$F> for ParametricShape {
            fn first_hit(
                &self,
                line: &Line<Interval<$F>>,
                leaves: Option<usize>,
            ) -> (HitEnclosure<$F>, usize) {
                self.proven_hit(line, leaves.is_some())
            }

            fn has_equation(&self, _part: usize) -> bool {
                false
            }

            /// There is no equation. The value is unknown, and the slopes are components of a normal.
            fn slope(&self, at: [Dual<Interval<$F>>; 3], part: usize) -> Dual<Interval<$F>> {
                let normal = self.normals(&at.map(|axis| axis.value), part);
                let along = |normal| dot(normal, at.map(|axis| axis.slope));
                Dual { value: Interval::whole(), slope: normal.map_or(Interval::whole(), along) }
            }
        }
    };
}

proofs!(f64);
proofs!(Fraction);

impl OverFootprint for ParametricShape {
    fn hits(&self, line: &Line<Affine>, _leaves: Option<usize>, met: &mut dyn FnMut(FootprintHit, usize)) {
        if let Some((from, _)) = coarse(line).clip(self.bounds.low, self.bounds.high) {
            met(FootprintHit::Doubtful(from), 0);
        }
    }

    fn slope(&self, _at: [Dual<Affine>; 3], _part: usize) -> Dual<Affine> {
        Dual::fixed(Affine::WHOLE)
    }
}

impl HitQueries for ParametricShape {
    fn is_on_surface(&self, at: DVec3, error: f64) -> bool {
        self.is_near(at, error)
    }

    fn premises(&self, _of: &'static str, _each: &mut dyn FnMut(&'static str, Premise)) {}

    fn proven(&self) -> Option<&dyn ProofMethods> {
        Some(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parametric::Parametric;
    use crate::parametric::tree::Tree;
    use tabray_exact::scalar::{Scalar, constants};

    /// A square of which the formulas that are proven are off by so much from those that were written.
    struct Square(f64);

    impl Parametric for Square {
        fn point<N: Scalar>(&self, [u, v]: [N; 2]) -> [N; 3] {
            [u, v, N::constant(0.25) * u * v]
        }

        fn as_written<F: Float>(&self, uv: [Interval<F>; 2]) -> Option<[Interval<F>; 3]> {
            let [x, y, z] = self.point(uv);
            Some([x, y + Interval::constant(self.0), z])
        }

        fn ends(&self) -> [[f64; 2]; 2] {
            [[-1.0, 1.0]; 2]
        }
    }

    #[test]
    fn a_hit_off_the_surface_as_it_was_written_is_open() {
        for (off, is_open) in [(0.0, false), (1e-9, true)] {
            let patches: Box<dyn Patches> = Box::new(Square(off));
            let tree = Tree::new(&*patches, Square(off).ends());
            let bounds = tree.bounds().expect("a box");
            let shape = ParametricShape { patches, tree, bounds };
            for [x, y] in [[0.3, 0.4], [-0.71, 0.123], [0.5, -0.2]] {
                let dir = constants(DVec3::new(0.1, -0.05, -1.0));
                let line = Line { origin: constants(DVec3::new(x, y, 3.0)), dir };
                let (found, _) = shape.proven_hit::<f64>(&line, false);
                assert_eq!(matches!(found, HitEnclosure::Doubtful(_)), is_open, "{found:?}");
                assert_eq!(matches!(found, HitEnclosure::Hits(_)), !is_open, "{found:?}");
            }
        }
    }
}
