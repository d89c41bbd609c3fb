//! Proofs about a mesh: that it is near a body's surface, and the surface near it.

use super::Done;
use super::body::Body;
use super::cells::Cells;
use super::closed::Singular;
use super::triangles::Triangles;
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};
use std::mem::replace;
use tabray_core::parallel;

/// The maximum number of times that a triangle or a cell is cut into four or eight.
const DEEPEST: u32 = 7;

/// The size below which an undecided cube is given up, as a fraction of the error.
const LEAST: f64 = 1.0 / 32.0;

/// The minimum number of cells for which threads share the work.
const MANY: usize = 16;

/// Finds the cells in which the mesh and the surface may be farther from each other than the error. Unless `all` is
/// set, the search ends soon after the first.
pub fn far(
    cells: &Cells,
    triangles: &Triangles,
    body: &Body<'_>,
    (error, all): (f64, bool),
    done: Done,
) -> Vec<usize> {
    let half = cells.side() / 2.0;
    let is_off = |cell: &usize, is: &dyn Fn(usize) -> bool| {
        let mut own = triangles.of_cells[*cell].clone();
        own.any(|face| !is(face as usize))
    };
    let is_bare = |cell: &usize, slopes: Option<&[Slopes]>| {
        if slopes.is_some_and(|slopes| is_crossed_once(cells, slopes, body, *cell)) {
            return false;
        }
        let faces = cells.around(*cell).flat_map(|other| triangles.of_cells[other].clone());
        let near: Vec<_> = faces.map(|face| triangles.corners(face as usize)).collect();
        !is_covered(body, &near, cells.middle(cells.list[*cell]), half, error)
    };
    let places = |is: &(dyn Fn(&usize) -> bool + Sync)| -> Vec<usize> {
        parallel::map_ranges(cells.list.len(), MANY, &|mut range| {
            done(range.len());
            if all { range.filter(is).collect() } else { range.find(is).into_iter().collect() }
        })
    };
    // Cells that are too large are found by their triangles, and most by the middles of these, in far less time.
    let by_middles = |cell: &usize| is_off(cell, &|face| is_near_at_middle(body, triangles, face, error));
    let by_triangles = |cell: &usize| is_off(cell, &|face| is_near(body, triangles, face, error));
    let found = if all { Vec::new() } else { places(&by_middles) };
    let off = if found.is_empty() { places(&by_triangles) } else { found };
    if !all && !off.is_empty() {
        return off;
    }
    let slopes: Option<Vec<_>> =
        parallel::filled(cells.list.len(), MANY, |cell| Slopes::of(cells, triangles, body, cell, error))
            .into_iter()
            .collect();
    places(&|cell| off.binary_search(cell).is_ok() || is_bare(cell, slopes.as_deref()))
}

/// Finds the cells with triangles that have points farther from all of their corners than the error.
pub fn large(cells: &Cells, triangles: &Triangles, error: f64) -> Vec<usize> {
    let is_large = |face: u32| outward(triangles, face as usize, error).is_some();
    (0..cells.list.len()).filter(|cell| triangles.of_cells[*cell].clone().any(is_large)).collect()
}

/// Returns cells and those around them that hold the triangles which their proofs may name.
pub fn beside(cells: &Cells, mut of: Vec<usize>) -> Vec<usize> {
    for _ in 0..=FARTHEST {
        of = of.iter().flat_map(|cell| cells.around(*cell)).collect();
        of.sort_unstable();
        of.dedup();
    }
    of
}

/// Finds the cells in which the surface may turn by a right angle; `None` if gradients do not tell.
pub fn tangled(cells: &Cells, body: &Body<'_>, done: Done) -> Option<Vec<usize>> {
    let half = cells.side() / 2.0;
    let is_graph = |cell: usize| body.is_graph(cells.middle(cells.list[cell]), half);
    is_graph(0)?;
    Some(parallel::map_ranges(cells.list.len(), MANY, &|range| {
        done(range.len());
        range.filter(|cell| is_graph(*cell) == Some(false)).collect()
    }))
}

/// Tells whether smaller cells would be tangled in the same places: whether each of these cells, or one to which
/// others of them lead, has a part that is tangled after it is halved so many times. A node stays tangled, and so do
/// the cells around it, however small they are.
pub fn stays_tangled(cells: &Cells, tangled: &[usize], body: &Body<'_>, halvings: u32) -> bool {
    let half = cells.side() / 2.0;
    let mut stays = parallel::filled(tangled.len(), MANY, |index| {
        has_tangled_part(body, cells.middle(cells.list[tangled[index]]), half, halvings)
    });
    let mut found: Vec<_> = (0..stays.len()).filter(|index| stays[*index]).collect();
    while let Some(index) = found.pop() {
        for next in cells.around(tangled[index]).filter_map(|cell| tangled.binary_search(&cell).ok()) {
            if !replace(&mut stays[next], true) {
                found.push(next);
            }
        }
    }
    stays.into_iter().all(|stays| stays)
}

fn has_tangled_part(body: &Body<'_>, middle: DVec3, half: f64, halvings: u32) -> bool {
    body.contains(middle, half).is_none()
        && body.is_graph(middle, half) == Some(false)
        && (halvings == 0
            || eighths(middle, half).any(|middle| has_tangled_part(body, middle, half / 2.0, halvings - 1)))
}

/// The number of times that a cell is halved in search of a point where the gradient is 0.
const SINGULAR: u32 = 8;

/// The most that cells differ in an index that a curve reaches in the same number of steps.
const SLENDER: u32 = 2;

/// Finds where the surface may be singular: cells beside each other are one place.
pub fn singular(cells: &Cells, body: &Body<'_>) -> Vec<Singular> {
    let found = parallel::map_ranges(cells.list.len(), MANY, &|range| {
        let at = |cell| singular_in(body, cells.middle(cells.list[cell]), cells.side() / 2.0, SINGULAR);
        range.filter_map(|cell| Some((cell, at(cell)?))).collect()
    });
    let mut left: BTreeMap<usize, DVec3> = found.into_iter().collect();
    let mut places = Vec::new();
    while let Some((start, _)) = left.first_key_value() {
        let last = |cell: usize| reached(cells, &left, cell).pop().and_then(|step| step.first().copied());
        let one_end = last(*start).unwrap_or(*start);
        let steps = reached(cells, &left, one_end);
        let all: Vec<_> = steps.concat();
        let points: Vec<_> = all.iter().map(|cell| left[cell]).collect();
        let [low, high] = [DVec3::min as fn(_, _) -> _, DVec3::max]
            .map(|of| points.iter().copied().reduce(of).unwrap_or_default());
        let is_slender = |step: &Vec<usize>| {
            (0..3).all(|axis| {
                let places = step.iter().map(|cell| cells.list[*cell][axis]);
                places.clone().max().zip(places.min()).is_none_or(|(most, least)| most - least <= SLENDER)
            })
        };
        places.push(match all.len() {
            _ if (high - low).max_element() < cells.side() => Singular::Point(points[0]),
            count if steps.iter().all(is_slender) => Singular::Curve([points[0], points[count - 1]], count),
            count => Singular::Part([low, high], count),
        });
        all.iter().for_each(|cell| _ = left.remove(cell));
    }
    places
}

/// Returns the cells that steps from a cell to those around it reach, by the number of steps.
fn reached(cells: &Cells, of: &BTreeMap<usize, DVec3>, from: usize) -> Vec<Vec<usize>> {
    let (mut known, mut steps) = (BTreeSet::from([from]), vec![vec![from]]);
    loop {
        let last = steps.last().into_iter().flatten();
        let next: Vec<_> = last
            .flat_map(|cell| cells.around(*cell))
            .filter(|cell| of.contains_key(cell) && known.insert(*cell))
            .collect();
        if next.is_empty() {
            return steps;
        }
        steps.push(next);
    }
}

fn singular_in(body: &Body<'_>, middle: DVec3, half: f64, halvings: u32) -> Option<DVec3> {
    match body.may_be_singular(middle, half) {
        true if halvings == 0 => Some(middle),
        true => eighths(middle, half).find_map(|middle| singular_in(body, middle, half / 2.0, halvings - 1)),
        false => None,
    }
}

/// Returns the middles of the eight cubes that are half as large as a cube.
pub fn eighths(middle: DVec3, half: f64) -> impl Iterator<Item = DVec3> {
    (0..8u32).map(move |part| {
        let sign = |bit: u32| if part >> bit & 1 == 0 { -0.5 } else { 0.5 };
        middle + half * DVec3::new(sign(0), sign(1), sign(2))
    })
}

/// Tells whether each point of a triangle is certainly within the error of the surface.
fn is_near(body: &Body<'_>, triangles: &Triangles, face: usize, error: f64) -> bool {
    outward(triangles, face, error)
        .is_none_or(|outward| outward.is_finite() && is_between(body, triangles.corners(face), outward, 0))
}

/// Tells whether the middle of a triangle may be within the error of the surface.
fn is_near_at_middle(body: &Body<'_>, triangles: &Triangles, face: usize, error: f64) -> bool {
    outward(triangles, face, error).is_none_or(|outward| {
        let middle = triangles.corners(face).into_iter().sum::<DVec3>() / 3.0;
        let is = |at: DVec3, inside: bool| body.contains_point(at) == Some(inside);
        is(middle + outward, false) && is(middle - outward, true)
    })
}

/// Returns the vector of a triangle's normal, as long as the error; `None` if the triangle is so small that each of its
/// points is certainly within the error of the surface.
fn outward(triangles: &Triangles, face: usize, error: f64) -> Option<DVec3> {
    let [a, b, c] = triangles.corners(face);
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    let slack = triangles.faces[face].map(|vertex| triangles.vertices[vertex as usize].slack);
    let slack = slack.into_iter().fold(0.0, f64::max);
    // A point of a triangle is at most as far from the nearest corner as in a triangle with equal sides.
    let is_small = longest / 3f64.sqrt() + slack <= error;
    let normal = (b - a).cross(c - a);
    (!is_small).then(|| normal / normal.length() * error)
}

/// Tells whether each point of a triangle lies between a point inside and a point outside, this far from it.
fn is_between(body: &Body<'_>, [a, b, c]: [DVec3; 3], outward: DVec3, depth: u32) -> bool {
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    let (middle, half) = ((low + high) / 2.0, (high - low).max_element() / 2.0);
    let is = |by: DVec3, inside: bool| {
        body.contains(middle + by, half) == Some(inside)
            || body.contains_triangle([a, b, c].map(|at| at + by)) == Some(inside)
    };
    if is(outward, false) && is(-outward, true) {
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

/// The directions along axes in which what a cell contains changes from inside to outside: a bit for each.
#[derive(Clone, Copy, Default)]
struct Slopes {
    /// Those along which the equation certainly rises all over the cell: lines cross the surface once at most.
    rising: u8,
    /// Those along which each point of the cell's triangles is certainly within the error of the surface.
    near: u8,
}

/// The least part of a gradient in a direction along which triangles are examined. One of three parts is larger.
const STEEP: f64 = 0.4;

/// The maximum number of cells that a line follows to each side.
const FARTHEST: usize = 4;

/// The maximum distance of a vertex from its cell, in halves of a cell: the least between vertices and ends of edges is
/// twice as much.
const OFF: f64 = 1.0 / 512.0;

/// Returns the vector of length 1 in a direction.
fn along(direction: usize) -> DVec3 {
    DVec3::AXES[direction / 2] * if direction.is_multiple_of(2) { 1.0 } else { -1.0 }
}

impl Slopes {
    /// Finds the directions of a cell; `None` if vertices are not where they belong.
    fn of(cells: &Cells, triangles: &Triangles, body: &Body<'_>, cell: usize, error: f64) -> Option<Self> {
        let (middle, half) = (cells.middle(cells.list[cell]), cells.side() / 2.0);
        let faces = triangles.of_cells[cell].clone().map(|face| triangles.corners(face as usize));
        let is_off = |at: DVec3| (at - middle).abs().max_element() > half * (1.0 + OFF);
        if faces.clone().flatten().any(is_off) {
            return None;
        }
        let mut slopes = Self::default();
        let Some(gradient) = body.gradient_in(middle, half) else { return Some(slopes) };
        let steepness = DVec3::from(gradient.map(|of| of.middle())).normalize_or_zero();
        for direction in 0..6 {
            let (part, along) = (gradient[direction / 2], along(direction));
            let is_rising = if direction % 2 == 0 { part.low > 0.0 } else { part.high < 0.0 };
            let is_near = |corners: [DVec3; 3]| is_between(body, corners, error * along, 0);
            let is_steep = || along.dot(steepness) > STEEP;
            slopes.rising |= u8::from(is_rising) << direction;
            slopes.near |=
                u8::from(faces.len() == 0 || is_steep() && faces.clone().all(is_near)) << direction;
        }
        Some(slopes)
    }
}

/// Tells whether each point of the surface in a cell is certainly within the error of the mesh, because each line along
/// an axis through the cell crosses both once.
///
/// The line leads from a cell inside through cells along which the equation rises to a cell outside. So it also leads
/// through the mesh, which separates the corners of these two, and whose vertices hardly leave their own cells. A point
/// where it meets the mesh, in a triangle of these cells or of those around them, is on the line between a point inside
/// and one outside, each as far away as the error, and the only point of the surface on the line is between these, too.
fn is_crossed_once(cells: &Cells, slopes: &[Slopes], body: &Body<'_>, cell: usize) -> bool {
    let half = cells.side() / 2.0;
    let is_clear = |cell: usize, direction: usize| {
        let is = |of: u8| of >> direction & 1 == 1;
        is(slopes[cell].rising) && cells.around(cell).all(|other| is(slopes[other].near))
    };
    // Follows cells to one side until one that is not crossed, and tells whether that is outside where the
    // equation rises, and else inside.
    let ends = |direction: usize, is_forward: bool| {
        let is_up = direction.is_multiple_of(2) == is_forward;
        let mut at = cells.list[cell];
        for _ in 0..FARTHEST {
            let place = at[direction / 2];
            at[direction / 2] = if is_up { place + 1 } else { place.wrapping_sub(1) };
            match cells.find(at) {
                _ if place == 0 && !is_up => return false,
                None => return body.contains(cells.middle(at), half) == Some(!is_forward),
                Some(next) if !is_clear(next, direction) => return false,
                Some(_) => {}
            }
        }
        false
    };
    (0..6).any(|direction| is_clear(cell, direction) && ends(direction, true) && ends(direction, false))
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
    eighths(middle, half).all(|middle| is_covered(body, &near, middle, half / 2.0, error))
}

/// Returns the square of the distance from a point to a triangle.
pub(super) fn distance_squared(point: DVec3, &[a, b, c]: &[DVec3; 3]) -> f64 {
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
