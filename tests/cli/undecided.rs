//! Pixels whose first hit 237 bits do not decide.

use crate::common::program::{folder, outcome, scene, tabray};
use serde_json::Value;

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
        let warning = format!("warning: {counted} pixels could not be decided: `column` jumps\n");
        assert!(err.contains(&warning), "{options:?}: {err}");
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
