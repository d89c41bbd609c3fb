//! What the tracer finds first is what is proven to be first, in every scene.

mod common;

use assert_cmd::cargo::cargo_bin_cmd;
use common::{load, model, root, scenes};
use tabray::verify::{self, Verdict};
use tempfile::TempDir;

/// Scenes in which many pixels look at an edge on purpose, or at two surfaces in one place.
const AT_EDGES: [&str; 10] = [
    "camera/edges-of-the-screen.ray", // two rectangles in one plane
    "plane/equal-distance.ray",       // two planes in one place
    "fplane/seam.ray",                // a column of pixels looks at the seam
    "hard/rug.ray",                   // a rug on a floor
    "hard/seam.ray",
    "hard/light-on-the-surface.ray", // a row of pixels looks at the corner of floor and wall
    "hard/tangent.ray",              // a column of pixels looks at the rim
    "hard/jump.ray",                 // the rims of a stair
    "toml/one-line-each.toml",       // rows of pixels look at a rectangle's sides
    "triangle/seam.ray",
];

/// Counts of proven, undecided and contradicted pixels: of every `step`-th, both ways.
fn counts(model: &tabray::model::Model, step: usize) -> [usize; 3] {
    let [width, height] = model.camera.value.pixels;
    let mut counts = [0; 3];
    for y in (0..height).step_by(step) {
        for x in (0..width).step_by(step) {
            counts[match verify::pixel(model, x, y) {
                Verdict::Proven => 0,
                Verdict::Tie => 1,
                Verdict::Contradicted => 2,
            }] += 1;
        }
    }
    counts
}

#[test]
fn no_scene_is_contradicted_and_nearly_every_pixel_is_proven() {
    for path in scenes() {
        let name = path.strip_prefix(root().join("scenes")).expect("a scene").to_string_lossy().into_owned();
        let model = load(&path);
        let [proven, undecided, contradicted] =
            counts(&model, if model.camera.value.pixels[0] > 320 { 31 } else { 7 });
        assert_eq!(contradicted, 0, "{name}");
        let part = undecided as f64 / (proven + undecided) as f64;
        assert!(part <= 0.001 || AT_EDGES.contains(&name.as_str()), "{name}: {undecided} of {proven}");
    }
}

#[test]
fn accuracies_but_the_classic_one_are_never_contradicted() {
    let scene = |accuracy: &str| {
        model(&format!(
            "camera eye {{ pixeldim 64 48 worlddim 8 6 viewpoint 4 3 7 accuracy {accuracy} }}
             material m {{ ambient 1 1 1 }}
             plane floor {{ material m normal 0 1 0 point 0 0 0 }}
             revsurf ripples {{ material m profile \"1 + 0.3 * sin(20 * y)\" direction 0.1 1 0 base 4 0.1 -4 height 6 }}
             sphere ball {{ material m center 2 3 -4 radius 1 }}"
        ))
    };
    for accuracy in ["draft", "exact", "strict"] {
        assert_eq!(counts(&scene(accuracy), 1)[2], 0, "{accuracy}");
    }
    assert!(counts(&scene("classic"), 1)[2] > 10);
}

#[test]
fn the_program_counts_and_shows_what_is_proven() {
    let folder = TempDir::new().expect("a folder");
    let run = |args: &[&str]| {
        let mut command = cargo_bin_cmd!("tabray");
        let scene = root().join("scenes/hard/ripples.ray");
        let output = command.current_dir(folder.path()).arg("verify").arg(scene).args(args).output();
        let output = output.expect("the program runs");
        (output.status.code(), String::from_utf8_lossy(&output.stdout).into_owned())
    };
    let (status, said) = run(&["-o", "a.png"]);
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("pixels proven (") && said.ends_with(" 0 contradicted\n"), "{said}");
    let colours = |name: &str| image::open(folder.path().join(name)).expect("a picture").into_rgb8();
    let white = colours("a.png").pixels().filter(|pixel| pixel.0 == [255; 3]).count();
    assert!(said.contains(&format!(", {white} tie")), "{said}");
    let (status, said) = run(&["--method", "classic", "-o", "b.png"]);
    assert_eq!(status, Some(1), "{said}");
    let red = colours("b.png").pixels().filter(|pixel| pixel.0 == [255, 0, 0]).count();
    assert!(red > 0 && said.ends_with(&format!(" {red} contradicted\n")), "{said}");
}

#[test]
fn a_contradiction_is_a_failure_that_counts_it() {
    let folder = TempDir::new().expect("a folder");
    let mut verify = cargo_bin_cmd!("tabray");
    verify.current_dir(folder.path()).args(["verify", "--method", "classic"]);
    let output = verify.arg(root().join("scenes/hard/ripples.ray")).output().expect("it runs");
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert_eq!(output.status.code(), Some(1), "{out}{err}");
    let (_, contradicted) = out.rsplit_once(", ").expect("three counts");
    let count: usize =
        contradicted.strip_suffix(" contradicted\n").and_then(|n| n.parse().ok()).expect("a number");
    assert!(count > 1, "{out}");
    assert_eq!(err, format!("error: the tracer finds another object at {count} pixels\n"));
}
