//! Shapes that are one formula: what is hit is what the formula says, and nothing is lost or made up.

mod common;

use common::{model, render};
use glam::DVec3;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::Rng;
use std::ops::Range;
use tabray::geometry::{Body, Hittable, MISS, Ray, Side, Span};
use tabray::implicit::{Frame, Implicit};
use tabray::model::Model;
use tabray::number::Number;

const CENTER: DVec3 = DVec3::new(0.3, -0.2, 0.7);
const AXIS: DVec3 = DVec3::new(0.4, 1.0, -0.3);
const RADIUS: f64 = 1.5;
const TUBE: f64 = 0.5;

/// The torus that the quartic below describes.
fn torus() -> Model {
    model(&format!(
        "camera eye {{ pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 }} material m {{ ambient 1 1 1 }}
        torus ring {{ material m center {} {} {} direction {} {} {} radius {RADIUS} tube {TUBE} }}",
        CENTER.x, CENTER.y, CENTER.z, AXIS.x, AXIS.y, AXIS.z
    ))
}

struct Dice(Pcg64);

impl Dice {
    fn new() -> Self {
        Self(Pcg64::new(1, 2))
    }

    fn within(&mut self, range: Range<f64>) -> f64 {
        let part = (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        range.start + (range.end - range.start) * part
    }

    fn direction(&mut self) -> DVec3 {
        let height = self.within(-1.0..1.0);
        let (sin, cos) = self.within(0.0..std::f64::consts::TAU).sin_cos();
        DVec3::new(sin, cos, 0.0) * (1.0 - height * height).sqrt() + DVec3::Z * height
    }

    /// A point of the torus and its normal, by the angles.
    fn on_torus(&mut self) -> (DVec3, DVec3) {
        let axis = AXIS.normalize();
        let (across, away) = axis.any_orthonormal_pair();
        let (sin, cos) = self.within(0.0..std::f64::consts::TAU).sin_cos();
        let outward = across * sin + away * cos;
        let (sin, cos) = self.within(0.0..std::f64::consts::TAU).sin_cos();
        let normal = outward * sin + axis * cos;
        (CENTER + outward * RADIUS + normal * TUBE, normal)
    }

    /// A ray from `far` away that meets the torus's ball somewhere.
    fn aimed(&mut self, far: f64) -> Ray {
        let target = CENTER + self.direction() * self.within(0.0..1.0).cbrt() * (RADIUS + TUBE);
        let origin = CENTER + self.direction() * far;
        Ray { origin, dir: (target - origin).normalize() }
    }

    /// A ray from `far` away that passes the torus at `off` from touching it; and where.
    fn grazing(&mut self, far: f64, off: f64) -> Ray {
        let (at, normal) = self.on_torus();
        let dir = self.direction().cross(normal).normalize();
        Ray { origin: at + normal * off - dir * far, dir }
    }
}

/// The quartic of the torus along a ray, from a point of the ray that is close to the torus: solved between its
/// turning points, which are the roots of its derivative.
struct Quartic {
    /// How far the point is along the ray.
    start: f64,
    coefficients: Vec<f64>,
}

impl Quartic {
    fn new(ray: &Ray) -> Self {
        let start = (CENTER - ray.origin).dot(ray.dir);
        // Rounded as one operation is.
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

    /// The distances of all roots in order, each with whether the ray comes in there; nothing where the ray touches
    /// the torus so closely that rounding decides.
    fn crossings(&self) -> Option<Vec<(f64, bool)>> {
        let turns = roots(&derivative(&self.coefficients));
        if turns.iter().any(|turn| value(&self.coefficients, *turn).abs() < 2e-13) {
            return None;
        }
        let roots = roots(&self.coefficients);
        Some(roots.iter().enumerate().map(|(index, root)| (self.start + root, index % 2 == 0)).collect())
    }

    /// The first root beyond `near`, of those that a ray meets which leaves a side.
    fn first(&self, near: f64, leaves: Option<Side>) -> Option<f64> {
        let crossings = self.crossings()?;
        let wanted = |(distance, comes_in): &(f64, bool)| {
            near < *distance && leaves.is_none_or(|side| *comes_in == (side == Side::Outside))
        };
        Some(crossings.into_iter().find(wanted).map_or(MISS, |(distance, _)| distance))
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

/// The real roots between -10 and 10 in order, by bisection between those of the derivative.
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

/// Asserts that the torus is hit where the quartic says; whether the quartic is sure.
fn agrees(shape: &dyn Hittable, ray: &Ray, leaves: Option<Side>, near: f64) -> bool {
    let quartic = Quartic::new(ray);
    let Some(expected) = quartic.first(near, leaves) else { return false };
    let found = shape.distance(ray, &Span { leaves, ..Span::RAY });
    if found == expected {
        return true;
    }
    assert!(found.is_finite() && expected.is_finite(), "{found:e}, not {expected:e}: {ray:?} {leaves:?}");
    // Where a ray grazes, a root moves more than its value does.
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
        assert!(agrees(shape, &dice.aimed(6.0), None, 0.0));
    }
}

#[test]
fn rays_that_graze_hit_or_miss_as_they_should() {
    let (model, mut dice) = (torus(), Dice::new());
    let shape = &*model.objects[0].shape;
    for power in 2..=12 {
        for off in [1.0, -1.0].map(|side| side * 0.1_f64.powi(power)) {
            let sure = (0..5_000).filter(|_| agrees(shape, &dice.grazing(6.0, off), None, 0.0)).count();
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
            agrees(shape, &dice.aimed(far), None, 0.0);
            agrees(shape, &dice.grazing(far, 1e-6), None, 0.0);
        }
    }
}

#[test]
fn a_viewer_inside_sees_the_wall() {
    let (model, mut dice) = (torus(), Dice::new());
    let shape = &*model.objects[0].shape;
    for _ in 0..20_000 {
        let (at, normal) = dice.on_torus();
        let ray = Ray { origin: at - normal * dice.within(0.1..0.9) * TUBE, dir: dice.direction() };
        assert!(agrees(shape, &ray, None, 0.0));
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
        let distance = shape.distance(&there, &Span::RAY);
        if distance == MISS {
            continue;
        }
        let origin = there.at(distance);
        let normal = shape.normal(origin);
        // Also very shallow.
        let steep = [1.0, 1e-2, 1e-4][turn / 3 % 3];
        let shallow = dice.direction().cross(normal).normalize();
        let dir = (shallow + steep * dice.within(0.3..2.0) * normal).normalize();
        for (leaves, dir) in [(Side::Outside, dir), (Side::Inside, -dir)] {
            let ray = Ray { origin, dir };
            assert!(agrees(shape, &ray, Some(leaves), 0.0));
            let found = shape.distance(&ray, &Span { leaves: Some(leaves), ..Span::RAY });
            // A ball as large as the tube, that touches the torus there from either side, meets it nowhere else.
            assert!(found > 1.5 * TUBE * dir.dot(normal).abs(), "{found:e} {leaves:?} {ray:?}");
            again[usize::from(leaves == Side::Inside)] += usize::from(found < MISS);
        }
        left += 1;
    }
    assert!(left > 20_000 && again[0] > left / 10 && again[1] == left, "{again:?} of {left}");
}
