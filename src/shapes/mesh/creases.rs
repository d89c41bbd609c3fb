//! The normals of a smoothed mesh: the means of the face normals around each corner, up to creases.

use super::edges::Edges;
use super::read::AtCorners;
use crate::triangle::Triangle;
use glam::DVec3;
use tabray_exact::double_double::{exponent_to_one, times_power_of_two};
use tabray_world::accuracy::Exact;

/// The unit normals of a smoothed mesh, one for each corner. A normal is 0 where the normals of the faces cancel.
pub(super) type Normals = AtCorners<[f32; 3]>;

impl Normals {
    /// Computes the normals at the corners of faces with these edges. Each is the sum of the normals of the faces
    /// around the corner that are connected by edges with at most `crease` degrees between their faces, weighted by the
    /// faces' angles at the corner.
    pub(super) fn of(vertices: &[DVec3], faces: &[[u32; 3]], edges: &Edges, crease: f64) -> Self {
        let flat: Vec<DVec3> = faces.iter().map(|face| flat_normal(vertices, *face)).collect();
        let least = libm::cos(crease.to_radians());
        // For each corner, an earlier one with the same normal, or itself.
        let mut above: Vec<u32> = (0..3 * faces.len() as u32).collect();
        for sides in edges.iter() {
            let [one, other] = sides else { continue };
            let pair = [one.face(), other.face()];
            if one.is_back() == other.is_back() || flat[pair[0]].dot(flat[pair[1]]) < least {
                continue;
            }
            for (side, corner) in faces[pair[0]].iter().enumerate() {
                if let Some(beside) = faces[pair[1]].iter().position(|beside| beside == corner) {
                    let [one, other] =
                        [3 * pair[0] + side, 3 * pair[1] + beside].map(|at| first(&mut above, at as u32));
                    above[one.max(other) as usize] = one.min(other);
                }
            }
        }
        let (mut sums, mut corners) = (Vec::new(), Vec::with_capacity(faces.len()));
        for (index, face) in faces.iter().enumerate() {
            let at = face.map(|corner| vertices[corner as usize]);
            corners.push([0, 1, 2].map(|side| {
                let corner = 3 * index + side;
                let first = above[corner] as usize;
                // The entry of an earlier corner already holds the index of its normal.
                let normal = if first == corner { sums.len() as u32 } else { above[first] };
                if first == corner {
                    sums.push(DVec3::ZERO);
                }
                above[corner] = normal;
                sums[normal as usize] += angle(&at, side) * flat[index];
                normal
            }));
        }
        let unit = |sum: DVec3| sum.normalize_or_zero().to_array().map(|part| part as f32);
        Self { values: sums.into_iter().map(unit).collect(), faces: corners.into() }
    }
}

/// Returns the unit normal of a face, or 0 if it has none.
pub(super) fn flat_normal(vertices: &[DVec3], face: [u32; 3]) -> DVec3 {
    let triangle = Triangle::<Exact>::new(face.map(|corner| vertices[corner as usize]));
    triangle.map_or(DVec3::ZERO, |triangle| triangle.plane.normal)
}

/// Returns the angle of a triangle at a corner, in radians.
fn angle(corners: &[DVec3; 3], side: usize) -> f64 {
    // Scaling by powers of two keeps products of tiny or huge edges from underflow and overflow.
    let edge = |to: usize| {
        let edge = corners[(side + to) % 3] - corners[side];
        edge * times_power_of_two(1.0, exponent_to_one(edge.abs().max_element()))
    };
    let (to, from) = (edge(1), edge(2));
    libm::atan2(to.cross(from).length(), to.dot(from))
}

/// Returns the first corner with the same normal as a corner, and shortens the path to it.
fn first(above: &mut [u32], mut corner: u32) -> u32 {
    while above[corner as usize] != corner {
        let up = above[above[corner as usize] as usize];
        above[corner as usize] = up;
        corner = up;
    }
    corner
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    const SIDES: u32 = 24;

    /// Returns a cylinder around z with `SIDES` sides, 15 degrees each, and a corner in the middle of each end.
    fn cylinder() -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let rim = |z: f64| {
            (0..SIDES).map(move |side| {
                let angle = TAU * f64::from(side) / f64::from(SIDES);
                DVec3::new(libm::cos(angle), libm::sin(angle), z)
            })
        };
        let vertices = rim(0.0).chain(rim(1.0)).chain([DVec3::ZERO, DVec3::Z]).collect();
        let faces = (0..SIDES).flat_map(|a| {
            let b = (a + 1) % SIDES;
            let (c, d) = (SIDES + a, SIDES + b);
            [[a, b, d], [a, d, c], [2 * SIDES, b, a], [2 * SIDES + 1, c, d]]
        });
        (vertices, faces.collect())
    }

    fn normals(crease: f64) -> (Vec<DVec3>, Vec<[u32; 3]>, Normals) {
        let (vertices, faces) = cylinder();
        let edges = Edges::of(&faces, vertices.len());
        let normals = Normals::of(&vertices, &faces, &edges, crease);
        (vertices, faces, normals)
    }

    #[test]
    fn edges_beyond_the_crease_stay_sharp() {
        let (vertices, faces, Normals { values: normals, faces: corners }) = normals(30.0);
        // Each corner of a rim has one normal for the sides and one for the end.
        assert_eq!(normals.len(), vertices.len() + 2 * SIDES as usize);
        for (face, normal) in faces.iter().zip(&*corners) {
            let is_end = face.iter().any(|corner| *corner >= 2 * SIDES);
            for (corner, normal) in face.iter().zip(normal) {
                let (at, normal) =
                    (vertices[*corner as usize], DVec3::from(normals[*normal as usize].map(f64::from)));
                let right = if is_end {
                    DVec3::Z * (2.0 * vertices[face[0] as usize].z - 1.0)
                } else {
                    at.with_z(0.0)
                };
                assert!((normal - right).length() < 1e-6, "{normal} at {at}");
            }
        }
    }

    #[test]
    fn a_crease_of_0_leaves_all_edges_sharp_but_those_in_a_plane() {
        let (vertices, _, Normals { values: normals, .. }) = normals(0.0);
        assert!(normals.len() >= vertices.len() + 4 * SIDES as usize, "{}", normals.len());
    }

    #[test]
    fn no_crease_is_as_sharp_as_half_a_turn() {
        let (vertices, _, Normals { values: normals, .. }) = normals(180.0);
        assert_eq!(normals.len(), vertices.len());
    }
}
