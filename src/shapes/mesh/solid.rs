//! Closed meshes as solids.

use super::surface::Surface;
use super::winding::DIRECTIONS;
use glam::DVec3;
use tabray_world::accuracy::NotClassic;
use tabray_world::coincidence::ROUNDING;
use tabray_world::geometry::facet::Facet;
use tabray_world::geometry::ray::{MISS, Ray, RayRange};

/// The minimum cosine between a direction and the normal of a face at which the side of the face is trusted.
const MIN_COSINE: f64 = 1e-3;

/// The maximum number of faces of a convex mesh whose inside is tested by planes.
const MAX_PLANES: usize = 64;

/// Returns a bound of the rounding error of the distance between a point and a plane through another point.
fn rounding(point: DVec3, at: DVec3) -> f64 {
    ROUNDING * (point.abs() + at.abs()).element_sum()
}

/// Tells whether a point lies above a plane, or `None` if the plane may pass through the box that extends `error` from
/// the point along each axis.
fn is_above([normal, point]: [DVec3; 2], at: DVec3, error: f64) -> Option<bool> {
    // The box extends at most √3 times as far along a normal.
    let (above, error) = (normal.dot(at - point), 1.75 * error + rounding(point, at));
    if above > error {
        Some(true)
    } else if above >= -error {
        None
    } else {
        Some(false)
    }
}

/// Tells whether a point lies below all planes, or `None` if it may lie on one of them.
fn inside(planes: &[[DVec3; 2]], at: DVec3, error: f64) -> Option<bool> {
    let mut inside = Some(true);
    for plane in planes {
        match is_above(*plane, at, error) {
            Some(true) => return Some(false),
            Some(false) => {}
            None => inside = None,
        }
    }
    inside
}

impl Surface {
    /// Tells whether a point lies in a closed mesh, or `None` if the surface may be within `error`, in world units, or
    /// if no direction decides.
    pub(super) fn contains<A: NotClassic>(&self, at: DVec3, error: f64) -> Option<bool> {
        if let Some(planes) = self.planes.get_or_init(|| self.convex::<A>()) {
            return inside(planes, at, error);
        }
        // As in `is_above`, the box extends at most √3 times as far.
        if self.is_on_surface::<A>(at, 1.75 * error) {
            return None;
        }
        for dir in DIRECTIONS {
            let ray = Ray { origin: at, dir: dir.normalize() };
            let distance = self.distance::<A>(&ray, &RayRange::ALL, -1.0);
            if distance == MISS {
                return Some(false);
            }
            let normal = self.triangle::<A>(self.face_along(&ray, distance)).plane.normal;
            let cosine = ray.dir.dot(normal);
            if cosine.abs() > MIN_COSINE {
                return Some(cosine > 0.0);
            }
        }
        None
    }

    /// Returns the facet in whose plane the whole surface within `error`, in world units, of a point lies. Returns
    /// `None` if there are several such planes or none, if the plane is not across an axis, or if the mesh is not known
    /// to be convex.
    pub(super) fn facet<A: NotClassic>(&self, at: DVec3, error: f64) -> Option<Facet> {
        let planes = self.planes.get_or_init(|| self.convex::<A>()).as_ref()?;
        let mut facet = None;
        for (face, plane) in planes.iter().enumerate() {
            match is_above(*plane, at, error) {
                Some(true) => return None,
                Some(false) => {}
                None => {
                    let own = Facet::of_triangle(self.corners(face), plane[0])?;
                    if *facet.get_or_insert(own) != own {
                        return None;
                    }
                }
            }
        }
        facet
    }

    /// Returns the planes of the faces of a certainly convex closed mesh, each as a normal and a point. Returns `None`
    /// for other meshes, and for meshes with many faces.
    fn convex<A: NotClassic>(&self) -> Option<Box<[[DVec3; 2]]>> {
        if self.face_count() > MAX_PLANES {
            return None;
        }
        let plane = |face: usize| [self.triangle::<A>(face).plane.normal, self.corners(face)[0]];
        let planes: Box<[_]> = (0..self.face_count()).map(plane).collect();
        let is_below = |at: &DVec3| {
            planes.iter().all(|[normal, point]| normal.dot(*at - *point) <= rounding(*point, *at))
        };
        self.vertices.iter().all(is_below).then_some(planes)
    }
}
