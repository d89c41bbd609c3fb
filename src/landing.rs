//! Where rays come to a surface.

use crate::cpu::kernels;
use crate::geometry::{Hittable, Side};
use crate::packet::{Rays, View, ViewMut};

/// Places on a surface, each where a ray comes to it.
pub struct Landing<'l> {
    /// Where they are.
    pub points: ViewMut<'l>,
    /// The unit normals there, turned to the rays' side where both are lit.
    pub normals: ViewMut<'l>,
    /// The side that each ray comes to.
    pub sides: &'l mut [Side],
    /// How far the light has come from the viewer: to where the rays start at first, and then to the places.
    pub travelled: &'l mut [f64],
}

kernels! {
    /// Where rays come to a shape after these distances.
    pub(crate) fn land[T: Hittable](
        shape: &T, rays: Rays, distances: &[f64], sides: &mut [Side], travelled: &mut [f64]
    ) => points, normals {
        let (count, is_two_sided) = (travelled.len(), shape.is_two_sided());
        let (rays, distances, sides) = (rays.first(count), &distances[..count], &mut sides[..count]);
        let (mut points, mut normals) = (points.first(count), normals.first(count));
        for lane in 0..count {
            let ray = rays.get(lane);
            let point = ray.at(distances[lane]);
            let normal = shape.normal(point);
            let side = Side::seen_along(ray.dir, normal);
            points.set(lane, point);
            normals.set(lane, if is_two_sided & (side == Side::Inside) { -normal } else { normal });
            sides[lane] = side;
            travelled[lane] += distances[lane];
        }
    }

    /// Where rays come after these distances, and how far their light has then travelled.
    pub(crate) fn arrive(rays: Rays, distances: &[f64], travelled: &mut [f64]) => points {
        let count = travelled.len();
        let (rays, distances, mut points) = (rays.first(count), &distances[..count], points.first(count));
        for lane in 0..count {
            points.set(lane, rays.get(lane).at(distances[lane]));
            travelled[lane] += distances[lane];
        }
    }

    /// The sides that rays come to, and the normals turned there if both sides are lit.
    pub(crate) fn face(dir: View, is_two_sided: bool, sides: &mut [Side]) => normals {
        let count = sides.len();
        let (dir, mut normals) = (dir.first(count), normals.first(count));
        for lane in 0..count {
            let normal = normals.get(lane);
            let side = Side::seen_along(dir.get(lane), normal);
            sides[lane] = side;
            normals.set(lane, if is_two_sided & (side == Side::Inside) { -normal } else { normal });
        }
    }
}
