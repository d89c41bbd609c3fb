//! The faces of a mesh near a point.

use super::face::{Flat, distance_to};
use super::surface::Surface;
use crate::triangle::Triangle;
use glam::DVec3;
use tabray_exact::interval::Interval;
use tabray_world::accuracy::NotClassic;
use tabray_world::coincidence::CLOSE;
use tabray_world::geometry::aabb::Aabb;
use tabray_world::geometry::ray::MISS;

impl Surface {
    /// Returns the face nearest to a point. Of several that are equally near up to rounding, it is the first in the
    /// file.
    pub(super) fn face_at(&self, at: DVec3) -> usize {
        self.first_at(at, |_| 0)
    }

    /// Returns the face nearest to a point. Of several that are equally near up to rounding, it is the one with the
    /// lowest rank, and among these the first in the file.
    pub(super) fn first_at(&self, at: DVec3, rank: impl Fn(usize) -> u8) -> usize {
        self.first_of(self.nearest(at), at, rank)
    }

    /// Like [`first_at`](Self::first_at), given the distance of the nearest admissible face, and that face.
    pub(super) fn first_of(
        &self,
        (distance, face): (f64, usize),
        at: DVec3,
        rank: impl Fn(usize) -> u8,
    ) -> usize {
        let rounding = 8.0 * f64::EPSILON * (at.abs().max_element() + self.max_coordinate());
        let within = distance + rounding;
        let place = |face: usize| (rank(face), self.order[face]);
        let (mut first, mut least) = (face, None);
        self.near(at, within, |face, distance| {
            if distance <= within && face != first {
                let (own, other) = (place(face), *least.get_or_insert_with(|| place(first)));
                if own < other {
                    (first, least) = (face, Some(own));
                }
            }
            within
        });
        first
    }

    /// Tells whether [`face_at`](Self::face_at) returns one of a mesh's `own` faces at each point of these faces in a
    /// box.
    pub(super) fn is_alone(&self, at: [Interval; 3], own: impl Fn(usize) -> bool) -> bool {
        let middle = DVec3::from(at.map(Interval::middle));
        let size = DVec3::from(at.map(Interval::width)).length();
        let within = size + 32.0 * f64::EPSILON * (middle.abs().max_element() + self.max_coordinate());
        let mut is_alone = within < MISS;
        self.near(middle, within, |face, distance| {
            is_alone &= distance > within || own(face);
            if is_alone { within } else { -1.0 }
        });
        is_alone
    }

    /// Returns the distance from a point to the nearest face, in world units, and the face.
    pub(super) fn nearest(&self, at: DVec3) -> (f64, usize) {
        self.nearest_of(at, |_| true)
    }

    /// Returns the distance from a point to the nearest of the wanted faces, in world units, and the face.
    pub(super) fn nearest_of(&self, at: DVec3, is_meant: impl Fn(usize) -> bool) -> (f64, usize) {
        // Most points are on the surface, with only few boxes so close.
        for within in [CLOSE * (at.abs().max_element() + self.max_coordinate()), MISS] {
            let mut best = (within, None);
            self.near(at, within, |face, distance| {
                if distance < best.0 && is_meant(face) {
                    best = (distance, Some(face));
                }
                best.0
            });
            if let (distance, Some(face)) = best {
                return (distance, face);
            }
        }
        // The coordinates are not all finite.
        (MISS, 0)
    }

    /// Calls a function with each face that may be within a distance of a point, and with its distance, in world units.
    /// The function returns the distance beyond which faces no longer matter.
    fn near(&self, at: DVec3, within: f64, mut call: impl FnMut(usize, f64) -> f64) {
        self.tree.around(at, within, &mut |face| call(face, distance_to(self.corners(face), at)));
    }

    /// Tells whether a point is on a face, up to an error in world units and to rounding.
    pub(super) fn is_on_surface<A: NotClassic>(&self, at: DVec3, error: f64) -> bool {
        self.is_on_one_of::<A>(at, error, |_| true)
    }

    /// Tells whether a point is on one of the wanted faces, up to an error in world units and to rounding.
    pub(super) fn is_on_one_of<A: NotClassic>(
        &self,
        at: DVec3,
        error: f64,
        is_meant: impl Fn(usize) -> bool,
    ) -> bool {
        let error_there = error + 8.0 * f64::EPSILON * at.abs().max_element();
        let mut any = false;
        self.tree.around(at, error_there, &mut |face| {
            let triangle = || Triangle::<A>::new(self.corners(face));
            any |= is_meant(face) && triangle().is_some_and(|face| is_on_surface(&face, at, error));
            if any { -1.0 } else { error_there }
        });
        any
    }
}

/// Tells whether a point is on a face, up to an error in world units and to rounding.
pub(super) fn is_on_surface<A: NotClassic>(triangle: &Triangle<A>, at: DVec3, error: f64) -> bool {
    let Aabb { low, high } = Aabb::around(&triangle.corners);
    let beside = error + 4.0 * f64::EPSILON * at.abs().max_element();
    (low - beside).cmple(at).all()
        && at.cmple(high + beside).all()
        && triangle.plane.is_on_surface(at, error)
        // A point of the plane beside the face is not on it, even where the box around the face contains it.
        && distance_to(triangle.corners, at) <= beside + Flat::of(triangle.corners).offset_error(at)
}
