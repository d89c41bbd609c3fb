//! The cost of the bare arithmetic of a test: textbook formulas in loops over arrays, without range checks, error
//! bounds, shading or any care for rounding. No tracer that makes the same tests, packet by packet, is faster.

use glam::DVec3;
use std::hint::black_box;
use tabray_core::geometry::ray_packet::{PACKET_SIZE, RayPacket};
use tabray_core::simd::cpu::{Cpu, kernels};
use tabray_core::simd::soa::Vectors;

/// The number of shapes in a round. With several, the compiler cannot hoist their constants out of the loop.
const SHAPES: usize = 8;

/// A textbook intersection test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextbookTest {
    /// A ray and a plane.
    Plane,
    /// A ray and a sphere.
    Sphere,
    /// A ray and a triangle (Möller and Trumbore 1997).
    Triangle,
}

impl TextbookTest {
    /// Returns the test that an entity of this type needs, if there is one for it.
    pub fn of(entity: &str) -> Option<Self> {
        match entity {
            "plane" | "tiled_plane" | "pplane" | "texplane" => Some(Self::Plane),
            "sphere" | "psphere" => Some(Self::Sphere),
            "triangle" => Some(Self::Triangle),
            _ => None,
        }
    }

    /// Performs at least this many tests.
    pub fn run(self, cpu: Cpu, tests: u64) {
        let (mut origin, mut dir) = (Vectors::<PACKET_SIZE>::ZERO, Vectors::<PACKET_SIZE>::ZERO);
        for lane in 0..PACKET_SIZE {
            let (x, y) = ((lane % 8) as f64, (lane / 8) as f64);
            origin.set(lane, DVec3::new(4.0, 3.0, 7.0));
            dir.set(lane, DVec3::new(0.1 * x - 0.3, 0.1 * y - 0.3, -1.0).normalize());
        }
        let rays = RayPacket::new(origin.view(PACKET_SIZE), dir.view(PACKET_SIZE), 0.0);
        let shapes: [[DVec3; 3]; SHAPES] = std::array::from_fn(|index| {
            let corner = DVec3::new(4.0, 3.0, -4.0 - 0.1 * index as f64);
            [corner, DVec3::X + 0.1 * DVec3::Z, DVec3::Y]
        });
        for _ in 0..tests.div_ceil((PACKET_SIZE * SHAPES) as u64) {
            let (mut near, mut hit_ids) = ([f64::INFINITY; PACKET_SIZE], [0; PACKET_SIZE]);
            let shapes = black_box(&shapes);
            match self {
                Self::Plane => planes(cpu, rays, shapes, &mut near, &mut hit_ids),
                Self::Sphere => spheres(cpu, rays, shapes, &mut near, &mut hit_ids),
                Self::Triangle => triangles(cpu, rays, shapes, &mut near, &mut hit_ids),
            }
            black_box((&near, &hit_ids));
        }
    }
}

kernels! {
    /// Tests planes, each a point and a normal.
    fn planes(rays: RayPacket, shapes: &[[DVec3; 3]], near: &mut [f64], hit_ids: &mut [u64]) {
        each(rays, shapes, near, hit_ids, |[point, normal, _], origin, dir| {
            (*point - origin).dot(*normal) / dir.dot(*normal)
        });
    }

    /// Tests spheres of radius 2, given by their centres.
    fn spheres(rays: RayPacket, shapes: &[[DVec3; 3]], near: &mut [f64], hit_ids: &mut [u64]) {
        each(rays, shapes, near, hit_ids, |[center, ..], origin, dir| {
            let from = origin - *center;
            let (b, c) = (from.dot(dir), from.dot(from) - 4.0);
            // NaN, which fails all comparisons, where the ray misses.
            -b - (b * b - c).sqrt()
        });
    }

    /// Tests triangles, each a corner and two edges.
    fn triangles(rays: RayPacket, shapes: &[[DVec3; 3]], near: &mut [f64], hit_ids: &mut [u64]) {
        each(rays, shapes, near, hit_ids, |[corner, one, other], origin, dir| {
            let (across, from) = (dir.cross(*other), origin - *corner);
            let inverse = 1.0 / one.dot(across);
            let up = from.cross(*one);
            let (u, v) = (from.dot(across) * inverse, dir.dot(up) * inverse);
            let is_inside = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0);
            if is_inside { other.dot(up) * inverse } else { f64::NAN }
        });
    }
}

#[inline(always)]
fn each(
    rays: RayPacket,
    shapes: &[[DVec3; 3]],
    near: &mut [f64],
    hit_ids: &mut [u64],
    distance: impl Fn(&[DVec3; 3], DVec3, DVec3) -> f64,
) {
    let count = near.len();
    let (rays, hit_ids) = (rays.first(count), &mut hit_ids[..count]);
    for (shape, id) in shapes.iter().zip(1..) {
        for lane in 0..count {
            let distance = distance(shape, rays.origin.get(lane), rays.dir.get(lane));
            let is_nearer = (distance > 0.0) & (distance < near[lane]);
            near[lane] = if is_nearer { distance } else { near[lane] };
            hit_ids[lane] = if is_nearer { id } else { hit_ids[lane] };
        }
    }
}
