//! Fewer triangles, by merging vertices where that moves the mesh little.
//!
//! A vertex that merges into a neighbour leaves a polygon, which triangles at the neighbour cover. Seen along the mean
//! normal of the old triangles, both the old and the new ones cover the polygon once, so each point of the ones is above
//! or below a point of the others. Between corners of the overlay these distances are linear: the largest is at the
//! vertex, or where an old edge crosses a new one. Each triangle has a bound of the sum of such distances. No point of
//! the old mesh is farther from the new one than the largest bound, nor of the new from the old.

use super::Done;
use super::crossing::crossing;
use super::triangles::Triangles;
use glam::{DVec2, DVec3};
use tabray_core::geometry::Aabb;

/// The number of rounds. Each one's limit is twice that of the one before: the least moves come first.
pub const ROUNDS: i32 = 5;

/// The maximum number of times that merging begins.
const ATTEMPTS: usize = 8;

/// The most triangles around two vertices that merge.
const MOST: usize = 24;

/// The least area of a triangle seen along the normal, as a part of its area.
const FACING: f64 = 0.2;

/// The least double area of a triangle where the old ones are larger, in squares of the diameter of the polygon.
const THIN: f64 = 0.02;

/// What is less than this part of the diameter, or of its square, is not told from 0; rounding is far less.
const ROUNDING: f64 = 1e-6;

struct Mesh<'t> {
    triangles: &'t mut Triangles,
    /// The triangles around each vertex.
    around: Vec<Vec<u32>>,
    /// For each triangle, a bound of the distance that merging has moved it.
    moved: Vec<f64>,
}

/// What is around a vertex, seen along the mean normal: the vertex is at 0.
struct Star {
    /// The edges opposite of the vertex.
    edges: Vec<[u32; 2]>,
    /// For each edge's start: its place, and its height along the normal.
    places: Vec<(DVec2, f64)>,
    /// The largest distance from the vertex, twice.
    diameter: f64,
    /// The least double area of a new triangle.
    least: f64,
    moved: f64,
}

/// Merges vertices as long as no point of the mesh moves farther than a limit. Vertices that are fixed stay. Where
/// merged triangles cross, merging begins again with the vertices there fixed; where that does not help, none are merged.
pub fn merged(triangles: &Triangles, mut fixed: Vec<bool>, limit: f64, done: Done) -> Triangles {
    for _ in 0..ATTEMPTS {
        let mut merged = triangles.clone();
        let is_moved = merge(&mut merged, &fixed, limit, done);
        let crossing = crossing(&merged, &is_moved);
        if crossing.is_empty() {
            return merged;
        }
        for (is_fixed, vertex) in fixed.iter_mut().zip(&triangles.vertices) {
            let near = Aabb { low: vertex.at - limit, high: vertex.at + limit };
            *is_fixed |= crossing.iter().any(|bounds| bounds.overlaps(&near));
        }
    }
    triangles.clone()
}

/// Merges vertices, and tells which of the triangles that are left have moved.
pub(super) fn merge(triangles: &mut Triangles, fixed: &[bool], limit: f64, done: Done) -> Vec<bool> {
    let mut around = vec![Vec::new(); triangles.vertices.len()];
    for (face, corners) in triangles.faces.iter().enumerate() {
        corners.iter().for_each(|corner| around[*corner as usize].push(face as u32));
    }
    let moved = vec![0.0; triangles.faces.len()];
    let mut mesh = Mesh { triangles, around, moved };
    for round in 1..=ROUNDS {
        done(fixed.len());
        let limit = libm::scalbn(limit, round - ROUNDS);
        for vertex in (0..fixed.len()).filter(|vertex| !fixed[*vertex]) {
            if let Some((into, moved)) = mesh.best(vertex as u32, limit) {
                mesh.join(vertex as u32, into, moved);
            }
        }
    }
    mesh.sweep()
}

impl Mesh<'_> {
    fn at(&self, vertex: u32) -> DVec3 {
        self.triangles.vertices[vertex as usize].at
    }

    /// Returns the two corners after this one in a triangle.
    fn opposite(&self, face: u32, vertex: u32) -> [u32; 2] {
        let [a, b, c] = self.triangles.faces[face as usize];
        if a == vertex {
            [b, c]
        } else if b == vertex {
            [c, a]
        } else {
            [a, b]
        }
    }

    /// Returns what is around a vertex; `None` where it is not seen once along the normal.
    fn star(&self, vertex: u32, limit: f64) -> Option<Star> {
        let faces = &self.around[vertex as usize];
        let moved = faces.iter().map(|face| self.moved[*face as usize]).fold(0.0, f64::max);
        if faces.is_empty() || faces.len() > MOST / 2 || moved > limit {
            return None;
        }
        let edges: Vec<_> = faces.iter().map(|face| self.opposite(*face, vertex)).collect();
        let at = self.at(vertex);
        let normals = edges.iter().map(|edge| {
            let [a, b] = edge.map(|corner| self.at(corner) - at);
            a.cross(b)
        });
        let normal = normals.clone().sum::<DVec3>().try_normalize()?;
        if normals.clone().any(|of| of.dot(normal) < FACING * of.length()) {
            return None;
        }
        let one = normal.any_orthonormal_vector();
        let other = normal.cross(one);
        let place = |[corner, _]: &[u32; 2]| {
            let by = self.at(*corner) - at;
            (DVec2::new(by.dot(one), by.dot(other)), by.dot(normal))
        };
        let places: Vec<_> = edges.iter().map(place).collect();
        // All turn to the left as seen from the vertex: they turn once if one of them crosses the axis ahead of it.
        let crosses = |[a, b]: &[u32; 2]| {
            let is_below = |of: &u32| {
                edges.iter().position(|[corner, _]| corner == of).is_some_and(|at| places[at].0.y < 0.0)
            };
            is_below(a) && !is_below(b)
        };
        if edges.iter().filter(|edge| crosses(edge)).count() != 1 {
            return None;
        }
        let diameter = 2.0 * places.iter().map(|(place, _)| place.length()).fold(0.0, f64::max);
        let least = normals.map(|of| of.dot(normal)).fold(THIN * diameter * diameter, f64::min);
        Some(Star { edges, places, diameter, least, moved })
    }

    /// Returns the neighbour that a vertex is best merged into, and the bound for the new triangles.
    fn best(&self, vertex: u32, limit: f64) -> Option<(u32, f64)> {
        let star = self.star(vertex, limit)?;
        let mut best = None;
        for (index, &[into, _]) in star.edges.iter().enumerate() {
            let least = best.map_or(limit, |(_, moved)| moved);
            if let Some(step) = self.step(&star, index, least - star.moved)
                && star.moved + step < least
                && self.may_join(vertex, &star, into)
            {
                best = Some((into, star.moved + step));
            }
        }
        best
    }

    /// Tells whether the mesh stays closed, and a two-manifold: two vertices have no neighbours in common but those of
    /// the triangles between them.
    fn may_join(&self, vertex: u32, star: &Star, into: u32) -> bool {
        let faces = &self.around[into as usize];
        let mut common: Vec<_> = faces
            .iter()
            .flat_map(|face| self.opposite(*face, into))
            .filter(|other| star.edges.iter().any(|[corner, _]| corner == other))
            .collect();
        common.sort_unstable();
        common.dedup();
        // A tetrahedron has no room for a triangle less.
        let has_face = |&face: &u32| {
            let edge = self.opposite(face, into);
            !edge.contains(&vertex) && edge.iter().all(|corner| common.contains(corner))
        };
        common.len() == 2 && faces.len() + star.edges.len() <= MOST && !faces.iter().any(has_face)
    }

    /// Returns a bound of the distances between old and new triangles if the vertex is merged into the start of an
    /// edge; `None` if it is more than the limit or unknown, or if new triangles are thin.
    fn step(&self, star: &Star, into: usize, limit: f64) -> Option<f64> {
        let Star { edges, places, diameter, .. } = star;
        let (from, height) = places[into];
        let least = ROUNDING * diameter * diameter;
        let thin = star.least.max(least);
        let point = |(place, height): (DVec2, f64)| place.extend(height);
        // Whatever it is merged into, the vertex is below or above one of the new triangles.
        let (mut step, mut is_seen) = (0.0, false);
        for &[a, b] in edges.iter().filter(|edge| !edge.contains(&edges[into][0])) {
            let place = |of: u32| edges.iter().position(|[corner, _]| *corner == of).map(|at| places[at]);
            let ((a, a_height), (b, b_height)) = (place(a)?, place(b)?);
            let area = (a - from).perp_dot(b - from);
            let corners = [(from, height), (a, a_height), (b, b_height)].map(point);
            let all = (corners[1] - corners[0]).cross(corners[2] - corners[0]).length();
            if area < (FACING * all).max(thin) {
                return None;
            }
            let parts = [a.perp_dot(b), b.perp_dot(from), from.perp_dot(a)];
            if parts.iter().all(|part| *part >= -least) {
                let above = (parts[0] * height + parts[1] * a_height + parts[2] * b_height) / area;
                step = above.abs().max(step);
                is_seen = true;
            }
        }
        if !is_seen || step > limit {
            return None;
        }
        // An old edge leads from the vertex, which is at 0, and a new one from its neighbour.
        for (old, &(end, end_height)) in places.iter().enumerate().filter(|(old, _)| *old != into) {
            for (new, &(to, to_height)) in places.iter().enumerate() {
                let is_shared = edges[new][1] == edges[into][0] || edges[into][1] == edges[new][0];
                if new == into || new == old || is_shared {
                    continue;
                }
                let beside = [end.perp_dot(from), end.perp_dot(to)];
                let past = [(to - from).perp_dot(-from), (to - from).perp_dot(end - from)];
                if [beside, past].iter().any(|[one, other]| one * other > 0.0) {
                    continue;
                }
                let whole = [beside, past].map(|[one, other]| one.abs() + other.abs());
                if whole.iter().any(|whole| *whole < least) {
                    return None;
                }
                let crossing = point((from, height)).lerp(point((to, to_height)), beside[0].abs() / whole[0]);
                step = step.max(crossing.distance(past[0].abs() / whole[1] * point((end, end_height))));
            }
        }
        Some(step + ROUNDING * diameter)
    }

    /// Merges a vertex into a neighbour.
    fn join(&mut self, vertex: u32, into: u32, moved: f64) {
        for face in std::mem::take(&mut self.around[vertex as usize]) {
            let corners = &mut self.triangles.faces[face as usize];
            if corners.contains(&into) {
                for corner in *corners {
                    self.around[corner as usize].retain(|of| *of != face);
                }
                *corners = [vertex; 3];
            } else {
                *corners = corners.map(|corner| if corner == vertex { into } else { corner });
                self.around[into as usize].push(face);
                self.moved[face as usize] = moved;
            }
        }
    }

    /// Removes the vertices and triangles that are no more, and tells which of the others have moved.
    fn sweep(self) -> Vec<bool> {
        let Self { triangles: Triangles { vertices, faces, of_cells }, around, moved } = self;
        of_cells.clear();
        let mut moved = moved.into_iter();
        let mut is_moved = Vec::with_capacity(faces.len());
        faces.retain(|[a, b, _]| {
            let moved = moved.next();
            if a != b {
                is_moved.push(moved > Some(0.0));
            }
            a != b
        });
        let mut numbers = Vec::with_capacity(vertices.len());
        let mut next = 0;
        for faces in &around {
            numbers.push(next);
            next += u32::from(!faces.is_empty());
        }
        faces.iter_mut().for_each(|face| *face = face.map(|corner| numbers[corner as usize]));
        let mut is_kept = around.iter().map(|faces| !faces.is_empty());
        vertices.retain(|_| is_kept.next() == Some(true));
        is_moved
    }
}
