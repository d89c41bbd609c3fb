//! The inside of a closed mesh: the points with a nonzero winding number.
//!
//! The winding number of a point is the number of bodies of the mesh that contain the point, where an inside-out body
//! counts as -1. Along any path to the outside, it is the number of faces crossed from their inner to their outer side,
//! minus the number crossed the other way. Bodies that overlap or touch thus form one inside, and a cavity, a body that
//! is turned inward in another one, is outside.
//!
//! The faces of most meshes are exactly the boundary of the inside. For other meshes, the winding number before each
//! face is computed.

use super::along::{Met, everywhere};
use super::face::Face;
use super::surface::{Depth, Surface};
use super::winding::DIRECTIONS;
use glam::DVec3;
use std::cmp::Ordering;
use std::sync::Arc;
use tabray_exact::interval::{Fraction, Interval};
use tabray_exact::scalar::{Scalar, constants, dot, per_axis};
use tabray_world::accuracy::Exact;
use tabray_world::certify::{Equation, HitEnclosure, Precise};
use tabray_world::geometry::orientation::side_of_plane;
use tabray_world::geometry::sight::Line;
use tabray_world::parallel;

impl Surface {
    /// Returns the winding numbers before the faces of a closed mesh, unless the faces are the boundary of its inside.
    pub(super) fn depths(&self) -> Option<&Arc<[Depth]>> {
        self.depths.get_or_init(|| if self.is_star() { None } else { self.find_depths() }).as_ref()
    }

    /// Tells whether a point lies inside of a closed mesh: whether the mesh winds around it. Returns `None` if 237 bits
    /// do not decide, as on the surface, or in both the plane of a face and its bounding box.
    ///
    /// Faces must be oriented as by [`turned_alike`](Self::turned_alike).
    pub fn winds_around(&self, at: DVec3) -> Option<bool> {
        let mut may_be_on = false;
        self.tree.within(
            |bounds| bounds.low.cmple(at).all() && at.cmple(bounds.high).all(),
            |face| may_be_on |= side_of_plane(self.corners(face), at) == Ordering::Equal,
        );
        if may_be_on {
            return None;
        }
        let number = self.number_at::<f64>(at).or_else(|| self.number_at::<Fraction>(at))?;
        Some(number != 0)
    }

    /// Returns the winding number of a point, or `None` if no direction decides.
    fn number_at<F: Precise>(&self, at: DVec3) -> Option<i32> {
        let origin = constants::<Interval<F>>(at);
        let mut lines = directions().map(|dir| Line { origin, dir: constants(dir) });
        lines.find_map(|line| self.winding(&line, &self.met::<Exact, F>(&line, |_| false, everywhere)))
    }

    fn find_depths(&self) -> Option<Arc<[Depth]>> {
        let overlaps = self.overlapping();
        let first_of = self.patches(&overlaps);
        let firsts: Vec<_> =
            (0..self.face_count()).filter(|face| first_of[*face] == *face && !overlaps[*face]).collect();
        let found = parallel::map(firsts.len(), |patch| {
            let face = firsts[patch];
            self.depth::<f64>(face).or_else(|| self.depth::<Fraction>(face))
        });
        // Undecided winding numbers count as 0.
        if !overlaps.contains(&true) && found.iter().all(|depth| depth.unwrap_or(0) == 0) {
            return None;
        }
        let mut depths = vec![None; self.face_count()];
        firsts.iter().zip(found).for_each(|(face, depth)| depths[*face] = depth);
        Some((0..self.face_count()).map(|face| depths[first_of[face]]).collect())
    }

    /// Returns the winding number before the outer side of a face that meets others only at shared edges and corners.
    /// Returns `None` if none of the tested directions decides.
    fn depth<F: Precise>(&self, face: usize) -> Depth {
        let third = Interval::constant(1.0) / Interval::constant(3.0);
        let triangle = self.triangle::<Exact>(face);
        let normal = triangle.area_normal::<Interval<F>>();
        let [a, b, c]: [[Interval<F>; 3]; 3] = triangle.corners.map(constants);
        let origin = per_axis(|axis| third * (a[axis] + b[axis] + c[axis]));
        let outward = |dir: &DVec3| dot(constants(*dir), normal).low > F::of(0.0);
        let mut lines =
            directions().filter(outward).map(|dir| Line { origin, dir: constants::<Interval<F>>(dir) });
        lines.find_map(|line| {
            self.winding(&line, &self.met::<Exact, F>(&line, |other| other == face, everywhere))
        })
    }

    /// Tells whether a closed mesh is certainly the surface of a star-shaped body: all faces turn their inner sides to
    /// one point, and a ray from there hits one face only.
    ///
    /// The faces of such a mesh meet only at shared edges and corners, and bound its inside. A closed mesh has
    /// consistently oriented faces. Around an edge, a ray from the point thus crosses as many faces on one side as on
    /// the other, and all rays that avoid edges cross one face each. If faces met elsewhere, some ray nearby would
    /// cross two.
    fn is_star(&self) -> bool {
        let middle = self.vertices.iter().sum::<DVec3>() / self.vertices.len() as f64;
        let is_behind = |face: usize| side_of_plane(self.corners(face), middle) == Ordering::Greater;
        if parallel::find_first(self.face_count(), |face| !is_behind(face)).is_some() {
            return false;
        }
        let mut lines =
            directions().map(|dir| Line { origin: constants::<Interval<f64>>(middle), dir: constants(dir) });
        lines.find_map(|line| self.winding(&line, &self.met::<Exact, f64>(&line, |_| false, everywhere)))
            == Some(1)
    }

    /// Returns for each face the first face of its patch. A patch consists of faces without overlaps, connected by
    /// edges of two faces. Before all of them, the winding number is the same.
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

    /// Returns the winding number of the points just after a line's start, given all faces that the line may hit, or
    /// `None` if one of the hits is uncertain.
    pub(super) fn winding<F: Precise>(&self, line: &Line<Interval<F>>, met: &[Met<F>]) -> Option<i32> {
        met.iter().map(|met| self.enters(line, met).map(|enters| if enters { -1 } else { 1 })).sum()
    }

    /// Tells whether a line crosses a face from its outer to its inner side, or `None` if it does not certainly cross
    /// the face off its edges.
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

/// Returns the face that represents the part of a face, and halves the path to it.
fn top(above: &mut [usize], mut face: usize) -> usize {
    while above[face] != face {
        above[face] = above[above[face]];
        face = above[face];
    }
    face
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the vertices and the faces of a cube, given its low corner and its side length. The faces are turned
    /// outward.
    fn cube(low: DVec3, side: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let corner = |index: usize| {
            low + side * DVec3::from([1, 2, 4].map(|bit| f64::from(u8::from(index & bit != 0))))
        };
        let faces = [
            [0, 2, 1],
            [1, 2, 3],
            [4, 5, 6],
            [5, 7, 6],
            [0, 1, 4],
            [1, 5, 4],
            [2, 6, 3],
            [3, 6, 7],
            [0, 4, 2],
            [2, 4, 6],
            [1, 3, 5],
            [3, 7, 5],
        ];
        ((0..8).map(corner).collect(), faces.to_vec())
    }

    /// Returns the surface of two cubes. The second one may be turned inward.
    fn two(one: (Vec<DVec3>, Vec<[u32; 3]>), other: (Vec<DVec3>, Vec<[u32; 3]>), inward: bool) -> Surface {
        let (vertices, mut faces) = ([one.0, other.0].concat(), one.1);
        for [a, b, c] in other.1.into_iter().map(|face| face.map(|corner| corner + 8)) {
            faces.push(if inward { [a, c, b] } else { [a, b, c] });
        }
        Surface::of_arrays(vertices, faces).expect("two cubes")
    }

    #[test]
    fn a_point_is_inside_where_the_mesh_winds_around_it() {
        let (vertices, mut faces) = cube(DVec3::ZERO, 1.0);
        for turned in [None, Some(3), Some(8)] {
            turned.into_iter().for_each(|face: usize| faces[face].reverse());
            let cube = Surface::of_arrays(vertices.clone(), faces.clone()).expect("a cube");
            let cube = if turned.is_some() { cube.turned_alike().expect("a cube") } else { cube };
            for (at, right) in [
                ([0.5; 3], Some(true)),
                ([1e-15, 0.5, 0.5], Some(true)),
                ([-1e-60, 0.5, 0.5], Some(false)),
                ([0.5, 1.0 + f64::EPSILON, 0.5], Some(false)),
                ([2.0, 0.3, 0.3], Some(false)),
                ([1.0, 0.3, 0.4], None),
                ([0.0; 3], None),
                ([1.0, 0.0, 0.25], None),
            ] {
                assert_eq!(cube.winds_around(DVec3::from(at)), right, "{at:?}");
            }
        }
    }

    #[test]
    fn bodies_that_overlap_are_one_and_one_turned_inward_is_a_cavity() {
        let all = || cube(DVec3::ZERO, 3.0);
        let overlapping = two(all(), cube(DVec3::splat(2.0), 3.0), false);
        for (at, is_inside) in [(1.0, true), (2.5, true), (4.0, true), (5.5, false)] {
            assert_eq!(overlapping.winds_around(DVec3::splat(at)), Some(is_inside), "{at}");
        }
        for (inward, is_inside) in [(true, false), (false, true)] {
            let within = two(all(), cube(DVec3::ONE, 1.0), inward);
            assert_eq!(within.winds_around(DVec3::splat(1.5)), Some(is_inside), "turned inward: {inward}");
            assert_eq!(within.winds_around(DVec3::splat(0.5)), Some(true));
        }
    }
}
