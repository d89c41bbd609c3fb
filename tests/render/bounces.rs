//! Light that goes on from surface to surface.

use crate::common::{model, model_in};
use glam::DVec3;
use std::fs;
use tabray::render::plan::{Plan, Ways};
use tabray::render::trace;
use tabray::scene::model::Model;
use tabray::tools::threads::renderer_with;

/// Returns the mean of an image's pixels, before they become bytes.
fn mean(text: &str) -> DVec3 {
    mean_of(&model(text))
}

fn mean_by(text: &str, ways: Ways) -> DVec3 {
    let model = model(text);
    mean_through(&Plan::new(&model).meeting_by(ways))
}

fn mean_of(model: &Model) -> DVec3 {
    mean_through(&Plan::new(model))
}

fn mean_through(plan: &Plan) -> DVec3 {
    let [width, height] = plan.camera.pixels;
    let pixels = (0..width * height).map(|index| trace::pixel(plan, index % width, index / width));
    pixels.sum::<DVec3>() / (width * height) as f64
}

#[test]
fn a_closed_ball_shows_the_sum_of_all_bounces() {
    // Of long paths, those that can bring little end by chance.
    for (bounces, samples, error) in [(0, 4, 1e-4), (1, 1, 1e-4), (3, 1024, 4e-3), (12, 1024, 4e-3)] {
        let ball = format!(
            "look_at eye {{ pixeldim 5 4 position 0.3 0.2 0.1 target 0 0 1 samples {samples} bounces {bounces} }}
             material glow {{ diffuse 0.5 0.25 0 emission 0.2 0.1 0.05 }}
             sphere ball {{ material glow center 0 0 0 radius 2 }}"
        );
        let sum = |albedo: f64| (0..=bounces).map(|bounce| albedo.powi(bounce)).sum::<f64>();
        let right = DVec3::new(0.2 * sum(0.5), 0.1 * sum(0.25), 0.05);
        let seen = mean(&ball);
        assert!((seen - right).abs().max_element() < error, "{bounces}: {seen} for {right}");
    }
}

#[test]
fn what_emits_behind_panes_is_met_by_aim_and_counted_once() {
    let lit = |pane: &str, samples: u32| {
        mean(&format!(
            "look_at eye {{ pixeldim 6 4 position 0 1 4 target 0 0 0 angle 20 samples {samples} bounces 1 }}
             material matt {{ diffuse 0.8 0.8 0.8 }} material glow {{ emission 60 60 60 }}
             material clear {{ diffuse 1 1 1 transparency 1 }} material half {{ diffuse 0 0 0 transparency 0.5 }}
             glass air {{ index 1 }}
             fplane floor {{ material matt point -9 0 9 normal 0 1 0 xdir 1 0 0 dimensions 18 18 }}
             sphere bulb {{ material glow center 0 3 0 radius 0.1 }} {pane}"
        ))
    };
    let at = |height: f64| format!("point -2 {height} 2 normal 0 1 0 xdir 1 0 0 dimensions 4 4");
    let bright = lit("", 256);
    for (pane, passed) in [
        (format!("fplane pane {{ material clear {} }}", at(1.5)), 1.0),
        (
            format!(
                "fplane pane {{ material half {} }} fplane other {{ material half {} }}",
                at(1.5),
                at(2.0)
            ),
            0.25,
        ),
    ] {
        let seen = lit(&pane, 256);
        assert!(
            (seen - passed * bright).abs().max_element() < 0.01 * bright.x,
            "{pane}: {seen} for {bright}"
        );
    }
    // Glass that may bend light is passed by chance alone, which takes more samples.
    let seen = lit(&format!("fplane pane {{ material air {} }}", at(1.5)), 16384);
    assert!((seen - bright).abs().max_element() < 0.1 * bright.x, "{seen} for {bright}");
}

#[test]
fn a_choice_among_ways_keeps_the_mean() {
    // Glass, metal and plastic behind matt walls: what they bring is chosen by chance there, and all of it is as bright.
    let room = |walls: &str| {
        mean(&format!(
            "look_at eye {{ pixeldim 6 4 position 0 0 3.9 target 0 0 0 angle 60 samples 512 bounces 6 }}
             material white {{ diffuse 0.5 0.5 0.5 emission 0.5 0.5 0.5 }} sphere room {{ material white center 0 0 0 radius 4 }}
             {walls}"
        ))
    };
    // In a room that is as bright everywhere, clear things cannot be seen.
    let sum: f64 = (0..=6).map(|bounce| 0.5_f64.powi(1 + bounce)).sum();
    for walls in [
        "",
        "glass clear { index 1.5 } sphere ball { material clear center 0.5 0.2 -1 radius 1 }",
        "glass frosted { index 1.5 roughness 0.4 } sphere ball { material frosted center 0.5 0.2 -1 radius 1 }",
        "metal mirror { colour 1 1 1 } sphere ball { material mirror center -0.5 0.2 -1 radius 1.2 }",
    ] {
        let seen = room(walls);
        assert!((seen - sum).abs().max_element() < 0.01, "{walls}: {seen} for {sum}");
    }
}

/// A matt floor under something that shines.
fn floor(bounces: u32, shines: &str) -> String {
    format!(
        "look_at eye {{ pixeldim 6 4 position 0 1 4 target 0 0 0 angle 20 samples 1024 bounces {bounces} }}
         material matt {{ diffuse 0.8 0.6 0.4 }}
         fplane floor {{ material matt point -9 0 9 normal 0 1 0 xdir 1 0 0 dimensions 18 18 }}
         {shines}"
    )
}

#[test]
fn a_panel_that_emits_lights_a_floor_as_a_lamp_does() {
    let by_aim = mean(&floor(
        0,
        "area_light lamp { location 0.5 2 0 target 0.5 0 0 dimensions 2 1 emissivity 3 3 3 visible no }",
    ));
    let by_chance = mean(&floor(
        1,
        "material glow { emission 3 3 3 }
         fplane lamp { material glow point -0.5 2 -0.5 normal 0 -1 0 xdir 1 0 0 dimensions 2 1 }",
    ));
    assert!(((by_chance - by_aim) / by_aim).abs().max_element() < 0.02, "{by_chance} for {by_aim}");
}

/// What emits, each above the floor and not far from it.
const GLOWING: [&str; 6] = [
    "fplane lamp { material glow point -0.5 2 -0.5 normal 0 -1 0 xdir 1 0 0 dimensions 2 1 }",
    "disc lamp { material glow center 0.5 1.5 0.2 normal 1 1 0 radius 0.6 }",
    "sphere lamp { material glow center 0.5 1.2 0 radius 0.4 }",
    "box lamp { material glow center 0.5 1.2 0 size 0.5 0.7 0.9 }",
    "sphere one { material glow center 0 0 0 radius 0.4 }
     place lamp { object one rotation 20 30 0 scale 1.5 1.5 1.5 translation 0 1.5 0 }",
    "fplane one { material glow point -1 0 0 normal 0 -1 0 xdir 1 0 0 dimensions 2 1 }
     place lamp { object one rotation 20 30 40 scale 1 1 0.5 translation 0 1.5 0 }",
];

#[test]
fn what_emits_lights_a_floor_the_same_by_aim_by_chance_and_by_both() {
    for lamp in GLOWING {
        let scene = floor(1, &format!("material glow {{ emission 3 3 3 }} {lamp}"));
        let [both, aim, chance] = [Ways::Both, Ways::Aim, Ways::Chance].map(|ways| mean_by(&scene, ways));
        let off = |mean: DVec3| ((mean - both) / both).abs().max_element();
        assert!(off(aim) < 0.01 && off(chance) < 0.04, "{lamp}: {both} by both, {aim}, {chance}");
    }
}

/// A rough floor under a lamp.
const ROUGH: &str = "look_at eye { pixeldim 6 4 position 0 1 4 target 0 0 0 angle 20 samples 1024 }
     metal steel { colour 0.9 0.8 0.7 roughness 0.4 }
     fplane floor { material steel point -9 0 9 normal 0 1 0 xdir 1 0 0 dimensions 18 18 }";

#[test]
fn rough_metal_mirrors_a_lamp_the_same_by_aim_by_chance_and_by_both() {
    for lamp in [
        "area_light lamp { location 0 1 -2 target 0 0 0 dimensions 1 0.5 emissivity 3 3 3 }",
        "area_light lamp { location 0.5 0.3 -1 target 0 0.2 0 radius 0.3 emissivity 3 3 3 }",
        "sphere_light lamp { location 0 0.7 -1 radius 0.4 emissivity 3 3 3 }",
    ] {
        let scene = format!("{ROUGH} {lamp}");
        let [both, aim, chance] = [Ways::Both, Ways::Aim, Ways::Chance].map(|ways| mean_by(&scene, ways));
        let off = |mean: DVec3| ((mean - both) / both).abs().max_element();
        assert!(off(aim) < 0.02 && off(chance) < 0.02, "{lamp}: {both} by both, {aim}, {chance}");
    }
}

#[test]
fn small_lamps_and_things_that_emit_are_clear_with_few_samples() {
    let small_glow = floor(
        1,
        "material glow { emission 300 300 300 } sphere lamp { material glow center 0.5 1.2 0 radius 0.04 }",
    );
    let small_lamp =
        format!("{ROUGH} sphere_light lamp {{ location 0 0.7 -1 radius 0.04 emissivity 300 300 300 }}");
    for scene in [small_glow, small_lamp] {
        let model = |samples: &str| model(&scene.replace("samples 1024", samples));
        let (few, many) = (model("samples 16"), model("samples 4096"));
        let error = |ways: Ways| {
            let (few, many) = (Plan::new(&few).meeting_by(ways), Plan::new(&many));
            let pixel = |index: usize| {
                let [few, many] = [&few, &many].map(|plan| trace::pixel(plan, index % 6, index / 6));
                ((few - many) / many).length_squared()
            };
            ((0..24).map(pixel).sum::<f64>() / 24.0).sqrt()
        };
        let (both, chance) = (error(Ways::Both), error(Ways::Chance));
        assert!(both < 0.1 && both < 0.1 * chance, "{both} by both, {chance} by chance");
    }
}

#[test]
fn the_emission_of_a_file_s_material_lights_a_floor() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("room for a file");
    write("lamp.mtl", "newmtl glow\nKd 0 0 0\nKe 3 3 3\n");
    let corners = "v -0.5 2 -0.5\nv 1.5 2 -0.5\nv 1.5 2 0.5\nv -0.5 2 0.5\n";
    write("lamp.obj", &format!("mtllib lamp.mtl\n{corners}usemtl glow\nf 1 2 3 4\n"));
    let lamp = "mesh lamp { material matt file lamp.obj materials file }";
    let by_file = mean_of(&model_in(folder.path(), &floor(1, lamp)));
    let glow = "material glow { emission 3 3 3 }
                fplane lamp { material glow point -0.5 2 -0.5 normal 0 -1 0 xdir 1 0 0 dimensions 2 1 }";
    let by_material = mean(&floor(1, glow));
    assert!(
        ((by_file - by_material) / by_material).abs().max_element() < 0.02,
        "{by_file} for {by_material}"
    );
}

#[test]
fn faces_of_a_file_that_emit_are_aimed_at_each_with_its_own_light() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("room for a file");
    write(
        "lamp.mtl",
        "newmtl bright\nKd 0 0 0\nKe 9 3 1\nnewmtl dim\nKd 0 0 0\nKe 1 1 1\nnewmtl dark\nKd 0.2 0.2 0.2\n",
    );
    let square = |x: f64, corner: u32| {
        let corners = [[0.0, -0.5], [0.9, -0.5], [0.9, 0.5], [0.0, 0.5]];
        let corners = corners.map(|[right, back]| format!("v {} 1 {back}\n", x + right));
        format!("{}f {corner} {} {} {}\n", corners.concat(), corner + 1, corner + 2, corner + 3)
    };
    write(
        "lamp.obj",
        &format!(
            "mtllib lamp.mtl\nusemtl bright\n{}usemtl dim\n{}usemtl dark\n{}",
            square(-1.0, 1),
            square(0.0, 5),
            square(1.0, 9)
        ),
    );
    for lamp in [
        "mesh lamp { material matt file lamp.obj materials file }",
        "mesh one { material matt file lamp.obj materials file }
         place lamp { object one rotation 20 30 0 scale 2 1 1 translation 0 0.2 0 }",
    ] {
        let model = model_in(folder.path(), &floor(1, lamp));
        let by = |ways: Ways| mean_through(&Plan::new(&model).meeting_by(ways));
        let [both, aim, chance] = [Ways::Both, Ways::Aim, Ways::Chance].map(by);
        let off = |mean: DVec3| ((mean - both) / both).abs().max_element();
        assert!(aim != chance && off(aim) < 0.01 && off(chance) < 0.05, "{lamp}: {both}, {aim}, {chance}");
    }
}

#[test]
fn a_mirror_throws_a_lamp_s_light_on_a_floor() {
    let lamp = |name: &str, x: f64| {
        format!(
            "area_light {name} {{ location {x} 2 0 target {x} 0 0 dimensions 1 1 emissivity 3 3 3 visible no }}"
        )
    };
    let both = mean(&floor(0, &format!("{} {}", lamp("one", -1.0), lamp("other", 5.0))));
    let visible = lamp("one", -1.0).replace(" visible no", "");
    let mirror = "metal chrome { colour 1 1 1 }
                  fplane mirror { material chrome point 2 -1 -99 normal -1 0 0 xdir 0 0 1 dimensions 198 99 }";
    let thrown = mean(&floor(1, &format!("{visible} {mirror}")));
    assert!(((thrown - both) / both).abs().max_element() < 0.01, "{thrown} for {both}");
}

#[test]
fn glass_throws_a_lamp_s_light_on_a_floor_as_that_of_what_emits() {
    let lit = |lamp: &str| {
        mean(&floor(
            1,
            &format!(
                "glass clear {{ index 1.5 }} sphere lens {{ material clear center 0 1.2 0 radius 0.6 }} {lamp}"
            ),
        ))
    };
    let by_lamp = lit("sphere_light bulb { location 0 2.6 0 radius 0.5 emissivity 9 9 9 }");
    let emitted =
        lit("material glow { emission 9 9 9 } sphere bulb { material glow center 0 2.6 0 radius 0.5 }");
    assert!(((by_lamp - emitted) / emitted).abs().max_element() < 0.02, "{by_lamp} for {emitted}");
}

#[test]
fn lamps_and_skies_are_counted_once() {
    // A single matt floor has no other surface to receive light from.
    for shines in [
        "area_light lamp { location 0 2 0 target 0 0 0 dimensions 2 2 emissivity 3 3 3 }",
        "sphere_light lamp { location 0 3 0 radius 1 emissivity 3 3 3 }",
        "sky day { lights yes }",
        "background grey { colour 0.5 0.5 0.5 }",
    ] {
        assert_eq!(mean(&floor(3, shines)), mean(&floor(0, shines)), "{shines}");
    }
}

#[test]
fn ambient_light_is_seen_but_lights_nothing() {
    let wall = "material bright { ambient 5 5 5 }
                fplane wall { material bright point -9 0 -2 normal 0 0 1 xdir 1 0 0 dimensions 18 9 }";
    let sun = "sun light { direction 0 1 0 emissivity 1 1 1 }";
    assert_eq!(mean(&floor(2, &format!("{wall} {sun}"))), mean(&floor(0, &format!("{wall} {sun}"))));
}

#[test]
fn bounces_give_the_same_bytes_on_any_number_of_threads() {
    let text = floor(4, "sky day { lights yes } sphere ball { material matt center 0 0.5 0 radius 0.5 }");
    let model = model(&text.replace("samples 1024", "samples 5"));
    let [one, three] =
        [1, 3].map(|threads| renderer_with(threads).expect("threads").picture(&Plan::for_picture(&model)));
    assert_eq!(one, three);
}
