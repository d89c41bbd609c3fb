//! Surfaces whose formulas are not defined everywhere, jump, or have slopes without bounds, beside their hits in closed form.

use crate::common::model;
use crate::oracle::rays::Random;
use glam::DVec3;
use tabray::geometry::{MISS, Ray, RayRange};
use tabray::query::{Query, QueryRay, Verdict};
use tabray::render::Plan;
use tabray::scene::Model;
use tabray::tools::verify;

/// Half the length of an edge of the box.
const SIZE: f64 = 2.0;

/// How near a hit may be to the edge of a surface for rounding to decide whether it counts.
const NEAR: f64 = 1e-9;

fn surface(formula: &str) -> Model {
    model(&format!(
        "camera eye {{ pixeldim 16 12 worlddim 8 6 viewpoint 4 3 6 }}
        material gold {{ ambient 1 1 0 }}
        implicit it {{ material gold formula \"{formula}\" box -2 -2 -2 2 2 2 }}"
    ))
}

/// The distances at which a ray crosses a surface, each with a number that is below 0 where the surface ends.
type Crossings = fn(&Ray) -> Vec<(f64, f64)>;

/// Asserts that random rays hit the surface of a formula first where its crossings say.
#[track_caller]
fn agrees(formula: &str, crossings: Crossings) {
    let (model, mut random, mut hits) = (surface(formula), Random::new(3), 0);
    let shape = &*model.objects[0].shape;
    for _ in 0..4000 {
        let mut point = |size: f64| DVec3::from([(); 3].map(|()| random.between(-size, size)));
        let (from, to) = (point(5.0), point(SIZE));
        let ray = Ray { origin: from, dir: (to - from).normalize() };
        let mut nearest = MISS;
        let mut is_near = false;
        for (t, inside) in crossings(&ray) {
            let inside = inside.min(SIZE - ray.at(t).abs().max_element());
            if t > 0.0 && inside > NEAR {
                nearest = nearest.min(t);
            } else {
                is_near |= t > -NEAR && inside > -NEAR;
            }
        }
        if is_near {
            continue;
        }
        let found = shape.distance(&ray, &RayRange::ALL);
        let is_right = found == nearest || (found - nearest).abs() < 1e-9 * (1.0 + nearest);
        assert!(is_right, "{formula}: {found}, not {nearest}, along {ray:?}");
        hits += usize::from(nearest < MISS);
    }
    assert!(hits > 200, "{formula}: {hits} hits");
}

/// Returns where `a t^2 + 2 b t + c` is 0.
fn quadratic(a: f64, b: f64, c: f64) -> Vec<f64> {
    let root = (b * b - a * c).sqrt();
    if root.is_nan() { Vec::new() } else { vec![(-b - root) / a, (-b + root) / a] }
}

fn sphere(ray: &Ray, center: DVec3, square: f64) -> Vec<f64> {
    let from = ray.origin - center;
    quadratic(1.0, from.dot(ray.dir), from.length_squared() - square)
}

/// Returns where a function of the distance changes its sign, by small steps and bisection, unless it jumps there.
fn by_steps(value: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    let step = |k: i32| {
        let [mut low, mut high] = [1e-3 * f64::from(k), 1e-3 * f64::from(k + 1)];
        let falls = value(low) > 0.0;
        if falls == (value(high) > 0.0) || (value(low) - value(high)).abs() > 3.0 {
            return None;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if falls == (value(middle) > 0.0) { low = middle } else { high = middle }
        }
        Some((low, 1.0))
    };
    (0..12_000).filter_map(step).collect()
}

#[test]
fn a_root_of_squares_that_are_written_as_products_has_an_inside() {
    let scene = "camera eye { pixeldim 16 12 worlddim 8 6 viewpoint 4 3 6 }
        material gold { ambient 1 1 0 }
        implicit ball { material gold formula \"sqrt(x*x + y*y + z*z) - 1\" box -2 -2 -2 2 2 2 }
        sphere other { material gold center 1 0 0 radius 0.5 }
        difference left { objects ball other }";
    assert!(model(scene).objects.iter().any(|object| object.args.name() == "left"));
}

#[test]
fn a_cone_by_its_root_has_one_half_and_a_tip() {
    agrees("sqrt(x^2 + z^2) - y", |ray| {
        let signs = DVec3::new(1.0, -1.0, 1.0);
        let [a, b, c] = [(ray.dir, ray.dir), (ray.origin, ray.dir), (ray.origin, ray.origin)]
            .map(|(one, other)| one.dot(signs * other));
        quadratic(a, b, c).into_iter().map(|t| (t, ray.at(t).y)).collect()
    });
}

#[test]
fn where_a_root_is_not_defined_there_is_no_surface() {
    agrees("z - sqrt(1 - x^2 - y^2)", |ray| {
        sphere(ray, DVec3::ZERO, 1.0).into_iter().map(|t| (t, ray.at(t).z)).collect()
    });
    agrees("ln(x) - ln(y)*2", |ray| {
        let (from, dir) = (ray.origin, ray.dir);
        let roots = quadratic(dir.y * dir.y, from.y * dir.y - 0.5 * dir.x, from.y * from.y - from.x);
        roots.into_iter().map(|t| (t, ray.at(t).y)).collect()
    });
}

#[test]
fn a_jump_is_no_surface() {
    agrees("y - 0.3*floor(3*x)", |ray| {
        let step = |k: i32| {
            let t = (0.3 * f64::from(k) - ray.origin.y) / ray.dir.y;
            let beyond = 3.0 * ray.at(t).x - f64::from(k);
            (t, beyond.min(1.0 - beyond))
        };
        (-6..6).map(step).collect()
    });
    agrees("atan2(z, x) - y", |ray| by_steps(|t| ray.at(t).z.atan2(ray.at(t).x) - ray.at(t).y));
}

#[test]
fn balls_repeated_up_to_the_ends_of_the_box_are_certain() {
    let text = "(x - floor(x) - 0.5)^2 + (y - floor(y) - 0.5)^2 + (z - floor(z) - 0.5)^2 - 0.1";
    let (model, mut random) = (surface(text), Random::new(3));
    let shape = &model.objects[0].shape;
    let mut hits = 0;
    for _ in 0..500 {
        let mut point = |size: f64| DVec3::from([(); 3].map(|()| random.between(-size, size)));
        let (from, to) = (point(9.0), point(SIZE));
        let ray = Ray { origin: from, dir: (to - from).normalize() };
        let bracket = shape.packets().t_bounds(&ray.into(), &RayRange::ALL);
        assert!(!bracket.is_doubtful(), "{ray:?}");
        hits += usize::from(bracket.far < MISS);
    }
    assert!(hits > 200, "{hits}");
}

#[test]
fn a_formula_of_two_parts_has_the_surface_of_each_where_it_is_chosen() {
    agrees("if(x < 0, y - 0.5, y + 0.5 - x)", |ray| {
        let (from, dir) = (ray.origin, ray.dir);
        let [left, right] = [(0.5 - from.y) / dir.y, (from.y + 0.5 - from.x) / (dir.x - dir.y)];
        vec![(left, -ray.at(left).x), (right, ray.at(right).x)]
    });
    // Neither part is defined everywhere.
    agrees("if(x >= 0, sqrt(x) - y, y + x*x + 0*ln(-x))", |ray| {
        let (from, dir) = (ray.origin, ray.dir);
        let right = quadratic(dir.y * dir.y, from.y * dir.y - 0.5 * dir.x, from.y * from.y - from.x);
        let left = quadratic(dir.x * dir.x, from.x * dir.x + 0.5 * dir.y, from.x * from.x + from.y);
        let right = right.into_iter().map(|t| (t, ray.at(t).y.min(ray.at(t).x)));
        right.chain(left.into_iter().map(|t| (t, -ray.at(t).x))).collect()
    });
}

#[test]
fn what_fractions_repeat_is_seen_as_often_as_it_is_there() {
    agrees("(fract(x) - 0.5)^2 + (mod(y, 1) - 0.5)^2 + (z - floor(z) - 0.5)^2 - 0.1", |ray| {
        let centers =
            (0..64).map(|index| DVec3::from([index / 16, index / 4 % 4, index % 4].map(f64::from)) - 1.5);
        centers.flat_map(|center| sphere(ray, center, 0.1)).map(|t| (t, 1.0)).collect()
    });
}

#[test]
fn a_pole_is_no_surface() {
    agrees("1/x - y", |ray| {
        let (from, dir) = (ray.origin, ray.dir);
        let half = 0.5 * (from.x * dir.y + from.y * dir.x);
        quadratic(dir.x * dir.y, half, from.x * from.y - 1.0).into_iter().map(|t| (t, 1.0)).collect()
    });
    agrees("tan(x) - y", |ray| by_steps(|t| ray.at(t).x.sin() - ray.at(t).y * ray.at(t).x.cos()));
}

#[test]
fn a_slope_without_bounds_is_no_hindrance() {
    agrees("cbrt(x) - y", |ray| by_steps(|t| ray.at(t).x - ray.at(t).y.powi(3)));
}

/// The surface is where the formula is defined, as it was written: clearing a denominator adds nothing to it.
#[test]
fn a_root_where_the_formula_is_not_defined_is_no_hit() {
    use Verdict::{Hit, Miss};
    let pole = "z/y + 0.1";
    for (formula, origin, dir, expected) in [
        // In the plane y = 0, the formula is nowhere defined.
        (pole, [-0.5, 0.0, -3.0], [0.0, 0.0, 1.0], Miss),
        // Here, z/y is 1, except for 0/0.
        (pole, [-3.0, 2.0, 2.0], [4.0, -2.0, -2.0], Miss),
        (pole, [-0.5, 1.0, -3.0], [0.0, 0.0, 1.0], Hit),
        ("1/(1/x + 1/y) - 1", [0.0, 0.0, -3.0], [0.0, 0.0, 1.0], Miss),
        ("1/(1/x + 1/y) - 1", [-6.0, -3.0, 0.5], [2.0, 1.0, 0.0], Miss),
        ("1/(1/x + 1/y) - 1", [1.5, -3.0, 0.5], [0.0, 2.0, 0.0], Miss),
        ("1/(1/x + 1/y) - 0.5", [1.5, -3.0, 0.5], [0.0, 2.0, 0.0], Hit),
        ("ln(y/z) - 0.2", [-3.0, 1.0, 0.0], [1.0, 0.0, 0.0], Miss),
        ("x^-2*(y - x) + z", [0.0, 0.5, -3.0], [0.0, 0.0, 1.0], Miss),
        ("acos(y/z) - 2", [0.0, -0.5, 3.0], [0.0, 0.0, -1.0], Hit),
    ] {
        let model = surface(formula);
        let ray = QueryRay::new(origin.into(), dir.into()).expect("a ray");
        for is_tight in [false, true] {
            let [answer] = Query::new(&model).proven(std::slice::from_ref(&ray), is_tight)[..] else {
                panic!("one answer")
            };
            assert_eq!(answer.verdict, expected, "{formula} from {origin:?} along {dir:?}: {answer:?}");
        }
        let [traced] = Query::new(&model).traced(&[ray])[..] else { panic!("one answer") };
        assert_eq!(traced.verdict, expected, "{formula} from {origin:?} along {dir:?}");
    }
}

#[test]
fn an_arc_cosine_of_a_quotient_is_seen_on_both_sides_of_its_pole() {
    let model = surface("acos(y/z) - 2");
    let cos = libm::cos(2.0);
    for step in 1..40 {
        let z = 0.05 * f64::from(step) - 1.025;
        let ray = QueryRay::new(DVec3::new(0.3, cos * z, 3.0), DVec3::NEG_Z).expect("a ray");
        let [answer] = Query::new(&model).proven(&[ray], false)[..] else { panic!("one answer") };
        assert_eq!(answer.verdict, Verdict::Hit, "{z}");
        assert!((answer.t - (3.0 - z)).abs() < 1e-12, "{} is not {}", answer.t, 3.0 - z);
    }
}

/// The numbers of its rays are only enclosed, and some of them meet a pole or the middle of the box.
#[test]
fn a_camera_decides_its_rays_past_poles_and_where_planes_meet() {
    for formula in [
        "y*z",
        "x*y*z",
        "ln(y/z) - 0.2",
        "acosh(y/z) - 0.5",
        "atanh(x/z) - y",
        "1/cbrt(x - z) - 1",
        "cbrt(x*y)^-1 - 2",
        "floor(1/x) - 3*y",
    ] {
        for position in ["2.52 1.56 3.12", "1 2 4"] {
            let model = model(&format!(
                "look_at eye {{ pixeldim 32 24 position {position} target 0 0 0 angle 45 }}
                material gold {{ ambient 1 1 0 }}
                implicit it {{ material gold formula \"{formula}\" box -1.2 -1.2 -1.2 1.2 1.2 1.2 }}"
            ));
            let plan = Plan::new(&model);
            for (x, y) in (0..24).flat_map(|y| (0..32).map(move |x| (x, y))) {
                let verdict = verify::pixel(&plan, x, y).verdict;
                assert_eq!(verdict, verify::Verdict::Proven, "{formula} from {position} at {x} {y}");
            }
        }
    }
}

/// The ray leaves the box 2e-15 before the formula is 0.
#[test]
fn a_root_right_beyond_the_box_is_no_hit() {
    let model = model(
        "camera eye { pixeldim 1 1 worlddim 18.028758263580333 5.527791219658041
            viewpoint 7.827668579316519 -6.169016004237104 3.0598036802932627 }
        material gold { ambient 1 1 0 }
        implicit it {
            material gold formula \"y - exp(-1.38*(x^2 + z^2))*cos(3*x)\"
            center 9.773727013351113 8.741966451444425 -0.04903968653374724
            box -2 -2 -2 2 2 2
        }",
    );
    assert_eq!(verify::pixel(&Plan::new(&model), 0, 0).verdict, verify::Verdict::Proven);
}
