//! Pixels whose first hit 237 bits do not decide.

use crate::common::program::{folder, outcome, scene, tabray};
use image::RgbImage;
use serde_json::Value;
use std::fs;

/// Renders the stair, through whose rims some rays pass. Returns the messages, what `--stats` counts and the number of white
/// pixels of `--aov undecided`.
fn stair(options: &[&str]) -> (String, u64, usize) {
    let folder = folder();
    let mut command = tabray(&folder);
    command.args(["render", "--size", "96", "-o", "a.png", "--aov", "undecided", "--stats=json"]);
    let (status, _, err) = outcome(command.args(options).arg(scene("hard/jump.ray")));
    assert_eq!(status, 0, "{err}");
    let stats = err.lines().find(|line| line.starts_with('{')).expect("statistics");
    let stats: Value = serde_json::from_str(stats).expect("JSON");
    assert_eq!(stats["undecided"][0]["object"], "column");
    let image = image::open(folder.path().join("a-undecided.png")).expect("an image").into_rgb8();
    let white = image.pixels().filter(|pixel| pixel.0 == [255; 3]).count();
    let black = image.pixels().filter(|pixel| pixel.0 == [0; 3]).count();
    assert_eq!(white + black, 96 * 72);
    (err, stats["undecided"][0]["pixels"].as_u64().expect("a number"), white)
}

#[test]
fn a_render_counts_and_shows_the_pixels_that_it_could_not_decide() {
    for options in [&[][..], &["--samples", "4"], &["--max-error", "20"]] {
        let (err, counted, white) = stair(options);
        assert!(counted > 0 && counted == white as u64, "{options:?}: {counted} {white}");
        let warning = format!(
            "warning: {counted} pixels could not be decided: `column` may not be continuous there, by `floor(y)`, as at "
        );
        assert!(err.contains(&warning), "{options:?}: {err}");
    }
}

#[test]
fn the_operation_that_leaves_pixels_open_is_named() {
    for (formula, reason) in [
        ("(x + 2)*heaviside(y - 0.3)", "`s` may not be continuous there, by `heaviside(y - 0.3)`"),
        ("sin(x*y)/(x*y) - 0.9", "`s` may be undefined, by `sin(x*y)/(x*y)`"),
        ("cbrt(x)*exp(y) + 0*sin(z)", "`s` has no bounded slope"),
        ("abs(x)*exp(y + 0.1*z)", "`s` is 0 without a change of sign"),
    ] {
        let folder = folder();
        let text = format!(
            "look_at eye {{ pixeldim 16 12  position 3.15 1.95 3.9  target 0 0 0  angle 45 }}
             material m {{ ambient 1 1 1 }}
             implicit s {{ material m  formula \"{formula}\"  box -1 -1 -1 1 1 1 }}"
        );
        fs::write(folder.path().join("s.ray"), text).expect("room for a file");
        let (status, _, err) = outcome(tabray(&folder).args(["render", "s.ray", "-o", "a.png"]));
        assert!(status == 0 && err.contains(reason), "{formula}: {err}");
        assert_eq!(err.contains("is squared"), err.contains("without a change of sign"), "{err}");
    }
}

#[test]
fn rays_along_the_horizon_are_decided() {
    let folder = folder();
    let mut command = tabray(&folder);
    command.args(["render", "--size", "96", "-o", "a.png"]).arg(scene("hard/rug.ray"));
    let (status, _, err) = outcome(&mut command);
    assert!(status == 0 && !err.contains("decided"), "{err}");
}

/// Renders a sphere by u and v, in the middle of whose picture is its pole. Returns the messages and the picture.
fn pole() -> (String, RgbImage) {
    let folder = folder();
    let sphere = "camera eye { pixeldim 9 9  worlddim 3 3  viewpoint 1.5 1.5 5 }
        material white { ambient 1 1 1 }
        parametric ball
        {
            material white
            x \"cos(v)*cos(u)\"  y \"cos(v)*sin(u)\"  z \"sin(v)\"
            u 0 6.283185307179586  v -1.58 1.58
            center 1.5 1.5 0
        }";
    fs::write(folder.path().join("pole.ray"), sphere).expect("room for a file");
    let (status, _, err) = outcome(tabray(&folder).args(["render", "pole.ray", "-o", "a.png"]));
    assert_eq!(status, 0, "{err}");
    (err, image::open(folder.path().join("a.png")).expect("an image").into_rgb8())
}

#[test]
fn a_ray_into_a_pole_is_counted() {
    let (err, image) = pole();
    let warning = "warning: 1 pixel could not be decided: `ball` has a pole or a fold there, or meets itself, as at 1.5 1.5 1\n";
    assert!(err.contains(warning), "{err}");
    // It is shown as what is around it is.
    let [at, beside] = [4, 5].map(|x| image.get_pixel(x, 4)[0]);
    assert!(at > 0 && at.abs_diff(beside) < 3, "{at} {beside}");
}
