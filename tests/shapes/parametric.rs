//! Parametric surfaces: rays hit them where surfaces of the same points are hit, and the hits are proven.

use crate::common::{model, registry};
use glam::DVec3;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::Rng;
use std::f64::consts::TAU;
use std::path::Path;
use tabray::exact::interval::{Float, Interval};
use tabray::geometry::{MISS, Ray, RayRange, Sight};
use tabray::scene::{self, Model};
use tabray::world::certify::{Enclosure, Precision};

struct Dice(Pcg64);

impl Dice {
    fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn inside(&mut self, size: f64) -> DVec3 {
        DVec3::new(self.range(-size, size), self.range(-size, size), self.range(-size, size))
    }

    /// Returns a ray from outside toward a point within a cube of this half size.
    fn ray(&mut self, size: f64) -> Ray {
        let origin = 5.0 * self.inside(1.0).normalize();
        Ray { origin, dir: (self.inside(size) - origin).normalize() }
    }
}

fn scene(object: &str) -> Model {
    model(&format!(
        "camera eye {{ pixeldim 4 3 worlddim 8 6 viewpoint 4 3 6 }} material m {{ ambient 1 1 1 }} {object}"
    ))
}

fn parametric([x, y, z]: [&str; 3], v: [f64; 2]) -> Model {
    let [low, high] = v;
    scene(&format!(
        "parametric p {{ material m x \"{x}\" y \"{y}\" z \"{z}\" u 0 6.283185307179586 v {low} {high} }}"
    ))
}

const TORUS: [&str; 3] = ["(1 + 0.4*cos(v))*cos(u)", "0.4*sin(v)", "(1 + 0.4*cos(v))*sin(u)"];
const STRIP: [&str; 3] = ["(1 + v*cos(u/2))*cos(u)", "v*sin(u/2)", "(1 + v*cos(u/2))*sin(u)"];
const BOTTLE: [&str; 3] = [
    "(1 + 0.5*cos(u/2)*sin(v) - 0.5*sin(u/2)*sin(2*v))*cos(u)",
    "0.5*sin(u/2)*sin(v) + 0.5*cos(u/2)*sin(2*v)",
    "(1 + 0.5*cos(u/2)*sin(v) - 0.5*sin(u/2)*sin(2*v))*sin(u)",
];

/// The middle of a torus, of which the warnings ask, is not on the torus.
#[test]
fn a_shader_of_u_and_v_may_be_on_a_parametric_surface() {
    let [x, y, z] = TORUS;
    let text = format!(
        "camera eye {{ pixeldim 4 3 worlddim 8 6 viewpoint 4 3 6 }} material m {{ ambient 1 1 1 }}
         formula bands {{ ambient \"v\" }}
         parametric p {{ material m x \"{x}\" y \"{y}\" z \"{z}\" u 0 {TAU} v 0 {TAU} shader bands }}
         place copy {{ object p translation 5 0 0 shader bands }}"
    );
    let loaded = scene::read(registry(), "scene", Path::new(""), text.as_bytes(), None);
    let warnings = loaded.unwrap_or_else(|report| panic!("{report}")).warnings.to_string();
    assert!(!warnings.contains("u and v"), "{warnings}");
}

#[test]
fn a_torus_of_u_and_v_is_hit_where_a_torus_is() {
    let own = parametric(TORUS, [0.0, TAU]);
    let other = scene("torus t { material m center 0 0 0 radius 1 tube 0.4 }");
    let [own, other] = [&own, &other].map(|model| &model.objects[0].shape);
    let (mut dice, mut hits) = (Dice(Pcg64::new(3, 4)), 0);
    for _ in 0..2000 {
        let ray = dice.ray(1.5);
        let [found, expected] = [own, other].map(|shape| shape.distance(&ray, &RayRange::ALL));
        if expected == MISS {
            assert_eq!(found, MISS, "{ray:?}");
            continue;
        }
        hits += 1;
        let normal = other.normal(ray.at(expected));
        let cosine = normal.dot(ray.dir).abs();
        assert!((found - expected).abs() < 1e-13 / cosine, "{ray:?}: {found} {expected} {cosine}");
        assert!(own.normal(ray.at(found)).dot(normal).abs() > 1.0 - 1e-12, "{ray:?}");
    }
    assert!(hits > 500, "{hits}");
}

/// The nearest triangle that a ray hits: its distance, the cosine of the angle to its normal, and whether it is at the end of v.
fn nearest(triangles: &[([DVec3; 3], bool)], ray: &Ray) -> (f64, f64, bool) {
    let mut nearest = (MISS, 1.0, false);
    for ([a, b, c], is_edge) in triangles {
        let (ab, ac, from) = (*b - *a, *c - *a, ray.origin - *a);
        let (across, turned) = (ray.dir.cross(ac), from.cross(ab));
        let determinant = ab.dot(across);
        let [u, v, t] =
            [from.dot(across), ray.dir.dot(turned), ac.dot(turned)].map(|part| part / determinant);
        if u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 && t < nearest.0 {
            nearest = (t, ab.cross(ac).normalize().dot(ray.dir).abs(), *is_edge);
        }
    }
    nearest
}

#[test]
fn a_strip_and_a_bottle_are_hit_where_their_triangles_are() {
    let strip = |u: f64, v: f64| {
        let out = 1.0 + v * (u / 2.0).cos();
        DVec3::new(out * u.cos(), v * (u / 2.0).sin(), out * u.sin())
    };
    let bottle = |u: f64, v: f64| {
        let (sin, cos) = (u / 2.0).sin_cos();
        let out = 1.0 + 0.5 * cos * v.sin() - 0.5 * sin * (2.0 * v).sin();
        DVec3::new(out * u.cos(), 0.5 * sin * v.sin() + 0.5 * cos * (2.0 * v).sin(), out * u.sin())
    };
    let both: [(_, &dyn Fn(f64, f64) -> DVec3, _, _); 2] =
        [(STRIP, &strip, [-0.4, 0.4], true), (BOTTLE, &bottle, [0.0, TAU], false)];
    for (formulas, at, [low, high], has_edge) in both {
        let count = 160;
        let corner = |i: usize, j: usize| {
            at(TAU * i as f64 / count as f64, low + (high - low) * j as f64 / count as f64)
        };
        let mut triangles = Vec::new();
        for (i, j) in (0..count).flat_map(|i| (0..count).map(move |j| (i, j))) {
            let is_edge = has_edge && (j < 3 || j + 4 > count);
            let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
            triangles.extend([([a, b, c], is_edge), ([a, c, d], is_edge)]);
        }
        let model = parametric(formulas, [low, high]);
        let shape = &model.objects[0].shape;
        let (mut dice, mut hits, mut open) = (Dice(Pcg64::new(5, 6)), 0, 0);
        for _ in 0..250 {
            let ray = dice.ray(1.2);
            let found = shape.distance(&ray, &RayRange::ALL);
            let (expected, cosine, is_edge) = nearest(&triangles, &ray);
            if found == MISS && expected == MISS {
                continue;
            }
            hits += 1;
            if (found - expected).abs() < 0.005 {
                continue;
            }
            // Triangles tell no more where the ray grazes the surface, or passes its end.
            open += 1;
            let is_open = if found < expected {
                shape.normal(ray.at(found)).dot(ray.dir).abs() < 0.25 || has_edge
            } else {
                cosine < 0.25 || is_edge
            };
            assert!(is_open, "{ray:?}: {found}, and {expected} of a triangle");
        }
        assert!(hits > 80 && open < 8, "{hits} {open}");
    }
}

#[test]
fn hits_of_strips_and_bottles_are_proven() {
    for (formulas, v) in [(TORUS, [0.0, TAU]), (STRIP, [-0.4, 0.4]), (BOTTLE, [0.0, TAU])] {
        let model = parametric(formulas, v);
        let shape = &model.objects[0].shape;
        let (mut dice, mut proven) = (Dice(Pcg64::new(7, 8)), 0);
        for _ in 0..150 {
            let ray = dice.ray(1.2);
            let found = shape.distance(&ray, &RayRange::ALL);
            match shape.certify(&Sight::along(&ray), Precision::Double) {
                Enclosure::Misses => assert_eq!(found, MISS, "{ray:?}"),
                Enclosure::Hits(at) | Enclosure::Edge(at) => {
                    let Interval { low, high } = at.coarse();
                    assert!(low - 1e-12 < found && found < high + 1e-12, "{ray:?}: {found} {low} {high}");
                }
                Enclosure::Doubtful(_) => continue,
            }
            proven += 1;
        }
        assert!(proven > 146, "{formulas:?}: {proven}");
    }
}

/// Rays in the plane of a seam, where u is 0 or v is 0: the torus is hit at its outer or its inner equator.
#[test]
fn hits_where_a_surface_closes_are_proven() {
    let model = parametric(TORUS, [0.0, TAU]);
    let shape = &model.objects[0].shape;
    let mut dice = Dice(Pcg64::new(5, 3));
    let mut hits = 0;
    for _ in 0..200 {
        let (from, to) = (dice.range(-0.3, 0.3), dice.range(-1.3, 1.3));
        let (origin, dir) = (DVec3::new(5.0, 0.0, from), DVec3::new(-5.0, 0.0, to - from).normalize());
        let sight = Sight::along(&Ray { origin, dir });
        let [half, square] = [origin.dot(dir), origin.length_squared() - 1.4 * 1.4];
        let truth = -half - (half * half - square).sqrt();
        let Enclosure::Hits(at) = shape.certify(&sight, Precision::Octuple) else { continue };
        assert!((at.middle().to_f64() - truth).abs() < 1e-12, "{at:?}, not {truth}");
        hits += 1;
    }
    assert!(hits >= 199, "{hits} of 200");
}

/// In the middle of this surface, where it comes back, a step of u does not move.
#[test]
fn a_surface_that_comes_back_from_an_edge_is_hit_on_its_nearer_sheet() {
    let model = scene("parametric p { material m x \"u^2\" y v z \"u^3\" u -1 1 v -1 1 }");
    let shape = &model.objects[0].shape;
    let mut dice = Dice(Pcg64::new(2, 7));
    for _ in 0..200 {
        let (x, y) = (dice.range(0.001, 0.999), dice.range(-0.999, 0.999));
        let ray = Ray { origin: DVec3::new(x, y, 5.0), dir: DVec3::NEG_Z };
        let found = shape.distance(&ray, &RayRange::ALL);
        assert!((found - (5.0 - x * x.sqrt())).abs() < 1e-13, "{ray:?}: {found}");
    }
}

#[test]
fn a_tube_around_a_circle_is_a_torus() {
    let own = scene("tube t { material m x \"cos(t)\" y 0 z \"sin(t)\" t 0 6.283185307179586 radius 0.4 }");
    let other = scene("torus t { material m center 0 0 0 radius 1 tube 0.4 }");
    let [own, other] = [&own, &other].map(|model| &model.objects[0].shape);
    let mut dice = Dice(Pcg64::new(9, 10));
    for _ in 0..500 {
        let ray = dice.ray(1.5);
        let [found, expected] = [own, other].map(|shape| shape.distance(&ray, &RayRange::ALL));
        assert!(found == expected || (found - expected).abs() < 1e-9, "{ray:?}: {found} {expected}");
    }
}

/// Where parts of a surface were tested one by one, some hits were left in places as wide as a part.
#[test]
fn a_thin_tube_is_hit_at_its_radius() {
    let text = "tube t { material m x \"0.06*sin(3*t)\" y \"1.45*t\" z -0.08 t 0 1 radius 0.022 }";
    let model = scene(text);
    let shape = &model.objects[0].shape;
    for toward in [
        DVec3::new(0.080_779_278_717_499_21, -0.41341209282874825, -3.686615306384831),
        DVec3::new(0.069_041_046_402_236_82, -0.023628672636087034, -3.691862525307287),
    ] {
        let ray = Ray { origin: DVec3::new(0.0, 1.1, 3.6), dir: toward.normalize() };
        let Enclosure::Hits(at) = shape.certify(&Sight::along(&ray), Precision::Double) else {
            panic!("{ray:?}")
        };
        let found = shape.distance(&ray, &RayRange::ALL);
        assert!(at.width().to_f64() < 1e-9, "{at:?}");
        let axis = |t: f64| DVec3::new(0.06 * libm::sin(3.0 * t), 1.45 * t, -0.08);
        let off = (0..1_000_000).map(|step| ray.at(found).distance(axis(f64::from(step) / 1e6)));
        let off = off.fold(f64::INFINITY, f64::min) - 0.022;
        assert!(off.abs() < 1e-9, "{ray:?}: {off} off the surface");
    }
}
