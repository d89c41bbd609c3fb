//! `verify --colours`: what is proven of an image's bytes.

use crate::common::program::{folder, outcome, scene, tabray};
use serde_json::Value;

/// Proves the colours of a scene. Returns the exit status, what is printed, and the messages.
fn proven(name: &str, options: &[&str]) -> (i32, String, String) {
    let folder = folder();
    let mut command = tabray(&folder);
    let (status, out, err) = outcome(command.args(["verify", "--colours"]).arg(scene(name)).args(options));
    (status, String::from_utf8(out).expect("text"), err)
}

#[test]
fn colours_of_lights_shadows_mirrors_and_glass_are_proven() {
    for name in
        ["light/shadow.ray", "material/mirror.ray", "material/coloured-shadow.ray", "spotlight/shadow.ray"]
    {
        let (status, out, err) = proven(name, &[]);
        assert_eq!(status, 0, "{name}: {err}");
        assert!(
            out.contains(
                "19200 of 19200 pixels proven (100.0000 %), 0 off by rounding, 0 open, 0 contradicted\n"
            ),
            "{name}: {out}"
        );
        assert!(out.contains("57600 of 57600 bytes proven"), "{name}: {out}");
    }
}

#[test]
fn pixels_at_the_edges_of_tiles_are_named() {
    let (status, out, _) = proven("pplane/tiles.ray", &["--json"]);
    assert_eq!(status, 0);
    let numbers: Value = serde_json::from_str(&out).expect("JSON");
    let of = |kind: &str| numbers["pixels"][kind].as_u64().expect("a number");
    assert_eq!(of("proven") + of("rounded"), 19200, "{out}");
    assert!((1..400).contains(&of("rounded")), "{out}");
    assert_eq!(numbers["first"]["rounded"][0][1], 59, "the row at whose middle tiles meet: {out}");
}

#[test]
fn the_image_of_a_proof_is_grey_where_the_picture_is_off_by_rounding() {
    let folder = folder();
    let mut command = tabray(&folder);
    command.args(["verify", "--colours", "-o", "proof.png"]).arg(scene("pplane/tiles.ray"));
    let (status, _, err) = outcome(&mut command);
    assert_eq!(status, 0, "{err}");
    let image = image::open(folder.path().join("proof.png")).expect("an image").into_rgb8();
    let grey = image.pixels().filter(|pixel| pixel.0 == [128; 3]).count();
    let black = image.pixels().filter(|pixel| pixel.0 == [0; 3]).count();
    assert!(grey > 0 && grey + black == 19200, "{grey} {black}");
}

#[test]
fn a_proof_of_colours_stops_in_time_and_does_not_depend_on_threads() {
    let (status, out, err) = proven("gallery/marbles.ray", &["--time-limit", "200ms"]);
    assert_eq!(status, 130, "{err}");
    assert!(
        out.contains("not reached") && err.contains("the time limit of 200ms has been reached"),
        "{out}{err}"
    );
    let by = |threads: &str| proven("material/glint.ray", &["--samples", "2", "--threads", threads]);
    assert_eq!(by("1"), by("3"));
}

#[test]
fn the_colours_of_the_classic_method_are_refused() {
    let (status, _, err) = proven("light/shadow.ray", &["--method", "classic"]);
    assert_eq!(status, 2);
    assert!(err.contains("the colours of the classic method cannot be proven"), "{err}");
}

#[test]
fn proofs_of_objects_are_printed_as_json_with_what_they_assume() {
    let folder = folder();
    let mut command = tabray(&folder);
    let (status, out, err) = outcome(command.args(["verify", "--json"]).arg(scene("entities/box.ray")));
    assert_eq!(status, 0, "{err}");
    let numbers: Value = serde_json::from_slice(&out).expect("JSON");
    let of = |kind: &str| numbers["pixels"][kind].as_u64().expect("a number");
    assert_eq!(of("proven") + of("ties"), of("all"), "{numbers}");
    assert_eq!((of("not_certified"), of("contradicted")), (0, 0), "{numbers}");
    assert_eq!(of("undecided"), of("ties"));
    assert_eq!(numbers["share"].as_f64(), Some(of("proven") as f64 / of("all") as f64), "to the last digit");
    let size = |side: usize| numbers["size"][side].as_u64().expect("a number");
    assert_eq!(size(0) * size(1), of("all"));
    let objects = numbers["objects"].as_array().expect("objects");
    let names: Vec<_> = objects.iter().map(|object| object["object"].as_str()).collect();
    assert!(names.contains(&Some("brick")), "{names:?}");
    for kind in ["all", "proven", "ties"] {
        let sum: u64 = objects.iter().filter_map(|object| object[kind].as_u64()).sum();
        assert_eq!(sum, of(kind), "{kind} of all objects");
    }
    assert_eq!(numbers["uncertified"], Value::Array(Vec::new()));
    assert_eq!(numbers["assumptions"][0]["assumed"], "vertices as placed, rounded to f64");
    assert_eq!(numbers["assumptions"][0]["of"], serde_json::json!(["area_light", "box"]));
    let mut command = tabray(&folder);
    let (_, out, _) = outcome(command.arg("verify").arg(scene("entities/box.ray")));
    let out = String::from_utf8(out).expect("text");
    assert!(out.ends_with("\nassumed: vertices as placed, rounded to f64 (`area_light`, `box`)\n"), "{out}");
}
