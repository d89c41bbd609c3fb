//! The rays of cameras: where they start, where they lead, and how far they are rounded.

use crate::common::model;
use glam::{DVec2, DVec3};
use tabray::exact::double_double::DoubleDouble;
use tabray::geometry::{ImagePoint, Ray};
use tabray::render::{Plan, trace};
use tabray::tools::threads::renderer_with;
use tabray::world::Sensor;

fn sensor(camera: &str) -> Sensor {
    model(camera).camera.value
}

/// Returns a ray through a point of the lens.
fn through(sensor: &Sensor, at: [f64; 2], lens: DVec2) -> Ray {
    sensor.camera.ray(&ImagePoint { at, pixels: sensor.pixels }, lens)
}

#[test]
fn look_at_shows_what_the_notes_camera_shows() {
    let notes = sensor("camera c { pixeldim 161 121 worlddim 8 6 viewpoint 4 3 6 }");
    // 161 pixels, which are 0.05 wide, from a distance of 6.
    let angle = 2.0 * (0.5 * 161.0 * 0.05_f64 / 6.0).atan().to_degrees();
    let free = sensor(&format!("look_at c {{ pixeldim 161 121 position 4 3 6 target 4 3 0 angle {angle} }}"));
    for (x, y) in [(0.0, 0.0), (160.0, 0.0), (80.0, 60.0), (17.5, 120.0)] {
        let (one, other) = (notes.ray(x, y), free.ray(x, y));
        assert_eq!(one.origin, other.origin);
        assert!(one.dir.distance(other.dir) < 1e-14, "{x} {y}: {one:?} and {other:?}");
    }
}

#[test]
fn look_at_shows_its_target_in_the_middle_and_up_above() {
    let sensor = sensor("look_at c { pixeldim 41 31 position 1 -2 5 target -3 4 -1 up 0.3 1 0.2 angle 60 }");
    let toward = (DVec3::new(-3.0, 4.0, -1.0) - DVec3::new(1.0, -2.0, 5.0)).normalize();
    assert!(sensor.ray(20.0, 15.0).dir.distance(toward) < 1e-15);
    let (up, above) = (DVec3::new(0.3, 1.0, 0.2), sensor.ray(20.0, 30.0).dir);
    assert!((above - toward).dot(up) > 0.0 && above.dot(toward.cross(up)).abs() < 1e-14);
    let [left, right] = [-0.5, 40.5].map(|x| sensor.ray(x, 15.0).dir);
    assert!((left.angle_between(right).to_degrees() - 60.0).abs() < 1e-9);
}

#[test]
fn up_may_have_any_length() {
    for kind in ["look_at", "fisheye", "orthographic"] {
        let seen = |up: &str| {
            let size = if kind == "orthographic" { "width 7" } else { "" };
            let sensor = sensor(&format!(
                "{kind} c {{ pixeldim 41 31 position 1 -2 5 target -3 4 -1 up {up} {size} }}"
            ));
            let ray = sensor.ray(3.0, 4.0);
            [ray.origin, ray.dir]
        };
        assert_eq!(seen("1e308 1e308 0"), seen("1 1 0"), "{kind}");
        assert_eq!(seen("5e-324 0 0"), seen("1 0 0"), "{kind}");
    }
}

#[test]
fn rays_are_rounded_no_more_than_those_of_the_notes_camera() {
    let mut state = 3_u64;
    let mut random = |size: f64| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        size * (2.0 * (state >> 11) as f64 / (1_u64 << 53) as f64 - 1.0)
    };
    let mut most = 0.0_f64;
    for kind in ["look_at", "orthographic"] {
        for _ in 0..300 {
            let [px, py, pz, tx, ty, tz, ux, uy, uz] =
                [10.0, 10.0, 10.0, 3.0, 3.0, 3.0, 1.0, 1.0, 1.0].map(&mut random);
            let size = if kind == "look_at" { "angle 90" } else { "width 7" };
            let sensor = sensor(&format!(
                "{kind} c {{ pixeldim 64 48 position {px} {py} {pz} target {tx} {ty} {tz} up {ux} {uy} {uz} {size} }}"
            ));
            for _ in 0..20 {
                let (x, y) = (32.0 + random(32.0), 24.0 + random(24.0));
                let (ray, line) = (sensor.ray(x, y), sensor.sight(x, y).line::<DoubleDouble>());
                let [a, b, c] = line.dir;
                let length = (a * a + b * b + c * c).sqrt();
                for axis in 0..3 {
                    assert_eq!(line.origin[axis].high, ray.origin[axis]);
                    let off = line.dir[axis] / length - DoubleDouble::from(ray.dir[axis]);
                    most = most.max(off.high.abs() / 2_f64.powi(-53));
                }
            }
        }
    }
    assert!(most <= 3.0, "{most} units of 2^-53");
}

#[test]
fn rays_of_an_orthographic_camera_are_parallel_and_as_far_apart_as_its_width() {
    let sensor = sensor("orthographic c { pixeldim 80 60 position 1 2 9 target 4 -3 0 width 4 }");
    let [left, right] = [-0.5, 79.5].map(|x| sensor.ray(x, 10.0));
    assert_eq!(left.dir, right.dir);
    assert!((left.origin.distance(right.origin) - 4.0).abs() < 1e-14);
    let low = sensor.ray(-0.5, -0.5);
    assert!(
        (sensor.ray(-0.5, 59.5).origin.distance(low.origin) - 3.0).abs() < 1e-14,
        "its pixels are square"
    );
}

#[test]
fn the_angle_of_a_fisheye_grows_evenly() {
    let sensor = sensor("fisheye c { pixeldim 101 101 position 0 0 0 target 0 0 -1 angle 270 }");
    let middle = sensor.ray(50.0, 50.0).dir;
    for pixels in [10.0, 25.0, 50.5] {
        for (x, y) in [(50.0 + pixels, 50.0), (50.0, 50.0 - pixels)] {
            let angle = middle.angle_between(sensor.ray(x, y).dir).to_degrees();
            assert!((angle - 135.0 * pixels / 50.5).abs() < 1e-9, "{angle} after {pixels} pixels");
        }
    }
}

#[test]
fn rays_through_a_lens_meet_in_its_focus_and_nowhere_else() {
    let sensor = sensor("thin_lens c { pixeldim 40 30 position 0 0 5 target 0 0 0 aperture 0.5 focus 8 }");
    let at = [33.0, 4.0];
    let sharp = through(&sensor, at, DVec2::ZERO);
    let sharp = sharp.at(8.0 / -sharp.dir.z);
    assert!((sharp.z + 3.0).abs() < 1e-14);
    for lens in [DVec2::new(1.0, 0.0), DVec2::new(-0.6, 0.8), DVec2::new(0.0, -0.3)] {
        let ray = through(&sensor, at, lens);
        assert!((ray.origin - DVec3::new(0.25 * lens.x, 0.25 * lens.y, 5.0)).length() < 1e-15);
        assert!(ray.at(8.0 / -ray.dir.z).distance(sharp) < 1e-14);
        assert!((ray.at(4.0 / -ray.dir.z) - through(&sensor, at, DVec2::ZERO).at(4.0)).length() > 1e-3);
    }
}

/// A floor, a leaf and a triangle on the viewer's side of z = 0.
const BEFORE: &str = "material m { ambient 9 9 9 }
    fplane leaf { material m normal 0 0 1 point 3 2 2 xdir 1 0 0 dimensions 2 2 }
    triangle sail { material m vertex1 0 0 2.5 vertex2 2 0 2.5 vertex3 1 3 2.5 }
    plane floor { material m normal 0 1 0 point 0 0 0 }";

#[test]
fn planes_are_on_both_sides_of_z_0_but_for_the_notes_camera() {
    let seen = |camera: &str, at: DVec3| {
        let model = model(&format!("{camera} {BEFORE}"));
        let sensor = &model.camera.value;
        let place = (0..81 * 61).map(|index| [f64::from(index % 81), f64::from(index / 81)]);
        let angle = |[x, y]: &[f64; 2]| sensor.ray(*x, *y).dir.angle_between(at - sensor.ray(*x, *y).origin);
        let [x, y] = place.min_by(|one, other| angle(one).total_cmp(&angle(other))).expect("a pixel");
        trace::first_hit(&Plan::new(&model), &sensor.sight(x, y)).map(|hit| hit.object.args.name().to_owned())
    };
    let points = [DVec3::new(4.0, 3.0, 2.0), DVec3::new(1.0, 1.0, 2.5), DVec3::new(6.0, 0.0, 1.0)];
    let [notes, free] = [
        "camera eye { pixeldim 81 61 worlddim 8 6 viewpoint 4 3 6 }",
        "look_at eye { pixeldim 81 61 position 4 3 9 target 4 2 0 angle 70 }",
    ];
    assert_eq!(points.map(|at| seen(free, at)), ["leaf", "sail", "floor"].map(|name| Some(name.to_owned())));
    assert_eq!(seen(notes, points[0]), None, "through the leaf");
    assert_eq!(seen(notes, points[2]), Some("floor".to_owned()), "behind the image plane");
}

#[test]
fn samples_of_a_lens_are_the_same_in_packets_and_alone() {
    let model = model(
        "thin_lens eye { pixeldim 9 7 position 4 3 9 target 4 2 0 angle 50 aperture 1 samples 5 }
        material m { ambient 1 2 3 diffuse 2 2 2 }
        light l { location 1 6 5 emissivity 3 3 3 }
        sphere near { material m center 3 2 4 radius 1 }
        sphere far { material m center 5 2 -6 radius 2 }
        fplane leaf { material m normal 0 0 1 point 3 2 2 xdir 1 0 0 dimensions 2 2 }",
    );
    let plan = Plan::new(&model);
    let renderer = renderer_with(2).expect("threads");
    let mut sharp = Plan::new(&model);
    sharp.camera.samples = 1;
    let mut blurred = 0;
    for (index, bytes) in renderer.picture(&plan).chunks(3).enumerate() {
        let (x, y) = (index % 9, 6 - index / 9);
        let alone = |plan: &Plan| plan.camera.display().bytes(trace::pixel(plan, x, y));
        assert_eq!(alone(&plan), bytes, "{x} {y}");
        blurred += usize::from(alone(&sharp) != bytes);
    }
    assert!(blurred > 10, "{blurred} pixels are blurred");
}
