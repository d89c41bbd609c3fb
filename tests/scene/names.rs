//! Names that several entities share.

use crate::common::program::{folder, outcome, tabray};
use crate::common::{model, registry, render};
use std::path::Path;
use tabray::scene::{self, Report, Severity};

const CAMERA: &str = "camera eye { pixeldim 41 31 worlddim 8 6 viewpoint 4 3 6 }\n";
const RED: &str = "material red { ambient 9 1 1 }\n";
const BALL: &str = "sphere ball { material red center 4 3 -3 radius 1 }\n";

/// Returns the warnings of a scene that has no errors.
fn warnings(text: &str) -> Report {
    match scene::read(registry(), "scene", Path::new(""), text.as_bytes(), None) {
        Ok(loaded) => loaded.warnings,
        Err(report) => panic!("{report}"),
    }
}

/// Returns the only warning of a scene, which marks the later place and the first one.
fn warning(text: &str, first: &str, later: &str) -> String {
    let report = warnings(text);
    let [fault] = report.faults() else { panic!("{report}") };
    assert_eq!(fault.severity, Severity::Warning);
    let at = |place: &scene::Place| place.as_ref().map_or("", |place| &text[place.start..]).to_owned();
    assert!(at(&fault.place).starts_with(later), "{report}");
    assert!(at(&fault.also[0].0).starts_with(first), "{report}");
    fault.message.clone() + ": " + &fault.label
}

#[test]
fn the_first_material_of_a_name_counts() {
    let again = "material red { ambient 1 1 9 }\n";
    let text = [CAMERA, RED, again, BALL].concat();
    assert!(render(&model(&text)) == render(&model(&[CAMERA, RED, BALL].concat())));
    assert_eq!(
        warning(&text, "red { ambient 9", "red { ambient 1"),
        "material `red` is defined twice: ignored"
    );
    let late = [CAMERA, RED, BALL, again].concat();
    assert!(render(&model(&late)) == render(&model(&text)), "wherever the second one stands");
}

#[test]
fn the_first_texture_of_a_name_counts_and_no_other_is_read() {
    let textures = "texture t { filename scenes/textures/letter.ppm }\ntexture t { filename none.ppm }\n";
    let wall =
        "texplane wall { material red normal 0 0 1 point 0 0 -1 xdir 1 0 0 dimensions 8 6 texname t mode 0 }";
    let text = [CAMERA, RED, textures, wall].concat();
    let told = warning(&text, "t { filename scenes", "t { filename none");
    assert_eq!(told, "texture `t` is defined twice: ignored");
}

#[test]
fn the_first_object_of_a_type_and_a_name_counts() {
    let again = "sphere ball { material red center 6 3 -3 radius 1 }\n";
    let text = [CAMERA, RED, BALL, again].concat();
    assert!(render(&model(&text)) == render(&model(&[CAMERA, RED, BALL].concat())));
    let told = warning(&text, "ball { material red center 4", "ball { material red center 6");
    assert_eq!(told, "sphere `ball` is defined twice: ignored");
}

/// The course's own spec1 to spec8 have both a sphere `left` and an fplane `left`, and show both.
#[test]
fn objects_of_different_types_may_share_a_name() {
    let pane = "fplane ball { material red normal 0 0 1 point 5 3 -3 xdir 1 0 0 dimensions 1 1 }\n";
    let text = [CAMERA, RED, BALL, pane].concat();
    assert_eq!(model(&text).objects.len(), 2);
    let told = warning(&text, "ball { material red center", "ball { material red normal");
    assert_eq!(told, "two objects have the name `ball`: ");
}

#[test]
fn all_lights_of_a_name_shine() {
    let lamps =
        "light lamp { location 1 7 2 emissivity 5 5 5 }\nlight lamp { location 7 7 2 emissivity 5 5 5 }\n";
    let text = [CAMERA, RED, BALL, lamps].concat();
    assert_eq!(model(&text).lights.len(), 2);
    assert_eq!(warning(&text, "lamp { location 1", "lamp { location 7"), "two lights have the name `lamp`: ");
}

#[test]
fn a_name_is_warned_of_once_however_often_it_is_there() {
    let text = [CAMERA, RED, &BALL.repeat(2048)].concat();
    let told = warning(&text, "ball {", "ball {");
    assert_eq!(told, "sphere `ball` is defined 2048 times: ignored, as are 2046 more");
}

#[test]
fn many_names_are_one_message() {
    let materials =
        |count: usize| (0..count).map(|i| format!("material m{i} {{ ambient 1 1 1 }}\n")).collect::<String>();
    let text = |count| [CAMERA, RED, BALL, &materials(count), &materials(count)].concat();
    assert_eq!(warnings(&text(8)).faults().len(), 8, "a few are told one by one");
    let told = warning(&text(900), "m0 {", "m0 {");
    assert_eq!(told, "material `m0` and 899 others are defined more than once: ignored, as are 899 more");
}

#[test]
fn what_is_left_out_is_checked_all_the_same() {
    let again = "material red { ambient 1 1 }\n";
    let text = [CAMERA, RED, again, BALL].concat();
    let (status, _, err) = outcome(tabray(&folder()).args(["check", "-"]).write_stdin(text));
    assert_eq!(status, 2);
    assert!(err.contains("`ambient` of material `red` takes 3 numbers, not 2"), "{err}");
}
