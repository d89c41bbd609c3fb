//! Triangles that cross each other.

use super::triangles::Triangles;
use glam::DVec3;
use tabray_core::geometry::Aabb;
use tabray_core::parallel;

/// The minimum number of triangles for which threads share the work.
const MANY: usize = 64;

/// Returns boxes around the triangles that cross others, where one of the two is moved.
pub fn crossing(triangles: &Triangles, is_moved: &[bool]) -> Vec<Aabb> {
    let bounds: Vec<_> = (0..is_moved.len()).map(|face| Aabb::around(&triangles.corners(face))).collect();
    let mut all: Vec<usize> = (0..is_moved.len()).collect();
    all.sort_unstable_by(|one, other| bounds[*one].low.x.total_cmp(&bounds[*other].low.x));
    let moved: Vec<_> = all.iter().copied().filter(|face| is_moved[*face]).collect();
    parallel::map_ranges(all.len(), MANY, &|range| {
        let mut found = Vec::new();
        for (one, own) in range.map(|one| (one, bounds[one])) {
            let among = if is_moved[one] { &all } else { &moved };
            let first = among.partition_point(|other| bounds[*other].low.x < own.low.x);
            for &other in among[first..].iter().take_while(|other| bounds[**other].low.x <= own.high.x) {
                if own.overlaps(&bounds[other]) && cross(triangles, one, other) {
                    found.extend([own, bounds[other]]);
                }
            }
        }
        found
    })
}

/// Tells whether an edge of one triangle passes through the inside of the other.
fn cross(triangles: &Triangles, one: usize, other: usize) -> bool {
    let passes = |one: usize, other: usize| {
        let (faces, [a, b, c]) = (&triangles.faces, triangles.corners(other));
        (0..3).any(|at| {
            let edge = [faces[one][at], faces[one][(at + 1) % 3]];
            let [from, to] = edge.map(|corner| triangles.vertices[corner as usize].at);
            let is_apart = edge.iter().all(|corner| !faces[other].contains(corner));
            is_apart
                && side([a, b, c], from) * side([a, b, c], to) < 0.0
                && [[a, b], [b, c], [c, a]]
                    .map(|[a, b]| side([from, to, a], b).signum())
                    .windows(2)
                    .all(|sides| sides[0] * sides[1] > 0.0)
        })
    };
    passes(one, other) || passes(other, one)
}

/// Returns on which side of a plane a point is.
fn side([a, b, c]: [DVec3; 3], at: DVec3) -> f64 {
    (b - a).cross(c - a).dot(at - a)
}
