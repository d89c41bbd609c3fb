//! Crossings of a ray with all faces of a closed mesh, in order, decided exactly for the rounded ray.
//!
//! A ray through an edge or a corner, or in the plane of a face, is decided by symbolic perturbation (Edelsbrunner and
//! Mücke 1990): as if its origin were moved by an infinitesimal distance along x, by a far smaller one along y, and by
//! an even smaller one along z. The moved ray meets no edge, and so enters and leaves a closed mesh alternately. As for
//! [`orientation`](tabray_world::geometry::orientation), products of coordinates must not underflow.

use super::face::Leaving;
use super::hits::NOTHING;
use super::points::is_on_surface;
use super::surface::Surface;
use crate::triangle::{exact_side, passed};
use glam::DVec3;
use std::cmp::Ordering;
use tabray_exact::double_double::DoubleDouble;
use tabray_exact::double_double::exact::Exact;
use tabray_exact::double_double::vectors::{cross, scaled_to_one};
use tabray_exact::double_double::{exponent_to_one, times_power_of_two};
use tabray_exact::scalar::per_axis;
use tabray_world::accuracy::NotClassic;
use tabray_world::coincidence::close;
use tabray_world::geometry::orientation::side_of_plane;
use tabray_world::geometry::ray::{MISS, Ray, RayError, RayRange};

/// A crossing of a ray and a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passage {
    pub face: usize,
    /// Whether the ray comes from the face's outer side.
    pub enters: bool,
    /// The distance of the face's plane along the ray, in world units.
    pub distance: f64,
}

/// A place where a ray crosses the boundary of the inside of a closed mesh.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    /// The first, in the order of the file, of the faces that form the boundary there.
    pub face: usize,
    /// The distance in world units.
    pub distance: f64,
}

impl Surface {
    /// Returns the places where a ray crosses the boundary of a closed mesh's inside, in order. The ray leaves the
    /// faces within `leaves` world units of its origin, or no face if this is negative.
    pub(super) fn turns<A: NotClassic>(&self, ray: &Ray, leaves: f64) -> Vec<Turn> {
        let passages = self.passages::<A>(ray, leaves);
        let mut winding = winding(&passages);
        let mut turns = Vec::new();
        for here in passages.chunk_by(|one, other| self.compared(ray, one, other).is_eq()) {
            let before = winding;
            // This undoes the winding of the faces here.
            winding -= self::winding(here);
            let bounding = here.iter().find(|passage| passage.enters == (winding > before));
            if (before == 0) != (winding == 0)
                && let Some(Passage { face, distance, .. }) = bounding.copied()
            {
                turns.push(Turn { face, distance });
            }
        }
        turns
    }

    /// Returns the faces of a closed mesh that a ray crosses, by distance. Faces at the same distance are in the order
    /// of the file.
    pub(super) fn passages<A: NotClassic>(&self, ray: &Ray, leaves: f64) -> Vec<Passage> {
        let mut passages = Vec::new();
        let leaving = if leaves < 0.0 { NOTHING } else { Leaving { least: leaves, most: leaves } };
        self.each(ray, &RayRange::ALL, leaving, |face, _| {
            let corners = self.corners(face);
            if let Some(enters) = enters(corners, ray)
                && side_of_plane(corners, ray.origin)
                    == if enters { Ordering::Less } else { Ordering::Greater }
            {
                let triangle = self.triangle::<A>(face);
                if leaves < 0.0 || !is_on_surface(&triangle, ray.origin, leaves) {
                    passages.push(Passage { face, enters, distance: triangle.plane.crossing(ray) });
                }
            }
            MISS
        });
        passages.sort_by(|one, other| {
            self.compared(ray, one, other).then(self.order[one.face].cmp(&self.order[other.face]))
        });
        passages
    }

    /// Tells whether `f64` arithmetic decides for each face up to a distance, in world units, whether a ray crosses it.
    /// The result then also holds for the exact camera ray that was rounded to this one.
    pub(super) fn is_off_edges(&self, ray: &Ray, far: f64) -> bool {
        let mut is_off = true;
        self.each(ray, &RayRange { far, ..RayRange::ALL }, NOTHING, |face, _| {
            is_off &= passed(self.corners(face), ray, RayError::NONE).is_some();
            if is_off { far } else { -1.0 }
        });
        is_off
    }

    /// Compares the distances of two faces along a ray.
    fn compared(&self, ray: &Ray, one: &Passage, other: &Passage) -> Ordering {
        if (one.distance - other.distance).abs() > close(ray, one.distance) {
            return one.distance.total_cmp(&other.distance);
        }
        nearer(ray, [one, other].map(|passage| self.corners(passage.face)))
    }
}

/// Returns the winding number at the start of a ray with these crossings.
pub(super) fn winding(passages: &[Passage]) -> i32 {
    passages.iter().map(|passage| if passage.enters { -1 } else { 1 }).sum()
}

/// Tells whether the line of a ray crosses a face from its outer to its inner side, or `None` if it misses the face.
fn enters(corners: [DVec3; 3], ray: &Ray) -> Option<bool> {
    let [a, b, c] = corners;
    match passed(corners, ray, RayError::NONE) {
        Some(false) => None,
        Some(true) => Some((a - ray.origin).cross(b - ray.origin).dot(ray.dir) < 0.0),
        None => {
            let sides = [(a, b), (b, c), (c, a)].map(|(from, to)| side(from, to, ray));
            // The ray is on the same side of all edges. A ray along an edge is parallel to the face.
            (sides[0].is_ne() && sides[0] == sides[1] && sides[1] == sides[2]).then(|| sides[0].is_lt())
        }
    }
}

/// Tells on which side of the line from one point to another a ray passes, perturbed as the module describes. Returns
/// `Equal` for a parallel ray.
fn side(from: DVec3, to: DVec3, ray: &Ray) -> Ordering {
    // The derivative along an axis is the component of the cross product of the direction and the edge.
    let moved = || {
        let edge = scaled_to_one(per_axis(|axis| DoubleDouble::difference(to[axis], from[axis])));
        cross(ray.dir.to_array().map(DoubleDouble::from), edge).map(|part| sign(part.high))
    };
    sign(exact_side(from, to, ray)).then_with(|| {
        let [x, y, z] = moved();
        x.then(y).then(z)
    })
}

fn sign(of: f64) -> Ordering {
    of.partial_cmp(&0.0).unwrap_or(Ordering::Equal)
}

/// Compares the distances, along a ray, of the planes of two faces. Neither is parallel to the ray.
fn nearer(ray: &Ray, faces: [[DVec3; 3]; 2]) -> Ordering {
    let all = faces.as_flattened().iter().chain([&ray.origin]);
    let size = all.map(|at| at.abs().max_element()).fold(0.0, f64::max);
    let scale = times_power_of_two(1.0, exponent_to_one(size));
    let minus =
        |one: DVec3, other: DVec3| per_axis(|axis| Exact::sum([scale * one[axis], -scale * other[axis]]));
    let dir = ray.dir.to_array().map(|part| Exact::sum([part]));
    let fraction = |[a, b, c]: [DVec3; 3]| {
        let (one, other) = (minus(b, a), minus(c, a));
        let normal = [(1, 2), (2, 0), (0, 1)].map(|(u, v)| less(&one[u], &other[v], &one[v], &other[u]));
        [minus(a, ray.origin), dir.clone()]
            .map(|of| Exact::sum(normal.iter().zip(&of).flat_map(|(one, other)| one.times(other))))
    };
    let [[away, toward], [other_away, other_toward]] = faces.map(fraction);
    let difference = sign_of(&less(&away, &other_toward, &other_away, &toward));
    if sign_of(&toward) == sign_of(&other_toward) { difference } else { difference.reverse() }
}

/// Returns the difference of two products, `one times - other by`.
fn less(one: &Exact, times: &Exact, other: &Exact, by: &Exact) -> Exact {
    Exact::sum(one.times(times).chain(other.times(by).map(|term| -term)))
}

fn sign_of(number: &Exact) -> Ordering {
    sign(number.parts().last().copied().unwrap_or(0.0))
}
