//! Where rays come to a surface.

use crate::geometry::packet::Rays;
use crate::geometry::ray::Side;
use crate::simd::cpu::kernels;
use crate::simd::soa::ViewMut;
use crate::world::hittable::Hittable;
use glam::DVec3;

/// Places on a surface, each where a ray of a packet comes to it. All arrays are as long as the packet's.
pub struct Landing<'l> {
    /// Where they are, in world coordinates.
    pub points: ViewMut<'l>,
    /// The unit normals there, turned to the rays' side where both are lit.
    pub normals: ViewMut<'l>,
    /// The side that each ray comes to.
    pub sides: &'l mut [Side],
    /// How far the way from the viewer is, in world units: to where the rays start at first, and then to the places.
    pub travelled: &'l mut [f64],
}

kernels! {
    /// Where rays come to a shape after these distances, and its normals there.
    pub(crate) fn land[T: Hittable](
        shape: &T, rays: Rays, distances: &[f64], sides: &mut [Side], travelled: &mut [f64]
    ) => points, normals {
        let (count, is_two_sided) = (travelled.len(), shape.is_two_sided());
        let (rays, distances, sides) = (rays.first(count), &distances[..count], &mut sides[..count]);
        let (mut points, mut normals) = (points.first(count), normals.first(count));
        for lane in 0..count {
            let ray = rays.get(lane);
            let point = ray.at(distances[lane]);
            let normal;
            (sides[lane], normal) = turned(ray.dir, shape.normal(point), is_two_sided);
            points.set(lane, point);
            normals.set(lane, normal);
            travelled[lane] += distances[lane];
        }
    }
}

/// The side that a ray along `dir` comes to of a surface with this normal, and the normal, turned there if both are lit.
#[inline(always)]
pub(crate) fn turned(dir: DVec3, normal: DVec3, is_two_sided: bool) -> (Side, DVec3) {
    let side = Side::seen_along(dir, normal);
    (side, if is_two_sided & (side == Side::Inside) { -normal } else { normal })
}
