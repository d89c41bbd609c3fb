//! Surfaces that cover only a part of what is behind them, by the free rules of light.

use crate::common::{model_in, render};
use glam::DVec3;
use image::{Rgba, RgbaImage};
use std::fs;
use std::path::Path;
use tabray::render::Plan;
use tabray::render::trace;
use tabray::tools::colours::{Prover, Verdict};
use tempfile::TempDir;

const SQUARE: &str = "mtllib square.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
    usemtl m\nf 1/1 2/2 3/3 4/4\n";

/// Writes an image of four columns with these opacities, and a square whose material has one of them.
const OPACITIES: [u8; 4] = [0, 51, 128, 255];
const OF_MATERIAL: f64 = 0.25;

fn folder() -> TempDir {
    let folder = TempDir::new().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    RgbaImage::from_fn(4, 1, |x, _| Rgba([255, 255, 255, OPACITIES[x as usize]]))
        .save(at("steps.png"))
        .expect("an image");
    fs::write(at("square.obj"), SQUARE).expect("a file");
    fs::write(at("square.mtl"), format!("newmtl m\nKd 1 1 1\nd {OF_MATERIAL}\n")).expect("a file");
    folder
}

/// Returns the light of four pixels in a row, each of which sees a column of the image.
fn row(folder: &Path, scene: &str) -> [DVec3; 4] {
    let model = model_in(
        folder,
        &format!(
            "orthographic eye {{ pixeldim 4 1 position 0 0 5 target 0 0 0 width 2 }}
             texture t {{ filename steps.png coverage yes }} image part {{ texture t }} {scene}"
        ),
    );
    let plan = Plan::new(&model);
    [0, 1, 2, 3].map(|x| trace::pixel(&plan, x, 0))
}

fn card(name: &str, material: &str, z: f64) -> String {
    format!(
        "fplane {name} {{ material {material} normal 0 0 1 point -1 -1 {z} xdir 1 0 0 dimensions 2 2 shader part }}"
    )
}

fn agree(seen: [DVec3; 4], wanted: impl Fn(f64) -> DVec3) {
    for (seen, opacity) in seen.into_iter().zip(OPACITIES) {
        let wanted = wanted(f64::from(opacity) / 255.0);
        assert!((seen - wanted).abs().max_element() < 1e-12, "{opacity}: {seen} for {wanted}");
    }
}

const BEHIND: DVec3 = DVec3::new(0.1, 0.2, 0.6);
const ONE: DVec3 = DVec3::new(0.8, 0.4, 0.2);
const OTHER: DVec3 = DVec3::new(0.3, 0.9, 0.5);
const COLOURS: &str = "background b { colour 0.1 0.2 0.6 } material one { ambient 0.8 0.4 0.2 }
    material other { ambient 0.3 0.9 0.5 } ";

#[test]
fn a_part_that_is_covered_is_the_analytic_blend() {
    let folder = folder();
    let one = format!("{COLOURS}{}", card("first", "one", 0.0));
    agree(row(folder.path(), &one), |covered| covered * ONE + (1.0 - covered) * BEHIND);
    let two = format!("{one} {}", card("second", "other", -1.0));
    agree(row(folder.path(), &two), |covered| {
        covered * ONE + (1.0 - covered) * (covered * OTHER + (1.0 - covered) * BEHIND)
    });
    let copied = format!("{one} place copy {{ object first translation 0 0 -1 }}");
    agree(row(folder.path(), &copied), |covered| covered * ONE + (1.0 - covered) * BEHIND);
}

#[test]
fn the_opacity_of_a_file_covers_as_that_of_an_image() {
    let folder = folder();
    let mesh = "mesh first { material one file square.obj materials file }";
    let seen = row(folder.path(), &format!("{COLOURS}{mesh}"));
    let wanted = OF_MATERIAL * ONE + (1.0 - OF_MATERIAL) * BEHIND;
    assert!(seen.iter().all(|seen| (*seen - wanted).abs().max_element() < 1e-12), "{seen:?} for {wanted}");
}

#[test]
fn a_mirror_and_rough_metal_are_seen_as_far_as_they_cover() {
    let folder = folder();
    // What they mirror is as bright as what is behind them.
    for material in ["material m { specular 1 1 1 }", "metal m { colour 1 1 1 roughness 0.3 }"] {
        let scene = format!("background b {{ colour 0.1 0.2 0.6 }} {material} {}", card("first", "m", 0.0));
        let seen = row(folder.path(), &scene);
        for seen in seen {
            assert!((seen - BEHIND).abs().max_element() < 0.01, "{material}: {seen}");
        }
    }
}

#[test]
fn what_is_not_covered_lets_the_light_of_lamps_pass() {
    let folder = folder();
    let lit = |card: &str| {
        let scene = format!(
            "material m {{ diffuse 0.5 0.5 0.5 }} sun s {{ direction 0 0 1 emissivity 1 1 1 }}
             plane wall {{ material m normal 0 0 1 point 0 0 -3 }} {card}"
        );
        // The card is beside the viewer's rays.
        row(folder.path(), &scene)
    };
    let bright = lit("")[0];
    // The viewer is in front of the card, which is between the wall and the sun.
    let seen = lit(&card("first", "m", 6.0));
    agree(seen, |covered| (1.0 - covered) * bright);
}

#[test]
fn the_notes_rules_cut_out_what_is_less_than_half_opaque() {
    let folder = folder();
    let picture = |texture: &str| {
        render(&model_in(
            folder.path(),
            &format!(
                "camera eye {{ pixeldim 32 24 worlddim 4 3 viewpoint 2 1.5 4 }}
                 background b {{ colour 0.1 0.2 0.6 }} material m {{ ambient 0.5 0.5 0.5 }}
                 texture t {{ filename steps.png {texture} }} image part {{ texture t }}
                 fplane p {{ material m normal 0 0 1 point 1 0.5 -1 xdir 1 0 0 dimensions 2 2 shader part }}"
            ),
        ))
    };
    assert_eq!(picture("coverage yes"), picture("cutout yes"));
}

#[test]
fn colours_of_what_covers_in_part_are_proven() {
    let folder = folder();
    let model = model_in(
        folder.path(),
        "look_at eye { pixeldim 24 18 position 0.3 1 5 target 0 0 0 angle 40 }
         background b { colour 0.1 0.2 0.6 } material m { ambient 0.2 0.2 0.2 diffuse 0.7 0.7 0.7 }
         sun s { direction 0.5 1 1 emissivity 1 1 1 } plane floor { material m normal 0 1 0 point 0 -1 0 }
         mesh first { material m file square.obj materials file }",
    );
    let plan = Plan::new(&model);
    let prover = Prover::new(&plan);
    let all = (0..18).flat_map(|y| (0..24).map(move |x| (x, y)));
    let open = all.filter(|(x, y)| prover.traced(*x, *y).verdict() != Verdict::Proven).count();
    assert_eq!(open, 0);
}
