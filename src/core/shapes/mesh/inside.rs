//! Whether a closed mesh has an inside: whether its faces meet only at the edges and corners that they share, and each of
//! them has the outside on its outer side and the inside on the other.
//!
//! The space around a mesh can then be told apart by any face that a ray meets first, and by counting crossings, and both
//! say the same.

use super::surface::Surface;
use super::winding::DIRECTIONS;
use crate::geometry::orientation::side_of_plane;
use crate::geometry::sight::Line;
use crate::parallel;
use crate::shapes::solid::Crossings;
use crate::world::accuracy::Exact;
use crate::world::certify::{Precise, ProofMethods};
use f256::f256;
use glam::DVec3;
use std::cmp::Ordering;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::{Scalar, constants, dot, per_axis};

impl Surface {
    /// Says why a closed mesh has no inside, phrased to follow "is not a closed shape: "; `None` if it has one. `shape` is
    /// the mesh as a shape.
    pub(super) fn fault(&self, shape: &(dyn ProofMethods + Sync)) -> Option<&str> {
        let fault = || {
            if self.is_star(shape) {
                return None;
            }
            let name = |face: usize| self.order[face] + 1;
            if let Some([one, other]) = self.overlap() {
                let how = match self.faces[one].iter().all(|corner| self.faces[other].contains(corner)) {
                    true => "are in one place",
                    false => "cross, or touch other than at edges and corners that they share",
                };
                let (one, other) = (name(one), name(other));
                return Some(format!("its faces {} and {} {how}", one.min(other), one.max(other)));
            }
            let patches = self.patches();
            // Where no direction tells, nothing is known to be wrong.
            let depth = |patch: usize| {
                let face = patches[patch];
                self.depth::<f64>(shape, face).or_else(|| self.depth::<f256>(shape, face)).unwrap_or(0)
            };
            let patch = parallel::find_first(patches.len(), |patch| depth(patch) != 0)?;
            let face = name(patches[patch]);
            Some(if depth(patch) > 0 {
                format!("its face {face} lies within others, but is not turned inward as that of a cavity")
            } else {
                format!("its face {face} is turned inside out")
            })
        };
        self.fault.get_or_init(fault).as_deref()
    }

    /// Returns how many bodies of a closed mesh the outer side of a face lies in, where those turned inside out count as
    /// less than none; `None` where no direction tells.
    fn depth<F: Precise>(&self, shape: &dyn ProofMethods, face: usize) -> Option<i32> {
        let third = Interval::constant(1.0) / Interval::constant(3.0);
        let triangle = self.triangle::<Exact>(face);
        let normal = triangle.area_normal::<Interval<F>>();
        let [a, b, c]: [[Interval<F>; 3]; 3] = triangle.corners.map(constants);
        let origin = per_axis(|axis| third * (a[axis] + b[axis] + c[axis]));
        let outward = |dir: &DVec3| dot(constants(*dir), normal).low > F::of(0.0);
        let mut lines =
            directions().filter(outward).map(|dir| Line { origin, dir: constants::<Interval<F>>(dir) });
        lines.find_map(|line| exits(shape, &line, Some(face)))
    }

    /// Tells whether a closed mesh is certainly the surface of a star-shaped body: whether all faces turn their inner sides
    /// to one point, and a ray from there meets one face only.
    ///
    /// Then its faces meet only at edges and corners that they share, and it has an inside. Around an edge, a ray from the
    /// point meets as many faces on the one side as on the other, as the mesh is closed and all faces are turned alike. So
    /// all rays that meet no edge meet one face each; but where faces met elsewhere, some ray nearby would meet two.
    fn is_star(&self, shape: &dyn ProofMethods) -> bool {
        let middle = self.vertices.iter().sum::<DVec3>() / self.vertices.len() as f64;
        let is_behind = |face: usize| side_of_plane(self.corners(face), middle) == Ordering::Greater;
        if parallel::find_first(self.face_count(), |face| !is_behind(face)).is_some() {
            return false;
        }
        let mut lines =
            directions().map(|dir| Line { origin: constants::<Interval<f64>>(middle), dir: constants(dir) });
        lines.find_map(|line| exits(shape, &line, None)) == Some(1)
    }

    /// Returns a face of each part of a closed mesh that hangs together by edges of two faces: on one side of such a part, all is
    /// inside as often.
    fn patches(&self) -> Vec<usize> {
        let edges = |face: usize| {
            let [a, b, c] = self.faces[face];
            [(a, b), (b, c), (c, a)].map(|(from, to)| ((from.min(to), from.max(to)), face))
        };
        let mut edges: Vec<_> = (0..self.face_count()).flat_map(edges).collect();
        edges.sort_unstable();
        let mut above: Vec<_> = (0..self.face_count()).collect();
        for pair in edges.chunk_by(|one, other| one.0 == other.0).filter(|pair| pair.len() == 2) {
            let [one, other] = [pair[0].1, pair[1].1].map(|face| top(&mut above, face));
            above[one.max(other)] = one.min(other);
        }
        (0..self.face_count()).filter(|face| above[*face] == *face).collect()
    }
}

/// The directions in which crossings are counted.
fn directions() -> impl Iterator<Item = DVec3> {
    DIRECTIONS.into_iter().flat_map(|dir| [dir, -dir])
}

/// Counts how often a line leaves a shape, less how often it enters it; `None` where that is not certain. Its start may lie
/// on one part of the shape, which does not count.
fn exits<F: Precise>(
    shape: &dyn ProofMethods,
    line: &Line<Interval<F>>,
    leaves: Option<usize>,
) -> Option<i32> {
    let mut crossings = Crossings::new(shape, line, leaves);
    let mut exits = 0;
    for index in 0.. {
        match crossings.get(index) {
            Ok(crossing) => exits += if crossing.enters { -1 } else { 1 },
            Err(end) => return (end == F::INFINITY).then_some(exits),
        }
    }
    None
}

/// Returns the face that stands for the part that a face belongs to, and halves the way to it.
fn top(above: &mut [usize], mut face: usize) -> usize {
    while above[face] != face {
        above[face] = above[above[face]];
        face = above[face];
    }
    face
}
