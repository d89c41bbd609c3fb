//! Plastic, and other matt bodies under a coat.

use crate::common::{model, render};
use glam::DVec3;
use std::sync::Arc;
use tabray::prelude::{AnyInterface, Interface, Law, Material, Number};
use tabray::render::plan::Plan;
use tabray::render::trace;
use tabray::scene::model::Object;
use tabray::tools::colours::{Prover, Verdict};

/// Returns the mean of an image's pixels, before they become bytes.
fn mean(text: &str) -> DVec3 {
    let model = model(text);
    let (plan, [width, height]) = (Plan::new(&model), model.camera.value.pixels);
    let pixels = (0..width * height).map(|index| trace::pixel(&plan, index % width, index / width));
    pixels.sum::<DVec3>() / (width * height) as f64
}

/// A plane in a bright sphere, seen at an angle from the vertical, in degrees.
fn furnace(plastic: &str, angle: f64) -> DVec3 {
    let (sin, cos) = angle.to_radians().sin_cos();
    mean(&format!(
        "look_at eye {{ pixeldim 4 4 position {} {} 0 target 0 0 0 angle 1 samples 1024 bounces 1 }}
         material white {{ emission 1 1 1 }} plastic p {{ {plastic} }}
         disc floor {{ material p center 0 0 0 normal 0 1 0 radius 30 }}
         sphere around {{ material white center 0 0 0 radius 40 }}",
        9.0 * sin,
        9.0 * cos
    ))
}

#[test]
fn a_white_body_under_any_coat_shows_all_light_in_a_furnace() {
    for plastic in ["colour 1 1 1", "colour 1 1 1 roughness 0.4", "colour 1 1 1 index 2 roughness 0.9"] {
        for angle in [10.0, 60.0, 80.0] {
            let seen = furnace(plastic, angle);
            assert!((seen - DVec3::ONE).abs().max_element() < 0.005, "{plastic}, {angle}: {seen}");
        }
    }
    let grey = furnace("colour 0.5 0.5 0.5 roughness 0.3", 45.0);
    assert!(grey.max_element() < 0.6 && grey.min_element() > 0.3, "{grey}");
}

#[test]
fn a_coat_of_air_changes_nothing() {
    let scene = |material: &str| {
        model(&format!(
            "look_at eye {{ pixeldim 32 24 position 0 1 5 target 0 0 0 angle 30 samples 4 }}
             sky day {{ lights yes }} area_light lamp {{ location 2 4 2 target 0 0 0 dimensions 1 1 emissivity 5 5 5 }}
             {material} sphere ball {{ material m center 0 0 0 radius 1 }}"
        ))
    };
    let matt = render(&scene("material m { diffuse 0.7 0.4 0.2 }"));
    assert_eq!(matt, render(&scene("plastic m { colour 0.7 0.4 0.2 index 1 }")));
    assert_ne!(matt, render(&scene("plastic m { colour 0.7 0.4 0.2 }")));
}

#[test]
fn a_lamp_lights_the_body_by_what_the_coat_lets_through_both_ways() {
    // A sun at right angles, which the coat does not mirror toward the viewer.
    let seen = |material: &str| {
        mean(&format!(
            "look_at eye {{ pixeldim 1 1 position 6 6 0 target 0 0 0 angle 1 samples 4 }}
             sun light {{ direction 0 1 0 emissivity 1 1 1 }} {material}
             plane floor {{ material m normal 0 1 0 point 0 0 0 }}"
        ))
    };
    let matt = seen("material m { diffuse 0.5 0.5 0.5 }");
    let plastic = seen("plastic m { colour 0.5 0.5 0.5 }");
    // By Fresnel's equations at 0 and 45 degrees, and the mean over all directions of 0.0918.
    let (passed, mean) = (0.96 * (1.0 - 0.050_24), 0.091_8);
    let body = 1.0 / (2.25 * (1.0 - 0.5 * (1.0 - (1.0 - mean) / 2.25)));
    let right = matt.x * passed * body;
    assert!((plastic.x / right - 1.0).abs() < 2e-3, "{plastic} for {right}");
}

#[test]
fn textures_colour_the_body() {
    let scene = |material: &str, shader: &str| {
        model(&format!(
            "look_at eye {{ pixeldim 32 24 position 0 1 5 target 0 0 0 angle 30 samples 4 bounces 1 }}
             sky day {{ lights yes }} material other {{ diffuse 0.1 0.1 0.6 }} {material}
             checker pattern {{ squares 4 4 altmaterial other }}
             sphere ball {{ material m center 0 0 0 radius 1 {shader} }}"
        ))
    };
    let even = render(&scene("plastic m { colour 0.7 0.4 0.2 }", ""));
    let textured = render(&scene("plastic m { colour 0.7 0.4 0.2 }", "shader pattern"));
    let same = even.pixels().zip(textured.pixels()).filter(|(one, other)| one == other).count();
    assert!(same > 32 * 24 / 8 && same < 32 * 24 * 7 / 8, "{same}");
}

/// A coat that absorbs light, more of it at flat angles.
#[derive(PartialEq)]
struct Varnish;

impl Interface for Varnish {
    fn law(&self) -> Law {
        Law::metal(DVec3::ZERO, 0.0)
    }

    fn is_coat(&self) -> bool {
        true
    }

    fn passed<N: Number>(&self, cosine: N) -> Option<N> {
        let (zero, one) = (N::constant(0.0), N::constant(1.0));
        Some((-N::constant(0.3) / cosine.max(zero).min(one)).exp().max(zero).min(one))
    }
}

#[test]
fn the_rule_of_a_coat_holds_in_pictures_and_in_proofs() {
    for lamp in [
        "light lamp { location 2 4 2 emissivity 30 30 30 }",
        "area_light lamp { location 2 4 2 target 0 0 0 dimensions 1 1 emissivity 9 9 9 }",
        "sphere_light lamp { location 2 4 2 radius 0.5 emissivity 9 9 9 }",
    ] {
        for samples in [1, 4] {
            let mut model = model(&format!(
                "look_at eye {{ pixeldim 32 24 position 0 1 5 target 0 0 0 angle 40 samples {samples} }}
                 {lamp} material m {{ ambient 0.1 0.1 0.1 diffuse 0.7 0.4 0.2 }}
                 sphere ball {{ material m center 0 0 0 radius 1 }} plane floor {{ material m normal 0 1 0 point 0 -1 0 }}"
            ));
            let bare = render(&model);
            let is_ball =
                |object: &&mut Object| object.shape.is_two_sided() && object.material.diffuse != DVec3::ZERO;
            let ball = model.objects.iter_mut().find(is_ball).expect("the ball");
            let coat = Some(AnyInterface::new(Varnish));
            ball.material = Arc::new(Material { interface: coat, ..(*ball.material).clone() });
            assert!(render(&model) != bare, "{lamp}");
            let plan = Plan::new(&model);
            let prover = Prover::new(&plan);
            let of = |index: usize| prover.traced(index % 32, index / 32).verdict();
            let verdicts: Vec<Verdict> = (0..32 * 24).map(of).collect();
            let count = |one: Verdict| verdicts.iter().filter(|verdict| **verdict == one).count();
            assert_eq!(count(Verdict::Contradicted), 0, "{lamp}, {samples}");
            assert!(
                count(Verdict::Proven) > 32 * 24 * 19 / 20,
                "{lamp}, {samples}: {}",
                count(Verdict::Proven)
            );
        }
    }
}
