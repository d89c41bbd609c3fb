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

/// The noise that progress tells is about the root mean square error against an image of many samples, for fixed numbers of
/// samples and for those that pixels need.
#[test]
fn progress_tells_the_noise_of_what_is_done() {
    let folder = folder();
    let scene = "look_at eye { pixeldim 32 32 position 0 1.5 3 target 0 0.4 0 } material grey { diffuse 0.7 0.7 0.7 }
         area_light lamp { emissivity 4 4 4 location 0 2 0 target 0.5 0 0 radius 0.6 }
         plane floor { material grey point 0 0 0 normal 0 1 0 } sphere ball { material grey center 0 0.5 0 radius 0.5 }";
    fs::write(folder.path().join("soft.ray"), scene).expect("a file");
    let render = |samples: &str| {
        let args =
            ["render", "soft.ray", "--samples", samples, "--progress", "json", "--quiet", "-o", "a.ppm"];
        let (status, _, err) = outcome(tabray(&folder).args(args));
        assert_eq!(status, 0, "{err}");
        let last: Value = serde_json::from_str(err.lines().last().expect("a line")).expect("JSON");
        let image = fs::read(folder.path().join("a.ppm")).expect("an image");
        (last["progress"]["noise"].as_f64(), image)
    };
    let (_, right) = render("512");
    for samples in ["4", "8", "4..8"] {
        let (noise, image) = render(samples);
        let squares = image.iter().zip(&right).map(|(one, other)| f64::from(one.abs_diff(*other)).powi(2));
        let error = (squares.sum::<f64>() / image.len() as f64).sqrt();
        let noise = noise.expect("noise");
        assert!(noise > 0.7 * error && noise < 1.6 * error, "{samples}: {noise} {error}");
    }
    assert_eq!(render("1").0, None, "one sample says nothing of its error");
}
