//! Shapes given by one formula: hits are where the formula is zero, and none is missed or invented.

use crate::common::{model, render};
use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;
use glam::DVec3;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::Rng;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use tabray::exact::Scalar;
use tabray::geometry::{Frame, MISS, Ray, RayRange, Side};
use tabray::scene::Model;
use tabray::shapes::{Implicit, Made};
use tabray::world::{AnyShape, Body, Facts, Hittable};

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

struct Dice(Pcg64);

impl Dice {
    fn new() -> Self {
        Self(Pcg64::new(1, 2))
    }

    fn range(&mut self, range: Range<f64>) -> f64 {
        let part = (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        range.start + (range.end - range.start) * part
    }

    fn direction(&mut self) -> DVec3 {
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

struct By<F> {
    formula: F,
    bounds: [DVec3; 2],
}

/// A formula, for each number type.
trait Formula: Send + Sync + 'static {
    fn value<N: Scalar>(&self, at: [N; 3]) -> N;
}

impl<F: Formula> Implicit for By<F> {
    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        self.formula.value(at)
    }

    fn bounds(&self) -> [DVec3; 2] {
        self.bounds
    }
}

fn shape(formula: impl Formula, low: DVec3, high: DVec3) -> AnyShape {
    Body::implicit(By { formula, bounds: [low, high] }, Frame::at(DVec3::ZERO)).shape
}

struct Ball;

impl Formula for Ball {
    fn value<N: Scalar>(&self, [x, y, z]: [N; 3]) -> N {
        x.powi(2) + y.powi(2) + z.powi(2) - N::constant(1.0)
    }
}

#[test]
fn the_box_cuts_and_shows_the_inside() {
    let bowl = shape(Ball, DVec3::splat(-1.0), DVec3::new(1.0, 0.0, 1.0));
    let hit = |origin, dir, leaves| {
        bowl.distance(&Ray { origin, dir }, &RayRange { origin_side: leaves, ..RayRange::ALL })
    };
    let above = DVec3::new(0.0, 3.0, 0.0);
    assert_eq!(hit(above, DVec3::NEG_Y, None), 4.0);
    assert_eq!(hit(above, DVec3::Y, None), MISS);
    assert_eq!(hit(DVec3::new(-3.0, 0.5, 0.0), DVec3::X, None), MISS);
    assert!((hit(DVec3::new(-3.0, -0.6, 0.0), DVec3::X, None) - 2.2).abs() < 1e-15);
    assert_eq!(hit(DVec3::NEG_Y, DVec3::Y, Some(Side::Inside)), MISS);
    // This ray runs along a face of the box.
    assert_eq!(hit(DVec3::new(-3.0, -1.0, 0.5), DVec3::X, None), MISS);
    assert!((hit(DVec3::new(-3.0, 0.0, 0.0), DVec3::X, None) - 2.0).abs() < 1e-15);
}

/// The shape of the template that `tabray new plugin` writes.
struct RoundCube;

impl Formula for RoundCube {
    fn value<N: Scalar>(&self, [x, y, z]: [N; 3]) -> N {
        x.powi(4) + y.powi(4) + z.powi(4) - N::constant(1.0)
    }
}

/// The function along such a ray is x^4 plus a constant. The constant, from 1e-2 to 1e-18, is computed in 300 bits.
#[test]
fn a_tangency_of_the_fourth_order_is_told_from_a_miss() {
    let real = |value: f64| FBig::<HalfEven>::try_from(value).expect("finite").with_precision(300).value();
    let fourth = |value: f64| real(value) * real(value) * real(value) * real(value);
    let (cube, mut dice) = (shape(RoundCube, DVec3::splat(-1.0), DVec3::splat(1.0)), Dice::new());
    let (mut hits, mut misses) = (0, 0);
    for _ in 0..5_000 {
        let z = dice.range(-0.9..0.9);
        let y = (1.0 - z.powi(4)).sqrt().sqrt();
        let y = y + 0.1_f64.powf(dice.range(2.0..18.0)) * if dice.range(0.0..1.0) < 0.5 { 1.0 } else { -1.0 };
        let below = (real(1.0) - fourth(y) - fourth(z)).to_f64().value();
        let ray = Ray { origin: DVec3::new(-10.0, y, z), dir: DVec3::X };
        let found = cube.distance(&ray, &RayRange::ALL);
        assert_eq!(found < MISS, below >= 0.0, "{y:?} {z:?}: {found}, {below:e}");
        if found < MISS {
            let half = below.sqrt().sqrt();
            // The rounding error of the function moves its root by this much, where f64 resolves the root.
            let slack = 1e-14 + 8.0 * f64::EPSILON / (4.0 * half.powi(3));
            assert!((found - (10.0 - half)).abs() <= slack.min(1e-3), "{y:?} {z:?}: {found}, {half:e}");
            hits += 1;
        } else {
            misses += 1;
        }
        for far in [found.next_up(), 10.5, 11.5] {
            let until = cube.distance(&ray, &RayRange { far, ..RayRange::ALL });
            assert!(
                until == found || found >= far && until == MISS,
                "{y:?} {z:?}: {found}, {until} to {far}"
            );
        }
    }
    assert!(hits > 1_000 && misses > 1_000, "{hits} {misses}");
}

struct Cone;

impl Formula for Cone {
    fn value<N: Scalar>(&self, [x, y, z]: [N; 3]) -> N {
        (x.powi(2) + z.powi(2)).sqrt() - y.abs()
    }
}

#[test]
fn a_tip_has_a_normal() {
    let cone = shape(Cone, DVec3::splat(-1.0), DVec3::splat(1.0));
    assert_eq!(cone.normal(DVec3::ZERO), DVec3::Y);
    let ray = Ray { origin: DVec3::new(3.0, 0.0, 0.0), dir: DVec3::NEG_X };
    assert_eq!(cone.distance(&ray, &RayRange::ALL), 3.0);
}

/// A wall along the gyroid, clipped to a sphere: it has edges, and rays meet it often.
struct Gyroid;

impl Formula for Gyroid {
    fn value<N: Scalar>(&self, [x, y, z]: [N; 3]) -> N {
        let ball = (x.powi(2) + y.powi(2) + z.powi(2)).sqrt() - N::constant(2.0);
        let [x, y, z] = [x, y, z].map(|coordinate| coordinate * N::constant(4.0));
        let wall = (x.sin() * y.cos() + y.sin() * z.cos() + z.sin() * x.cos()).abs() - N::constant(0.3);
        wall.max(N::constant(4.0) * ball)
    }
}

#[test]
fn thin_walls_and_edges_are_found_as_by_small_steps() {
    let (gyroid, mut dice) = (shape(Gyroid, DVec3::splat(-2.0), DVec3::splat(2.0)), Dice::new());
    let mut hits = 0;
    for _ in 0..300 {
        let (from, to) = (dice.direction() * 4.0, dice.direction() * 1.5);
        let ray = Ray { origin: from, dir: (to - from).normalize() };
        let value = |distance: f64| Gyroid.value(ray.at(distance).to_array());
        let found = gyroid.distance(&ray, &RayRange::ALL);
        let stepped = (0..8000).map(|step| f64::from(step) * 1e-3).find(|distance| value(*distance) < 0.0);
        // A step can pass over a hit, but cannot find one too early.
        match stepped {
            Some(stepped) => {
                assert!(found <= stepped, "{found} {stepped}");
                assert!(value(found).abs() < 1e-13 && value(found - 1e-9) > -1e-13, "{found} {ray:?}");
                hits += 1;
            }
            None if found < MISS => assert!(value(found).abs() < 1e-13, "{found} {ray:?}"),
            None => {}
        }
    }
    assert!(hits > 200, "{hits}");
}

#[test]
fn a_hit_does_not_depend_on_the_rays_before_it() {
    let mut dice = Dice::new();
    let rays: Vec<Ray> = (0..200)
        .map(|_| (dice.direction() * 4.0, dice.direction()))
        .map(|(from, to)| Ray { origin: from, dir: (to - from).normalize() })
        .collect();
    let hits = |rays: &mut dyn Iterator<Item = &Ray>| -> Vec<f64> {
        let gyroid = shape(Gyroid, DVec3::splat(-2.0), DVec3::splat(2.0));
        rays.map(|ray| gyroid.distance(ray, &RayRange::ALL)).collect()
    };
    let (forward, mut backward) = (hits(&mut rays.iter()), hits(&mut rays.iter().rev()));
    backward.reverse();
    assert_eq!(forward, backward);
    let alone: Vec<_> = rays.iter().flat_map(|ray| hits(&mut [ray].into_iter())).collect();
    assert_eq!(forward, alone);
}

/// The gyroid, which counts how often it is evaluated.
struct CountedGyroid(Arc<AtomicUsize>);

impl Formula for CountedGyroid {
    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        self.0.fetch_add(1, Ordering::Relaxed);
        Gyroid.value(at)
    }
}

#[test]
fn rays_share_what_is_known_of_the_box() {
    let (count, mut dice) = (Arc::new(AtomicUsize::new(0)), Dice::new());
    let gyroid = shape(CountedGyroid(Arc::clone(&count)), DVec3::splat(-2.0), DVec3::splat(2.0));
    let [first, later] = [(); 2].map(|()| {
        for _ in 0..5000 {
            let (from, to) = (dice.direction() * 4.0, dice.direction());
            gyroid.distance(&Ray { origin: from, dir: (to - from).normalize() }, &RayRange::ALL);
        }
        count.swap(0, Ordering::Relaxed)
    });
    assert!(3 * later < 2 * first, "{first} evaluations, then {later}");
}

struct Wild;

impl Formula for Wild {
    fn value<N: Scalar>(&self, [x, y, z]: [N; 3]) -> N {
        (N::constant(1.0) / x).tan() * (y * N::constant(1e9)).floor() + (z.ln() / x).exp()
    }
}

#[test]
fn formulas_without_bounds_end() {
    let (wild, mut dice) = (shape(Wild, DVec3::splat(-1.0), DVec3::splat(1.0)), Dice::new());
    for _ in 0..20 {
        let ray = Ray { origin: dice.direction() * 3.0, dir: dice.direction() };
        let distance = wild.distance(&ray, &RayRange::ALL);
        assert!(distance > 0.0);
        wild.distance(&Ray { origin: -0.4 * ray.dir, dir: ray.dir }, &RayRange::ALL);
    }
    for far in [1e300, f64::INFINITY, f64::NAN] {
        let ray = Ray { origin: DVec3::splat(far), dir: DVec3::NEG_X };
        assert_eq!(wild.distance(&ray, &RayRange::ALL), MISS);
    }
}

/// A formula whose terms are greater than f64 numbers can be, but for places near two planes; it counts how often it is
/// evaluated.
struct Overflowing(Arc<AtomicUsize>);

impl Formula for Overflowing {
    fn value<N: Scalar>(&self, [x, y, _]: [N; 3]) -> N {
        self.0.fetch_add(1, Ordering::Relaxed);
        let much = N::constant(1e200);
        much * (much * x.sin()) - much * (much * y.sin())
    }
}

#[test]
fn where_terms_overflow_a_ray_takes_few_evaluations() {
    let (count, mut dice) = (Arc::new(AtomicUsize::new(0)), Dice::new());
    let shape = shape(Overflowing(Arc::clone(&count)), DVec3::splat(-1.0), DVec3::splat(1.0));
    let rays = 20;
    for _ in 0..rays {
        let origin = dice.direction() * 3.0;
        shape.distance(&Ray { origin, dir: -origin.normalize() }, &RayRange::ALL);
    }
    // A search that is not given up takes some 16,000 pieces, and more than one evaluation for each.
    let each = count.swap(0, Ordering::Relaxed) / rays;
    assert!(each < 8000, "{each} evaluations");
}

/// The formula of a heart, which counts how often it is evaluated.
struct Counted(Arc<AtomicUsize>);

impl Formula for Counted {
    fn value<N: Scalar>(&self, [x, y, z]: [N; 3]) -> N {
        self.0.fetch_add(1, Ordering::Relaxed);
        let n = N::constant;
        let ellipsoid = x.powi(2) + y.powi(2) + n(2.25) * z.powi(2) - n(1.0);
        ellipsoid - (x.powi(2) + n(0.1125) * z.powi(2)).pow(n(1.0) / n(3.0)) * y
    }
}

/// Such a ray is rounded by more than the size of the shape, from 1e150 on in twice the precision, too.
#[test]
fn a_shape_seen_from_much_too_far_away_takes_few_evaluations() {
    let (count, mut dice) = (Arc::new(AtomicUsize::new(0)), Dice::new());
    let heart = shape(Counted(Arc::clone(&count)), DVec3::splat(-1.5), DVec3::splat(1.5));
    let evaluations = [1e20, 1e24, 1e150].map(|far| {
        for _ in 0..20 {
            let origin = dice.direction() * far;
            heart.distance(&Ray { origin, dir: -origin.normalize() }, &RayRange::ALL);
        }
        count.swap(0, Ordering::Relaxed) / 20
    });
    assert!(evaluations.iter().all(|count| *count < 150), "{evaluations:?}");
}

#[test]
fn a_heart_has_no_seam_where_its_parts_meet() {
    let model = model(
        "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 } material m { ambient 1 1 1 }
        heart h { material m center 0 0 0 size 1 }",
    );
    let (heart, mut dice) = (&*model.objects[0].shape, Dice::new());
    for turn in 0..20_000 {
        let height = dice.range(-0.5..0.5) * 0.1_f64.powi(turn % 16);
        let target = DVec3::new(dice.range(-0.3..0.3), height, 0.0);
        let level = dice.direction().reject_from_normalized(DVec3::Y).normalize();
        let ray = Ray { origin: target + 5.0 * level, dir: -level };
        let distance = heart.distance(&ray, &RayRange::ALL);
        let (at, normal) = (ray.at(distance), heart.normal(ray.at(distance)));
        assert!(distance < MISS && normal.is_normalized() && normal.dot(ray.dir) < 0.0, "{ray:?}");
        let dir = (normal + 0.9 * dice.direction()).normalize();
        let left = heart.distance(
            &Ray { origin: at, dir },
            &RayRange { origin_side: Some(Side::Outside), ..RayRange::ALL },
        );
        assert!(left > 0.01, "{left:e} from {at}");
    }
}
