//! Exact decisions, like those of [`orientation`](tabray_world::geometry::orientation), whether faces of a mesh have common
//! points beyond shared edges and corners.

use super::surface::Surface;
use glam::DVec3;
use std::cmp::Ordering;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::Relaxed;
use tabray_world::geometry::aabb::Aabb;
use tabray_world::geometry::orientation::{axis_across, side_of_plane, turn};
use tabray_world::parallel;

impl Surface {
    /// Tells for each face whether it has a common point with another face beyond shared edges and corners.
    pub(super) fn overlapping(&self) -> Vec<bool> {
        let found: Vec<_> = (0..self.face_count()).map(|_| AtomicBool::new(false)).collect();
        let around = |face: usize| Aabb::around(&self.corners(face));
        parallel::for_each(self.face_count(), &|face| {
            let own = around(face);
            let are_found = |other: usize| [face, other].iter().all(|one| found[*one].load(Relaxed));
            self.tree.within(
                |bounds| bounds.overlaps(&own),
                |other| {
                    let may_overlap = other > face && around(other).overlaps(&own) && !are_found(other);
                    if may_overlap && self.do_overlap(face, other) {
                        [face, other].iter().for_each(|one| found[*one].store(true, Relaxed));
                    }
                },
            );
        });
        found.into_iter().map(AtomicBool::into_inner).collect()
    }

    /// Tells whether two faces have a common point beyond a shared edge or corner.
    fn do_overlap(&self, face: usize, other: usize) -> bool {
        let (pair, corners) =
            ([self.faces[face], self.faces[other]], [self.corners(face), self.corners(other)]);
        let is_loose = |of: usize, corner: usize| !pair[1 - of].contains(&pair[of][corner]);
        let loose = |of: usize| (0..3).filter(move |corner| is_loose(of, *corner));
        // Many faces may meet at a corner. If two faces with one common corner have another common point, they share
        // the line from the corner through that point, up to where it leaves one of them through the edge opposite the
        // corner.
        let across =
            |of: usize| Aabb::around(&[0, 1].map(|edge| corners[of][loose(of).nth(edge).unwrap_or(0)]));
        let misses = |of: usize| !across(of).overlaps(&Aabb::around(&corners[1 - of]));
        if loose(0).count() == 2 && loose(1).count() == 2 && misses(0) && misses(1) {
            return false;
        }
        let side = |of: usize, corner: usize| side_of_plane(corners[1 - of], corners[of][corner]);
        // In most pairs, one face lies on one side of the other.
        let is_apart = |of: usize| {
            let mut sides = loose(of).map(|corner| side(of, corner));
            sides.next().is_some_and(|first| first != Ordering::Equal && sides.all(|other| other == first))
        };
        if is_apart(0) || is_apart(1) {
            return false;
        }
        match (loose(0).next(), loose(1).next(), loose(0).count()) {
            // Two faces in one plane with a shared edge overlap if they are on the same side of it.
            (Some(one), Some(two), 1) => {
                let (edge, axis) = ([1, 2].map(|next| corners[0][(one + next) % 3]), axis_across(corners[0]));
                turn(edge, corners[0][one], axis) == turn(edge, corners[1][two], axis)
            }
            (Some(_), Some(_), _) => (0..2).any(|of| {
                let edges = [(0, 1), (1, 2), (2, 0)].into_iter();
                let mut loose = edges.filter(|(from, to)| is_loose(of, *from) && is_loose(of, *to));
                loose.any(|(from, to)| meets([corners[of][from], corners[of][to]], corners[1 - of]))
            }),
            _ => true,
        }
    }
}

/// Tells whether a segment and a triangle have a common point.
fn meets([from, to]: [DVec3; 2], triangle: [DVec3; 3]) -> bool {
    let [a, b, c] = triangle;
    let edges = [[a, b], [b, c], [c, a]];
    match (side_of_plane(triangle, from), side_of_plane(triangle, to)) {
        (Ordering::Equal, Ordering::Equal) => {
            let axis = axis_across(triangle);
            is_one_side(edges.map(|edge| turn(edge, from, axis)))
                || edges.into_iter().any(|edge| cross([from, to], edge, axis))
        }
        (one, other) => one != other && is_one_side(edges.map(|[a, b]| side_of_plane([from, to, a], b))),
    }
}

/// Tells whether two segments in a plane have a common point.
fn cross(one: [DVec3; 2], other: [DVec3; 2], axis: usize) -> bool {
    let is_split = |line: [DVec3; 2], [from, to]: [DVec3; 2]| {
        let (from, to) = (turn(line, from, axis), turn(line, to, axis));
        from != to || from == Ordering::Equal
    };
    // The boxes decide for segments on one line.
    is_split(one, other) && is_split(other, one) && Aabb::around(&one).overlaps(&Aabb::around(&other))
}

fn is_one_side(sides: [Ordering; 3]) -> bool {
    !sides.contains(&Ordering::Less) || !sides.contains(&Ordering::Greater)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::read::Model;
    use crate::mesh::{Look, ToWorld};
    use tabray_world::geometry::placement::Rotation;

    type Whole = [i64; 3];

    fn minus(one: Whole, other: Whole) -> Whole {
        [0, 1, 2].map(|axis| one[axis] - other[axis])
    }

    fn across(one: Whole, other: Whole) -> Whole {
        [(1, 2), (2, 0), (0, 1)].map(|(u, v)| one[u] * other[v] - one[v] * other[u])
    }

    /// Tells whether two flat convex polygons have a common point: whether no axis separates them.
    fn have_common_point(polygons: [&[Whole]; 2]) -> bool {
        let edges = |of: &[Whole]| -> Vec<Whole> {
            (0..of.len()).map(|at| minus(of[(at + 1) % of.len()], of[at])).collect()
        };
        let [one, other] = polygons.map(edges);
        let [up, other_up] = [&one, &other].map(|edges| across(edges[0], edges[1]));
        let mut axes = vec![up, other_up];
        axes.extend(one.iter().flat_map(|edge| other.iter().map(|other| across(*edge, *other))));
        axes.extend(one.iter().map(|edge| across(up, *edge)));
        axes.extend(other.iter().map(|edge| across(other_up, *edge)));
        axes.into_iter().all(|axis| {
            let ends = polygons.map(|of| {
                let along = || of.iter().map(|at| (0..3).map(|part| at[part] * axis[part]).sum::<i64>());
                (along().min().expect("corners"), along().max().expect("corners"))
            });
            ends[0].0 <= ends[1].1 && ends[1].0 <= ends[0].1
        })
    }

    fn do_faces_overlap(points: &[Whole], faces: [[u32; 3]; 2]) -> Option<bool> {
        let vertices =
            points.iter().map(|at| DVec3::from(at.map(|part| 94_906_267.0 * part as f64))).collect();
        let model = Model { vertices, faces: faces.to_vec(), ..Model::default() };
        let placement = ToWorld::new(DVec3::ONE, Rotation::NONE, DVec3::ZERO);
        let surface = Surface::new(model, &placement, Look::default())
            .ok()
            .filter(|surface| surface.face_count() == 2)?;
        Some(surface.do_overlap(0, 1))
    }

    #[test]
    fn faces_overlap_where_nothing_separates_them() {
        let mut state = 1_u64;
        let mut below = |count: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % count
        };
        let mut counts = [0; 4];
        for _ in 0..20_000 {
            // The corners are eight times those of a small grid, often in one plane. In world space, they are large
            // enough for products to be rounded.
            let flat = below(4);
            let mut point = || [0, 1, 2].map(|axis| if axis == flat { 8 } else { 8 * below(4) as i64 });
            let points: Vec<_> = (0..6).map(|_| point()).collect();
            let are_distinct = (0..6).all(|one| (0..one).all(|other| points[one] != points[other]));
            let cut = |from: Whole, to: Whole| [0, 1, 2].map(|axis| from[axis] + (to[axis] - from[axis]) / 8);
            let [a, b, c, d, e, f] = points[..] else { panic!("six") };
            if !are_distinct {
                continue;
            }
            if let Some(found) = do_faces_overlap(&points, [[0, 1, 2], [3, 4, 5]]) {
                assert_eq!(found, have_common_point([&[a, b, c], &[d, e, f]]), "{points:?}");
                counts[usize::from(found)] += 1;
            }
            // The shared corner is cut off.
            if let Some(found) = do_faces_overlap(&points, [[0, 1, 2], [0, 3, 4]]) {
                let rest = [cut(a, b), b, c, cut(a, c)];
                assert_eq!(found, have_common_point([&rest, &[a, d, e]]), "{points:?}");
                counts[2 + usize::from(found)] += 1;
            }
        }
        assert!(counts.iter().all(|count| *count > 1000), "{counts:?}");
    }

    #[test]
    fn faces_beside_an_edge_overlap_where_one_is_folded_onto_the_other() {
        let points = [[0, 0, 0], [8, 0, 0], [3, 9, 0], [2, 5, 0], [4, -3, 0], [2, 5, 1]];
        let overlap = |other| do_faces_overlap(&points, [[0, 1, 2], [1, 0, other]]);
        assert_eq!([3, 4, 5].map(overlap), [Some(true), Some(false), Some(false)]);
    }
}
