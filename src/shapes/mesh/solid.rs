//! Closed meshes as solids.

use super::surface::Surface;
use crate::geometry::ray::{MISS, Ray, RayRange};
use crate::world::accuracy::Bounded;
use glam::DVec3;

/// Directions in which it is looked for the face that tells whether a point lies inside; along none of them do the edges
/// of made-up shapes run.
const DIRECTIONS: [DVec3; 4] = [
    DVec3::new(0.615_947, 0.359_214, 0.701_135),
    DVec3::new(-0.271_803, 0.857_241, -0.437_365),
    DVec3::new(0.480_163, -0.692_127, -0.538_843),
    DVec3::new(-0.733_019, -0.226_591, 0.641_357),
];

/// The least cosine between a direction and the normal of a face that tells its sides apart.
const LEAST_COSINE: f64 = 1e-3;

impl Surface {
    /// Tells whether a point lies in a closed mesh; `None` where no face tells.
    pub(super) fn holds<A: Bounded>(&self, at: DVec3) -> Option<bool> {
        for dir in DIRECTIONS {
            let ray = Ray { origin: at, dir: dir.normalize() };
            let distance = self.distance::<A>(&ray, &RayRange::ALL, -1.0);
            if distance == MISS {
                return Some(false);
            }
            let normal = self.triangle::<A>(self.face_along(&ray, distance)).plane.normal;
            let cosine = ray.dir.dot(normal);
            if cosine.abs() > LEAST_COSINE {
                return Some(cosine > 0.0);
            }
        }
        None
    }

    /// Tells whether the faces of a closed mesh run clockwise as seen from the outside, so that its volume is negative.
    pub(super) fn is_inside_out(&self) -> bool {
        let middle = self.bounds.middle();
        let volume = |face: usize| {
            let [a, b, c] = self.corners(face).map(|corner| corner - middle);
            a.dot(b.cross(c))
        };
        (0..self.face_count()).map(volume).sum::<f64>() < 0.0
    }
}
