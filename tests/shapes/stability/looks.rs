//! F12 to F14: colours.

use super::{DOWN_Z, Random, shape, text};
use crate::common::{model, render};
use glam::{DVec3, dvec3};
use std::f64::consts::{PI, TAU};
use tabray::geometry::{Ray, Sight};
use tabray::render::{Plan, to_byte, trace};
use tabray::scene::{Choice, Model};
use tabray::world::material::Reflectivity;
use tabray::world::{Accuracy, Rgb, SurfacePoint};

/// Returns the ambient colour of the first object at a point.
fn look(model: &Model, at: DVec3) -> Rgb {
    let object = &model.objects[0];
    object.shader.colour_at(Reflectivity::Ambient, &object.material, &SurfacePoint::at(at))
}

/// Returns the notes' angle around z, from 0 to pi.
fn naive_angle(x: f64, y: f64) -> f64 {
    (x / (x * x + y * y).sqrt()).acos()
}

fn rainbow() -> Model {
    model(&text("", "pplane p { material m normal 0 0 1 point 0 0 0 shader 1 }"))
}

/// Returns the rainbow's colour: 6 (1 + cos(2 angle + k 2 pi / 3)) in channel k.
fn rainbow_colour(angle: f64) -> Rgb {
    Rgb::from([0.0, 1.0, 2.0].map(|third| 6.0 * (1.0 + (2.0 * angle + third * TAU / 3.0).cos())))
}

/// F12: at the shader's own point the notes' angle is NaN.
#[test]
fn a_rainbow_has_a_colour_at_its_own_point() {
    assert!(naive_angle(0.0, 0.0).is_nan());
    assert!(naive_angle(1e-160, 0.0).is_nan(), "of {}", 1e-160 / (1e-160_f64 * 1e-160).sqrt());
    let rainbow = rainbow();
    assert!(look(&rainbow, DVec3::ZERO).is_finite());
    for (x, y, angle) in [
        (1e-160, 0.0, 0.0),
        (1e-170, 0.0, 0.0),
        (0.0, 1e-170, PI / 2.0),
        (-1e-160, 1e-160, 0.75 * PI),
        (1e-300, -1e-300, -PI / 4.0),
        (1e200, 1e200, PI / 4.0),
    ] {
        let (colour, expected) = (look(&rainbow, dvec3(x, y, 0.0)), rainbow_colour(angle));
        assert!(colour.abs_diff_eq(expected, 1e-13), "{colour} is not {expected} at ({x:e}, {y:e})");
    }
}

/// F12: near 0 and pi, an arc cosine has half of its digits.
#[test]
fn a_rainbow_is_smooth_beside_the_axis() {
    assert_eq!(naive_angle(1.0, 1e-9), 0.0);
    let rainbow = rainbow();
    for (x, y, angle) in
        [(1.0, 1e-9, 1e-9), (1.0, -1e-9, -1e-9), (-1.0, 1e-9, PI - 1e-9), (3.0, 1.5e-8, 5e-9)]
    {
        let (colour, expected) = (look(&rainbow, dvec3(x, y, 0.0)), rainbow_colour(angle));
        assert!(colour.abs_diff_eq(expected, 1e-13), "{colour} is not {expected} at ({x}, {y:e})");
    }
}

/// F12: on a sphere, the notes' test for the lower half always fails, so that the lower half looks like the upper one.
/// The look is kept.
#[test]
fn an_angular_sphere_has_a_colour_at_its_poles() {
    let sphere = model(&text("", "psphere s { material m center 0 0 0 radius 1 shader 0 }"));
    for z in [1.0, -1.0] {
        assert!(naive_angle(0.0, 0.0).is_nan());
        assert!(look(&sphere, dvec3(0.0, 0.0, z)).is_finite());
        assert!(look(&sphere, dvec3(1e-170, 0.0, z)).is_finite());
    }
    for angle in [0.3, 1.0, 2.0, 3.0_f64] {
        let at = |angle: f64| look(&sphere, dvec3(angle.cos(), angle.sin(), 0.0));
        let expected = rainbow_colour(TAU - angle) / 6.0;
        assert!(at(angle).abs_diff_eq(expected, 1e-13), "{} is not {expected} at {angle}", at(angle));
        assert!(at(-angle).abs_diff_eq(expected, 1e-13), "{} is not {expected} at -{angle}", at(-angle));
    }
}

/// F12, in an image: no pixel is black.
#[test]
fn every_pixel_of_a_rainbow_has_a_colour() {
    let picture = render(&model(
        "camera c { pixeldim 17 13 worlddim 8 6 viewpoint 4 3 6 } material m { ambient 1 1 1 }
         pplane p { material m normal 0 0 1 point 4 3 -1 shader 1 }",
    ));
    assert!(picture.pixels().all(|pixel| pixel.0.iter().map(|channel| u32::from(*channel)).sum::<u32>() > 0));
}

/// Returns the number of the notes' tile at a coordinate.
fn naive_tile(x: f64) -> i32 {
    (2.0 * x + 1000.0) as i32
}

/// F13: casts truncate toward 0, where two tiles become one, and saturate at numbers too large for an integer.
#[test]
fn tiles_are_as_wide_at_negative_far_coordinates() {
    assert_eq!((naive_tile(-500.49), naive_tile(-499.51)), (0, 0), "a tile of twice the width");
    assert_eq!(naive_tile(1.1e9), naive_tile(2e9), "one tile for all larger coordinates");
    assert_eq!(naive_tile(2e9).checked_add(naive_tile(2e9)), None);
    let floor = model(&text("", "pplane p { material m normal 0 1 0 point 0 0 0 shader 0 }"));
    let is_cyan = |x: f64, z: f64| look(&floor, dvec3(x, 0.0, z)).x == 0.0;
    for middle in [-500.25, -499.75, -1234.25, 0.25, -0.25, 7.75, 1.1e9 + 0.25, -2e9 - 0.75, 1e12 + 0.25] {
        // The steps lead from the middle of one tile to that of the next, along x and along z.
        for (step, same) in
            [(0.5, false), (-0.5, false), (1.0, true), (-1.0, true), (0.2, true), (-0.2, true)]
        {
            assert_eq!(
                is_cyan(middle, 0.25) == is_cyan(middle + step, 0.25),
                same,
                "x from {middle} by {step}"
            );
            assert_eq!(
                is_cyan(0.25, middle) == is_cyan(0.25, middle + step),
                same,
                "z from {middle} by {step}"
            );
        }
        assert_eq!(is_cyan(middle, middle), is_cyan(0.25, 0.25), "the diagonal has one colour");
    }
}

fn tiled_wall(normal: &str, point: &str, dimensions: &str) -> Model {
    model(&text(
        "",
        &format!(
            "material other {{ ambient 0 0 1 }}
             tiled_plane p {{ material m altmaterial other normal {normal} point {point} xdir 0 0 1 dimensions {dimensions} }}"
        ),
    ))
}

/// F13, for tiles of any size, which the notes count from -100000.
#[test]
fn tiles_of_a_plane_are_as_wide_beyond_the_notes_offset() {
    let naive = |x: f64| (x + 100_000.0).trunc();
    assert_eq!(naive(-100_000.4), naive(-99_999.6));
    let floor = tiled_wall("0 1 0", "0 0 0", "1 1");
    let is_other = |z: f64| look(&floor, dvec3(0.5, 0.0, z)).x == 0.0;
    for middle in [-100_000.5, -99_999.5, 0.5, -0.5, 3e9 + 0.5, -3e9 - 0.5] {
        for (step, same) in [(1.0, false), (-1.0, false), (2.0, true), (0.4, true), (-0.4, true)] {
            assert_eq!(is_other(middle) == is_other(middle + step), same, "from {middle} by {step}");
        }
    }
}

/// F13: a wall at the edge of a tile has the tiles of its own two directions; the third coordinate, which rounding may
/// move either way, does not count.
#[test]
fn a_wall_on_the_edge_of_a_tile_has_no_speckles() {
    let naive = |x: f64| (2.0 * x).floor();
    assert_ne!(naive(0.5), naive(0.5_f64.next_down()));
    let wall = tiled_wall("1 0 0", "0.5 0 0", "0.5 0.5");
    for (y, z) in [(0.25, -0.25), (3.8, -7.1), (1.3, -2.4)] {
        let looks = [0.5, 0.5_f64.next_down(), 0.5_f64.next_up()].map(|x| look(&wall, dvec3(x, y, z)));
        assert!(looks.iter().all(|look| *look == looks[0]), "{looks:?}");
    }
}

/// F14: casts of a channel that is not a number, or too large. As an integer, 1.004 becomes 256, of which a byte keeps
/// 0; and a NaN, such as 0 times infinity, stays NaN when it is clamped.
#[test]
fn a_channel_is_a_byte_whatever_it_is() {
    let bytes =
        [f64::NAN, -1.0, -0.0, 0.999, 1.0, 1.004, 1e300, f64::INFINITY, f64::NEG_INFINITY].map(to_byte);
    assert_eq!(bytes, [0, 0, 0, 254, 255, 255, 255, 255, 0]);
}

/// F14: cos / distance, with the light on the surface or nearly on it.
#[test]
fn a_light_on_the_surface_blinds_nobody() {
    assert!((0.0 * (1.0 / 0.0_f64)).is_nan());
    for above in [0.0, 1e-310, 1e-200, 1e-160, 1e-20, 1e-9] {
        for emissivity in ["1 1 1", "0 0 0", "1 0 0"] {
            let object = format!(
                "plane p {{ material m normal 0 0 1 point 0 0 0 }}
                 light l {{ location 0 0 {above} emissivity {emissivity} }}"
            );
            let scene = model(&text("", &object));
            let ray = Ray { origin: 2.0 * DVec3::Z, dir: DOWN_Z };
            let colour = trace::colour(&Plan::new(&scene), &Sight::along(&ray), None);
            assert!(!colour.is_nan(), "{colour} of {emissivity} from {above:e} above");
            assert!(
                colour.min_element() >= 0.5,
                "{colour}: the ambient half is there whatever the light does"
            );
        }
    }
}

/// F14: a surface on which a light lies does not block its light, however the two equal distances are rounded.
#[test]
fn a_light_on_a_wall_lights_the_floor_evenly() {
    let scene = model(&text(
        "",
        "material grey { diffuse 1 1 1 }
         plane wall { material grey normal 0 0 1 point 0 0 -4 }
         plane floor { material grey normal 0 1 0 point 0 0 0 }
         light l { location 4 3 -4 emissivity 9 9 9 }",
    ));
    let (eye, lamp) = (dvec3(4.0, 3.0, 6.0), dvec3(4.0, 3.0, -4.0));
    let mut random = Random(14);
    let (mut naive_dark, mut dark) = (0, 0);
    for _ in 0..2_000 {
        let target = dvec3(random.between(0.0, 8.0), 0.0, random.between(-3.9, -1.0));
        let to_light = lamp - target;
        let wall = (-4.0 - target.z) / to_light.normalize().z;
        naive_dark += u32::from(wall < to_light.length());
        let ray = Ray { origin: eye, dir: (target - eye).normalize() };
        dark += u32::from(trace::colour(&Plan::new(&scene), &Sight::along(&ray), None).x == 0.0);
    }
    assert!(naive_dark > 50, "{naive_dark}");
    assert_eq!(dark, 0, "of 2000 points of the floor lie in the shadow of the wall");
}

/// F14: an eye on the surface, or so near that 1 / distance is infinite.
#[test]
fn an_eye_on_the_surface_has_a_colour() {
    let scene = model(&text("", "plane p { material m normal 0 0 1 point 0 0 0 }"));
    for above in [0.0, 1e-310, 1e-200, 1e-20] {
        let ray = Ray { origin: dvec3(0.0, 0.0, above), dir: DOWN_Z };
        assert!(
            !trace::colour(&Plan::new(&scene), &Sight::along(&ray), None).is_nan(),
            "from {above:e} above"
        );
    }
}

/// F14: for an image of one pixel, the notes divide by the number of gaps between pixels, which is 0.
#[test]
fn a_picture_of_one_pixel_has_a_colour() {
    let [width, at] = [1.0_f64, 0.0];
    assert!((8.0 * at / (width - 1.0)).is_nan());
    let scene = model(
        "camera c { pixeldim 1 1 worlddim 8 6 viewpoint 4 3 6 } material m { ambient 9 0 0 }
         plane p { material m normal 0 0 1 point 0 0 0 }",
    );
    assert_eq!(scene.camera.value.ray(0.0, 0.0).dir, DOWN_Z);
    assert_eq!(render(&scene).get_pixel(0, 0).0, [255, 0, 0]);
}

/// F11 and F14: a normal of zero length at the centre of a sphere does no harm if nobody asks for it.
#[test]
fn a_ball_is_lit_by_a_light_in_its_middle_on_no_side() {
    let scene = model(&text(
        "",
        "sphere s { material m center 0 0 0 radius 1 } light l { location 0 0 0 emissivity 9 9 9 }",
    ));
    let outside =
        trace::colour(&Plan::new(&scene), &Sight::along(&Ray { origin: 3.0 * DVec3::Z, dir: DOWN_Z }), None);
    assert_eq!(outside, Rgb::splat(0.5), "ambient 1 over a distance of 2");
    assert!(shape("sphere s { material m center 0 0 0 radius 1 }").normal(DVec3::Z).is_normalized());
}

/// Returns the colour of a point whose light is on the side opposite the viewer, where half vectors lie below the
/// surface.
fn glint_from_behind(shininess: &str, lamp: &str, method: Accuracy) -> Rgb {
    let scene = format!(
        "camera c {{ pixeldim 3 3 worlddim 8 6 viewpoint 4 3 6 accuracy {} }}
         material shiny {{ ambient 1 1 1 diffuse 1 1 1 specular 1 shininess {shininess} }}
         plane p {{ material shiny normal 0 0 -1 point 0 0 -1 }}
         light l {{ location {lamp} emissivity 9 9 9 }}",
        method.option().name
    );
    trace::colour(
        &Plan::new(&model(&scene)),
        &Sight::along(&Ray { origin: dvec3(4.0, 3.0, 6.0), dir: DOWN_Z }),
        None,
    )
}

#[test]
fn a_glint_does_not_come_from_the_wrong_side() {
    assert!((-0.5_f64).powf(12.5).is_nan() && (-0.5_f64).powf(2.0) > 0.0);
    for method in [Accuracy::Classic, Accuracy::Exact] {
        // Lamps beside the line of sight, and one on it, for which the half vector is 0.
        for lamp in ["9 3 -2", "4.5 3 -4", "4 3 -4"] {
            let matt = glint_from_behind("0", lamp, method);
            assert!(matt.min_element() > 1.0 / 7.0, "{matt}: the light comes to that side");
            for shininess in ["0.3", "0.5", "1", "1.5", "2", "12.5", "100", "300", "1e5", "1e10", "1e300"] {
                let shiny = glint_from_behind(shininess, lamp, method);
                assert_eq!(shiny, matt, "shininess {shininess}, {method:?}, from {lamp}");
            }
        }
    }
}

/// A cosine may be rounded to more than 1, and a large power of that may be anything.
#[test]
fn no_glint_is_brighter_than_its_light() {
    assert!(1.0_f64.next_up().powf(1e18) > 1e90);
    let mut random = Random(7);
    for _ in 0..300 {
        let lamp = dvec3(random.between(-5.0, 5.0), random.between(-5.0, 5.0), random.between(1.0, 5.0));
        let scene = format!(
            "camera c {{ pixeldim 3 3 worlddim 8 6 viewpoint 4 3 6 }} material m {{ specular 1 shininess 1e18 }}
             sphere p {{ material m center 0 0 0 radius 1 }}
             light l {{ location {} {} {} emissivity 1 1 1 }}",
            lamp.x, lamp.y, lamp.z
        );
        // The ray runs along the line on which the light is reflected back.
        let ray = Ray { origin: 0.9 * lamp, dir: -lamp.normalize() };
        let colour = trace::colour(&Plan::new(&model(&scene)), &Sight::along(&ray), None);
        let way = 0.9 * lamp.length() - 1.0;
        assert!(colour.max_element() <= 1.000001 / way, "{colour} after {way} from {lamp}");
    }
}

/// The notes: "different effects may be obtained by using different frequencies and phase angles for each color".
#[test]
fn each_channel_of_a_rainbow_may_have_its_own_frequency_and_phase() {
    let rainbow = |attributes: &str| {
        model(&text(
            "",
            &format!(
                "rainbow r {{ {attributes} }} plane p {{ material m normal 0 0 1 point 0 0 0 shader r }}"
            ),
        ))
    };
    for (attributes, frequencies, phases) in [
        ("frequency 1 5 64", [1.0, 5.0, 64.0], [0.0, TAU / 3.0, 2.0 * TAU / 3.0]),
        ("frequency 3 2 1 phase 0.5", [3.0, 2.0, 1.0], [0.5, 0.5 + TAU / 3.0, 0.5 + 2.0 * TAU / 3.0]),
        ("phase 0 1 -2", [2.0; 3], [0.0, 1.0, -2.0]),
        ("frequency 7 phase 4 4 4", [7.0; 3], [4.0; 3]),
    ] {
        let model = rainbow(attributes);
        for angle in (0..64).map(|step| 0.1 * f64::from(step)) {
            let colour = look(&model, dvec3(3.0 * angle.cos(), 3.0 * angle.sin(), 0.0));
            for (channel, (frequency, phase)) in frequencies.iter().zip(phases).enumerate() {
                let expected = 6.0 * (1.0 + (frequency * angle + phase).cos());
                let error = (colour[channel] - expected).abs();
                assert!(error < 1e-11, "{attributes}: channel {channel} at {angle} is off by {error:e}");
            }
        }
    }
    let notes = rainbow("phase 0 \"2*pi/3\" \"4*pi/3\"");
    for angle in (0..64).map(|step| 0.1 * f64::from(step)) {
        let at = dvec3(angle.cos(), angle.sin(), 0.0);
        assert!(look(&notes, at).abs_diff_eq(rainbow_colour(angle), 1e-13), "the notes' phases are these");
    }
}

#[test]
fn a_procedural_sphere_without_a_shader_has_the_notes() {
    let scene = |shader: &str| {
        model(&text("", &format!("psphere s {{ material m center 0 0 0 radius 1 {shader} }}")))
    };
    for angle in [0.3, 1.0, 2.0, 4.0_f64] {
        let at = dvec3(angle.cos(), angle.sin(), 0.0);
        assert_eq!(look(&scene(""), at), look(&scene("shader 0"), at));
    }
    assert_eq!(tabray::scene::dump::notes(&scene("")), tabray::scene::dump::notes(&scene("shader 0")));
}
