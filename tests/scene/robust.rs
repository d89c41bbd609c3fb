//! Bad input of any kind ends in messages: no panic, no endless run.

use crate::common;
use crate::common::{model, registry};
use proptest::prelude::*;
use std::path::Path;
use tabray::scene::{self, Severity};

/// Reads bytes as a scene; either there is a model, or there is an error that can be printed.
fn read(bytes: &[u8]) {
    if let Err(report) = scene::read(registry(), "any", Path::new(""), bytes, None) {
        assert!(report.faults().iter().any(|fault| fault.severity == Severity::Error));
        assert!(report.to_string().contains("error"));
    }
}

proptest! {
    #[test]
    fn any_bytes_are_read_or_refused(bytes in any::<Vec<u8>>()) {
        read(&bytes);
    }

    #[test]
    fn any_text_is_read_or_refused(text in "(\\PC|\\s){0,200}") {
        read(text.as_bytes());
    }

    #[test]
    fn any_order_of_the_languages_words_is_read_or_refused(
        words in prop::collection::vec(prop::sample::select(vec![
            "camera", "material", "sphere", "plane", "fplane", "tiled_plane", "light", "{", "}", "{", "}", "\n", "#",
            "pixeldim", "worlddim", "viewpoint", "ambient", "normal", "point", "xdir", "center", "radius", "a", "b",
            "0", "1", "-3.5", "1e400", "nan", "1,5", "raduis", "über", "\r\n", "\t",
        ]), 0..60)
    ) {
        read(words.join(" ").as_bytes());
    }
}

proptest! {
    #[test]
    fn any_order_of_tomls_words_is_read_or_refused(
        words in prop::collection::vec(prop::sample::select(vec![
            "[camera.eye]", "\n[sphere.a]\n", "\n[sphere.b]\n", "\n[[sphere.a]]\n", "\n[material.m]\n", "[", "]", "{", "}",
            "\n", "#", ".", "=", ",", "\"", "'", "\"m\"", "\"\"\"", "\\", "pixeldim = [8, 6]\n", "material = \"m\"\n",
            "center = [1, 2, 3]\n", "radius", "radius = 1\n", "1", "-0", "1.", "0x", "nan", "true", "1979-05-27", "über",
            "\r\n", "\t", "\u{7f}",
        ]), 0..60)
    ) {
        read(format!("[camera.eye]\n{}", words.concat()).as_bytes());
        read(words.join(" ").as_bytes());
    }
}

#[test]
fn brackets_in_brackets_are_refused_however_many() {
    for (open, close) in [("[", "]"), ("{a=", "}")] {
        let deep = format!("[sphere.a]\nradius = {}1{}\n", open.repeat(200_000), close.repeat(200_000));
        read(deep.as_bytes());
        read(format!("[sphere.a]\nradius = {}", open.repeat(200_000)).as_bytes());
    }
}

#[test]
fn a_scene_with_a_fault_in_each_toml_table_reports_them_all() {
    let mut text =
        "[camera.eye]\npixeldim = [8, 6]\nworlddim = [8, 6]\nviewpoint = [4, 3, 6]\n[material.m]\nambient = [1, 1, 1]\n"
            .to_owned();
    for index in 0..10_000 {
        text += &format!("[sphere.s{index}]\nmaterial = \"m\"\ncenter = [1, 2\nradius = 1\n");
    }
    let Err(report) = scene::read(registry(), "many.toml", Path::new(""), text.as_bytes(), None) else {
        panic!("faults")
    };
    assert_eq!(report.faults().len(), 10_000);
}

#[test]
fn a_scene_with_a_fault_in_each_of_ten_thousand_entities_reports_them_all() {
    let mut text =
        "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 }\nmaterial m { ambient 1 1 1 }\n".to_owned();
    for index in 0..10_000 {
        text += &format!("sphere s{index} {{ material m center 1 2 raduis 1 }}\n");
    }
    let Err(report) = scene::read(registry(), "many", Path::new(""), text.as_bytes(), None) else {
        panic!("faults")
    };
    assert_eq!(report.faults().len(), 20_000);
    assert!(report.to_string().ends_with("many: 20000 errors\n"));
}

#[test]
fn mirrors_that_touch_end_and_stay_within_the_stack() {
    // Two mirrors at a distance that rounding loses: only the limit on rays ends their reflections.
    let model = model(
        "camera eye { pixeldim 4 3 worlddim 8 6 viewpoint 4 3 6 }
         material glass  { ambient 0.001 0.001 0.001 transparency 0.5 specular 1 }
         material mirror { ambient 0.001 0.001 0.001 specular 1 }
         plane near { material glass normal 0 0 1 point 0 0 -2 }
         plane far { material mirror normal 0 0 1 point 0 0 -2.000000000000001 }",
    );
    common::render(&model);
}

#[test]
fn light_on_a_surface_and_extreme_sizes_give_bytes() {
    let model = model(
        "camera eye { pixeldim 40 30 worlddim 8 6 viewpoint 4 3 6 }
         material m { ambient 1 1 1 diffuse 1 1 1 specular 1 shininess 2.5 }
         sphere big { material m center 1e150 0 0 radius 1e150 }
         sphere small { material m center 4 3 -1 radius 1e-150 }
         plane wall { material m normal 1e-100 0 1e-100 point 0 0 -4 }
         light on_the_wall { location 4 3 -8 emissivity 1 1 1 }
         light far_away { location 1e150 1e150 1e150 emissivity 1e300 1 1 }",
    );
    common::render(&model);
}
