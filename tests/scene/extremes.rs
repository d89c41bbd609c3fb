//! Extreme numbers in place of each number of a scene: the scene is refused or rendered at once.

use crate::common::{model, registry, render, root};
use std::fs;
use std::time::{Duration, Instant};
use tabray::scene;

/// Zeros, numbers whose squares and cubes overflow or underflow, and numbers at the limits of lengths.
const NUMBERS: [&str; 16] = [
    "0", "-0", "1e-320", "1e-160", "1e-152", "1e-9", "-1e-9", "1e9", "-1e9", "1e16", "1e77", "1e152",
    "1e154", "1e166", "1e300", "-1e300",
];

/// The maximum time for an image of 48 pixels on a busy machine.
const LONG: Duration = Duration::from_secs(20);

#[test]
fn extreme_numbers_are_refused_or_drawn_at_once() {
    let folder = root().join("scenes/entities");
    let mut files: Vec<_> =
        fs::read_dir(&folder).expect("scenes").map(|file| file.expect("a file").path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "ray"));
    files.sort();
    let mut drawn = 0;
    for file in &files {
        // By its name, so that a new file does not change what others are tried with.
        let name = file.file_stem().expect("a name").to_string_lossy();
        let first = name.bytes().fold(0, |sum, byte| 31 * sum % 997 + usize::from(byte));
        let text = fs::read_to_string(file).expect("a scene");
        // Only words that are numbers as a whole are replaced.
        let parts: Vec<&str> = text.split_inclusive(char::is_whitespace).collect();
        let is_number = |part: &&str| part.trim().parse::<f64>().is_ok();
        let places: Vec<_> = (0..parts.len()).filter(|at| is_number(&parts[*at])).collect();
        for (index, at) in places.iter().enumerate() {
            let number = format!("{} ", NUMBERS[(first + 7 * index) % NUMBERS.len()]);
            let text = [&parts[..*at], &[&number], &parts[at + 1..]].concat().concat();
            let start = Instant::now();
            if let Ok(mut loaded) = scene::read(registry(), "extreme", &folder, text.as_bytes(), None) {
                let camera = &mut loaded.model.camera.value;
                (camera.pixels, camera.samples) = ([8, 6], 1);
                render(&loaded.model);
                drawn += 1;
            }
            let took = start.elapsed();
            assert!(took < LONG, "{} with {number}for number {index} takes {took:?}", file.display());
        }
    }
    assert!(drawn > 100, "{drawn} are drawn");
}

#[test]
fn a_mesh_or_a_box_seen_from_much_too_far_away_is_drawn() {
    for object in
        ["mesh a { material m file ../models/bowl.stl }", "box a { material m center 0 0.5 0 size 2 1 1 }"]
    {
        let text = format!(
            "camera eye {{ pixeldim 8 6 worlddim 4 3 viewpoint 4 3.6 1e77 }}\n\
             material m {{ ambient 0.2 0.2 0.2 diffuse 1 1 1 }}\n{object}\n\
             light l {{ location 0 5 5 emissivity 1 1 1 }}\n"
        );
        let folder = root().join("scenes/entities");
        let scene = scene::read(registry(), "far", &folder, text.as_bytes(), None);
        render(&scene.unwrap_or_else(|report| panic!("{report}")).model);
    }
}

#[test]
fn a_direction_may_have_any_length() {
    let picture = |length: &str| {
        let along = |part: f64| format!("\"{part}*{length}\"");
        let direction = |x: f64, y: f64, z: f64| [x, y, z].map(along).join(" ");
        render(&model(&format!(
            "camera eye {{ pixeldim 32 24 worlddim 8 6 viewpoint 4 3 6 }}
             material m {{ ambient 1 1 1 diffuse 4 4 4 }}
             sky day {{ horizon 0.5 0.5 0.6 zenith 0.1 0.2 0.6 up {} }}
             plane floor {{ material m normal {} point 0 0 0 }}
             fplane sheet {{ material m normal {} point 1 1 -3 xdir {} dimensions 2 2 }}
             cylinder can {{ material m base 6 1 -4 direction {} height 2 radius 1 }}
             light lamp {{ location 1 7 2 emissivity 20 20 20 }}",
            direction(0.25, 1.0, 0.0),
            direction(0.0, 2.0, 0.125),
            direction(-0.5, 0.25, 1.0),
            direction(1.0, 0.5, 0.25),
            direction(0.5, 1.0, 0.25),
        )))
    };
    let usual = picture("1");
    // Powers of two, of which the largest component keeps all digits.
    for power in ["2^-1000", "2^-500", "2^500", "2^1000"] {
        assert_eq!(picture(power), usual, "{power}");
    }
}
