//! Objects and lights that an image does not need are left out, and its bytes stay the same.

use crate::common::program::{folder, outcome, tabray};
use crate::common::{registry, scenes, small};
use std::fs;
use std::path::Path;
use tabray::render::{Plan, Renderer, decisions};
use tabray::scene::{self, Model};
use tabray::tools::threads::renderer_with;
use tabray::world::Accuracy;

/// Tells whether the pictures with and without what is not needed are the same, and how many decisions leave something
/// out.
fn compared(renderer: &Renderer, model: &Model) -> (bool, usize) {
    let plan = Plan::for_picture(model);
    let is_same = renderer.picture(&plan) == renderer.picture(&Plan::new(model));
    let text: Vec<_> = decisions::of(&plan).iter().map(ToString::to_string).collect();
    (is_same, text.iter().map(|text| text.matches("left out, as").count()).sum())
}

#[test]
fn pictures_without_what_they_do_not_need_are_the_same() {
    let renderer = renderer_with(2).expect("threads");
    for path in scenes() {
        for accuracy in [None, Some(Accuracy::Draft)] {
            assert!(compared(&renderer, &small(&path, accuracy)).0, "{}", path.display());
        }
    }
}

/// Loads a scene with few pixels and with more entities: spheres around the viewer, so many that there is a BVH with
/// them and none without, one of them of glass, and a light that shines away.
fn with_more(path: &Path) -> Option<Model> {
    let mut text = fs::read_to_string(path).ok()?;
    text += "\nmaterial more_matt { ambient 1 2 3 diffuse 3 2 1 } material more_glass { transparency 0.5 }
        spotlight more_light { location 4 3 200 emissivity 9 9 9 point 4 3 300 theta 30 }\n";
    for index in 0..30 {
        let material = if index == 7 { "more_glass" } else { "more_matt" };
        let (x, y) = (10 * (index % 6) - 20, 10 * (index / 6) - 20);
        text += &format!("sphere more{index} {{ material {material} center {x} {y} 300 radius 3 }}\n");
    }
    let loaded = scene::read(registry(), "scene", path.parent()?, text.as_bytes(), None).ok()?;
    let mut model = loaded.model;
    (model.camera.value.pixels, model.camera.value.samples) = small_size(path);
    Some(model)
}

fn small_size(path: &Path) -> ([usize; 2], u32) {
    let camera = small(path, None).camera.value;
    (camera.pixels, camera.samples)
}

#[test]
fn pictures_of_scenes_with_more_behind_the_viewer_are_the_same() {
    let renderer = renderer_with(2).expect("threads");
    let (mut tried, mut left_out) = (0, 0);
    for path in scenes().iter().filter(|path| path.extension().is_some_and(|extension| extension == "ray")) {
        let Some(model) = with_more(path) else { continue };
        let (is_same, count) = compared(&renderer, &model);
        assert!(is_same, "{}", path.display());
        tried += 1;
        left_out += usize::from(count > 0);
    }
    assert!(tried > 120 && left_out > 90, "{left_out} of {tried}");
}

#[test]
fn keep_all_leaves_nothing_out_and_the_image_is_the_same() {
    let folder = folder();
    let text = "camera eye { pixeldim 40 30 worlddim 8 6 viewpoint 4 3 7 } material matt { diffuse 2 2 2 }
        light lamp { location 4 9 2 emissivity 5 5 5 } light below { location 4 -1 2 emissivity 5 5 5 }
        light weak { location 4 9 2 emissivity 0.001 0 0 }
        plane floor { material matt normal 0 1 0 point 0 0 0 }
        sphere behind { material matt center 4 3 30 radius 1 }";
    fs::write(folder.path().join("a.ray"), text).expect("a file");
    let run = |args: &[&str]| {
        let (status, out, err) = outcome(tabray(&folder).args(args));
        assert_eq!(status, 0, "{err}");
        out
    };
    let plan = String::from_utf8(run(&["plan", "a.ray"])).expect("text");
    assert!(
        plan.contains("; `below` is left out, as it is behind all that is seen; `weak` changes no pixel by ")
    );
    assert!(plan.contains(
        "\nunmet        `behind`: left out, as no ray from the viewer, off a mirror or to a light"
    ));
    let whole = String::from_utf8(run(&["plan", "a.ray", "--keep-all"])).expect("text");
    assert!(!whole.contains("left out"), "{whole}");
    let [less, all] =
        [&["render", "a.ray", "-o", "-"][..], &["render", "a.ray", "-o", "-", "--keep-all"]].map(run);
    assert!(less == all);
}
