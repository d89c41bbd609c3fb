//! F06 to F11: planes and rectangles.

use super::{DOWN_Z, Random, distance, holds, refusal, shape, text, words};
use crate::common::model;
use glam::{DVec3, dvec3};
use tabray::geometry::{Aabb, MISS, Ray, Sight};
use tabray::render::{Plan, trace};

/// The notes' `hits_plane`, which computes N.Q once and takes a ray for parallel if N.D is exactly 0.
fn naive(origin: DVec3, dir: DVec3, normal: DVec3, point: DVec3) -> Option<f64> {
    let toward = normal.dot(dir);
    (toward != 0.0).then(|| (normal.dot(point) - normal.dot(origin)) / toward)
}

fn plane(normal: DVec3, point: DVec3) -> String {
    format!("plane p {{ material m normal {} point {} }}", words(normal), words(point))
}

/// F06: the two terms of N.Q are 6e7 in magnitude, and the distance is 1e-3.
#[test]
fn a_plane_far_from_the_origin_is_hit_to_the_last_digit() {
    let (normal, eye) = (dvec3(0.6, 0.8, 0.0), dvec3(1e8, -7.5e7, 0.0));
    let point = dvec3(1e8 + 0.6e-3, -7.5e7 + 0.8e-3, 0.0);
    let truth = 9.999960660934448e-4;
    let off = naive(eye, normal, normal, point).expect("a hit, if a wrong one") - truth;
    assert!(off.abs() > 1e-9, "{off:e}");
    holds(distance(&*shape(&plane(normal, point)), eye, normal), truth, 2.0);
}

/// F07: a ray's numbers are taken as they are: one that sinks by 1e-17 per unit meets the floor after 1e17 units, not
/// before.
#[test]
fn a_ray_along_a_plane_misses_and_one_that_sinks_hits_it_where_that_leads() {
    let eye = DVec3::Y;
    let floor = shape(&plane(DVec3::Y, DVec3::ZERO));
    assert_eq!(distance(&*floor, eye, DVec3::X), MISS);
    assert_eq!(distance(&*floor, eye, dvec3(1.0, 1e-17, 0.0)), MISS);
    holds(distance(&*floor, eye, dvec3(1.0, -1e-17, 0.0)), 1e17, 1.0);
    holds(distance(&*floor, eye, dvec3(1.0, -1e-9, 0.0)), 1e9, 1.0);
}

/// F07: once normalized, N and N x K are exactly perpendicular in less than half of all cases. A ray that is parallel
/// up to the rounding of its direction meets the plane farther away than anything else, and not at all if it starts in
/// the plane.
#[test]
fn rays_along_any_plane_hit_nothing_near() {
    let mut random = Random(21);
    let mut vector = || DVec3::from([0; 3].map(|_| random.whole(-9, 9) as f64));
    let (mut parallel, mut naive_hits, mut range) = (0, 0, 0);
    for index in 0..3_000 {
        let (normal, other, eye) = (vector(), vector(), vector());
        let (Some(unit), Some(dir)) = (normal.try_normalize(), normal.cross(other).try_normalize()) else {
            continue;
        };
        // Every third eye lies in the plane, since its coordinates are integers.
        let eye = if index % 3 == 0 { normal.cross(eye) } else { eye };
        let away = normal.dot(eye).abs() / normal.length();
        parallel += 1;
        range += u32::from(away == 0.0);
        naive_hits +=
            u32::from(naive(eye, dir, unit, DVec3::ZERO).is_some_and(|hit| hit > 0.0 && hit < 1e14));
        let hit = distance(&*shape(&plane(normal, DVec3::ZERO)), eye, dir);
        // The direction's components have errors of at most 2^-53.
        let is_far = away > 0.0 && hit >= away * 2.0_f64.powi(52);
        assert!(hit == MISS || is_far, "normal {normal}, eye {eye}, along {dir}: {hit:e}");
    }
    assert!(naive_hits * 50 > parallel && range > 500, "{naive_hits} of {parallel}, {range} in the plane");
}

/// Most rays that leave a surface lead away from most planes, and those planes are not tested.
#[test]
fn ways_without_an_end_are_clear_of_the_planes_that_they_lead_away_from() {
    let up_from = |height: f64| Aabb { low: dvec3(-4.0, height, -9.0), high: DVec3::INFINITY };
    let floor = shape(&plane(DVec3::Y, DVec3::ZERO));
    assert!(floor.is_clear_of(&up_from(0.1)) && !floor.is_clear_of(&up_from(0.0)));
    assert!(!floor.is_clear_of(&Aabb { low: DVec3::NEG_INFINITY, high: DVec3::INFINITY }));
    let slope = shape(&plane(dvec3(0.0, 1.0, 1.0), DVec3::ZERO));
    assert!(slope.is_clear_of(&up_from(9.1)) && !slope.is_clear_of(&up_from(8.9)));
    assert!(!slope.is_clear_of(&Aabb { low: dvec3(0.0, 9.1, f64::NEG_INFINITY), high: DVec3::INFINITY }));
}

/// F08: the test `h_z > 0`, without a margin for rounding, drops pixels of a plane that lies in the image plane.
#[test]
fn a_plane_in_the_screen_is_seen_through_every_pixel() {
    let scene = model(
        "camera c { pixeldim 640 480 worlddim 8 6 viewpoint 4 3 7 } material m { ambient 1 1 1 }
         plane p { material m normal 0 0 1 point 0 0 0 }",
    );
    let (mut dropped, mut seen) = (0, 0);
    for (x, y) in (0..640).flat_map(|x| (0..480).map(move |y| (x, y))) {
        let ray = scene.camera.value.ray(f64::from(x), f64::from(y));
        let hit =
            naive(ray.origin, ray.dir, DVec3::Z, DVec3::ZERO).expect("no ray is parallel to the screen");
        dropped += u32::from(ray.at(hit).z > 0.0);
        seen += u32::from(scene.objects[0].shape.distance(&ray, &tabray::geometry::RayRange::ALL) < MISS);
    }
    assert!(dropped > 100, "{dropped}");
    assert_eq!(seen, 640 * 480);
}

/// F08: the rule itself is kept, as in the images of the course: a plane in front of the image plane casts no shadow.
#[test]
fn a_plane_in_front_of_the_screen_is_not_there() {
    let (point, to_light) = (dvec3(4.0, 0.0, -2.0), dvec3(0.0, 8.0, 6.0).normalize());
    holds(naive(point, to_light, DVec3::Z, DVec3::Z).expect("a hit"), 5.0, 1.0);
    assert_eq!(distance(&*shape(&plane(DVec3::Z, DVec3::Z)), point, to_light), MISS);
}

/// Projects a direction onto a plane as the notes do, and normalizes it.
fn projected(normal: DVec3, xdir: DVec3) -> DVec3 {
    (xdir - normal.dot(xdir) * normal).normalize()
}

/// F09: what rounding leaves of the projection becomes the reversed normal itself once it is normalized.
#[test]
fn an_xdir_along_the_normal_is_refused() {
    let normal = DVec3::ONE / 3.0_f64.sqrt();
    let dir = projected(normal, normal);
    assert!(dir.is_nan() || dir.dot(normal).abs() > 0.99, "{dir}");
    for (normal, xdir) in
        [("1 1 1", "1 1 1"), ("1 2 3", "2 4 6"), ("1 1 1", "-7 -7 -7"), ("1 0 0", "1 1e-9 0")]
    {
        let object =
            format!("fplane f {{ material m normal {normal} point 0 0 0 xdir {xdir} dimensions 1 1 }}");
        let message = refusal(&object);
        assert!(message.contains("has an `xdir` parallel to its `normal`"), "{message}");
    }
}

/// F09: with a normal that is not a unit vector, the notes' projection of (1, 0, 0) leaves the plane.
#[test]
fn a_long_normal_does_not_tilt_the_sides() {
    let normal = dvec3(1.0, 0.0, 1.0);
    assert_eq!(projected(normal, DVec3::X).dot(normal), -1.0);
    let pane = shape("fplane f { material m normal 1 0 1 point 0 0 -9 xdir 1 0 0 dimensions 2 1 }");
    // The first side runs to (1.41, 0, -10.41), and the second one upward.
    for (x, range) in [(0.01, true), (1.41, true), (-0.01, false), (1.42, false)] {
        let hit = distance(&*pane, dvec3(x, 0.5, 0.0), DOWN_Z);
        assert_eq!(hit < MISS, range, "at x = {x}");
        assert!(!range || (hit - (9.0 + x)).abs() < 1e-14, "{hit} at x = {x}");
    }
}

/// F10: with the notes' form, about three of a hundred rays at the seam of two tilted rectangles fall through.
#[test]
fn no_ray_falls_through_the_seam_of_two_rectangles() {
    // The first side runs along (3/5, 0, -4/5), so that the corners are exact in the last digit and the two edges truly
    // coincide.
    let tilted = dvec3(4.0, 1.5, 3.0);
    let normal = tilted.normalize();
    let across = projected(normal, dvec3(3.0, 0.0, -4.0));
    let up = normal.cross(across);
    let corners = [dvec3(-37.5, 20.75, -41.25), dvec3(-36.0, 20.75, -43.25)];
    let panes = corners.map(|corner| {
        let object = format!(
            "fplane f {{ material m normal {} point {} xdir 3 0 -4 dimensions 2.5 2 }}",
            words(tilted),
            words(corner),
        );
        shape(&object)
    });
    let contains = |corner: DVec3, at: DVec3| {
        let from_corner = at - corner;
        (0.0..=2.5).contains(&across.dot(from_corner)) && (0.0..=2.0).contains(&up.dot(from_corner))
    };
    let mut random = Random(11);
    let (mut naive_lost, mut lost) = (0, 0);
    for _ in 0..100_000 {
        let target = corners[1] + random.between(0.1, 1.9) * up;
        let eye = dvec3(random.between(-5.0, 5.0), random.between(-5.0, 5.0), 8.0);
        let dir = (target - eye).normalize();
        let at = eye + naive(eye, dir, normal, corners[0]).expect("no such ray is parallel") * dir;
        naive_lost += u32::from(!corners.iter().any(|corner| contains(*corner, at)));
        lost += u32::from(panes.iter().all(|pane| distance(&**pane, eye, dir) == MISS));
    }
    assert!(naive_lost > 1_000, "{naive_lost}");
    assert_eq!(lost, 0, "of 100000");
}

/// F10, for the edge that two triangles share.
#[test]
fn no_ray_falls_through_the_seam_of_two_triangles() {
    let [a, b] = [dvec3(0.3, 0.7, -1.1), dvec3(1.7, 2.9, -3.7)];
    let [left, right] = [dvec3(-1.2, 2.3, -2.9), dvec3(3.1, 1.3, -1.7)];
    let triangle = |corners: [DVec3; 3]| {
        let [a, b, c] = corners.map(words);
        shape(&format!("triangle t {{ material m vertex1 {a} vertex2 {b} vertex3 {c} }}"))
    };
    let both = [triangle([a, b, left]), triangle([b, a, right])];
    let mut random = Random(12);
    let mut lost = 0;
    for _ in 0..100_000 {
        let target = a + random.between(0.05, 0.95) * (b - a);
        let eye = dvec3(random.between(-5.0, 5.0), random.between(-5.0, 5.0), 8.0);
        let dir = (target - eye).normalize();
        lost += u32::from(both.iter().all(|triangle| distance(&**triangle, eye, dir) == MISS));
    }
    assert_eq!(lost, 0, "of 100000");
}

/// F11: a vector without a direction becomes NaN, and NaN passes every test of the form `if x < 0 { miss }`.
#[test]
fn a_normal_without_a_direction_is_refused_where_it_stands() {
    let unit = DVec3::ZERO / DVec3::ZERO.length();
    assert!(unit.is_nan() && !(unit.dot(DVec3::Z) < 0.0));
    let message = refusal("plane p {\n material m\n normal 0 0 0\n point 0 0 0 }");
    assert!(message.contains("normal 0 0 0") && message.contains("scene:5"), "{message}");
}

/// F07 and F14 together: a floor that is seen up to its horizon has a colour in every pixel.
#[test]
fn a_floor_has_a_colour_up_to_the_horizon() {
    let floor =
        "plane floor { material m normal 0 1 0 point 0 0 0 } light l { location 4 3 1 emissivity 9 9 9 }";
    let scene = model(&text("", floor));
    for slope in [1e-3, 1e-9, 1e-15, 1e-17, 1e-300, 0.0] {
        let ray = Ray { origin: DVec3::Y, dir: dvec3(0.6, -slope, -0.8) };
        assert!(
            trace::colour(&Plan::new(&scene), &Sight::along(&ray), None).is_finite(),
            "at a slope of {slope:e}"
        );
    }
}
