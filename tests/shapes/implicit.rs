//! Shapes given by one formula: hits are where the formula is zero, and none is missed or invented.

use super::torus::Dice;
use crate::common::model;
use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;
use glam::DVec3;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use tabray::exact::Scalar;
use tabray::geometry::{Frame, MISS, Ray, RayRange, Side};
use tabray::shapes::{Implicit, Made};
use tabray::world::{AnyShape, Body};

/// The formulas of the tests. They are one type, because all that finds hits is compiled for each type.
#[derive(Clone, Copy)]
enum Formula {
    Ball,
    /// The shape of the template that `tabray new plugin` writes.
    RoundCube,
    Cone,
    /// A wall along the gyroid, clipped to a sphere: it has edges, and rays meet it often.
    Gyroid,
    Heart,
    /// A formula that has no bounds in many places.
    Wild,
    /// A formula whose terms are greater than f64 numbers can be, but for places near two planes.
    Overflowing,
}

impl Formula {
    fn value<N: Scalar>(self, [x, y, z]: [N; 3]) -> N {
        let n = N::constant;
        match self {
            Self::Ball => x.powi(2) + y.powi(2) + z.powi(2) - n(1.0),
            Self::RoundCube => x.powi(4) + y.powi(4) + z.powi(4) - n(1.0),
            Self::Cone => (x.powi(2) + z.powi(2)).sqrt() - y.abs(),
            Self::Gyroid => {
                let ball = (x.powi(2) + y.powi(2) + z.powi(2)).sqrt() - n(2.0);
                let [x, y, z] = [x, y, z].map(|coordinate| coordinate * n(4.0));
                let wall = (x.sin() * y.cos() + y.sin() * z.cos() + z.sin() * x.cos()).abs() - n(0.3);
                wall.max(n(4.0) * ball)
            }
            Self::Heart => {
                let ellipsoid = x.powi(2) + y.powi(2) + n(2.25) * z.powi(2) - n(1.0);
                ellipsoid - (x.powi(2) + n(0.1125) * z.powi(2)).pow(n(1.0) / n(3.0)) * y
            }
            Self::Wild => (n(1.0) / x).tan() * (y * n(1e9)).floor() + (z.ln() / x).exp(),
            Self::Overflowing => {
                let much = n(1e200);
                much * (much * x.sin()) - much * (much * y.sin())
            }
        }
    }
}

/// The surface of a formula, which counts how often it is evaluated.
struct Surface {
    formula: Formula,
    bounds: [DVec3; 2],
    count: Arc<AtomicUsize>,
}

impl Implicit for Surface {
    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        self.count.fetch_add(1, Ordering::Relaxed);
        self.formula.value(at)
    }

    fn bounds(&self) -> [DVec3; 2] {
        self.bounds
    }
}

fn shape(formula: Formula, low: DVec3, high: DVec3) -> AnyShape {
    counted(formula, low, high).0
}

/// Returns a shape and the number of times that its formula was evaluated.
fn counted(formula: Formula, low: DVec3, high: DVec3) -> (AnyShape, Arc<AtomicUsize>) {
    let count = Arc::new(AtomicUsize::new(0));
    let surface = Surface { formula, bounds: [low, high], count: Arc::clone(&count) };
    (Body::implicit(surface, Frame::at(DVec3::ZERO)).shape, count)
}

#[test]
fn the_box_cuts_and_shows_the_inside() {
    let bowl = shape(Formula::Ball, DVec3::splat(-1.0), DVec3::new(1.0, 0.0, 1.0));
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

/// The function along such a ray is x^4 plus a constant. The constant, from 1e-2 to 1e-18, is computed in 300 bits.
#[test]
fn a_tangency_of_the_fourth_order_is_told_from_a_miss() {
    let real = |value: f64| FBig::<HalfEven>::try_from(value).expect("finite").with_precision(300).value();
    let fourth = |value: f64| real(value) * real(value) * real(value) * real(value);
    let (cube, mut dice) = (shape(Formula::RoundCube, DVec3::splat(-1.0), DVec3::splat(1.0)), Dice::new());
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

#[test]
fn a_tip_has_a_normal() {
    let cone = shape(Formula::Cone, DVec3::splat(-1.0), DVec3::splat(1.0));
    assert_eq!(cone.normal(DVec3::ZERO), DVec3::Y);
    let ray = Ray { origin: DVec3::new(3.0, 0.0, 0.0), dir: DVec3::NEG_X };
    assert_eq!(cone.distance(&ray, &RayRange::ALL), 3.0);
}

#[test]
fn thin_walls_and_edges_are_found_as_by_small_steps() {
    let (gyroid, mut dice) = (shape(Formula::Gyroid, DVec3::splat(-2.0), DVec3::splat(2.0)), Dice::new());
    let mut hits = 0;
    for _ in 0..300 {
        let (from, to) = (dice.direction() * 4.0, dice.direction() * 1.5);
        let ray = Ray { origin: from, dir: (to - from).normalize() };
        let value = |distance: f64| Formula::Gyroid.value(ray.at(distance).to_array());
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
        let gyroid = shape(Formula::Gyroid, DVec3::splat(-2.0), DVec3::splat(2.0));
        rays.map(|ray| gyroid.distance(ray, &RayRange::ALL)).collect()
    };
    let (forward, mut backward) = (hits(&mut rays.iter()), hits(&mut rays.iter().rev()));
    backward.reverse();
    assert_eq!(forward, backward);
    let alone: Vec<_> = rays.iter().flat_map(|ray| hits(&mut [ray].into_iter())).collect();
    assert_eq!(forward, alone);
}

#[test]
fn rays_share_what_is_known_of_the_box() {
    let (gyroid, count) = counted(Formula::Gyroid, DVec3::splat(-2.0), DVec3::splat(2.0));
    let mut dice = Dice::new();
    let [first, later] = [(); 2].map(|()| {
        for _ in 0..5000 {
            let (from, to) = (dice.direction() * 4.0, dice.direction());
            gyroid.distance(&Ray { origin: from, dir: (to - from).normalize() }, &RayRange::ALL);
        }
        count.swap(0, Ordering::Relaxed)
    });
    assert!(3 * later < 2 * first, "{first} evaluations, then {later}");
}

#[test]
fn formulas_without_bounds_end() {
    let (wild, mut dice) = (shape(Formula::Wild, DVec3::splat(-1.0), DVec3::splat(1.0)), Dice::new());
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

#[test]
fn where_terms_overflow_a_ray_takes_few_evaluations() {
    let (shape, count) = counted(Formula::Overflowing, DVec3::splat(-1.0), DVec3::splat(1.0));
    let mut dice = Dice::new();
    let rays = 20;
    for _ in 0..rays {
        let origin = dice.direction() * 3.0;
        shape.distance(&Ray { origin, dir: -origin.normalize() }, &RayRange::ALL);
    }
    // A search that is not given up takes some 16,000 pieces, and more than one evaluation for each.
    let each = count.swap(0, Ordering::Relaxed) / rays;
    assert!(each < 8000, "{each} evaluations");
}

/// Such a ray is rounded by more than the size of the shape, from 1e150 on in twice the precision, too.
#[test]
fn a_shape_seen_from_much_too_far_away_takes_few_evaluations() {
    let (heart, count) = counted(Formula::Heart, DVec3::splat(-1.5), DVec3::splat(1.5));
    let mut dice = Dice::new();
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
