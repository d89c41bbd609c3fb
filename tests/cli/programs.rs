//! What the program tells other programs.

use crate::common::program::{folder, outcome, tabray};
use serde_json::Value;
use std::fs;

const SCENE: &str = "look_at eye { pixeldim 41 31 position 0 0 20 target 0 0 0 angle 40 rules notes }
    material grey { diffuse 0.5 0.5 0.5 } material shiny { diffuse 0.2 0.2 0.2 specular 0.5 0.5 0.5 }
    light key { location 0 30 20 emissivity 9 9 9 } light low { location 0 -30 0 emissivity 9 9 9 }
    sphere ball { material shiny center 0 0 0 radius 5 } plane floor { material grey normal 0 1 0 point 0 -6 0 }";

#[test]
fn a_pixel_is_explained_in_json_with_all_digits() {
    let folder = folder();
    fs::write(folder.path().join("ball.ray"), SCENE).expect("a file");
    let (status, out, err) = outcome(tabray(&folder).args(["probe", "ball.ray", "20", "15", "--json"]));
    assert_eq!((status, err.as_str()), (0, ""));
    let pixel: Value = serde_json::from_slice(&out).expect("JSON");
    assert_eq!((&pixel["pixel"], &pixel["size"]), (&[20, 15].into(), &[41, 31].into()));
    let primary = &pixel["rays"][0];
    assert_eq!(
        (&primary["kind"], &primary["object"], &primary["number"]),
        (&"primary".into(), &"ball".into(), &0.into())
    );
    assert_eq!(
        (&primary["distance"], &primary["normal"]),
        (&15.0.into(), &serde_json::json!([0.0, 0.0, 1.0]))
    );
    let lights = primary["lights"].as_array().expect("lights");
    let outcomes: Vec<_> = lights.iter().map(|light| light["outcome"].as_str().expect("a word")).collect();
    assert_eq!(outcomes, ["shines", "behind"]);
    let reflected = pixel["rays"].as_array().expect("rays").iter().find(|ray| ray["kind"] == "reflected");
    assert!(reflected.is_some_and(|ray| ray["from"] == 0), "{pixel}");
    // The text has the same bytes.
    let (_, text, _) = outcome(tabray(&folder).args(["probe", "ball.ray", "20", "15"]));
    let text = String::from_utf8(text).expect("text");
    let bytes: Vec<u64> =
        pixel["bytes"].as_array().expect("bytes").iter().filter_map(Value::as_u64).collect();
    assert!(text.contains(&format!("bytes            ({}, {}, {})", bytes[0], bytes[1], bytes[2])), "{text}");
}

#[test]
fn progress_is_told_in_lines_of_json() {
    let folder = folder();
    fs::write(folder.path().join("ball.ray"), SCENE).expect("a file");
    let args = ["render", "ball.ray", "--samples", "64", "--progress", "json", "--quiet", "-o", "a.png"];
    let (status, _, err) = outcome(tabray(&folder).args(args));
    assert_eq!(status, 0, "{err}");
    let told: Vec<Value> = err.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    let last = &told.last().expect("a line")["progress"];
    assert!(last["of"] == 31 && last["done"] == 31, "{err}");
}
