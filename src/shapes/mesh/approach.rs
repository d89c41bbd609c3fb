//! Rays from so far away that `f64` arithmetic cannot tell the faces of a mesh apart.

use glam::DVec3;
use tabray_exact::double_double::exact::Exact;
use tabray_exact::double_double::two_product;
use tabray_exact::scalar::per_axis;
use tabray_world::geometry::aabb::Aabb;
use tabray_world::geometry::ray::{Ray, RayError};

/// The maximum distance, as a multiple of a mesh's size, at which `f64` arithmetic finds the faces quickly.
pub(super) const FAR: f64 = (1_u64 << 30) as f64;

/// More steps than lead from the largest numbers to the smallest, as each leaves less than 2^-50 of the way. The length of
/// the way is infinite above 1e154, and never halves.
const MAX_STEPS: usize = 64;

/// A ray that starts closer to a mesh than the original ray. From a distance that is large for their size, `f64`
/// arithmetic cannot tell faces apart.
pub(super) struct Approach {
    pub ray: Ray,
    /// A bound on the error of its origin.
    pub drift: RayError,
    /// The distance of the new origin from the old one, in world units. `slack` bounds its error.
    pub travelled: f64,
    pub slack: f64,
}

impl Approach {
    /// Leaves a ray as it is.
    pub(super) fn none(ray: &Ray) -> Self {
        Self { ray: *ray, drift: RayError::NONE, travelled: 0.0, slack: 0.0 }
    }

    /// Moves the start of a ray to just before a box that is far away for its size.
    pub(super) fn new(ray: &Ray, bounds: &Aabb) -> Self {
        let middle = 0.5 * bounds.low + 0.5 * bounds.high;
        let size = (bounds.high - bounds.low).length();
        let mut left = (middle - ray.origin).length();
        if left <= FAR * size {
            return Self::none(ray);
        }
        let (mut steps, mut at) = (Vec::new(), ray.origin);
        let mut exactly = ray.origin.to_array().map(|part| Exact::sum([part]));
        // Each step leaves only the rounding error of the step before it. A ray that misses the box by far comes no
        // closer.
        loop {
            let step = ray.dir.dot(middle - at) - 2.0 * size;
            steps.push(step);
            at = DVec3::from(per_axis(|axis| {
                exactly[axis].extend(<[f64; 2]>::from(two_product(step, ray.dir[axis])));
                exactly[axis].rounded().high
            }));
            // Products of numbers above 1e300 overflow.
            if !at.is_finite() {
                return Self::none(ray);
            }
            let before = left;
            left = (middle - at).length();
            if before <= FAR * size || left > 0.5 * before || steps.len() == MAX_STEPS {
                break;
            }
        }
        let slack = 4.0 * f64::EPSILON * steps.iter().map(|step| step.abs()).sum::<f64>();
        let drift =
            RayError { origin: 2.0 * f64::EPSILON * at.abs().max_element() + f64::MIN_POSITIVE, dir: 0.0 };
        Self { ray: Ray { origin: at, dir: ray.dir }, drift, travelled: steps.iter().sum(), slack }
    }
}

#[cfg(test)]
mod tests {
    use crate::mesh::ToWorld;
    use crate::mesh::hits::NOTHING;
    use crate::mesh::tests::{PLAIN, closed, surface};
    use glam::DVec3;
    use tabray_world::accuracy::Exact;
    use tabray_world::geometry::placement::Rotation;
    use tabray_world::geometry::ray::{MISS, Ray, RayRange};

    /// Beyond 1e13 times the size of a mesh, rounding hides which of its faces a ray may hit. All faces would be
    /// candidates, and each would be compared with all others.
    #[test]
    fn few_faces_are_candidates_from_far_away() {
        let surface = surface(closed(&[1.0], 20), &ToWorld::new(PLAIN, Rotation::NONE, DVec3::ZERO));
        for (far, side) in
            [1e3, 1e10, 1e13, 1e16, 1e30, 1e77, 1e150].into_iter().flat_map(|far| [(far, 1.0), (far, -1.0)])
        {
            for (x, y) in (0..40).map(|at| f64::from(at) / 41.0 - 0.47).map(|x| (x, 0.3 - x * x)) {
                let ray_from =
                    |far: f64| Ray { origin: DVec3::new(x, y, side * far), dir: DVec3::new(0.0, 0.0, -side) };
                let (ray, near) = (ray_from(far), ray_from(2.0));
                let mut candidates = Vec::new();
                surface.each(&ray, &RayRange::ALL, NOTHING, |face, _| {
                    candidates.push(face);
                    MISS
                });
                assert!(
                    candidates.len() <= 8,
                    "{} candidates of {} from {far}",
                    candidates.len(),
                    surface.face_count()
                );
                let [distance, from_near] =
                    [ray, near].map(|ray| surface.distance::<Exact>(&ray, &RayRange::ALL, -1.0));
                assert!((distance - (far - 2.0 + from_near)).abs() <= 2.0 * f64::EPSILON * far, "from {far}");
                let first = surface.face_along(&near, from_near);
                assert!(candidates.contains(&first), "from {far}");
                // Beyond this distance, the hit point may be nearer to another face, because its error exceeds the size
                // of a face.
                if far <= 1e13 {
                    assert_eq!(surface.face_along(&ray, distance), first, "from {far}");
                }
            }
        }
    }

    /// A ray that passes a mesh at a distance far larger than the mesh, and comes from much farther away, hits nothing.
    #[test]
    fn rays_that_pass_by_from_far_away_have_no_candidates() {
        let surface = surface(closed(&[1.0], 20), &ToWorld::new(PLAIN, Rotation::NONE, DVec3::ZERO));
        for (far, beside) in [(1e150, 1e134), (1e150, 10.0), (1e20, 1.5), (1e40, 1e25)] {
            let ray = Ray { origin: DVec3::new(beside, 0.0, far), dir: DVec3::NEG_Z };
            surface.each(&ray, &RayRange::ALL, NOTHING, |face, _| panic!("face {face} from {far} {beside}"));
        }
    }
}
