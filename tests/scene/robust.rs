//! Bad input of any kind ends in messages, without a panic and without an endless run.

use crate::common;
use crate::common::{model, registry};
use proptest::prelude::*;
use std::path::Path;
use tabray::scene::{self, Report, Severity};

/// Reads bytes as a scene. There must be either a model or an error that can be printed.
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
            "let", "repeat", "include", "\"2*a\"", "\"a\"", "\"1/0\"", "repeat a 3 {", "let b",
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
            "[let]\n", "a = \"2*b\"\n", "[repeat.b]\n", "count = 3\n", "[repeat.b.sphere.a]\n", "include", "\"a\"",
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
fn a_scene_with_a_fault_in_each_toml_table_counts_them_all() {
    let mut text =
        "[camera.eye]\npixeldim = [8, 6]\nworlddim = [8, 6]\nviewpoint = [4, 3, 6]\n[material.m]\nambient = [1, 1, 1]\n"
            .to_owned();
    for index in 0..10_000 {
        text += &format!("[sphere.s{index}]\nmaterial = \"m\"\ncenter = [1, 2\nradius = 1\n");
    }
    let Err(report) = scene::read(registry(), "many.toml", Path::new(""), text.as_bytes(), None) else {
        panic!("faults")
    };
    assert_eq!(report.count(Severity::Error), 10_000);
}

#[test]
fn a_scene_with_a_fault_in_each_of_ten_thousand_entities_counts_them_all() {
    let mut text =
        "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 }\nmaterial m { ambient 1 1 1 }\n".to_owned();
    for index in 0..10_000 {
        text += &format!("sphere s{index} {{ material m center 1 2 raduis 1 }}\n");
    }
    let Err(report) = scene::read(registry(), "many", Path::new(""), text.as_bytes(), None) else {
        panic!("faults")
    };
    assert_eq!(report.count(Severity::Error), 20_000);
    assert_eq!(report.faults().len(), 100);
    assert!(report.to_string().ends_with("\n\nand 19900 more errors\n\nmany: 20000 errors\n"));
}

/// Returns the report of a scene that is refused.
fn refused(name: &str, text: &str) -> Report {
    match scene::read(registry(), name, Path::new(""), text.as_bytes(), None) {
        Ok(_) => panic!("it is read"),
        Err(report) => report,
    }
}

const HEAD: &str = "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 }\nmaterial m { ambient 1 1 1 }\n";

const TOML_HEAD: &str = "[camera.eye]\npixeldim = [8, 6]\nworlddim = [8, 6]\nviewpoint = [4, 3, 6]\n[material.m]\nambient = [1, 1, 1]\n";

#[test]
fn messages_stay_short_however_long_a_line_is() {
    let runs = [
        "{}",
        "{",
        "}",
        "[]",
        "[",
        "\"",
        "a",
        "\"\\x",
        "=",
        ",",
        "a.",
        "sphere s{",
        "ü",
        "a ",
        "}\n",
        "x = y\n",
    ];
    for run in runs {
        let junk = run.repeat(60_000 / run.len());
        for text in
            [format!("{HEAD}{junk}"), format!("{HEAD}sphere s {{ material m center {junk} radius 2 }}")]
        {
            short(&refused("long", &text), run);
        }
        for text in
            [format!("{TOML_HEAD}{junk}"), format!("{TOML_HEAD}[sphere.s]\ncenter = {junk}\nradius = 2\n")]
        {
            short(&refused("long.toml", &text), run);
        }
    }
}

/// Asserts that a report is not too long to read, in any form.
fn short(report: &Report, of: &str) {
    for said in [report.to_string(), report.short(), report.json()] {
        assert!(said.len() < 200_000, "{} bytes are said of {of:?}", said.len());
    }
}

#[test]
fn a_place_in_a_long_line_is_told_by_its_own_line_and_column() {
    let report = refused("long", &format!("{HEAD}# \n{}sphere s {{ material m }}", " ".repeat(9_000)));
    let told = report.to_string();
    assert!(told.contains(" --> long:4:9008\n"), "{told}");
    assert!(told.contains("sphere s { material m }"), "{told}");
}

#[test]
fn errors_that_differ_in_their_places_alone_are_one() {
    let report = refused("many", &format!("{HEAD}{}", "}\n".repeat(5_000)));
    let [fault] = report.faults() else { panic!("{report}") };
    assert_eq!((fault.message.as_str(), fault.similar_faults.0), ("stray `}`", 4_999));
    let told = report.to_string();
    assert!(told.contains("note: the same in 4999 more places, first in lines 4, 5, 6\n"), "{told}");
    assert!(told.ends_with("\nmany: 5000 errors\n"), "{told}");
    assert_eq!(report.short().lines().count(), 1);
    assert_eq!(report.json().lines().count(), 1);
}

#[test]
fn a_few_errors_of_one_kind_are_told_one_by_one() {
    assert_eq!(refused("few", &format!("{HEAD}{}", "}\n".repeat(8))).faults().len(), 8);
    assert_eq!(refused("few", &format!("{HEAD}{}", "}\n".repeat(9))).faults().len(), 1);
}

#[test]
fn an_error_is_told_after_any_number_of_warnings() {
    let balls: String = (0..200)
        .map(|ball| format!("sphere s{ball} {{ material m center 1 1 1 radius 1 radius 1 }}\n"))
        .collect();
    let report = refused("warnings", &format!("{HEAD}{balls}plane p {{ material m }}"));
    assert!(report.to_string().contains("error: plane `p` lacks `normal`, `point`"), "{report}");
    assert!(report.to_string().contains("\n\nand 100 more warnings\n\n"), "{report}");
}

#[test]
fn ten_thousand_misspelt_names_are_guessed_at_for_a_while() {
    let names = |what: fn(usize) -> String| (0..10_000).map(what).collect::<String>();
    let materials = names(|name| format!("material red{name} {{ ambient 1 1 1 }}\n"));
    let balls = names(|name| format!("sphere s{name} {{ material rde{name} center 1 1 1 radius 1 }}\n"));
    let report = refused("names", &format!("{HEAD}{materials}{balls}"));
    assert_eq!(report.count(Severity::Error), 10_000);
    assert!(report.to_string().contains("did you mean `red0`?"), "{report}");
}

#[test]
fn many_attributes_and_values_are_refused_and_not_kept() {
    let values = format!("{HEAD}sphere s {{ material m radius 1 center {}}}", "1 ".repeat(100_000));
    assert!(refused("values", &values).to_string().contains("takes 3 numbers, not 1000 or more"));
    let attributes = format!("{HEAD}sphere s {{ material m center 1 1 1 {}}}", "radius 1 ".repeat(100_000));
    assert!(
        refused("attributes", &attributes).to_string().contains("this sphere has more than 1000 attributes")
    );
}

#[test]
fn a_line_of_toml_is_not_longer_than_it_may_be() {
    let told = refused("line.toml", &format!("{TOML_HEAD}x = {}", "[".repeat(70_000))).to_string();
    assert!(told.contains("error: this line is 70004 bytes long\n --> line.toml:7:1\n"), "{told}");
}

#[test]
fn a_second_equals_sign_is_told_where_it_stands() {
    let told = refused(
        "twice.toml",
        &format!("{TOML_HEAD}[sphere.s]\nmaterial = \"m\"\ncenter == [4, 3, -4]\nradius = 2\n"),
    );
    assert!(told.to_string().contains("extra `=`, expected nothing\n --> twice.toml:9:9\n"), "{told}");
    refused("short.toml", "[sphere.a]\ncenter==");
    assert!(refused("dotted.toml", "[camera.eye]\n1.pixeldim = [8, 6]\n").is_fatal());
}

#[test]
fn a_long_scene_in_toml_is_read_as_a_short_one_is() {
    let ball =
        |ball: usize| format!("[sphere.s{ball}]\nmaterial = \"m\"\ncenter = [\n1, 1,\n1]\nradius = 1\n");
    let balls: String = (0..4_000).map(ball).collect();
    let text = format!("{TOML_HEAD}{balls}");
    let loaded = scene::read(registry(), "long.toml", Path::new(""), text.as_bytes(), None);
    assert_eq!(loaded.unwrap_or_else(|report| panic!("{report}")).model.objects.len(), 4_000);
    let again = refused("long.toml", &format!("{text}{}", ball(7)));
    assert!(again.to_string().contains("error: duplicate `s7`\n"), "{again}");
    let inline: String = (0..4_000)
        .map(|ball| format!("sphere.s{ball} = {{ material = \"m\", center = [1, 1, 1], radius = 1 }}\n"))
        .collect();
    let text = format!("{inline}{TOML_HEAD}");
    let late = refused("long.toml", &text);
    assert!(late.to_string().contains("material `m` is used before it is defined"), "{late}");
}

#[test]
fn mirrors_that_touch_end_and_stay_within_the_stack() {
    // Two mirrors at a distance that is lost to rounding: only the limit on rays ends their reflections.
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

#[test]
fn a_fault_within_curly_quotes_is_shown_in_whole_letters() {
    let head = "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 }\nmaterial red { ambient 1 1 1 }\n";
    for rest in [
        "sphere “ball ” { }",
        "sphere “plane ” { material red  center 4 3 -4  raduis 1 }\n“plane ” wall { }",
        "sphere a { material “x y z”  center 4 3 -4  radius 1 }",
        "sphere a { material “x y”  center “4 3 ” -4  radius 1 }\nsphere „b“ {",
    ] {
        let text = format!("{head}{rest}");
        let read = scene::read(registry(), "any", Path::new(""), text.as_bytes(), None);
        let report = read.err().expect("faults");
        for shown in [report.to_string(), report.short(), report.json()] {
            assert!(shown.contains("curly quotes do not quote a name"), "{shown}");
        }
        for fault in report.faults() {
            assert!(fault.place.as_ref().is_none_or(|place| text.get(place.clone()).is_some()), "{fault:?}");
        }
    }
}
