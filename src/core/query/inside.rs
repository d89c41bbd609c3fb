//! Whether a point lies inside a closed shape, by the number of crossings along a line.

use crate::geometry::sight::Line;
use crate::shapes::solid::Crossings;
use crate::world::any_shape::AnyShape;
use crate::world::certify::{Precise, ProofMethods};
use f256::f256;
use glam::DVec3;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::{constants, per_axis};

/// The directions of the lines, one after the other until one tells: along none of them do the edges of made-up shapes run.
const DIRECTIONS: [DVec3; 3] = [
    DVec3::new(0.615_947, 0.359_214, 0.701_135),
    DVec3::new(-0.733_019, 0.226_591, -0.641_357),
    DVec3::new(0.271_803, -0.857_241, 0.437_365),
];

/// Tells whether a point lies inside a closed shape: whether the two halves of a line through it certainly cross the surface an odd
/// number of times each. `None` where 237 bits do not tell, as on the surface, and for a shape without an equation.
///
/// Faces of a mesh need not agree in how they are turned. Of a surface that is not closed, the answer means nothing.
pub fn is_inside(shape: &AnyShape, at: DVec3) -> Option<bool> {
    let (proven, bounds) = (shape.proven()?, shape.facts().bounds);
    // Lines start beside the point, about as far away as the shape is large.
    let size = bounds.map_or(1.0, |bounds| bounds.half_size().max_element().max(f64::MIN_POSITIVE));
    let size = libm::scalbn(1.0, libm::ilogb(size));
    let lines = || DIRECTIONS.iter().map(|dir| size * *dir);
    let by = lines().find_map(|dir| by_line::<f64>(proven, at, dir));
    by.or_else(|| lines().find_map(|dir| by_line::<f256>(proven, at, dir)))
}

/// Tells whether a point lies inside a closed shape, by a line in this direction. Both halves must agree: one crosses the surface
/// once more or less where the line runs along it, or through an edge that it does not cross.
fn by_line<F: Precise>(shape: &dyn ProofMethods, at: DVec3, dir: DVec3) -> Option<bool> {
    let [one, other] = [dir, -dir].map(|dir| is_odd::<F>(shape, at, dir));
    one.filter(|_| one == other)
}

/// Tells whether the half-line from a point certainly crosses a shape an odd number of times; `None` where the point may lie on
/// the surface.
fn is_odd<F: Precise>(shape: &dyn ProofMethods, at: DVec3, dir: DVec3) -> Option<bool> {
    let (at, dir) = (constants::<Interval<F>>(at), constants(dir));
    // The point is at t = 1.
    let (line, one) = (Line { origin: per_axis(|axis| at[axis] - dir[axis]), dir }, F::of(1.0));
    let (mut crossings, mut is_odd) = (Crossings::new(shape, &line, None), false);
    for index in 0.. {
        match crossings.get(index) {
            Ok(crossing) if crossing.at.high < one => {}
            Ok(crossing) if crossing.at.low > one => is_odd = !is_odd,
            Ok(_) => return None,
            Err(end) => return (end == F::INFINITY).then_some(is_odd),
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::mesh::{Mesh, Surface};
    use crate::world::accuracy::{Accuracy, Exact};
    use std::sync::Arc;

    #[test]
    fn a_point_is_inside_however_faces_are_turned() {
        let corner = |index: usize| DVec3::from([1, 2, 4].map(|bit| f64::from(u8::from(index & bit != 0))));
        let mut faces = vec![
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
        for turned in [None, Some(3), Some(8)] {
            turned.into_iter().for_each(|face: usize| faces[face].reverse());
            let surface = Surface::of_arrays((0..8).map(corner).collect(), faces.clone()).expect("a cube");
            let cube = AnyShape::from(Mesh::<Exact>::shape(Arc::new(surface), Accuracy::Exact));
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
                assert_eq!(is_inside(&cube, DVec3::from(at)), right, "{at:?}");
            }
        }
    }
}
