//! Rays of a beam have the same hits as single rays.

use super::*;
use crate::implicit::parts::Parts;
use std::sync::Arc;
use tabray_exact::formula::Formula;
use tabray_exact::formula::field::Field;
use tabray_world::geometry::frame::Frame;
use tabray_world::hittable::Hittable;
use tabray_world::simd::soa::Vectors;

/// Half of the side of the box.
const HALF: f64 = 3.0;

struct Surface(Field);

impl Implicit for Surface {
    const IS_IN_WIDE_BOX: bool = true;

    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        self.0.at(at)
    }

    fn field(&self) -> Option<&Field> {
        Some(&self.0)
    }

    fn bounds(&self) -> [DVec3; 2] {
        [DVec3::splat(-HALF), DVec3::splat(HALF)]
    }
}

fn shape(text: &str) -> ImplicitShape<Surface> {
    let field = Formula::parse_in(text, Field::VARIABLES).map(|formula| Field::new(Arc::new(formula)));
    let formula = Surface(field.ok().flatten().expect(text));
    let [low, high] = formula.bounds();
    let frame = Frame::at(DVec3::new(0.3, -0.2, 0.1));
    let (parts, most_pieces) = (Parts::new(low, high, 1), usize::MAX);
    let (recorded, along_lines, degree, nodes) = Default::default();
    ImplicitShape { formula, recorded, along_lines, degree, frame, low, high, parts, most_pieces, nodes }
}

/// Returns pseudorandom numbers from -0.5 to 0.5.
fn numbers(seed: usize) -> impl Iterator<Item = f64> {
    (1..).map(move |step: usize| {
        let mixed = (step + 977 * seed).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        ((mixed ^ (mixed >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 11) as f64 / (1_u64 << 53) as f64
            - 0.5
    })
}

/// Compares the brackets of a beam's rays with those of single rays. Returns the distances of the hits.
fn compare(shape: &ImplicitShape<Surface>, rays: &[Ray; BEAM], ranges: &[RayRange; BEAM]) -> [f64; BEAM] {
    let (mut origin, mut dir) = (Vectors::<BEAM>::ZERO, Vectors::<BEAM>::ZERO);
    for (lane, ray) in rays.iter().enumerate() {
        origin.view_mut(BEAM).set(lane, ray.origin);
        dir.view_mut(BEAM).set(lane, ray.dir);
    }
    let packet = RayPacket::new(origin.view(BEAM), dir.view(BEAM), ranges[0].origin_error);
    let mut brackets = [Bracket::MISS; BEAM];
    bracket_each(shape, packet, ranges, &mut brackets);
    from_fn(|lane| {
        let range = &ranges[lane];
        let (alone, together) = (shape.t_bounds(&rays[lane].into(), range), brackets[lane]);
        let is_same = (alone.near - together.near).abs() <= 1e-12 * (1.0 + alone.near) || alone == together;
        assert!(alone.is_doubtful() || is_same, "{lane} {range:?}: {together:?} and {alone:?}");
        together.near
    })
}

#[test]
fn rays_of_a_beam_are_hit_where_each_alone_is() {
    for text in [
        "sin(x)*cos(y) + sin(y)*cos(z) + sin(z)*cos(x)",
        "0.5*(sin(2*x)*cos(y)*sin(z) + sin(2*y)*cos(z)*sin(x) + sin(2*z)*cos(x)*sin(y)) \
            - 0.5*(cos(2*x)*cos(2*y) + cos(2*y)*cos(2*z) + cos(2*z)*cos(2*x)) + 0.15",
        "y - 0.2*sin(4*x)*cos(3*z) - 0.1*sin(x*z)",
        "sqrt(max(abs(x) - 1.7, 0)^2 + max(abs(y) - 1.5, 0)^2 + max(abs(z) - 0.3, 0)^2) - 0.1",
        "min(abs(x) + abs(y) + abs(z) - 1, 0.5 - exp(-4*((x - 1.5)^2 + y^2 + z^2)))",
        "floor(3*x) + y + 0.3*z",
    ] {
        let shape = shape(text);
        for seed in 0..60 {
            let mut number = numbers(seed);
            let mut vector = |size: f64| size * DVec3::from_array(from_fn(|_| number.next().unwrap_or(0.0)));
            let size = [0.0, 1e-9, 1e-4, 1e-2, 0.05, 0.5][seed % 6];
            let (from, to) = (12.0 * vector(1.0).normalize(), vector(4.0));
            let rays: [Ray; BEAM] = from_fn(|_| {
                let origin = from + vector(size);
                Ray { origin, dir: (to + vector(size) - origin).normalize() }
            });
            let distances = compare(&shape, &rays, &[RayRange::ALL; BEAM]);
            let near = distances[0].min(14.0);
            compare(&shape, &rays, &[RayRange { near: near - 0.3 * size, ..RayRange::ALL }; BEAM]);
            compare(&shape, &rays, &[RayRange { far: near + 0.3 * size, ..RayRange::ALL }; BEAM]);
            // Rays that start before or behind their hits, as where a ball cuts a surface.
            let beside = vector(1.0).abs();
            let starts = from_fn(|lane| {
                let part = [-0.5, 0.1, 1.0, 3.0][lane % 4] * beside.x;
                let near = if distances[lane] < MISS { distances[lane] + part * size } else { near };
                RayRange { near, ..RayRange::ALL }
            });
            compare(&shape, &rays, &starts);
            // Rays that start at these hits.
            let toward = vector(20.0);
            let leaving = |lane: usize| {
                let origin = rays[lane].at(if distances[lane] < MISS { distances[lane] } else { near });
                Ray { origin, dir: (toward - origin).normalize() }
            };
            let leaving: [Ray; BEAM] = from_fn(leaving);
            let is_above = leaving[0].dir.dot(shape.normal(leaving[0].origin)) > 0.0;
            let origin_side = Some(if is_above { Side::Outside } else { Side::Inside });
            if distances.iter().all(|distance| *distance < MISS) {
                let range = RayRange { origin_side, origin_error: 1e-13, ..RayRange::ALL };
                compare(&shape, &leaving, &[range; BEAM]);
            }
        }
    }
}
