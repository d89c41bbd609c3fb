//! Pictures that are handed in, right and wrong in each way that is known.

use crate::common::program::{folder, outcome, tabray};
use crate::common::snapshots;
use image::{Rgb, RgbImage, imageops};
use serde_json::Value;
use std::fs;
use tempfile::TempDir;

/// A ball with a glint on a floor, a lamp at each side, and a wall behind. `BALL`, `GLINT` and `LEFT` stand for parts that are
/// left out for wrong pictures.
const SCENE: &str = "camera eye { pixeldim 64 48  worlddim 8 6  viewpoint 4 3 8 }
material red { ambient 2 1 1  diffuse 7 2 1  specular 0.4 0.4 0.4  GLINT }
material stone { ambient 1 1 2  diffuse 3 4 5 }
plane floor { material stone  normal 0 1 0  point 0 0 0 }
plane wall { material stone  normal 0 0 1  point 0 0 -9 }
BALL
LEFT
light right { location 7 8 1  emissivity 4 5 6 }";

const BALL: &str = "sphere ball { material red  center 4 2 -4  radius 1.5 }";
const LEFT: &str = "light left { location 1 7 -1  emissivity 5 4 3 }";
const GLINT: &str = "shininess 12";

struct Exercise {
    folder: TempDir,
    right: RgbImage,
}

impl Exercise {
    fn new() -> Self {
        let folder = folder();
        let right = rendered(&folder, "right", BALL, GLINT, LEFT);
        Self { folder, right }
    }

    /// Returns the image of the scene with other parts.
    fn other(&self, ball: &str, glint: &str, left: &str) -> RgbImage {
        rendered(&self.folder, "other", ball, glint, left)
    }

    /// Grades a picture, and returns the status and what is said.
    fn said(&self, picture: &RgbImage, options: &[&str]) -> (i32, String) {
        picture.save(self.folder.path().join("handed-in.ppm")).expect("a picture");
        let mut command = tabray(&self.folder);
        let (status, out, err) = outcome(command.args(["grade", "right.ray", "handed-in.ppm"]).args(options));
        (status, String::from_utf8(out).expect("text") + &err)
    }

    /// Returns the kinds of mistakes of a picture, each with its share.
    fn kinds(&self, picture: &RgbImage) -> Vec<(String, f64)> {
        let (status, said) = self.said(picture, &["--json"]);
        assert_eq!(status, 1, "{said}");
        let told: Value = serde_json::from_str(&said).expect("JSON");
        let findings = told["findings"].as_array().expect("findings");
        let sum: u64 = findings.iter().filter_map(|found| found["pixels"].as_u64()).sum();
        assert_eq!(Some(sum), told["differing"].as_u64(), "each pixel is counted once");
        let kind = |found: &Value| Some((found["kind"].as_str()?.to_owned(), found["share"].as_f64()?));
        findings.iter().map(|found| kind(found).expect("a kind and a share")).collect()
    }
}

fn rendered(folder: &TempDir, name: &str, ball: &str, glint: &str, left: &str) -> RgbImage {
    let text = SCENE.replace("BALL", ball).replace("GLINT", glint).replace("LEFT", left);
    fs::write(folder.path().join(format!("{name}.ray")), text).expect("a file");
    let mut command = tabray(folder);
    let (status, _, err) =
        outcome(command.args(["render", &format!("{name}.ray"), "-o", &format!("{name}.ppm")]));
    assert_eq!(status, 0, "{err}");
    image::open(folder.path().join(format!("{name}.ppm"))).expect("a picture").into_rgb8()
}

/// Returns the right image, with the pixels of another one where `is_other` says so.
fn mixed(right: &RgbImage, other: &RgbImage, is_other: impl Fn(u32, u32) -> bool) -> RgbImage {
    RgbImage::from_fn(64, 48, |x, y| *if is_other(x, y) { other } else { right }.get_pixel(x, y))
}

/// Tells whether a pixel shows the ball, or is beside it, by its row from the top.
fn is_ball(x: u32, y: u32) -> bool {
    let [x, y] = [(f64::from(x) - 32.0) / 8.0, (f64::from(y) - 28.0) / 8.0];
    // From the viewer, it is seen smaller than it is.
    x * x + y * y < 1.6
}

fn mapped(image: &RgbImage, of: impl Fn([u8; 3]) -> [u8; 3]) -> RgbImage {
    RgbImage::from_fn(64, 48, |x, y| Rgb(of(image.get_pixel(x, y).0)))
}

#[test]
fn mistakes_are_named_by_their_kinds() {
    let exercise = Exercise::new();
    let right = &exercise.right;
    let (status, said) = exercise.said(right, &[]);
    assert_eq!(
        (status, said.as_str()),
        (0, "the picture is what the scene shows: none of 3072 pixels differs\n")
    );
    let no_ball = exercise.other("", GLINT, LEFT);
    let no_lamp = exercise.other(BALL, GLINT, "");
    let power = |level: u8, exponent: f64| (255.0 * (f64::from(level) / 255.0).powf(exponent)).round() as u8;
    let shifted = RgbImage::from_fn(64, 48, |x, y| *right.get_pixel(x.saturating_sub(2), (y + 1).min(47)));
    let pictures = [
        ("flipped", imageops::flip_vertical(right)),
        ("flipped", imageops::flip_horizontal(right)),
        ("shifted", shifted),
        ("gamma", mapped(right, |pixel| pixel.map(|level| power(level, 1.0 / 2.2)))),
        ("channels", mapped(right, |[r, g, b]| [b, g, r])),
        ("off by one", mapped(right, |pixel| pixel.map(|level| level.saturating_add(1)))),
        ("shadow missing", mixed(right, &no_ball, |x, y| !is_ball(x, y))),
        ("too much shadow", mixed(right, &no_lamp, |x, y| x < 32 || y < 24)),
        ("wrong object", mixed(right, &no_ball, is_ball)),
        ("glint", exercise.other(BALL, "", LEFT)),
        ("glint", exercise.other(BALL, "shininess 3", LEFT)),
    ];
    for (index, (kind, picture)) in pictures.iter().enumerate() {
        let kinds = exercise.kinds(picture);
        let share: f64 = kinds.iter().filter(|(of, _)| of == kind).map(|(_, share)| share).sum();
        assert!(share > 0.5, "picture {index}, {kind}: {kinds:?}");
        let (status, said) = exercise.said(picture, &[]);
        let head = said.split("\n\npixel").next().expect("a text");
        assert!(status == 1 && said.contains("bytes   "), "with an explanation: {said}");
        snapshots("grade")
            .bind(|| insta::assert_snapshot!(format!("{index}-{}", kind.replace(' ', "-")), head));
    }
    assert_eq!(exercise.said(&pictures[5].1, &["--tolerance", "1"]).0, 0, "a level is within the tolerance");
}

#[test]
fn what_no_trial_explains_is_told_as_such() {
    let exercise = Exercise::new();
    let noise = RgbImage::from_fn(64, 48, |x, y| {
        Rgb([x * 37 + y * 91, x * 53 + y * 17, x * 7 + y * 29].map(|level| level as u8))
    });
    let kinds = exercise.kinds(&noise);
    assert!(kinds[0].0 == "other" && kinds[0].1 > 0.8, "{kinds:?}");
}

#[test]
fn a_picture_of_another_size_is_refused() {
    let exercise = Exercise::new();
    let (status, said) = exercise.said(&RgbImage::new(32, 24), &[]);
    assert_eq!(status, 2);
    assert!(said.contains("has 32 x 24 pixels, and the image of the scene 64 x 48"), "{said}");
    assert!(said.contains("add `--set \"eye.pixeldim=32 24\"`"), "{said}");
    let mut command = tabray(&exercise.folder);
    let (status, _, err) = outcome(command.args(["grade", "right.ray", "none.ppm"]));
    assert!(status == 2 && err.contains("none.ppm"), "{err}");
}
