//! `render --max-error --certain`: pixels whose colours are proven.

use crate::common::program::{folder, outcome, tabray};
use std::fs;
use tempfile::TempDir;

/// A floor and a sphere in the light of a lamp, small enough to be proven quickly.
const SCENE: &str = "camera eye { pixeldim 32 24  worlddim 8 6  viewpoint 4 3 8 }
    material paper { ambient 0.4 0.4 0.3  diffuse 3 3 3 }
    light lamp { location 2 8 4  emissivity 9 8 7 }
    plane floor { material paper  normal 0 1 0  point 0 0 0 }
    sphere ball { material paper  center 4 1.5 -3  radius 1.2 }";

/// Renders a scene in a folder with these options: the image's bytes, and what is said.
fn render(folder: &TempDir, scene: &str, options: &[&str]) -> (Vec<u8>, String) {
    let mut command = tabray(folder);
    command.arg("render").arg(scene).args(["--certain", "-o", "out.ppm"]).args(options);
    let (status, _, err) = outcome(&mut command);
    assert_eq!(status, 0, "{options:?}: {err}");
    (fs::read(folder.path().join("out.ppm")).expect("an image"), err)
}

#[test]
fn certain_pixels_are_counted_shown_and_within_their_bounds() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("a.ray"), SCENE).expect("a file");
    let (_, told) =
        render(&folder, "a.ray", &["--max-error", "1", "--aov", "error,samples", "--stats", "json"]);
    assert!(told.contains(" % of the pixels are certain to be within 1 of 255 levels"), "{told}");
    let json = told.lines().find(|line| line.starts_with('{')).expect("statistics");
    let stats: serde_json::Value = serde_json::from_str(json).expect("JSON");
    let number = |name: &str| stats["proven"][name].as_u64().expect("a count");
    let (certain, open) = (number("certain"), number("open"));
    assert_eq!(certain + open, 32 * 24);
    assert!(certain > 700, "{certain}");
    let exr = |name: &str| image::open(path.join(name)).expect("an EXR").into_rgb32f();
    let (bounds, samples) = (exr("out-error.exr"), exr("out-samples.exr"));
    assert_eq!(bounds.pixels().filter(|pixel| pixel.0[2] == 1.0).count() as u64, open);
    let shown = image::open(path.join("out-error.ppm")).expect("an image").into_rgb8();
    assert_eq!(shown.pixels().filter(|pixel| pixel.0 == [255, 0, 0]).count() as u64, open);
    let picture = |name: &str, options: &[&str]| {
        let (status, _, err) = outcome(tabray(&folder).args(["render", "a.ray", "-o", name]).args(options));
        assert_eq!(status, 0, "{err}");
        exr(name)
    };
    let truth = picture("truth.exr", &["--samples", "4096"]);
    let certain = picture("certain.exr", &["--max-error", "1", "--certain"]);
    for ((x, y, bound), (one, other)) in bounds.enumerate_pixels().zip(certain.pixels().zip(truth.pixels())) {
        // Samples are off, too, where an edge crosses the pixel.
        let most = bound.0[0] + 0.3 / 255.0;
        let off = (0..3).map(|channel| one.0[channel].min(1.0) - other.0[channel].min(1.0));
        let off = off.fold(0.0_f32, |off, one| off.max(one.abs()));
        assert!(off <= most, "{x} {y}: {off}, {bound:?}");
    }
    for ((x, y, bound), samples) in bounds.enumerate_pixels().zip(samples.pixels()) {
        let is_open = bound.0[2] == 1.0;
        assert_eq!(samples.0[0] == 0.0, !is_open, "{x} {y}");
        assert_eq!(bound.0[0] > 1.000_001 / 255.0, is_open, "{x} {y}: {bound:?}");
    }
}

#[test]
fn a_certain_render_that_was_stopped_is_continued() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("a.ray"), SCENE).expect("a file");
    let options = ["--size", "160x120", "--max-error", "1"];
    let (whole, _) = render(&folder, "a.ray", &options);
    fs::remove_file(path.join("out.ppm")).expect("an image");
    let limited = ["render", "a.ray", "--certain", "-o", "out.ppm", "--time-limit", "300ms"];
    outcome(tabray(&folder).args(limited).args(options));
    let wrong = ["render", "a.ray", "-o", "out.ppm", "--resume"];
    if path.join("out.ppm.checkpoint").exists() {
        let (status, _, said) = outcome(tabray(&folder).args(wrong).args(options));
        assert_eq!(status, 2, "{said}");
        assert!(said.contains("further samples"), "{said}");
    }
    let (resumed, _) = render(&folder, "a.ray", &[&options[..], &["--resume"]].concat());
    assert!(resumed == whole);
}

#[test]
fn certain_needs_a_limit_and_the_exact_method() {
    let folder = folder();
    fs::write(folder.path().join("a.ray"), SCENE).expect("a file");
    for (options, said) in [
        (&["--certain"][..], "--max-error"),
        (
            &["--certain", "--max-error", "1", "--method", "classic"],
            "the classic method has colours of its own",
        ),
    ] {
        let mut command = tabray(&folder);
        let (status, _, err) = outcome(command.args(["render", "a.ray", "-o", "a.png"]).args(options));
        assert_eq!(status, 2, "{err}");
        assert!(err.contains(said), "{err}");
    }
}

#[test]
fn plan_says_what_is_certain() {
    let folder = folder();
    fs::write(folder.path().join("a.ray"), SCENE).expect("a file");
    let arguments = ["plan", "a.ray", "--max-error", "2", "--certain"];
    let (status, out, err) = outcome(tabray(&folder).args(arguments));
    assert_eq!(status, 0, "{err}");
    let plan = String::from_utf8(out).expect("text");
    assert!(
        plan.contains("4 to 4096 evenly spread samples in each pixel whose error is not proven"),
        "{plan}"
    );
    assert!(plan.contains("\ncertain      all rays through a pixel are enclosed at once"), "{plan}");
}
