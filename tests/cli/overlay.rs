//! `--overlay`: the lines and the labels of an image as an SVG over it.

use crate::common::program::{folder, names_in, outcome, tabray};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use glam::DVec2;
use std::fs;
use tempfile::TempDir;

/// A ball with level lines, which is a circle of 50 pixels around 100 100, and one behind it, of 40 around 150 100.
const BALLS: &str = "orthographic eye { pixeldim 200 200  position 0 0 9  target 0 0 0  width 4 }
background far { colour 1 1 1 }
material white { ambient 0.5 0.5 0.5 } material ink { ambient 0 0 0 }
lines rings { formula y  spacing 0.4  altmaterial ink }
sphere one { material white  center 0 0 0  radius 1  shader rings }
sphere two { material white  center 1 0 -3  radius 0.8 }\n";

/// A saddle in a box, whose edges and whose own slopes cut its level lines off.
const SADDLE: &str = "look_at eye { pixeldim 240 180  position 6 4 8  target 0.1 0 0  angle 22 }
background far { colour 1 1 1 }
material white { ambient 1 1 1 }
lines heights { formula y  spacing 0.25  width 0  altmaterial white }
implicit saddle { material white  formula \"y = x^2 - z^2\"  box -1 -1 -1  1 1 1  shader heights }\n";

/// Axes, and a ball that hides the half of one, and what follows them.
const AXES: &str = "look_at eye { pixeldim 160 120  position 4 3 7  target 0.6 0.9 0  angle 34  samples 4 }
background far { colour 1 1 1 }
material grey { ambient 0.8 0.8 0.8 }
sphere ball { material grey  center 1.4 0.2 0.8  radius 0.5 }
axes frame { material grey  from -1 0 0  to 2 2 2  radius 0.02  numbers 0.3 }\n";

fn run(folder: &TempDir, arguments: &[&str]) -> (i32, String) {
    let (status, out, err) = outcome(tabray(folder).args(arguments));
    (status, String::from_utf8_lossy(&out).into_owned() + &err)
}

fn of(scene: &str) -> TempDir {
    let folder = folder();
    fs::write(folder.path().join("a.ray"), scene).expect("a file");
    folder
}

/// Renders an image and the SVG over it, and returns the SVG.
fn drawn(folder: &TempDir, name: &str, options: &[&str]) -> String {
    let (png, svg) = (format!("{name}.png"), format!("{name}.svg"));
    let (status, said) =
        run(folder, &[&["render", "a.ray", "-o", &png, "--overlay", &svg], options].concat());
    assert_eq!(status, 0, "{said}");
    fs::read_to_string(folder.path().join(svg)).expect("an SVG")
}

/// Returns the points of all curves of a class, and whether each curve is closed.
fn curves(svg: &str, class: &str) -> Vec<(Vec<[f64; 2]>, bool)> {
    let group = svg.split(&format!("class=\"{class}\"")).nth(1).expect("a group");
    let group = group.split("</g>").next().expect("its end");
    let curve = |part: &str| {
        let data = part.split('"').next().expect("data");
        let numbers: Vec<f64> =
            data.trim_end_matches('Z').split(' ').map(|number| number.parse().expect("a number")).collect();
        (numbers.chunks(2).map(|pair| [pair[0], pair[1]]).collect(), data.ends_with('Z'))
    };
    group.split("d=\"M").skip(1).map(curve).collect()
}

fn texts(svg: &str) -> Vec<&str> {
    svg.split("</text>")
        .filter_map(|part| part.rsplit_once('>'))
        .map(|(_, text)| text)
        .filter(|text| !text.trim().is_empty())
        .collect()
}

#[test]
fn outlines_and_level_lines_are_where_they_are_to_hundredths_of_a_pixel_and_hidden_ones_are_left_out() {
    let folder = of(BALLS);
    let svg = drawn(&folder, "a", &[]);
    let image = svg.split("base64,").nth(1).and_then(|rest| rest.split('"').next()).expect("an image");
    let png = fs::read(folder.path().join("a.png")).expect("a file");
    assert!(BASE64_STANDARD.decode(image).expect("base 64") == png);
    let from = |[x, y]: [f64; 2], middle: f64| (x - middle).hypot(y - 100.0);
    let mut counts = [0; 2];
    let outlines = curves(&svg, "outlines");
    for at in outlines.iter().flat_map(|(points, _)| points) {
        let off = [from(*at, 100.0) - 50.0, from(*at, 150.0) - 40.0];
        // Where both circles meet, a point joins three lines.
        let meets = off.iter().all(|off| off.abs() < 1.0);
        let which = usize::from(off[0].abs() > off[1].abs());
        assert!(off[which].abs() < 0.03 || meets, "{at:?}");
        assert!(off[0] > -0.03 || meets, "{at:?} is hidden");
        counts[which] += 1;
    }
    assert!(counts.iter().all(|count| *count > 20), "{counts:?}");
    // Level lines are seen from the side.
    let mut levels = curves(&svg, "levels");
    levels.sort_by(|(one, _), (other, _)| one[0][1].total_cmp(&other[0][1]));
    assert_eq!(levels.len(), 5);
    for (line, (points, is_closed)) in levels.iter().enumerate() {
        assert!(
            !is_closed && points.iter().all(|at| (at[1] - (60.0 + 20.0 * line as f64)).abs() < 0.02),
            "{points:?}"
        );
        for end in [points[0], points[points.len() - 1]] {
            assert!((from(end, 100.0) - 50.0).abs() < 0.2, "{end:?}");
        }
    }
    let one = drawn(&folder, "one", &["--threads", "1"]);
    assert!(svg == one);
    // A part of the image has the same lines.
    let part = drawn(&folder, "part", &["--crop", "0,90,60,60"]);
    assert!(part.contains("viewBox=\"0 50 60 60\""), "{part}");
    let points: Vec<_> = curves(&part, "outlines").into_iter().flat_map(|(points, _)| points).collect();
    assert!(points.iter().all(|at| at[0] <= 60.0 && (49.0..=111.0).contains(&at[1])), "{points:?}");
}

#[test]
fn level_lines_reach_the_edges_of_a_surface_and_the_outlines_that_hide_them() {
    let folder = of(SADDLE);
    let svg = drawn(&folder, "a", &[]);
    let outlines = curves(&svg, "outlines");
    let sides = outlines.iter().flat_map(|(points, _)| points.windows(2));
    let sides: Vec<_> = sides.map(|side| [DVec2::from(side[0]), DVec2::from(side[1])]).collect();
    let from = |at: DVec2, [one, other]: [DVec2; 2]| {
        let part = (at - one).dot(other - one) / one.distance_squared(other);
        at.distance(one.lerp(other, if part.is_nan() { 0.0 } else { part.clamp(0.0, 1.0) }))
    };
    let levels = curves(&svg, "levels");
    let open = levels.iter().filter(|(_, is_closed)| !is_closed);
    let ends: Vec<_> = open.flat_map(|(points, _)| [points[0], points[points.len() - 1]]).collect();
    // Four meet in the saddle's middle, which is level.
    let inside = |at: [f64; 2]| ends.iter().filter(|end| **end == at).count() == 4;
    let off = |at: [f64; 2]| sides.iter().map(|side| from(at.into(), *side)).fold(f64::INFINITY, f64::min);
    let far: Vec<_> = ends.iter().filter(|at| off(**at) > 0.2 && !inside(**at)).collect();
    assert!(ends.len() > 30 && far.is_empty(), "{far:?} of {}", ends.len());
}

#[test]
fn the_numbers_of_axes_are_in_the_image_or_as_text_over_it() {
    let folder = of(AXES);
    let svg = drawn(&folder, "a", &["--dpi", "300"]);
    // The ball hides the middle of two of them.
    let found = texts(&svg);
    for text in ["x", "y", "z", "\u{2212}1"] {
        assert!(found.contains(&text), "{text} is not in {found:?}");
    }
    assert_eq!(found.iter().filter(|text| **text == "1").count(), 2, "{found:?}");
    assert!(svg.contains("width=\"0.5333333333333333in\""), "{svg}");
    for (name, set) in [("with.png", "frame.numbers=0.3"), ("without.png", "frame.numbers=0")] {
        let (status, said) = run(&folder, &["render", "a.ray", "-o", name, "--set", set]);
        assert_eq!(status, 0, "{said}");
    }
    let pixels = |name: &str| image::open(folder.path().join(name)).expect("an image").into_rgb8();
    assert!(pixels("a.png") == pixels("without.png"));
    let differing = pixels("with.png")
        .pixels()
        .zip(pixels("without.png").pixels())
        .filter(|(one, other)| one != other)
        .count();
    assert!((100..4000).contains(&differing), "{differing}");
}

#[test]
fn axes_count_world_coordinates_and_take_so_many_strokes() {
    let folder = of(AXES);
    let svg = drawn(&folder, "a", &["--set", "frame.center=-0.7 0 0", "--set", "frame.ticks=0.1"]);
    let found = texts(&svg);
    for text in ["\u{2212}0.4", "0", "0.3"] {
        assert!(found.contains(&text), "{text} is not in {found:?}");
    }
    let many = ["render", "a.ray", "-o", "b.png", "--set", "frame.ticks=0.04"];
    let (status, said) = run(&folder, &many);
    assert!(status == 2 && said.contains("axes `frame` has numbers of more than 1024 strokes"), "{said}");
}

#[test]
fn an_axis_that_is_seen_from_its_end_has_its_name_alone() {
    let folder = of("orthographic eye { pixeldim 90 90  position 0 0 9  target 0 0 0  width 6 }
background far { colour 1 1 1 }
material grey { ambient 0.8 0.8 0.8 }
axes frame { material grey  from -2 -2 -2  to 2.5 2.5 2.5  radius 0.02  numbers 0.3 }\n");
    let svg = drawn(&folder, "a", &[]);
    assert_eq!(texts(&svg).join(" "), "x 1 \u{2212}1 2 \u{2212}2 y 1 \u{2212}1 2 \u{2212}2 z");
}

#[test]
fn a_drawing_that_no_image_lies_under_is_refused_with_its_cure() {
    let folder = of(BALLS);
    fs::write(folder.path().join("b.ray"), BALLS).expect("a file");
    for (arguments, said) in [
        (&["a.ray", "-o", "a.exr", "--overlay", "a.svg"][..], "`a.svg` cannot contain `a.exr`"),
        (&["a.ray", "-o", "a.png", "--overlay", "a.png"], "= help: `--overlay a.svg`"),
        (&["a.ray", "-o", "-", "--overlay", "a.svg"], "`a.svg` cannot contain `-`"),
        (&["a.ray", "-o", "a.png", "--overlay", "a.ray"], "`a.ray` is the name of none"),
        (&["a.ray", "b.ray", "--overlay", "a.svg"], "`--overlay` takes one scene"),
        (&["a.ray", "--overlay", "a.svg", "--part", "1/2"], "cannot be used with"),
    ] {
        let (status, found) = run(&folder, &[&["render"], arguments].concat());
        assert!(status == 2 && found.contains(said), "{arguments:?}: {found}");
    }
    assert_eq!(names_in(folder.path()), ["a.ray", "b.ray"]);
}
