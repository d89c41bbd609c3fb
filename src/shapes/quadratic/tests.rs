use super::surface::Quadratic;
use glam::DVec3;
use tabray_world::geometry::ray::MISS;
use tabray_world::geometry::ray::RayError;

const BOX: [DVec3; 2] = [DVec3::splat(-1e9), DVec3::splat(1e9)];

fn hit(coefficients: [f64; 10], [low, high]: [DVec3; 2], origin: DVec3, dir: DVec3) -> f64 {
    let surface = Quadratic::new(coefficients, low, high);
    let ray = surface.own(origin, dir, DVec3::ZERO);
    let exact = surface.exact_hit(&ray, 0.0);
    let quick = surface.quick_hit(&ray, 0.0, RayError::NONE);
    if quick.is_missed {
        assert_eq!(exact, MISS);
    } else if !quick.is_unknown {
        assert!((quick.distance - exact).abs() <= quick.error, "{quick:?} {exact}");
        let corrected = surface.corrected(&ray, quick.distance);
        assert!(corrected.is_nan() || (corrected - exact).abs() <= 1e-15 * exact, "{corrected} {exact}");
    }
    exact
}

const SPHERE: [f64; 10] = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];

#[test]
fn balls_of_every_size_are_hit() {
    for exponent in [-150, -80, -20, 0, 20, 80, 150] {
        let radius = 10_f64.powi(exponent);
        let mut sphere = SPHERE;
        sphere[9] = radius * radius;
        let all = BOX.map(|corner| corner * radius);
        let found = hit(sphere, all, DVec3::new(0.0, 0.0, 3.0) * radius, DVec3::NEG_Z);
        assert!((found / radius - 2.0).abs() < 1e-14, "{radius:e}: {found:e}");
        assert_eq!(hit(sphere, all, DVec3::new(1.1, 0.0, 3.0) * radius, DVec3::NEG_Z), MISS);
    }
}

#[test]
fn coefficients_of_every_size_make_the_same_ball() {
    for exponent in [-301, -150, 1, 150, 301] {
        let sphere = SPHERE.map(|coefficient| coefficient * 10_f64.powi(exponent));
        let found = hit(sphere, BOX, DVec3::new(0.6, 0.0, 3.0), DVec3::NEG_Z);
        assert!((found - 2.2).abs() < 1e-14, "1e{exponent}: {found:e}");
    }
    // A sphere of radius 3e150, entirely outside of the box.
    let huge = [1e-301, 1e-301, 1e-301, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    assert_eq!(hit(huge, BOX, DVec3::new(0.6, 0.0, 3.0), DVec3::NEG_Z), MISS);
}

#[test]
fn two_planes_that_are_almost_one_are_hit_where_they_are() {
    let dir = DVec3::new(0.36, 0.48, -0.8);
    let along = dir.element_sum();
    for apart in [1e-15, 1e-30, 0.0_f64] {
        let found =
            hit([1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 0.0, 0.0, 0.0, apart], BOX, DVec3::new(0.1, 0.7, -0.3), dir);
        let truth = (0.1 + 0.7 - 0.3 - apart.sqrt()) / -along;
        assert!((found - truth).abs() < 1e-14 * truth.abs() || truth < 0.0, "{apart:e}: {found} {truth}");
    }
}

#[test]
fn straight_lines_and_planes_are_hit_once() {
    let plane = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 1.0];
    assert_eq!(hit(plane, BOX, DVec3::Z, DVec3::NEG_Z), 0.5);
    assert_eq!(hit(plane, BOX, DVec3::Z, DVec3::X), MISS);
    // A ray hits a paraboloid along its axis.
    let bowl = [1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0];
    assert_eq!(hit(bowl, BOX, DVec3::new(1.0, 0.0, 3.0), DVec3::NEG_Z), 2.0);
}
