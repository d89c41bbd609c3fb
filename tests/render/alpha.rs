//! Images that are transparent where they show no object.

use crate::common::model;
use glam::DVec3;
use std::ops::Range;
use tabray::render::flaws::Flaws;
use tabray::render::renderer::RenderCallbacks;
use tabray::render::{Plan, Renderer};
use tabray::scene::model::Model;
use tabray::world::material::Rgb;
use tabray::world::sensor::Adaptive;

const BEHIND: Rgb = DVec3::new(0.3, 0.5, 0.8);

/// A mirror, a matt ball and a ball of glass before a background, which also lights them under the free rules.
fn scene(camera: &str) -> Model {
    let lights = if camera == FREE { "yes" } else { "no" };
    model(&format!(
        "{camera} background far {{ colour 0.3 0.5 0.8  lights {lights} }}
         material red {{ ambient 0.3 0.05 0.05  diffuse 0.8 0.1 0.1 }}
         material mirror {{ specular 0.8 0.8 0.8 }} glass crystal {{}}
         sphere one {{ material red  center -1 1 0  radius 0.8 }}
         sphere two {{ material mirror  center 0.9 1.4 -1  radius 0.7 }}
         sphere three {{ material crystal  center 0.5 0.5 1  radius 0.5 }}
         light key {{ location 3 6 5  emissivity 1 1 1 }}"
    ))
}

const FREE: &str = "look_at eye { pixeldim 48 40  position 0 1.2 6  target 0 0.9 0 }";
const NOTES: &str = "camera eye { pixeldim 48 40  worlddim 5 4.2  viewpoint 0 1 6 }";

/// Returns the light and the alpha of each pixel of a part of an image, in rows from the top.
fn light(plan: &Plan, part: [&Range<usize>; 2]) -> Vec<(Rgb, f64)> {
    let overseer = RenderCallbacks { stops: &|| false, row: &|| () };
    let seen =
        Renderer::default().light(plan, part, overseer, &|_: Flaws| {}, &|light, alpha| (light, alpha));
    seen.expect("nothing stops it")
}

fn whole(plan: &Plan) -> Vec<(Rgb, f64)> {
    let [width, height] = plan.camera.pixels;
    light(plan, [&(0..width), &(0..height)])
}

fn transparent(model: &Model) -> Plan<'_> {
    let mut plan = Plan::for_picture(model);
    plan.camera.alpha = true;
    plan
}

#[test]
fn before_its_background_a_transparent_image_is_the_opaque_one() {
    for (camera, samples, bounces) in
        [(FREE, 1, 0), (FREE, 9, 0), (FREE, 16, 2), (NOTES, 1, 0), (NOTES, 7, 0)]
    {
        let mut model = scene(camera);
        (model.camera.value.samples, model.camera.value.bounces) = (samples, bounces);
        let (opaque, clear) = (whole(&Plan::for_picture(&model)), whole(&transparent(&model)));
        for ((seen, one), (light, alpha)) in opaque.iter().zip(&clear) {
            let over = *light + (1.0 - alpha) * BEHIND;
            // Trees of rays end within a sixteenth of a level.
            assert!((over - *seen).abs().max_element() < 1e-3, "{camera}: {over} for {seen}");
            assert_eq!(*one, 1.0);
            if *alpha == 1.0 {
                assert!((*light - *seen).abs().max_element() < 1e-3);
            }
        }
        let partly = clear.iter().filter(|(_, alpha)| *alpha > 0.0 && *alpha < 1.0).count();
        assert!((samples == 1) == (partly == 0), "{partly} with {samples} samples");
        assert!(clear.iter().any(|(light, alpha)| *alpha == 0.0 && *light == Rgb::ZERO));
    }
}

/// Returns how much of a square of side 1 at a place is in a disc around the origin.
fn in_disc(low: [f64; 2], radius: f64) -> f64 {
    const STRIPS: usize = 2000;
    let chord = |strip: usize| {
        let x = low[0] + (strip as f64 + 0.5) / STRIPS as f64;
        let half = (radius * radius - x * x).max(0.0).sqrt();
        ((low[1] + 1.0).min(half) - low[1].max(-half)).max(0.0)
    };
    (0..STRIPS).map(chord).sum::<f64>() / STRIPS as f64
}

#[test]
fn the_alpha_of_a_ball_is_the_part_of_each_pixel_that_it_covers() {
    // Two pixels to a unit.
    let mut model = model(
        "orthographic eye { pixeldim 40 40  position 0 0 9  target 0 0 0  width 20 }
         material m { ambient 1 1 1 } sphere ball { material m  center 0 0 0  radius 7.3 }",
    );
    let covered = |x: usize, row: usize| in_disc([x as f64 - 20.0, 19.0 - row as f64], 14.6);
    for (samples, adaptive, off) in [
        (64, None, 0.06),
        (1024, None, 0.005),
        (4, Some(Adaptive { most: 1024, error: Some(1.0 / 255.0) }), 0.03),
    ] {
        (model.camera.value.samples, model.camera.value.adaptive) = (samples, adaptive);
        let seen = whole(&transparent(&model));
        for (index, (light, alpha)) in seen.iter().enumerate() {
            let wanted = covered(index % 40, index / 40);
            assert!((alpha - wanted).abs() < off, "pixel {index}: {alpha} for {wanted}");
            assert!((*light - DVec3::splat(*alpha)).abs().max_element() < 1e-12);
        }
        let (all, area) =
            (seen.iter().map(|(_, alpha)| alpha).sum::<f64>(), std::f64::consts::PI * 14.6 * 14.6);
        assert!((all / area - 1.0).abs() < 2e-3, "{all} for {area}");
    }
}

#[test]
fn what_a_leaf_covers_in_part_is_as_opaque_as_that() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let half = image::RgbaImage::from_pixel(1, 1, image::Rgba([255, 255, 255, 51]));
    half.save(folder.path().join("half.png")).expect("an image");
    let card = |name: &str, z: f64| {
        format!(
            "fplane {name} {{ material m  normal 0 0 1  point -1 -1 {z}  xdir 1 0 0  dimensions 2 2  shader part }}"
        )
    };
    let scene = |cards: &str, sky: &str| {
        crate::common::model_in(
            folder.path(),
            &format!(
                "orthographic eye {{ pixeldim 1 1  position 0 0 5  target 0 0 0  width 1 }} {sky}
                 texture t {{ filename half.png  coverage yes }} image part {{ texture t }}
                 material m {{ ambient 0.5 0.5 0.5 }} {cards}"
            ),
        )
    };
    for sky in ["", "background far { colour 0.3 0.5 0.8 }"] {
        for (cards, wanted) in [(card("one", 0.0), 0.2), (card("one", 0.0) + &card("two", -1.0), 0.36)] {
            let model = scene(&cards, sky);
            let [(light, alpha)] = whole(&transparent(&model))[..] else { panic!("one pixel") };
            assert!((alpha - wanted).abs() < 1e-12, "{alpha} for {wanted}");
            assert!((light - DVec3::splat(0.5 * wanted)).abs().max_element() < 1e-12, "{light}");
        }
    }
    // Where a black leaf is before a black object, nothing can be told by light.
    let black = "material k {} sphere ball { material k  center 0 0 -9  radius 3 }";
    let model = scene(
        &(card("one", 0.0).replace("material m", "material k").replace("fplane", &format!("{black} fplane"))),
        "",
    );
    assert_eq!(whole(&transparent(&model)), [(Rgb::ZERO, 1.0)]);
}

#[test]
fn alpha_does_not_depend_on_the_part_that_is_rendered() {
    let adaptive = Some(Adaptive { most: 64, error: None });
    for adaptive in [None, adaptive] {
        let mut model = scene(FREE);
        (model.camera.value.samples, model.camera.value.adaptive) = (4, adaptive);
        let plan = transparent(&model);
        let (all, (columns, rows)) = (whole(&plan), (7..31, 5..29));
        let part = light(&plan, [&columns, &rows]);
        let same = rows.flat_map(|row| columns.clone().map(move |column| 48 * row + column));
        assert!(same.map(|index| all[index]).eq(part));
    }
}
