//! What lies inside of a closed mesh: the points around which it winds.
//!
//! The winding number of a point tells how many bodies of the mesh hold it, where those turned inside out count as less than
//! none. Along any way to the outside, it is how often faces are passed from their inner to their outer side, less how often
//! the other way. A point lies inside where that is not 0: bodies that overlap or touch are one, and a cavity, turned inward
//! in a body, is outside.
//!
//! Most meshes are the boundary of that as they are. Of others, it is found for each face what lies before it.

use super::along::Met;
use super::face::Face;
use super::surface::{Depth, Surface};
use super::winding::DIRECTIONS;
use crate::geometry::orientation::side_of_plane;
use crate::geometry::sight::Line;
use crate::parallel;
use crate::world::accuracy::Exact;
use crate::world::certify::{Equation, HitEnclosure, Precise};
use f256::f256;
use glam::DVec3;
use std::cmp::Ordering;
use std::sync::Arc;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::{Scalar, constants, dot, per_axis};

impl Surface {
    /// Returns what lies before each face of a closed mesh, if that is not the outside.
    pub(super) fn depths(&self) -> Option<&Arc<[Depth]>> {
        self.depths.get_or_init(|| if self.is_star() { None } else { self.find_depths() }).as_ref()
    }

    fn find_depths(&self) -> Option<Arc<[Depth]>> {
        let overlaps = self.overlapping();
        let first_of = self.patches(&overlaps);
        let firsts: Vec<_> =
            (0..self.face_count()).filter(|face| first_of[*face] == *face && !overlaps[*face]).collect();
        let found = parallel::map(firsts.len(), |patch| {
            let face = firsts[patch];
            self.depth::<f64>(face).or_else(|| self.depth::<f256>(face))
        });
        // Where no direction tells, nothing is known to be wrong.
        if !overlaps.contains(&true) && found.iter().all(|depth| depth.unwrap_or(0) == 0) {
            return None;
        }
        let mut depths = vec![None; self.face_count()];
        firsts.iter().zip(found).for_each(|(face, depth)| depths[*face] = depth);
        Some((0..self.face_count()).map(|face| depths[first_of[face]]).collect())
    }

    /// Returns the winding number beside the outer side of a face that meets others only at shared edges and corners; `None`
    /// where no direction tells.
    fn depth<F: Precise>(&self, face: usize) -> Depth {
        let third = Interval::constant(1.0) / Interval::constant(3.0);
        let triangle = self.triangle::<Exact>(face);
        let normal = triangle.area_normal::<Interval<F>>();
        let [a, b, c]: [[Interval<F>; 3]; 3] = triangle.corners.map(constants);
        let origin = per_axis(|axis| third * (a[axis] + b[axis] + c[axis]));
        let outward = |dir: &DVec3| dot(constants(*dir), normal).low > F::of(0.0);
        let mut lines =
            directions().filter(outward).map(|dir| Line { origin, dir: constants::<Interval<F>>(dir) });
        lines.find_map(|line| self.winding(&line, &self.met::<Exact, F>(&line, |other| other == face, false)))
    }

    /// Tells whether a closed mesh is certainly the surface of a star-shaped body: whether all faces turn their inner sides
    /// to one point, and a ray from there meets one face only.
    ///
    /// Then its faces meet only at edges and corners that they share, and bound its inside. Around an edge, a ray from the
    /// point meets as many faces on the one side as on the other, as the mesh is closed and all faces are turned alike. So
    /// all rays that meet no edge meet one face each; but where faces met elsewhere, some ray nearby would meet two.
    fn is_star(&self) -> bool {
        let middle = self.vertices.iter().sum::<DVec3>() / self.vertices.len() as f64;
        let is_behind = |face: usize| side_of_plane(self.corners(face), middle) == Ordering::Greater;
        if parallel::find_first(self.face_count(), |face| !is_behind(face)).is_some() {
            return false;
        }
        let mut lines =
            directions().map(|dir| Line { origin: constants::<Interval<f64>>(middle), dir: constants(dir) });
        lines.find_map(|line| self.winding(&line, &self.met::<Exact, f64>(&line, |_| false, false)))
            == Some(1)
    }

    /// Returns for each face the first of those that hang together with it by edges of two faces, none of which overlaps
    /// others: before all of them, the winding number is the same.
    fn patches(&self, overlaps: &[bool]) -> Vec<usize> {
        let edges = |face: usize| {
            let [a, b, c] = self.faces[face];
            [(a, b), (b, c), (c, a)].map(|(from, to)| ((from.min(to), from.max(to)), face))
        };
        let mut edges: Vec<_> = (0..self.face_count()).flat_map(edges).collect();
        edges.sort_unstable();
        let mut above: Vec<_> = (0..self.face_count()).collect();
        for pair in edges.chunk_by(|one, other| one.0 == other.0).filter(|pair| pair.len() == 2) {
            if pair.iter().all(|(_, face)| !overlaps[*face]) {
                let [one, other] = [pair[0].1, pair[1].1].map(|face| top(&mut above, face));
                above[one.max(other)] = one.min(other);
            }
        }
        (0..self.face_count()).map(|face| top(&mut above, face)).collect()
    }

    /// Returns the winding number of the points just after a line's start, given all faces that the line may meet; `None`
    /// where one of them is not certain.
    pub(super) fn winding<F: Precise>(&self, line: &Line<Interval<F>>, met: &[Met<F>]) -> Option<i32> {
        met.iter().map(|met| self.enters(line, met).map(|enters| if enters { -1 } else { 1 })).sum()
    }

    /// Tells whether a line passes a face from its outer to its inner side; `None` where it is not certain that it passes
    /// through the face, off its edges.
    pub(super) fn enters<F: Precise>(
        &self,
        line: &Line<Interval<F>>,
        ((_, found), face): &Met<F>,
    ) -> Option<bool> {
        let HitEnclosure::Hits(at) = *found else { return None };
        let triangle = self.triangle::<Exact>(*face);
        let slope = dot(triangle.area_normal(), line.dir);
        let is_certain = Face(triangle).inside_trim(line.at(at)).low > F::of(0.0) && !slope.has_zero();
        is_certain.then(|| slope.high < F::of(0.0))
    }
}

/// The directions in which faces are counted.
fn directions() -> impl Iterator<Item = DVec3> {
    DIRECTIONS.into_iter().flat_map(|dir| [dir, -dir])
}

/// Returns the face that stands for the part that a face belongs to, and halves the way to it.
fn top(above: &mut [usize], mut face: usize) -> usize {
    while above[face] != face {
        above[face] = above[above[face]];
        face = above[face];
    }
    face
}
