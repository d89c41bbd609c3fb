//! Polygons in a plane, and their division into triangles or extrusion to prisms.

use crate::mesh::read::Model;
use crate::mesh::{Look, Mesh, Surface, SurfaceError, ToWorld};
use glam::{DVec2, DVec3};
use std::sync::Arc;
use tabray_exact::double_double::DoubleDouble;
use tabray_world::accuracy::{Accuracy, Exact, Strict};
use tabray_world::any_shape::AnyShape;
use tabray_world::body::Body;
use tabray_world::geometry::placement::Rotation;

/// Scales points by a power of two to a size between 1 and 2, which keeps products of their coordinates from overflow
/// and underflow.
pub fn to_unit_size<const N: usize>(points: &[[f64; N]]) -> Vec<[f64; N]> {
    let size = points.as_flattened().iter().fold(0.0, |most: f64, number| most.max(number.abs()));
    // Keeping only the exponent makes the product exact.
    let power = f64::from_bits(size.to_bits() & f64::INFINITY.to_bits());
    let scale = if power.is_normal() { 1.0 / power } else { 1.0 };
    points.iter().map(|point| point.map(|number| number * scale)).collect()
}

/// Returns a number with a sign that tells whether three points turn left (positive), right (negative), or not at all
/// (0).
fn turn([a, b, c]: [DVec2; 3]) -> f64 {
    let from_a = |to: DVec2, axis: usize| DoubleDouble::difference(to[axis], a[axis]);
    let (left, right) = (from_a(b, 0) * from_a(c, 1), from_a(b, 1) * from_a(c, 0));
    let sign = (left - right).high;
    if sign == 0.0 { 0.0 } else { sign.signum() }
}

fn unit_corners(corners: &[DVec2]) -> Vec<DVec2> {
    let corners: Vec<_> = corners.iter().map(DVec2::to_array).collect();
    to_unit_size(&corners).into_iter().map(DVec2::from).collect()
}

/// Tells whether a polygon's edges meet only at shared corners.
pub fn is_simple(corners: &[DVec2]) -> bool {
    let corners = unit_corners(corners);
    let count = corners.len();
    let at = |index: usize| corners[index % count];
    let turns_back = |index: usize| {
        let (a, b, c) = (at(index), at(index + 1), at(index + 2));
        a == b || (turn([a, b, c]) == 0.0 && (a - b).dot(c - b) > 0.0)
    };
    let cross = |one: usize, other: usize| {
        let ([a, b], [c, d]) = ([at(one), at(one + 1)], [at(other), at(other + 1)]);
        let boxes_meet = a.min(b).cmple(c.max(d)).all() && c.min(d).cmple(a.max(b)).all();
        let splits = |from, to, p, q| turn([from, to, p]) * turn([from, to, q]) <= 0.0;
        boxes_meet && splits(a, b, c, d) && splits(c, d, a, b)
    };
    let is_neighbour = |one: usize, other: usize| other - one == 1 || (one == 0 && other == count - 1);
    count >= 3
        && !(0..count).any(turns_back)
        && !(0..count).any(|one| (one + 1..count).any(|other| !is_neighbour(one, other) && cross(one, other)))
}

/// Tells whether the corners of a simple polygon run counterclockwise.
fn is_counterclockwise(corners: &[DVec2]) -> bool {
    let count = corners.len();
    // The polygon is convex at its leftmost corner.
    let before = |a: DVec2, b: DVec2| (a.x, a.y) < (b.x, b.y);
    let left =
        (1..count).fold(0, |left, index| if before(corners[index], corners[left]) { index } else { left });
    turn([corners[(left + count - 1) % count], corners[left], corners[(left + 1) % count]]) > 0.0
}

/// Cuts a simple polygon into triangles with the same orientation. Returns `None` if the polygon is not simple.
pub fn triangles(corners: &[DVec2]) -> Option<Vec<[u32; 3]>> {
    if !is_simple(corners) {
        return None;
    }
    let corners = &unit_corners(corners)[..];
    let sign = if is_counterclockwise(corners) { 1.0 } else { -1.0 };
    let mut left: Vec<_> = (0..corners.len()).collect();
    let mut all = Vec::new();
    while left.len() >= 3 {
        let count = left.len();
        let ear = |index: usize| [left[(index + count - 1) % count], left[index], left[(index + 1) % count]];
        let side = |three: [usize; 3]| sign * turn(three.map(|corner| corners[corner]));
        let is_ear = |index: &usize| {
            let [a, b, c] = ear(*index);
            let holds = |at: usize| {
                let sides = [side([a, b, at]), side([b, c, at]), side([c, a, at])];
                ![a, b, c].contains(&at) && sides.iter().all(|side| *side >= 0.0)
            };
            side([a, b, c]) > 0.0 && !left.iter().any(|at| holds(*at))
        };
        let next = (0..count).find(is_ear)?;
        all.push(ear(next).map(|corner| corner as u32));
        left.remove(next);
    }
    Some(all)
}

/// Returns the prism above a polygon in x and z, from one height to another, without its two ends if it is open. The
/// sides come first, then the lower end, then the upper end. Returns `None` if the polygon is not simple.
pub fn prism(corners: &[DVec2], [low, high]: [f64; 2], is_open: bool) -> Option<Model> {
    let mut corners = corners.to_vec();
    if is_simple(&corners) && !is_counterclockwise(&unit_corners(&corners)) {
        corners.reverse();
    }
    let ends = triangles(&corners)?;
    let count = corners.len() as u32;
    let at = |y: f64| corners.iter().map(move |corner| DVec3::new(corner.x, y, corner.y));
    // Turning from x to z is clockwise as seen from above.
    let around = (0..count).flat_map(|from| {
        let to = (from + 1) % count;
        [(from, [from, from + count, to + count]), (from, [from, to + count, to])]
    });
    let bottom = ends.iter().map(|corners| (count, *corners));
    let top = ends.iter().map(|[a, b, c]| (count + 1, [c + count, b + count, a + count]));
    let (sides, faces) = around.chain(bottom.chain(top).filter(|_| !is_open)).unzip();
    Some(Model { vertices: at(low).chain(at(high)).collect(), faces, sides, ..Model::default() })
}

/// Returns the triangles of a flat polygon.
pub fn polygon(vertices: Vec<DVec3>, faces: Vec<[u32; 3]>) -> Model {
    Model { sides: vec![0; faces.len()], vertices, faces, ..Model::default() }
}

/// Adds two vectors, and notes whether a component is rounded.
pub fn sum(one: DVec3, other: DVec3, is_rounded: &mut bool) -> DVec3 {
    *is_rounded |= (0..3).any(|axis| DoubleDouble::difference(one[axis], -other[axis]).low != 0.0);
    one + other
}

/// Makes an object of triangles. `are_rounded` tells whether their vertices may have been rounded, and `is_two_sided`
/// whether an open surface is lit on both sides.
///
/// # Errors
/// Returns the reason why the triangles make no object.
pub fn body(
    model: Model,
    are_rounded: bool,
    is_two_sided: bool,
    accuracy: Accuracy,
) -> Result<Body, SurfaceError> {
    let in_place = ToWorld::new(DVec3::ONE, Rotation::NONE, DVec3::ZERO);
    let mut surface = Surface::new(model, &in_place, Look { is_two_sided, ..Look::default() })?;
    surface.are_rounded = are_rounded;
    let surface = Arc::new(surface);
    Ok(match accuracy {
        Accuracy::Strict => Body::plain(AnyShape::of_packets(Mesh::<Strict>::new(surface, accuracy))),
        _ => Body::plain(AnyShape::of_packets(Mesh::<Exact>::new(surface, accuracy))),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(of: &[[f64; 2]]) -> Vec<DVec2> {
        of.iter().copied().map(DVec2::from).collect()
    }

    fn area(corners: &[DVec2], [a, b, c]: [u32; 3]) -> f64 {
        let at = |corner: u32| corners[corner as usize];
        0.5 * (at(b) - at(a)).perp_dot(at(c) - at(a))
    }

    #[test]
    fn a_polygon_is_cut_into_triangles_that_fill_it() {
        let star =
            points(&[[0., 4.], [1., 1.], [4., 0.], [1., -1.], [0., -4.], [-1., -1.], [-4., 0.], [-1., 1.]]);
        let tee = points(&[[0., 0.], [1., 0.], [2., 0.], [2., 1.], [1., 1.], [1., 3.], [0., 3.]]);
        for (corners, whole) in [(star, -16.0), (tee, 4.0)] {
            let all = triangles(&corners).expect("it is simple");
            assert_eq!(all.len(), corners.len() - 2);
            let areas: Vec<_> = all.iter().map(|face| area(&corners, *face)).collect();
            assert!(areas.iter().all(|area| area * whole > 0.0), "{areas:?}");
            assert_eq!(areas.iter().sum::<f64>(), whole);
        }
    }

    #[test]
    fn polygons_of_any_size_are_cut() {
        for size in [1e-300, 1e-160, 1e150, 1e300] {
            let corners = points(&[[0., 0.], [2. * size, 0.], [1.5 * size, size], [2. * size, 2. * size]]);
            assert_eq!(triangles(&corners).map(|all| all.len()), Some(2), "{size}");
            assert!(prism(&corners, [0.0, size], false).is_some(), "{size}");
        }
    }

    #[test]
    fn a_polygon_that_meets_itself_is_not_simple() {
        for corners in [
            points(&[[0., 0.], [1., 1.], [1., 0.], [0., 1.]]),
            points(&[[0., 0.], [2., 0.], [1., 0.]]),
            points(&[[0., 0.], [0., 0.], [1., 0.], [0., 1.]]),
            points(&[[0., 0.], [2., 0.], [2., 1.], [1., 0.], [0., 1.]]),
        ] {
            assert!(!is_simple(&corners), "{corners:?}");
        }
    }
}
