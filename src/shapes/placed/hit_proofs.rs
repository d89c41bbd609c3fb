//! Hits of copies along lines with interval coefficients.

use super::shape::Placed;
use glam::DVec3;
use tabray_exact::affine::Affine;
use tabray_exact::dual::Dual;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::{Scalar, constants, dot, per_axis};
use tabray_world::certify::{FootprintHit, HitEnclosure, HitProofs, OverFootprint, Precise};
use tabray_world::geometry::sight::Line;

impl<F: Precise> HitProofs<F> for Placed {
    fn first_hit(&self, line: &Line<Interval<F>>, leaves: Option<usize>) -> (HitEnclosure<F>, usize) {
        let own = Line { origin: self.placement.point(line.origin), dir: self.placement.vector(line.dir) };
        match self.body.shape.proven() {
            Some(proven) => {
                let (found, part) = F::proofs(proven).first_hit(&own, leaves);
                (self.max_z.kept_hit(line, found), part)
            }
            None => (HitEnclosure::Doubtful(F::of(0.0)), 0),
        }
    }

    fn slope(&self, at: [Dual<Interval<F>>; 3], part: usize) -> Dual<Interval<F>> {
        let own = self.placement.point(at);
        match self.body.shape.proven() {
            Some(proven) => F::proofs(proven).slope(own, part),
            None => Dual::fixed(Interval::whole()),
        }
    }

    fn source(&self, part: usize) -> Option<(&dyn HitProofs<F>, usize)> {
        Some((F::proofs(self.body.shape.proven()?), part))
    }

    fn to_source(&self, at: [Interval<F>; 3]) -> [Interval<F>; 3] {
        self.placement.point(at)
    }

    fn shading_normal(
        &self,
        at: [Interval<F>; 3],
        part: usize,
        normal: [Interval<F>; 3],
    ) -> Option<[Interval<F>; 3]> {
        let shape = F::proofs(self.body.shape.proven()?);
        let n = Interval::<F>::constant;
        // Normals are transformed by the inverse transpose of the matrix that transforms vectors.
        let own = self.placement.vector(normal);
        let own = per_axis(|axis| own[axis] * n(self.placement.scale[axis]).powi(2));
        let length = dot(own, own).sqrt();
        let own = per_axis(|axis| own[axis] / length);
        let shaded = shape.shading_normal(self.placement.point(at), part, own)?;
        if shaded == own {
            return Some(normal);
        }
        let world = per_axis(|axis| dot(self.placement.vector(constants(DVec3::AXES[axis])), shaded));
        let length = dot(world, world).sqrt();
        Some(per_axis(|axis| world[axis] / length))
    }
}

impl OverFootprint for Placed {
    fn hits(&self, line: &Line<Affine>, leaves: Option<usize>, met: &mut dyn FnMut(FootprintHit, usize)) {
        let own = Line { origin: self.placement.point(line.origin), dir: self.placement.vector(line.dir) };
        match self.body.shape.proven() {
            Some(proven) => proven.hits(&own, leaves, &mut |found, part| {
                self.max_z.kept_footprint(line, found).into_iter().for_each(|found| met(found, part));
            }),
            None => met(FootprintHit::Doubtful(0.0), 0),
        }
    }

    fn slope(&self, at: [Dual<Affine>; 3], part: usize) -> Dual<Affine> {
        let own = self.placement.point(at);
        match self.body.shape.proven() {
            Some(proven) => OverFootprint::slope(proven, own, part),
            None => Dual::fixed(Affine::WHOLE),
        }
    }
}
