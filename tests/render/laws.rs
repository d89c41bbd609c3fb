//! The laws of the free rules: light depends neither on the scale of a scene nor on where the viewer stands, and glass loses
//! none of it.

use crate::common::glass::{SHAPES, glass};
use crate::common::{model, model_in, render, root};
use image::RgbImage;
use proptest::prelude::*;
use tabray::geometry::Sight;
use tabray::glam;
use tabray::render::plan::Plan;
use tabray::render::ray_stats::RayStats;
use tabray::render::trace::{self, Scratch, Tracer};
use tabray::simd::Cpu;

/// A scene with a mirror, glass, a sky, a lamp and a floor, whose lengths all carry a factor.
fn scaled(s: f64) -> String {
    let l = |lengths: &[f64]| {
        lengths.iter().map(|length| format!("{:?}", length * s)).collect::<Vec<_>>().join(" ")
    };
    format!(
        "look_at eye {{ pixeldim 24 16 position {} target {} angle 42 rules free }}
         sky day {{ horizon 0.9 0.93 1 zenith 0.35 0.5 0.8 ground 0.3 0.3 0.3 }}
         metal chrome {{ colour 0.9 0.91 0.93 }}
         glass clear {{ index 1.5 colour 0.93 0.98 1 }}
         material floor {{ ambient 0.25 0.26 0.3 diffuse 0.4 0.4 0.45 specular 0.18 shininess 60 }}
         disc ground {{ material floor center 0 0 0 normal 0 1 0 radius {} }}
         sphere a {{ material chrome center {} radius {} }}
         sphere b {{ material clear center {} radius {} }}
         sphere c {{ material clear center {} radius {} }}
         sphere d {{ material chrome center {} radius {} }}
         light key {{ location {} emissivity 0.9 0.9 0.9 falloff square at {} }}",
        l(&[2.7, 2.0, 3.9]),
        l(&[0.0, 0.4, 0.0]),
        l(&[9.0]),
        l(&[-0.9, 0.45, -0.3]),
        l(&[0.45]),
        l(&[0.5, 0.4, 0.75]),
        l(&[0.4]),
        l(&[0.1, 0.4, -0.2]),
        l(&[0.4]),
        l(&[1.3, 0.4, -0.2]),
        l(&[0.4]),
        l(&[-2.5, 4.0, 2.5]),
        l(&[5.0]),
    )
}

/// Renders a scene, and counts its rays.
fn counted(text: &str) -> (Vec<[u8; 3]>, RayStats) {
    let model = model(text);
    let (plan, mut stats, mut scratch) = (Plan::for_picture(&model), RayStats::default(), Scratch::default());
    let [width, height] = plan.camera.pixels;
    let pixels: Vec<_> = (0..height).flat_map(|y| (0..width).map(move |x| [x, y])).collect();
    let display = plan.camera.display();
    let mut tracer = Tracer::new(&plan, Cpu::best(), &mut scratch, &mut stats);
    let colours = tracer.pixels(&pixels);
    let bytes = (0..pixels.len()).map(|pixel| display.bytes(colours.get(pixel))).collect();
    (bytes, stats)
}

#[test]
fn a_power_of_two_changes_no_byte_and_no_ray() {
    let (whole, rays) = counted(&scaled(1.0));
    for exponent in [-20, -7, 3, 20] {
        let (scaled, of_scaled) = counted(&scaled(f64::powi(2.0, exponent)));
        assert!(scaled == whole, "2^{exponent}");
        assert_eq!(of_scaled.all_rays(), rays.all_rays(), "2^{exponent}");
    }
}

#[test]
fn any_factor_changes_next_to_nothing() {
    let (whole, rays) = counted(&scaled(1.0));
    for factor in [1e-6, 0.1, 3.0, 1000.0, 1e6] {
        let (scaled, of_scaled) = counted(&scaled(factor));
        let differ = scaled.iter().zip(&whole).filter(|(one, other)| one != other).count();
        assert!(differ <= whole.len() / 100, "{factor}: {differ} pixels differ");
        let cost = of_scaled.all_rays() as f64 / rays.all_rays() as f64;
        assert!((cost - 1.0).abs() < 0.01, "{factor}: {cost} times as many rays");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_viewer_who_comes_nearer_sees_the_same(x in 0..24_usize, y in 0..16_usize, part in 0.05..0.9) {
        let text = scaled(1.0).replace("specular 0.18 shininess 60", "").replace("metal chrome { colour 0.9 0.91 0.93 }", "material chrome { ambient 0.1 0.2 0.3 diffuse 0.5 0.4 0.3 }");
        let model = model(&text);
        let plan = Plan::new(&model);
        let sight = plan.camera.sight(x as f64, y as f64);
        let hit = trace::first_hit(&plan, &sight);
        // Glass shows what is behind it from where the viewer stands.
        let hit = hit.filter(|hit| hit.object.material.transparency == 0.0);
        if let Some(hit) = hit {
            let mut ray = sight.ray();
            let far = trace::colour(&plan, &sight, None);
            ray.origin = ray.at(part * hit.distance);
            let near = trace::colour(&plan, &Sight::along(&ray), None);
            prop_assert!((far - near).abs().max_element() < 1e-9, "{far} {near}");
        }
    }
}

/// Asserts that a picture shows one colour, up to half a level.
#[track_caller]
fn is_all(picture: &RgbImage, colour: [f64; 3], what: &str) {
    for pixel in picture.pixels() {
        let off = (0..3).map(|channel| (f64::from(pixel[channel]) - 255.0 * colour[channel]).abs());
        assert!(off.fold(0.0, f64::max) <= 0.5 + 1e-9, "{what}: {pixel:?}");
    }
}

#[test]
fn glass_in_a_furnace_is_as_bright_as_the_furnace() {
    for (name, shape) in SHAPES {
        for index in [1.1, 1.5, 2.4] {
            for colour in [[0.8; 3], [0.9, 0.5, 0.1]] {
                let [red, green, blue] = colour;
                let text = format!("{} background b {{ colour {red} {green} {blue} }} {shape}", glass(index));
                is_all(&render(&model(&text)), colour, &format!("{name}, {index}"));
            }
        }
    }
}

#[test]
fn a_gem_in_a_furnace_is_as_bright_as_the_furnace() {
    let folder = root().join("scenes/entities");
    let text = format!(
        "{} background b {{ colour 0.8 0.8 0.8 }} mesh a {{ material g file ../models/icosahedron.ply }}",
        glass(1.5)
    );
    is_all(&render(&model_in(&folder, &text)), [0.8; 3], "gem");
}

/// A floor under a lamp, whose attributes follow, seen from above.
fn lit(rules: &str, lamp: &str) -> String {
    format!(
        "look_at eye {{ pixeldim 9 9 position 0.1 3 0.5 target 0 0 0 angle 60 rules {rules} }}
         material matt {{ diffuse 1 1 1 }}
         plane floor {{ material matt normal 0 1 0 point 0 0 0 }}
         light lamp {{ emissivity 0.5 0.5 0.5 {lamp} }}"
    )
}

#[test]
fn a_lamp_weakens_as_its_falloff_says() {
    for (height, at) in [(2.0, 4.0), (0.01, 4.0), (0.01, 0.5)] {
        for (falloff, power) in [("none", 0), ("distance", 1), ("square", 2)] {
            let model = model(&lit("free", &format!("location 0 {height} 0 falloff {falloff} at {at}")));
            let plan = Plan::new(&model);
            for (x, y) in (0..9).flat_map(|x| (0..9).map(move |y| (x, y))) {
                let sight = plan.camera.sight(f64::from(x), f64::from(y));
                let hit = trace::first_hit(&plan, &sight).expect("the floor");
                let distance = (hit.point - glam::DVec3::new(0.0, height, 0.0)).length();
                let strength = f64::powi(at / f64::max(distance, 0.01 * at), power);
                let expected = 0.5 * strength * height / distance;
                let off = (trace::colour(&plan, &sight, None).x - expected).abs();
                assert!(off <= 1e-9 * expected, "{falloff}, {height}, {at}: {off} of {expected}");
            }
        }
    }
}

#[test]
fn the_notes_rules_know_no_falloff() {
    let without = render(&model(&lit("notes", "location 0 2 0")));
    assert!(render(&model(&lit("notes", "location 0 2 0 falloff square at 7"))) == without);
}

#[test]
fn planes_beyond_the_image_plane_are_seen_by_the_free_rules_alone() {
    for (rules, is_seen) in [("notes", false), ("free", true)] {
        let model = model(&format!(
            "camera eye {{ pixeldim 3 3 worlddim 8 6 viewpoint 4 3 6 rules {rules} }}
             material bright {{ ambient 1 1 1 }} plane wall {{ material bright normal 0 0 1 point 0 0 1 }}"
        ));
        let plan = Plan::new(&model);
        assert_eq!(trace::first_hit(&plan, &plan.camera.sight(1.0, 1.0)).is_some(), is_seen, "{rules}");
    }
}
