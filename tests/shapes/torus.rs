//! A torus as a formula: its hits are those of its quartic, and none is missed or invented.

use crate::common::{model, render};
use glam::DVec3;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::Rng;
use std::ops::Range;
use tabray::geometry::{MISS, Ray, RayRange, Side};
use tabray::scene::Model;
use tabray::world::{Facts, Hittable};

const CENTER: DVec3 = DVec3::new(4.1, 2.9, -2.7);
const AXIS: DVec3 = DVec3::new(0.4, 1.0, -0.3);
const RADIUS: f64 = 1.5;
const TUBE: f64 = 0.5;

/// Returns a scene with a mirror, the torus that the quartic below describes, and an object that it reflects.
fn torus() -> Model {
    model(&format!(
        "camera eye {{ pixeldim 160 120 worlddim 8 6 viewpoint 4 3 5 }}
        material chrome {{ ambient 1 0.5 0.2 diffuse 2 1 1 specular 0.85 shininess 50 }}
        torus ring {{ material chrome center {} {} {} direction {} {} {} radius {RADIUS} tube {TUBE} }}
        plane floor {{ material chrome normal 0 1 0 point 0 0 0 }}
        light lamp {{ location 1 8 3 emissivity 16 16 16 }}",
        CENTER.x, CENTER.y, CENTER.z, AXIS.x, AXIS.y, AXIS.z
    ))
}

pub struct Dice(Pcg64);

impl Dice {
    pub fn new() -> Self {
        Self(Pcg64::new(1, 2))
    }

    pub fn range(&mut self, range: Range<f64>) -> f64 {
        let part = (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        range.start + (range.end - range.start) * part
    }

    pub fn direction(&mut self) -> DVec3 {
        let height = self.range(-1.0..1.0);
        let (sin, cos) = self.range(0.0..std::f64::consts::TAU).sin_cos();
        DVec3::new(sin, cos, 0.0) * (1.0 - height * height).sqrt() + DVec3::Z * height
    }

    /// Returns a point of the torus and its normal, at random angles.
    fn on_torus(&mut self) -> (DVec3, DVec3) {
        let axis = AXIS.normalize();
        let (across, away) = axis.any_orthonormal_pair();
        let (sin, cos) = self.range(0.0..std::f64::consts::TAU).sin_cos();
        let outward = across * sin + away * cos;
        let (sin, cos) = self.range(0.0..std::f64::consts::TAU).sin_cos();
        let normal = outward * sin + axis * cos;
        (CENTER + outward * RADIUS + normal * TUBE, normal)
    }

    /// Returns a ray from a distance of `far` to a point in the torus's bounding sphere.
    fn aimed(&mut self, far: f64) -> Ray {
        let target = CENTER + self.direction() * self.range(0.0..1.0).cbrt() * (RADIUS + TUBE);
        let origin = CENTER + self.direction() * far;
        Ray { origin, dir: (target - origin).normalize() }
    }

    /// Returns a ray from a distance of `far` that passes the torus at a distance of `off` from tangency.
    fn grazing(&mut self, far: f64, off: f64) -> Ray {
        let (at, normal) = self.on_torus();
        let dir = self.direction().cross(normal).normalize();
        Ray { origin: at + normal * off - dir * far, dir }
    }
}

/// The quartic of the torus along a ray, relative to a point of the ray close to the torus. It is solved between its
/// extrema, which are the roots of its derivative.
struct Quartic {
    /// The distance of the point along the ray.
    start: f64,
    coefficients: Vec<f64>,
}

impl Quartic {
    fn new(ray: &Ray) -> Self {
        let start = (CENTER - ray.origin).dot(ray.dir);
        // The sum below is rounded only once, like a single operation.
        let along = |axis: usize| {
            let way = start * ray.dir[axis];
            let way_error = start.mul_add(ray.dir[axis], -way);
            let place = ray.origin[axis] + way;
            let part = place - ray.origin[axis];
            let place_error = (ray.origin[axis] - (place - part)) + (way - part);
            (place - CENTER[axis]) + (place_error + way_error)
        };
        let base = DVec3::new(along(0), along(1), along(2));
        let axis = AXIS.normalize();
        let square = vec![base.dot(base), 2.0 * base.dot(ray.dir), ray.dir.dot(ray.dir)];
        let height = vec![base.dot(axis), ray.dir.dot(axis)];
        let mut sum = square.clone();
        sum[0] += RADIUS * RADIUS - TUBE * TUBE;
        let mut coefficients = times(&sum, &sum);
        let height = times(&height, &height);
        for power in 0..3 {
            coefficients[power] -= 4.0 * RADIUS * RADIUS * (square[power] - height[power]);
        }
        Self { start, coefficients }
    }

    fn at(&self, distance: f64) -> f64 {
        value(&self.coefficients, distance - self.start)
    }

    /// Returns the distances of all roots in order, and for each whether the ray enters there; `None` if the ray is so
    /// nearly tangent to the torus that rounding decides.
    fn crossings(&self) -> Option<Vec<(f64, bool)>> {
        let turns = roots(&derivative(&self.coefficients));
        if turns.iter().any(|turn| value(&self.coefficients, *turn).abs() < 2e-13) {
            return None;
        }
        Some(self.roots())
    }

    /// Returns all roots like [`crossings`](Self::crossings), however close to a tangency.
    fn roots(&self) -> Vec<(f64, bool)> {
        let roots = roots(&self.coefficients);
        roots.iter().enumerate().map(|(index, root)| (self.start + root, index % 2 == 0)).collect()
    }

    /// Returns the first root ahead; for a ray that leaves a side, the first of those that it can meet.
    fn first(&self, leaves: Option<Side>) -> Option<f64> {
        Some(first(self.crossings()?, leaves))
    }
}

fn first(roots: Vec<(f64, bool)>, leaves: Option<Side>) -> f64 {
    let wanted = |(distance, comes_in): &(f64, bool)| {
        0.0 < *distance && leaves.is_none_or(|side| *comes_in == (side == Side::Outside))
    };
    roots.into_iter().find(wanted).map_or(MISS, |(distance, _)| distance)
}

/// The torus with its quartic as the equation, and its normal from its geometry.
struct Quartics;

impl Hittable for Quartics {
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        range.keep(first(Quartic::new(ray).roots(), range.origin_side))
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        let (axis, at) = (AXIS.normalize(), at - CENTER);
        (at - RADIUS * at.reject_from_normalized(axis).normalize()).normalize()
    }

    fn facts(&self) -> Facts {
        Facts { is_two_sided: true, ..Facts::unbounded(0.0) }
    }
}

fn times(one: &[f64], other: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; one.len() + other.len() - 1];
    for (i, a) in one.iter().enumerate() {
        for (j, b) in other.iter().enumerate() {
            product[i + j] += a * b;
        }
    }
    product
}

fn value(coefficients: &[f64], t: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * t + coefficient)
}

fn derivative(coefficients: &[f64]) -> Vec<f64> {
    coefficients.iter().enumerate().skip(1).map(|(power, coefficient)| power as f64 * coefficient).collect()
}

/// Returns the real roots between -10 and 10 in order, by bisection between the roots of the derivative.
fn roots(coefficients: &[f64]) -> Vec<f64> {
    if coefficients.len() < 2 {
        return Vec::new();
    }
    let mut ends = vec![-10.0];
    ends.extend(roots(&derivative(coefficients)));
    ends.push(10.0);
    let bracket = |pair: &[f64]| {
        let (mut low, mut high) = (pair[0], pair[1]);
        let rises = value(coefficients, low) < 0.0;
        if rises == (value(coefficients, high) < 0.0) {
            return None;
        }
        loop {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                return Some(middle);
            }
            if (value(coefficients, middle) < 0.0) == rises {
                low = middle;
            } else {
                high = middle;
            }
        }
    };
    ends.windows(2).filter_map(bracket).collect()
}

/// Asserts that the torus is hit where the quartic says; returns whether the quartic decides.
fn agrees(shape: &dyn Hittable, ray: &Ray, leaves: Option<Side>) -> bool {
    let quartic = Quartic::new(ray);
    let Some(expected) = quartic.first(leaves) else { return false };
    let found = shape.distance(ray, &RayRange { origin_side: leaves, ..RayRange::ALL });
    if found == expected {
        return true;
    }
    assert!(found.is_finite() && expected.is_finite(), "{found:e}, not {expected:e}: {ray:?} {leaves:?}");
    // For a grazing ray, the error of a root is larger than that of the value.
    let apart = (found - expected).abs();
    let rounding = 2.0 * f64::EPSILON * found.abs();
    assert!(
        apart <= 1e-12 + rounding || apart < 1e-4 && quartic.at(found).abs() < 1e-12,
        "{found:e}, not {expected:e}: {ray:?} {leaves:?} {:e}",
        quartic.at(found)
    );
    true
}

#[test]
fn no_hit_of_a_torus_is_missed_or_made_up() {
    let (model, mut dice) = (torus(), Dice::new());
    let shape = &*model.objects[0].shape;
    for _ in 0..100_000 {
        assert!(agrees(shape, &dice.aimed(6.0), None));
    }
}

#[test]
fn rays_that_graze_hit_or_miss_as_they_should() {
    let (model, mut dice) = (torus(), Dice::new());
    let shape = &*model.objects[0].shape;
    for power in 2..=12 {
        for off in [1.0, -1.0].map(|side| side * 0.1_f64.powi(power)) {
            let sure = (0..5_000).filter(|_| agrees(shape, &dice.grazing(6.0, off), None)).count();
            assert!(sure > 4_950, "{off:e}: {sure}");
        }
    }
}

#[test]
fn distance_does_not_blur_a_torus() {
    let (model, mut dice) = (torus(), Dice::new());
    let shape = &*model.objects[0].shape;
    for far in [1e4, 1e7] {
        for _ in 0..10_000 {
            agrees(shape, &dice.aimed(far), None);
            agrees(shape, &dice.grazing(far, 1e-6), None);
        }
    }
}

#[test]
fn a_viewer_inside_sees_the_wall() {
    let (model, mut dice) = (torus(), Dice::new());
    let shape = &*model.objects[0].shape;
    for _ in 0..20_000 {
        let (at, normal) = dice.on_torus();
        let ray = Ray { origin: at - normal * dice.range(0.1..0.9) * TUBE, dir: dice.direction() };
        assert!(agrees(shape, &ray, None));
    }
}

#[test]
fn what_leaves_a_torus_meets_it_again_where_it_is_and_not_where_it_starts() {
    let (model, mut dice) = (torus(), Dice::new());
    let shape = &*model.objects[0].shape;
    let (mut left, mut again) = (0, [0, 0]);
    for turn in 0..60_000 {
        // A point as the tracer finds it, from near and from far.
        let there = dice.aimed([6.0, 1e4, 1e6][turn % 3]);
        let distance = shape.distance(&there, &RayRange::ALL);
        if distance == MISS {
            continue;
        }
        let origin = there.at(distance);
        let normal = shape.normal(origin);
        // Some of the rays are very shallow.
        let steep = [1.0, 1e-2, 1e-4][turn / 3 % 3];
        let shallow = dice.direction().cross(normal).normalize();
        let dir = (shallow + steep * dice.range(0.3..2.0) * normal).normalize();
        for (leaves, dir) in [(Side::Outside, dir), (Side::Inside, -dir)] {
            let ray = Ray { origin, dir };
            assert!(agrees(shape, &ray, Some(leaves)));
            let found = shape.distance(&ray, &RayRange { origin_side: Some(leaves), ..RayRange::ALL });
            // A sphere with the radius of the tube, tangent to the torus there on either side, meets the torus nowhere
            // else.
            assert!(found > 1.5 * TUBE * dir.dot(normal).abs(), "{found:e} {leaves:?} {ray:?}");
            again[usize::from(leaves == Side::Inside)] += usize::from(found < MISS);
        }
        left += 1;
    }
    assert!(left > 20_000 && again[0] > left / 10 && again[1] == left, "{again:?} of {left}");
}

#[test]
fn a_mirror_torus_looks_as_its_quartic_has_it() {
    let model = torus();
    let picture = render(&model);
    let mut by_quartic = model;
    by_quartic.objects[0].shape = Quartics.into();
    let expected = render(&by_quartic);
    let differing = expected.pixels().zip(picture.pixels()).filter(|(a, b)| a != b).count();
    assert!(differing == 0, "{differing} pixels differ");
}

#[test]
fn normals_are_unit_vectors_that_point_outward() {
    let (model, mut dice) = (torus(), Dice::new());
    for _ in 0..10_000 {
        let (at, normal) = dice.on_torus();
        let found = model.objects[0].shape.normal(at);
        assert!((found - normal).length() < 1e-13 && found.is_normalized(), "{found} {normal}");
    }
}
