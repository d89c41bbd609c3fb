//! Proofs about a mesh: that it is near a body's surface, and the surface near it.

use super::body::Body;
use super::cells::Cells;
use super::triangles::Triangles;
use glam::DVec3;
use tabray_core::parallel;

/// The maximum number of times that a triangle or a cell is cut into four or eight.
const DEEPEST: u32 = 7;

/// The size below which an undecided cube is given up, as a fraction of the error.
const LEAST: f64 = 1.0 / 32.0;

/// The minimum number of cells for which threads share the work.
const MANY: usize = 16;

/// The places where a proof fails.
pub struct Proof {
    pub far: Vec<[DVec3; 2]>,
    pub tangled: Option<Vec<[DVec3; 2]>>,
}

/// Finds the places where the mesh and the surface may be farther from each other than the error, and those where the
/// surface may turn by a right angle within a cell. Unless `all` is set, the search ends soon after the first place.
pub fn of(cells: &Cells, triangles: &Triangles, body: &Body<'_>, error: f64, all: bool) -> Proof {
    let half = cells.side() / 2.0;
    let cube = |cell: usize| {
        let middle = cells.middle(cells.list[cell]);
        [middle - half, middle + half]
    };
    let is_far = |cell: usize| {
        let own = triangles.of_cells[cell].clone();
        let is_near = own.into_iter().all(|face| is_near(body, triangles, face as usize, error));
        !is_near
            || !is_covered(body, &near(cells, triangles, cell), cells.middle(cells.list[cell]), half, error)
    };
    let places = |is: &(dyn Fn(usize) -> bool + Sync)| {
        if !all {
            return parallel::find_first(cells.list.len(), is).map(cube).into_iter().collect();
        }
        parallel::map_ranges(cells.list.len(), MANY, &|range| {
            range.filter(|cell| is(*cell)).map(cube).collect()
        })
    };
    let is_examined = body.is_graph(cells.middle(cells.list[0]), half).is_some();
    let tangled: Option<Vec<_>> = is_examined
        .then(|| places(&|cell| body.is_graph(cells.middle(cells.list[cell]), half) == Some(false)));
    if !all && tangled.as_ref().is_some_and(|places| !places.is_empty()) {
        return Proof { far: Vec::new(), tangled };
    }
    Proof { far: places(&is_far), tangled }
}

/// Returns the triangles of a cell and of those around it.
fn near(cells: &Cells, triangles: &Triangles, cell: usize) -> Vec<[DVec3; 3]> {
    let at = cells.list[cell];
    let mut found = Vec::new();
    for part in 0..27 {
        // A cell below the first one has a number that no cell has.
        let by = [part % 3, part / 3 % 3, part / 9];
        let other = [0, 1, 2].map(|axis| (at[axis] + by[axis]).wrapping_sub(1));
        if other.contains(&u32::MAX) {
            continue;
        }
        if let Some(other) = cells.find(other) {
            found.extend(triangles.of_cells[other].clone().map(|face| triangles.corners(face as usize)));
        }
    }
    found
}

/// Tells whether each point of a triangle is certainly within the error of the surface.
fn is_near(body: &Body<'_>, triangles: &Triangles, face: usize, error: f64) -> bool {
    let corners = triangles.corners(face);
    let [a, b, c] = corners;
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    let slack = triangles.faces[face].map(|vertex| triangles.vertices[vertex as usize].slack);
    let slack = slack.into_iter().fold(0.0, f64::max);
    // A point of a triangle is at most as far from the nearest corner as in a triangle with equal sides.
    if longest / 3f64.sqrt() + slack <= error {
        return true;
    }
    let normal = (b - a).cross(c - a);
    let normal = normal / normal.length();
    normal.is_finite() && is_between(body, corners, normal * error, 0)
}

/// Tells whether each point of a triangle lies between a point inside and a point outside, this far from it.
fn is_between(body: &Body<'_>, [a, b, c]: [DVec3; 3], outward: DVec3, depth: u32) -> bool {
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    let (middle, half) = ((low + high) / 2.0, (high - low).max_element() / 2.0);
    let is = |at: DVec3, inside: bool| body.contains(at, half) == Some(inside);
    if is(middle + outward, false) && is(middle - outward, true) {
        return true;
    }
    if depth == DEEPEST || half < LEAST * outward.length() {
        return false;
    }
    let [ab, bc, ca] = [(a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0];
    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        .into_iter()
        .all(|part| is_between(body, part, outward, depth + 1))
}

/// Tells whether each point of the surface in a cube is certainly within the error of one of these triangles.
fn is_covered(body: &Body<'_>, triangles: &[[DVec3; 3]], middle: DVec3, half: f64, error: f64) -> bool {
    let reach = error - half * 3f64.sqrt();
    if reach >= 0.0 && triangles.iter().any(|triangle| distance_squared(middle, triangle) <= reach * reach) {
        return true;
    }
    if body.contains(middle, half).is_some() {
        return true;
    }
    if half < LEAST * error {
        return false;
    }
    // A triangle farther away than this is near no part of the cube.
    let far = error + half * 3f64.sqrt();
    let near: Vec<_> = triangles
        .iter()
        .filter(|triangle| distance_squared(middle, triangle) <= far * far)
        .copied()
        .collect();
    (0..8u32).all(|part| {
        let sign = |bit: u32| if part >> bit & 1 == 0 { -0.5 } else { 0.5 };
        let middle = middle + half * DVec3::new(sign(0), sign(1), sign(2));
        is_covered(body, &near, middle, half / 2.0, error)
    })
}

/// Returns the square of the distance from a point to a triangle.
fn distance_squared(point: DVec3, &[a, b, c]: &[DVec3; 3]) -> f64 {
    let to_edge = |from: DVec3, to: DVec3| {
        let (along, own) = (to - from, point - from);
        let t = (own.dot(along) / along.length_squared()).clamp(0.0, 1.0);
        (own - t * along).length_squared()
    };
    let normal = (b - a).cross(c - a);
    let is_left = |from: DVec3, to: DVec3| (to - from).cross(point - from).dot(normal) >= 0.0;
    if is_left(a, b) && is_left(b, c) && is_left(c, a) {
        let height = (point - a).dot(normal);
        return height * height / normal.length_squared();
    }
    to_edge(a, b).min(to_edge(b, c)).min(to_edge(c, a))
}
