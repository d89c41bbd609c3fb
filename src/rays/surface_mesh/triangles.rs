//! The triangles between corners inside and corners outside.

use super::Done;
use super::body::Body;
use super::cells::{Cells, Index, key, of_eight, point};
use glam::DVec3;
use std::ops::Range;
use tabray_core::parallel;

/// The axes along which the edges of the six tetrahedra run from the low corner of a cell to the high one.
const WAYS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

/// The part of an edge that the surface crosses is halved until it is shorter than this, in steps of single precision.
const FINEST: f64 = 0.25;

/// The least distance of a vertex from an end of its edge, in edges, so every triangle has an area.
const LEAST: f64 = 1.0 / 512.0;

/// The least distance of a vertex from an end of its edge, in steps of single precision.
const STEPS: f64 = 8.0;

/// The minimum number of corners, edges or cells for which threads share the work.
const MANY: usize = 64;

/// A vertex of a mesh.
#[derive(Clone)]
pub struct Vertex {
    pub at: DVec3,
    /// A bound on the distance from it to the surface; infinite where that is not known.
    pub slack: f64,
}

/// The triangles of a body's surface.
#[derive(Clone)]
pub struct Triangles {
    pub vertices: Vec<Vertex>,
    pub faces: Vec<[u32; 3]>,
    /// For each cell, the range of its triangles.
    pub of_cells: Vec<Range<u32>>,
}

/// An edge between two corners of a cell: the lower corner, and the axes along which the other one lies.
type Edge = u64;

fn edge(one: Index, other: Index) -> Edge {
    let (low, high) = if key(one) < key(other) { (one, other) } else { (other, one) };
    let step = [0, 1, 2].map(|axis| u64::from(high[axis] - low[axis]) << axis);
    (key(low) << 3) | step.into_iter().sum::<u64>()
}

fn ends(edge: Edge) -> [Index; 2] {
    let part = |by: u32| (edge >> by) as u32 & 0xf_ffff;
    let low = [part(3), part(23), part(43)];
    [low, of_eight(low, edge as u32 & 7)]
}

impl Triangles {
    /// Makes the triangles in all cells, in the order of the cells.
    pub fn of(cells: &Cells, body: &Body<'_>, done: Done) -> Self {
        let mut corners: Vec<(u64, Index)> = cells
            .list
            .iter()
            .flat_map(|cell| (0..8).map(|part| of_eight(*cell, part)))
            .map(|corner| (key(corner), corner))
            .collect();
        corners.sort_unstable_by_key(|(key, _)| *key);
        corners.dedup_by_key(|(key, _)| *key);
        let sides = parallel::filled(corners.len(), MANY, |index| {
            body.contains_point(cells.corner(corners[index].1))
        });
        let side = |corner: Index| {
            let index = corners.binary_search_by_key(&key(corner), |(key, _)| *key).unwrap_or(0);
            sides[index]
        };
        // Each triangle by the edges that its vertices are on.
        let of_cells = parallel::map_ranges(cells.list.len(), MANY, &|range| {
            range.map(|index| in_cell(cells.list[index], &|corner| side(corner) == Some(true))).collect()
        });
        let mut edges: Vec<Edge> = of_cells.iter().flatten().flatten().copied().collect();
        edges.sort_unstable();
        edges.dedup();
        let vertices = parallel::map_ranges(edges.len(), MANY, &|range| {
            let vertex = |edge: &Edge| {
                let ends = ends(*edge);
                crossing(body, ends.map(|end| (cells.corner(end), side(end))))
            };
            done(range.len());
            edges[range].iter().map(vertex).collect()
        });
        let number = |edge: &Edge| edges.binary_search(edge).unwrap_or(0) as u32;
        let mut ranges = Vec::with_capacity(of_cells.len());
        let mut faces: Vec<[u32; 3]> = Vec::new();
        for triangles in &of_cells {
            let start = faces.len() as u32;
            faces.extend(triangles.iter().map(|triangle| triangle.each_ref().map(number)));
            ranges.push(start..faces.len() as u32);
        }
        Self { vertices, faces, of_cells: ranges }
    }

    /// Returns the corners of a triangle.
    pub fn corners(&self, face: usize) -> [DVec3; 3] {
        self.faces[face].map(|vertex| self.vertices[vertex as usize].at)
    }

    /// Tells whether each edge belongs to two triangles, which agree on their outer side.
    pub fn is_closed(&self) -> bool {
        let sides = |&[a, b, c]: &[u32; 3]| [(a, b), (b, c), (c, a)];
        let mut one: Vec<_> = self.faces.iter().flat_map(sides).collect();
        let mut other: Vec<_> = one.iter().map(|(from, to)| (*to, *from)).collect();
        one.sort_unstable();
        other.sort_unstable();
        one == other && one.windows(2).all(|pair| pair[0] != pair[1])
    }
}

/// Returns the triangles in a cell, each counterclockwise seen from outside.
fn in_cell(cell: Index, is_inside: &dyn Fn(Index) -> bool) -> Vec<[Edge; 3]> {
    let mut triangles = Vec::new();
    for way in WAYS {
        let mut corners = [cell; 4];
        for (step, axis) in way.into_iter().enumerate() {
            corners[step + 1] = corners[step];
            corners[step + 1][axis] += 1;
        }
        let (inner, outer): (Vec<Index>, Vec<Index>) =
            corners.into_iter().partition(|corner| is_inside(*corner));
        let between = |inside: usize, outside: usize| edge(inner[inside], outer[outside]);
        let mut add = |triangle: [Edge; 3]| {
            // Triangles between the middles of edges have the same orientation as between any other points of the
            // edges.
            let [a, b, c] = triangle.map(|edge| ends(edge).map(point).into_iter().sum::<DVec3>());
            let mean =
                |corners: &[Index]| corners.iter().map(|at| point(*at)).sum::<DVec3>() / corners.len() as f64;
            let outward = mean(&outer) - mean(&inner);
            let is_turned = (b - a).cross(c - a).dot(outward) < 0.0;
            let [a, b, c] = triangle;
            triangles.push(if is_turned { [a, c, b] } else { triangle });
        };
        match inner.len() {
            1 => add([between(0, 0), between(0, 1), between(0, 2)]),
            3 => add([between(0, 0), between(1, 0), between(2, 0)]),
            2 => {
                add([between(0, 0), between(0, 1), between(1, 1)]);
                add([between(0, 0), between(1, 1), between(1, 0)]);
            }
            _ => {}
        }
    }
    triangles
}

/// Returns the vertex on an edge, given its ends and their sides.
fn crossing(body: &Body<'_>, [one, other]: [(DVec3, Option<bool>); 2]) -> Vertex {
    let (inner, outer) = if one.1 == Some(true) { (one, other) } else { (other, one) };
    let at = |t: f64| inner.0 + t * (outer.0 - inner.0);
    let length = (outer.0 - inner.0).length();
    let step = inner.0.abs().max(outer.0.abs()).max_element() * f64::from(f32::EPSILON);
    let least = LEAST.max(STEPS * step / length).min(0.5);
    let vertex = |t: f64| at(t.clamp(least, 1.0 - least)).as_vec3().as_dvec3();
    if let Some(thick) = body.thick() {
        let found = vertex(thick.inner_part(inner.0, outer.0));
        return Vertex { at: found, slack: thick.depth(found).abs() };
    }
    let (mut low, mut high) = (0.0, 1.0);
    let mut middle = 0.5;
    while (high - low) * length > FINEST * step {
        middle = 0.5 * (low + high);
        match body.contains_point(at(middle)) {
            Some(true) => low = middle,
            Some(false) => high = middle,
            None => break,
        }
    }
    let found = vertex(middle);
    // The surface lies between a point inside and a point outside.
    let is_certain = inner.1 == Some(true) && outer.1 == Some(false);
    let slack = found.distance(at(low)).max(found.distance(at(high)));
    Vertex { at: found, slack: if is_certain { slack } else { f64::INFINITY } }
}
