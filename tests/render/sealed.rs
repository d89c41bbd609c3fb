//! Closed rooms: no light from outside reaches what is seen inside.

use crate::common::{model_in, render};
use image::RgbImage;
use std::fs;
use tabray::render::{Plan, decisions};
use tabray::scene::Model;
use tabray::tools::colours::{Prover, Verdict};
use tempfile::TempDir;

/// A cube of size 6.
const CUBE: &str = "v 1 0 0\nv 7 0 0\nv 7 6 0\nv 1 6 0\nv 1 0 6\nv 7 0 6\nv 7 6 6\nv 1 6 6
    f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 1 5 8 4\nf 2 3 7 6";

/// Rooms like the cube. From its middle, some pixels show points that lie exactly on its edges, where lamps are before one
/// wall and behind the other.
const ROOMS: [&str; 4] = [
    "mesh room { material m file cube.obj }",
    "box room { material m center 4 3 3 size 6 6 6 }",
    "prism room { material m points -3 -3  3 -3  3 3  -3 3 base 4 0 3 height 6 }",
    "mesh pattern { material m file cube.obj } place room { object pattern }",
];

const LAMPS: &str = "light beside { location 20 3 1 emissivity 900 900 900 }
    light behind { location 4 3 -9 emissivity 900 900 900 size 1 }";

const INSIDE: &str = "camera eye { pixeldim 9 7 worlddim 8 6 viewpoint 4 3 3 } material m { diffuse 9 9 9 }";

fn scene(text: &str) -> Model {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("cube.obj"), CUBE).expect("a file");
    model_in(folder.path(), text)
}

fn lit(picture: &RgbImage) -> usize {
    picture.pixels().filter(|pixel| pixel.0 != [0; 3]).count()
}

#[test]
fn no_light_comes_in_at_an_edge() {
    for room in ROOMS {
        let model = scene(&format!("{INSIDE} {LAMPS} {room}"));
        assert_eq!(lit(&render(&model)), 0, "{room}");
        let plan = Plan::new(&model);
        let prover = Prover::new(&plan);
        for (x, y) in (0..7).flat_map(|y| (0..9).map(move |x| (x, y))) {
            assert_ne!(prover.traced(x, y).verdict(), Verdict::Contradicted, "{x} {y}: {room}");
        }
    }
}

#[test]
fn no_light_comes_into_a_mirror_of_bumps() {
    for (smooth, height) in [(0, "0.2*sin(9*x)"), (1, "0.2*sin(9*x)"), (1, "0.3*sin(5*x+3*y)+0.2*sin(7*z)")] {
        let model = scene(&format!(
            "look_at eye {{ pixeldim 32 24 position 3.7 2.6 3.3 target 1 0 0 angle 100 }}
             bumps waves {{ height \"{height}\" }} material m {{ diffuse 9 9 9 specular 0.9 }} {LAMPS}
             mesh room {{ material m file cube.obj shader waves smooth {smooth} }}"
        ));
        assert_eq!(lit(&render(&model)), 0, "smooth {smooth}, {height}");
    }
}

/// What a closed object is around may be lit all the same: by a lamp on the viewer's side, through glass, and where the
/// object is open or the lamp touches it.
#[test]
fn light_that_no_closed_object_keeps_out_comes_in() {
    for (what, room, lamp) in [
        ("inside", ROOMS[1], "light l { location 4 3 5 emissivity 900 900 900 }"),
        ("on the wall", ROOMS[1], "light l { location 7 3 5 emissivity 900 900 900 }"),
        (
            "glass",
            "material g { diffuse 9 9 9 transparency 0.5 } box room { material g center 4 3 3 size 6 6 6 }",
            "light l { location 20 3 1 emissivity 900 900 900 }",
        ),
        (
            "open",
            "cylinder tube { material m base 1 3 3 direction 1 0 0 height 6 radius 2.9 open yes }",
            "light l { location 20 3 3 emissivity 900 900 900 }",
        ),
    ] {
        assert!(lit(&render(&scene(&format!("{INSIDE} {lamp} {room}")))) > 9, "{what}");
    }
}

/// A lamp in a lampshade lights nothing, seen from outside.
#[test]
fn a_plan_says_which_lights_are_shut_out() {
    let outside = "camera eye { pixeldim 9 7 worlddim 8 6 viewpoint 4 3 30 } material m { diffuse 9 9 9 }
        light lamp { location 4 3 3 emissivity 900 900 900 }";
    let model = scene(&format!("{outside} {}", ROOMS[0]));
    assert_eq!(lit(&render(&model)), 0);
    let says = "`lamp` is left out, as a closed object is around either it or the viewer";
    let lines = decisions::of(&Plan::for_picture(&model));
    assert!(lines.iter().any(|line| line.to_string().contains(says)), "{says}");
}
