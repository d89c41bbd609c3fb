//! Lights that are spread out, against closed forms: areas, the sun, and the light of backgrounds.

use crate::common::{model, model_in, render, root};
use glam::DVec3;
use image::{Rgb, Rgb32FImage};
use std::f64::consts::PI;
use tabray::render::Plan;
use tabray::render::trace;
use tabray::scene::Model;
use tabray::tools::threads::renderer_with;
use tabray::world::sample::Sampler;
use tempfile::TempDir;

/// Looks straight down at the origin of a matt floor, or along `up` at a surface that faces it.
fn at_origin(normal: DVec3, rest: &str) -> String {
    let eye = 0.01 * normal;
    format!(
        "look_at eye {{ pixeldim 1 1 position {} {} {} target 0 0 0 up 0.3 0.2 0.9 angle 0.001 }}
         material matt {{ diffuse 0.8 0.4 0.2 }}
         disc floor {{ material matt center 0 0 0 normal {} {} {} radius 0.001 }} {rest}",
        eye.x, eye.y, eye.z, normal.x, normal.y, normal.z
    )
}

/// Returns the colour of the pixel by a number of samples.
fn seen(model: &Model, samples: u32) -> DVec3 {
    let mut plan = Plan::new(model);
    plan.camera.samples = samples;
    plan.camera.sampler = Sampler::Sobol;
    trace::pixel(&plan, 0, 0)
}

/// Returns what a polygon of radiance 1 adds to a point at the origin with this normal and the diffuse colour 1, if all of it
/// is above the horizon (Lambert's formula).
fn lambert(normal: DVec3, corners: &[DVec3]) -> f64 {
    let sides = (0..corners.len()).map(|index| {
        let [one, next] = [corners[index], corners[(index + 1) % corners.len()]].map(DVec3::normalize);
        let across = one.cross(next);
        one.dot(next).clamp(-1.0, 1.0).acos() * normal.dot(across.normalize())
    });
    (sides.sum::<f64>() / (2.0 * PI)).abs()
}

#[test]
fn a_rectangle_lights_as_its_form_factor_says() {
    for (location, target, [width, height]) in [
        (DVec3::new(0.0, 1.0, 0.0), DVec3::ZERO, [1.0, 1.0]),
        (DVec3::new(0.2, 0.05, -0.1), DVec3::new(0.2, 0.0, -0.1), [2.0, 3.0]),
        (DVec3::new(3.0, 2.5, 1.0), DVec3::new(1.0, 1.0, 4.0), [2.0, 1.5]),
        (DVec3::new(-30.0, 40.0, 10.0), DVec3::ZERO, [1.0, 0.5]),
        (DVec3::new(1.0, 60.0, 2.0), DVec3::new(0.0, 20.0, 40.0), [1.5, 1.0]),
    ] {
        let scene = at_origin(
            DVec3::Y,
            &format!(
                "area_light a {{ location {} {} {} target {} {} {} dimensions {width} {height} emissivity 3 3 3 visible no }}",
                location.x, location.y, location.z, target.x, target.y, target.z
            ),
        );
        let facing = (target - location).normalize();
        let across = DVec3::Y.cross(facing);
        let across = if across.length() < 1e-6 { DVec3::X } else { across.normalize() };
        let (across, up) = (0.5 * width * across, 0.5 * height * facing.cross(across));
        let corner = |x: f64, y: f64| location + x * across + y * up;
        let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        let expected = 3.0 * lambert(DVec3::Y, &corners) * DVec3::new(0.8, 0.4, 0.2);
        let found = seen(&model(&scene), 4096);
        let off = (found - expected).abs().max_element() / expected.max_element();
        assert!(off < 1e-3, "{location}: {found}, not {expected}");
    }
}

#[test]
fn a_disc_lights_as_its_form_factor_says() {
    for (height, radius) in [(1.0, 0.5), (0.05, 2.0), (1.0, 1.0), (40.0, 1.0)] {
        let scene = at_origin(
            DVec3::Y,
            &format!(
                "area_light a {{ location 0 {height} 0 target 0 0 0 radius {radius} emissivity 2 2 2 }}"
            ),
        );
        let expected = 2.0 * 0.8 * radius * radius / (radius * radius + height * height);
        // The lamp is behind the viewer's back, and the floor does not hide it.
        let found = seen(&model(&scene), 4096).x;
        assert!((found - expected).abs() < 3e-3 * expected, "{height}, {radius}: {found}, not {expected}");
    }
}

/// Returns what a ball of radiance 1 adds to a surface of diffuse colour 1 that sees its middle at this cosine, where `square`
/// is the square of its radius over its distance, also where it is partly below the horizon (Lagarde and de Rousiers, "Moving
/// Frostbite to Physically Based Rendering", 2014, listing 7, over pi).
fn from_ball(cosine: f64, square: f64) -> f64 {
    if cosine * cosine > square {
        return square * cosine.max(0.0);
    }
    let sine = (1.0 - cosine * cosine).sqrt();
    let x = (1.0 / square - 1.0).sqrt();
    let y = -x * cosine / sine;
    let root = sine * (1.0 - y * y).sqrt();
    ((cosine * y.acos() - x * root) * square + (root / x).atan()).max(0.0) / PI
}

#[test]
fn a_sphere_lights_as_its_form_factor_says() {
    // Facing, tilted, touching the horizon, partly below it, nearly all below it, near, and far away.
    for (middle, radius) in [
        (DVec3::new(0.0, 2.0, 0.0), 1.0),
        (DVec3::new(3.0, 2.0, -1.0), 0.8),
        (DVec3::new(3.0, 1.0, -1.0), 1.0),
        (DVec3::new(1.0, 0.3, 0.5), 0.9),
        (DVec3::new(1.0, -0.5, 0.5), 0.9),
        (DVec3::new(0.0, 1.01, 0.0), 1.0),
        (DVec3::new(0.3, 0.0, 0.1), 0.25),
        (DVec3::new(-2e4, 3e4, 1e4), 1.0),
    ] {
        for visible in ["yes", "no"] {
            let scene = at_origin(
                DVec3::Y,
                &format!(
                    "sphere_light a {{ location {} {} {} radius {radius} emissivity 3 3 3 visible {visible} }}",
                    middle.x, middle.y, middle.z
                ),
            );
            let square = radius * radius / middle.length_squared();
            let expected = 3.0 * from_ball(middle.normalize().y, square) * DVec3::new(0.8, 0.4, 0.2);
            let found = seen(&model(&scene), 4096);
            let off = (found - expected).abs().max_element() / expected.max_element();
            assert!(off < 2e-3, "{middle}, {radius}: {found}, not {expected}");
        }
    }
}

#[test]
fn inside_a_sphere_of_light_a_surface_shows_its_radiance() {
    let scene = at_origin(DVec3::Y, "sphere_light a { location 0.3 0.2 0 radius 1 emissivity 0.5 0.5 0.5 }");
    let found = seen(&model(&scene), 4096);
    assert!((found - 0.5 * DVec3::new(0.8, 0.4, 0.2)).length() < 1e-3, "{found}");
}

#[test]
fn a_sun_adds_its_emissivity_to_what_faces_it() {
    for (angle, direction) in
        [(0.0, DVec3::Y), (0.53, DVec3::new(1.0, 2.0, -0.5)), (60.0, DVec3::new(0.3, 1.0, 0.2))]
    {
        let DVec3 { x, y, z } = direction;
        let scene = at_origin(
            DVec3::Y,
            &format!("sun s {{ direction {x} {y} {z} angle {angle} emissivity 1.5 1.5 1.5 }}"),
        );
        // As a ball that is seen at this angle: radiance times pi times the square of the sine, times the cosine.
        let expected = 1.5 * 0.8 * direction.normalize().y;
        let found = seen(&model(&scene), 1024).x;
        assert!((found - expected).abs() < 1e-3 * expected, "{angle}: {found}, not {expected}");
    }
}

#[test]
fn an_even_background_shows_a_convex_surface_in_its_colour() {
    // The sky law, at any number of samples.
    for (samples, light) in [(1, 0.7), (3, 0.7), (16, 0.25)] {
        let model = model(&format!(
            "look_at eye {{ pixeldim 40 30 position 0 0.5 4 target 0 0 0 angle 40 samples {samples} transfer linear }}
             material matt {{ diffuse 0.8 0.4 1 }} background b {{ colour {light} {light} {light} lights yes }}
             ellipsoid e {{ material matt center 0 0 0 radius 1 scale 1 0.7 0.8 }}"
        ));
        let plan = Plan::new(&model);
        let mut on_it = 0;
        for (x, y) in (0..40).flat_map(|x| (0..30).map(move |y| (x, y))) {
            let colour = trace::pixel(&plan, x, y);
            let expected = light * DVec3::new(0.8, 0.4, 1.0);
            let is_around = (colour - DVec3::splat(light)).abs().max_element() < 1e-12;
            let is_on_it = (colour - expected).abs().max_element() < 1e-12;
            on_it += usize::from(is_on_it);
            // Pixels of the outline are between the two.
            assert!(is_around || is_on_it || samples > 1, "{x}, {y}: {colour}");
        }
        assert!(on_it > 300, "{samples}: {on_it}");
    }
}

#[test]
fn a_sky_lights_as_the_integral_of_its_gradient_says() {
    let sky = "sky s { horizon 0.2 0.2 0.2 zenith 1 1 1 ground 0.5 0.5 0.5 lights yes }";
    // Over the upper half, the mean of the sine by the cosine is 2/3.
    let found = seen(&model(&at_origin(DVec3::Y, sky)), 4096).x;
    assert!((found / 0.8 - (0.2 + 0.8 * 2.0 / 3.0)).abs() < 1e-3, "{found}");
    let found = seen(&model(&at_origin(DVec3::NEG_Y, sky)), 4096).x;
    assert!((found / 0.8 - 0.5).abs() < 1e-3, "{found}");
}

/// Writes a map that is dim but for a small lamp, and returns its folder.
fn map() -> TempDir {
    let folder = TempDir::new().expect("a folder");
    let mut map = Rgb32FImage::from_pixel(128, 64, Rgb([0.2, 0.3, 0.5]));
    for (x, y) in [(90, 20), (91, 20), (90, 21), (91, 21)] {
        map.put_pixel(x, y, Rgb([900.0, 800.0, 600.0]));
    }
    map.save(folder.path().join("lamp.exr")).expect("a map");
    folder
}

#[test]
fn an_environment_lights_as_the_sum_over_its_map_says() {
    let folder = map();
    let text = |normal: DVec3, lights: &str| {
        at_origin(
            normal,
            &format!("texture t {{ filename lamp.exr }} environment e {{ texture t lights {lights} }}"),
        )
    };
    let background = model_in(folder.path(), &text(DVec3::Y, "no")).background.expect("a background").value;
    for normal in [DVec3::Y, DVec3::NEG_Z, DVec3::new(0.6, 0.2, 0.4).normalize()] {
        let (mut expected, count) = (DVec3::ZERO, 1024);
        for (column, row) in (0..2 * count).flat_map(|column| (0..count).map(move |row| (column, row))) {
            let around = PI * (f64::from(column) + 0.5) / f64::from(count);
            let height = 2.0 * (f64::from(row) + 0.5) / f64::from(count) - 1.0;
            let flat = (1.0 - height * height).sqrt();
            let toward = DVec3::new(flat * around.sin(), height, -flat * around.cos());
            expected += toward.dot(normal).max(0.0) * background.colour_toward(toward);
        }
        expected *= 4.0 / f64::from(2 * count * count);
        let found = seen(&model_in(folder.path(), &text(normal, "yes")), 4096) / DVec3::new(0.8, 0.4, 0.2);
        let off = ((found - expected) / expected).abs().max_element();
        assert!(off < 1e-2, "{normal}: {found}, not {expected}");
    }
}

#[test]
fn threads_change_no_byte_of_spread_out_light() {
    for name in [
        "entities/area_light.ray",
        "entities/sphere_light.ray",
        "entities/sun.ray",
        "sky/lights.ray",
        "environment/lights.ray",
    ] {
        let path = root().join("scenes").join(name);
        let mut model = crate::common::load(&path);
        model.camera.value.pixels = [48, 36];
        model.camera.value.samples = 4;
        let [one, three] =
            [1, 3].map(|threads| renderer_with(threads).expect("threads").picture(&Plan::new(&model)));
        assert!(one == three, "{name}");
    }
}

/// A scene lit by an area and the sun, whose lengths all carry a factor.
fn scaled(s: f64) -> String {
    let l = |lengths: &[f64]| lengths.iter().map(|length| format!("{:?} ", length * s)).collect::<String>();
    format!(
        "look_at eye {{ pixeldim 24 16 samples 4 position {} target {} angle 42 }}
         sky day {{ lights yes }}
         material matt {{ diffuse 0.5 0.4 0.3 specular 0.1 shininess 20 }}
         disc ground {{ material matt center 0 0 0 radius {} }}
         sphere ball {{ material matt center {} radius {} }}
         area_light a {{ location {} target 0 0 0 dimensions {} emissivity 6 6 6 visible no }}
         area_light b {{ location {} target 0 0 0 radius {} emissivity 6 6 6 }}
         sphere_light c {{ location {} radius {} emissivity 2 2 2 }}
         sun s {{ direction 1 2 3 angle 3 emissivity 0.3 0.3 0.3 }}",
        l(&[2.7, 2.0, 3.9]),
        l(&[0.0, 0.4, 0.0]),
        l(&[9.0]),
        l(&[0.3, 0.5, 0.4]),
        l(&[0.5]),
        l(&[-2.0, 2.0, 0.5]),
        l(&[0.7, 0.4]),
        l(&[0.5, 1.5, -1.5]),
        l(&[0.3]),
        l(&[-0.7, 0.3, 0.9]),
        l(&[0.2])
    )
}

#[test]
fn spread_out_light_does_not_depend_on_the_scale() {
    let whole = render(&model(&scaled(1.0)));
    for exponent in [-20, -3, 20] {
        assert!(render(&model(&scaled(f64::powi(2.0, exponent)))) == whole, "2^{exponent}");
    }
    let other = render(&model(&scaled(1000.0)));
    let differ = other.pixels().zip(whole.pixels()).filter(|(one, other)| one != other).count();
    assert!(differ <= 4, "{differ} pixels differ");
}
