//! What materials do with light inside glass and at rough surfaces, against closed forms.

use crate::common::glass::{SHAPES, glass};
use crate::common::{model, render};
use glam::DVec3;
use image::RgbImage;
use std::f64::consts::FRAC_PI_2;
use tabray::geometry::{Ray, Sight};
use tabray::render::Plan;
use tabray::render::limits::MAX_RAYS;
use tabray::render::plan::depth::Depth;
use tabray::render::trace;
use tabray::scene::Model;
use tabray::tools::colours::{Prover, Verdict};
use tabray::world::sample::{Sample, Sampler};

/// The fractions of light that are left after a length of 2.
const LEFT: DVec3 = DVec3::new(0.25, 1.0, 0.81);

/// Glass that does not bend light, and takes some away.
const TINTED: &str = "glass tinted { index 1 attenuation 0.25 1 0.81 at 2 }";

fn sight(origin: [f64; 3], dir: [f64; 3]) -> Sight {
    Sight::along(&Ray { origin: origin.into(), dir: DVec3::from(dir).normalize() })
}

/// Returns the colour of a ray by the centres of lights.
fn seen(model: &Model, origin: [f64; 3], dir: [f64; 3]) -> DVec3 {
    trace::colour(&Plan::new(model), &sight(origin, dir), None)
}

fn is_near(one: DVec3, other: DVec3) -> bool {
    (one - other).abs().max_element() < 1e-9
}

#[test]
fn glass_absorbs_light_by_the_length_of_its_way() {
    for rules in ["notes", "free"] {
        let scene = model(&format!(
            "look_at eye {{ pixeldim 4 3 position 0 0 9 target 0 0 0 rules {rules} }}
             background b {{ colour 0.8 0.8 0.8 }} {TINTED}
             box slab {{ material tinted center 0 0 0 size 3 3 3 }}"
        ));
        let after = |length: f64| 0.8 * LEFT.powf(length / 2.0);
        assert!(is_near(seen(&scene, [0.0, 0.0, 9.0], [0.0, 0.0, -1.0]), after(3.0)), "{rules}");
        let askew = [0.2, 0.1, -1.0];
        let length = 3.0 * DVec3::from(askew).length();
        assert!(is_near(seen(&scene, [-1.0, -0.5, 5.0], askew), after(length)), "{rules}");
        // A viewer in the glass.
        assert!(is_near(seen(&scene, [0.0, 0.0, 0.5], [0.0, 0.0, -1.0]), after(2.0)), "{rules}");
    }
}

#[test]
fn glass_absorbs_what_a_mirror_in_it_shows() {
    let scene = model(&format!(
        "look_at eye {{ pixeldim 4 3 position 0 0 9 target 0 0 0 rules free }}
         background b {{ colour 0.8 0.8 0.8 }} {TINTED} material mirror {{ specular 1 }}
         box slab {{ material tinted center 0 0 0 size 4 4 4 }}
         box core {{ material mirror center 0 0 0 size 1 1 1 }}"
    ));
    let there_and_back = 0.8 * LEFT.powf(3.0 / 2.0);
    assert!(is_near(seen(&scene, [0.1, 0.1, 9.0], [0.0, 0.0, -1.0]), there_and_back));
}

/// A floor under a slab of glass, with a lamp.
fn floor(lamp: &str) -> Model {
    model(&format!(
        "look_at eye {{ pixeldim 16 12 position 0 2 9 target 0 0 0 rules free }} {TINTED}
         material matt {{ diffuse 1 1 1 }} plane floor {{ material matt normal 0 1 0 point 0 0 0 }}
         box slab {{ material tinted center 0 2 0 size 8 1 8 }}
         light lamp {{ emissivity 0.9 0.9 0.9 location {lamp} }}"
    ))
}

#[test]
fn light_is_absorbed_on_its_way_to_a_shadow() {
    let down = ([0.0, 1.0, 0.0], [0.0, -1.0, 0.0]);
    let straight = seen(&floor("0 5 0"), down.0, down.1);
    assert!(is_near(straight, 0.9 * LEFT.powf(0.5)), "{straight}");
    let slanted = seen(&floor("3 4 0"), down.0, down.1);
    assert!(is_near(slanted, 0.9 * 0.8 * LEFT.powf(1.25 / 2.0)), "{slanted}");
    // A lamp in the glass.
    let inside = seen(&floor("0 2 0"), down.0, down.1);
    assert!(is_near(inside, 0.9 * LEFT.powf(0.25)), "{inside}");
}

#[test]
fn a_shadow_of_glass_that_absorbs_is_never_proven_wrong() {
    let scene = floor("3 4 0");
    let plan = Plan::new(&scene);
    let prover = Prover::new(&plan);
    for (x, y) in (0..16).flat_map(|x| (0..12).map(move |y| (x, y))) {
        assert_ne!(prover.traced(x, y).verdict(), Verdict::Contradicted, "{x} {y}");
    }
}

#[test]
fn trees_in_glass_that_absorbs_and_glints_end_near_their_whole() {
    let surroundings = "sky s { horizon 0.9 0.9 1 zenith 0.3 0.5 0.8 ground 0.2 0.2 0.2 }
        light l { location 3 5 4 emissivity 0.8 0.8 0.7 }
        material dark { ambient 0.02 0.02 0.02 diffuse 0.1 0.1 0.1 }
        disc floor { material dark center 0 -1.1 0 normal 0 1 0 radius 4 }\n";
    for (name, shape) in SHAPES {
        let text = format!("{}{surroundings}{shape}", glass(1.5));
        let text = text.replace("index 1.5", "index 1.5 attenuation 0.3 0.9 0.6 at 1 shininess 40");
        let model = model(&text);
        let [mut ended, mut whole] = [Plan::new(&model), Plan::new(&model)];
        whole.depth = whole.depth.map(Depth::uncut);
        (ended.camera.pixels, whole.camera.pixels) = ([4, 3], [4, 3]);
        let display = ended.camera.display();
        for pixel in (0..12).map(|pixel| [pixel % 4, pixel / 4]) {
            let colour =
                |plan: &Plan, budget: u32| trace::within_budgets(plan, &[pixel], &[budget], &mut ())[0];
            let ((one, missing), (other, _)) = (colour(&ended, MAX_RAYS as u32), colour(&whole, 100_000));
            let off = 255.0 * (display.shown(one) - display.shown(other)).abs().max_element();
            assert!(off <= 0.5 || missing > 0.0, "{name}, {pixel:?}: {off} levels");
        }
    }
}

#[test]
fn glass_shows_a_lamp_as_a_highlight() {
    let scene = model(
        "look_at eye { pixeldim 4 3 position 0 0 9 target 0 0 0 rules free } glass g { shininess 20 }
         sphere ball { material g center 0 0 0 radius 1 } light l { location 4 5 7 emissivity 0.5 0.4 0.3 }",
    );
    for aside in [0.0, 0.2, 0.4, 0.6] {
        let point = DVec3::new(aside, aside, (1.0 - 2.0 * aside * aside).sqrt());
        let toward = (DVec3::new(4.0, 5.0, 7.0) - point).normalize();
        let cosine = (toward + DVec3::Z).normalize().dot(point);
        let expected = cosine.powi(20) * DVec3::new(0.5, 0.4, 0.3);
        let colour = seen(&scene, [aside, aside, 9.0], [0.0, 0.0, -1.0]);
        // Trees end when what is left is less than a sixteenth of a level.
        assert!((colour - expected).abs().max_element() < 1.0 / 16.0 / 255.0, "{colour} {expected}");
    }
}

/// Returns the mean of what the samples of a ray return.
fn mean(plan: &Plan, sight: &Sight, count: u32) -> DVec3 {
    let sample = |index| Sample { sampler: Sampler::Sobol, index, pixel: 5 };
    (0..count).map(|index| trace::colour(plan, sight, Some(sample(index)))).sum::<DVec3>() / f64::from(count)
}

#[test]
fn rough_metal_mirrors_by_the_distribution_of_its_facets() {
    for roughness in [0.2, 0.5, 0.8] {
        for lean in [0.05_f64, 0.2, 0.5] {
            // What facets show that lean no more than this.
            let radius = 100.0 * (2.0 * lean).tan();
            let scene = model(&format!(
                "look_at eye {{ pixeldim 4 3 position 0 0 9 target 0 0 0 rules free samples 4 }}
                 metal rough {{ colour 1 1 1 roughness {roughness} }} material white {{ ambient 0.7 0.7 0.7 }}
                 plane floor {{ material rough normal 0 1 0 point 0 0 0 }}
                 disc lid {{ material white normal 0 1 0 center 0 100 0 radius {radius} }}"
            ));
            let part = |lean: f64| lean.tan().powi(2) / (lean.tan().powi(2) + f64::powi(roughness, 4));
            // What facets would mirror into the floor is turned back.
            let expected = 0.7 * (part(lean) + 1.0 - part(FRAC_PI_2 - lean));
            let colour = mean(&Plan::new(&scene), &sight([0.0, 50.0, 0.0], [0.0, -1.0, 0.0]), 4096);
            assert!((colour.x - expected).abs() < 2e-3, "{roughness}, {lean}: {colour} {expected}");
        }
    }
}

#[test]
fn rough_surfaces_lose_no_light() {
    for material in ["metal g { colour 1 1 1 roughness 0.6 }", "glass g { roughness 0.4 }"] {
        let scene = model(&format!(
            "look_at eye {{ pixeldim 4 3 position 0 0 9 target 0 0 0 rules free samples 4 }}
             background b {{ colour 0.8 0.8 0.8 }} {material} sphere ball {{ material g center 0 0 0 radius 1 }}"
        ));
        let mut plan = Plan::new(&scene);
        // So that rays are followed although what they return is known.
        plan.depth = plan.depth.map(Depth::uncut);
        for aside in [0.0, 0.5, 0.9, 0.99] {
            let sight = sight([aside, 0.0, 9.0], [0.0, 0.0, -1.0]);
            let colour = mean(&plan, &sight, 64);
            // Few rays are reflected within the glass for so long that they are left.
            assert!((colour.x - 0.8).abs() < 2e-3, "{material} {aside}: {colour}");
        }
    }
}

#[test]
fn a_rough_surface_is_smooth_where_pixels_have_one_sample() {
    let text = |roughness: f64| {
        format!(
            "look_at eye {{ pixeldim 8 6 position 0 0 9 target 0 0 0 angle 14 rules free }}
             sky s {{ horizon 0.9 0.9 1 zenith 0.3 0.5 0.8 ground 0.2 0.2 0.2 }}
             metal m {{ roughness {roughness} }} sphere ball {{ material m center 0 0 0 radius 1 }}"
        )
    };
    let [smooth, rough] = [model(&text(0.0)), model(&text(0.5))];
    let [smooth, mut rough] = [Plan::new(&smooth), Plan::new(&rough)];
    for (x, y) in (0..8).flat_map(|x| (0..6).map(move |y| (x, y))) {
        assert_eq!(trace::pixel(&rough, x, y), trace::pixel(&smooth, x, y), "{x} {y}");
    }
    rough.camera.samples = 16;
    assert_ne!(trace::pixel(&rough, 4, 3), trace::pixel(&smooth, 4, 3));
}

/// Facets of which the square of the width is 0 have no density, and mirror lamps by chance.
#[test]
fn the_least_roughness_is_none() {
    let picture = |roughness: &str| {
        render(&model(&format!(
            "look_at eye {{ pixeldim 24 24 position 0 3 3 target 0 0 0 angle 40 samples 4 }}
             area_light panel {{ location 0 3 -3 target 0 0 0 dimensions 1 1 emissivity 2 2 2 }}
             metal m {{ roughness {roughness} }} plane floor {{ material m normal 0 1 0 point 0 0 0 }}"
        )))
    };
    assert_eq!(picture("1e-100"), picture("0"));
}

/// A ball under two lamps, one of which has a size, with another object beside it.
fn ball(material: &str, beside: &str) -> RgbImage {
    render(&model(&format!(
        "look_at eye {{ pixeldim 40 30 position 0 1 5 target 0 0 0 angle 30 samples 4 }}
         light lamp {{ location 3 5 6 emissivity 1 1 1 }}
         area_light panel {{ location -3 4 5 target 0 0 0 dimensions 1 1 emissivity 9 9 9 visible no }}
         material m {{ ambient 0.1 0.1 0.1 diffuse 0.4 0.3 0.2 shininess 30 {material} }}
         material bright {{ ambient 1 1 1 }}
         sphere ball {{ material m center 0 0 0 radius 1 }} {beside}"
    )))
}

#[test]
fn highlights_without_mirror_images_are_those_of_a_mirror_that_sees_nothing() {
    let none = ball("", "");
    let (mirror, alone) = (ball("specular 0.5", ""), ball("highlight 0.5", ""));
    assert_eq!(mirror, alone);
    assert_ne!(none, alone);
    // In the mirror, another object appears.
    let wall = "plane wall { material bright normal 1 0 0 point -1.5 0 0 }";
    assert_ne!(ball("specular 0.5", wall), ball("highlight 0.5", wall));
    let brighter = |one: &RgbImage, other: &RgbImage| {
        one.pixels().zip(other.pixels()).filter(|(one, other)| one.0[2] > other.0[2]).count()
    };
    let (plain, shown) = (ball("", wall), ball("highlight 0.5", wall));
    assert!(brighter(&shown, &plain) > 20 && brighter(&plain, &shown) == 0);
}

#[test]
fn a_lamp_that_is_seen_has_highlights_without_mirror_images() {
    let scene = |material: &str, shader: &str| {
        render(&model(&format!(
            "look_at eye {{ pixeldim 40 30 position 0 1 5 target 0 0 0 angle 30 samples 4 }}
             sphere_light lamp {{ location 3 5 6 radius 0.5 emissivity 60 60 60 }}
             material m {{ diffuse 0.2 0.2 0.2 shininess 30 {material} }} material other {{ diffuse 0.1 0.3 0.2 }}
             checker pattern {{ squares 4 4 altmaterial other }}
             sphere ball {{ material m center 0 0 0 radius 1 {shader} }}"
        )))
    };
    for shader in ["", "shader pattern"] {
        let (none, some) = (scene("", shader), scene("highlight 0.3", shader));
        let brighter =
            some.pixels().zip(none.pixels()).filter(|(some, none)| some.0[0] > none.0[0] + 20).count();
        assert!((5..400).contains(&brighter), "{brighter}");
    }
}

#[test]
fn the_inside_of_an_open_prism_is_lit_as_that_of_a_tube() {
    for shape in [
        "cylinder tube { material white base 0 0 0 height 2 radius 1 open yes }",
        "prism tube { material white points 1 0  0 1  -1 0  0 -1 height 2 open yes }",
    ] {
        for material in ["material white { diffuse 9 9 9 }", "plastic white { colour 0.9 0.9 0.9 }"] {
            let scene = model(&format!(
                "look_at eye {{ pixeldim 4 3 position 0 9 0 target 1 0 0 }} {material} {shape}
                 light lamp {{ location 0 5 0 emissivity 5 5 5 }}"
            ));
            let colour = seen(&scene, [-0.3, 4.0, -0.3], [0.8, -3.0, 0.8]);
            assert!(colour.min_element() > 0.05, "{shape} {material}: {colour}");
        }
    }
}
