//! The course's own scenes: their pictures, pixel by pixel, and their dumps, byte by byte.
//!
//! They are not part of this project. Where `../shared/conformance` is absent these tests say so and pass.

mod common;

use assert_cmd::cargo::cargo_bin_cmd;
use common::root;
use std::fs;
use std::io::{self, Write};
use std::path::PathBuf;

/// A scene, and the percentage of its pixels that must be right to 1 of 255 in every channel. What is short
/// of 100 is the instructor's program's: hit points overwritten by shadow rays, 80-bit arithmetic at edges,
/// an older shadow, and a cone's slope twice too steep.
const SCENES: [(&str, f64); 19] = [
    ("fplane/fplane1", 100.0),
    ("fplane/fplane3", 100.0),
    ("fplane/fplane4", 99.98),
    ("glint/shiny", 100.0),
    ("glint/shiny2", 100.0),
    ("proj/proj3", 100.0),
    ("revsurf/revsurfa", 70.0),
    ("revsurf/revsurff", 100.0),
    ("spec/spec0", 100.0),
    ("spec/spec1", 99.98),
    ("spec/spec3", 99.97),
    ("spec/spec5", 99.97),
    ("spec/spec8", 99.61),
    ("spotlight/spotlight", 100.0),
    ("texplane/texplane2", 99.96),
    ("tplane/tplane4", 100.0),
    ("trans/translucent", 62.19),
    ("trans/translucent3", 100.0),
    ("trans/translucent5", 100.0),
];

/// Calls `check` with each scene, the path of its files without an extension, and the percentage.
fn each(mut check: impl FnMut(&str, PathBuf, f64)) {
    let folder = root().join("../shared/conformance");
    if !folder.is_dir() {
        // Not `eprintln!`, which the test harness hides.
        let _ = writeln!(io::stderr(), "SKIPPED: the course's scenes are not in {}", folder.display());
        return;
    }
    for (scene, percent) in SCENES {
        check(scene, folder.join(scene), percent);
    }
}

#[test]
fn the_courses_pictures_come_out_the_same() {
    let mut short = Vec::new();
    each(|scene, path, percent| {
        let run = cargo_bin_cmd!()
            .arg("render")
            .arg(path.with_extension("txt"))
            .args(["-o", "-"])
            .assert()
            .success();
        let actual = image::load_from_memory(&run.get_output().stdout).expect("a PPM").into_rgb8();
        let expected = image::open(path.with_extension("png")).expect("the course's picture").into_rgb8();
        assert_eq!(actual.dimensions(), expected.dimensions(), "{scene}");
        let far = |(a, b): (&image::Rgb<u8>, &image::Rgb<u8>)| (0..3).map(|i| a[i].abs_diff(b[i])).max();
        let pixels = expected.pixels().len();
        let near = actual.pixels().zip(expected.pixels()).filter(|pair| far(*pair) <= Some(1)).count();
        let got = 100.0 * near as f64 / pixels as f64;
        eprintln!("{scene:20} {got:8.4} % of its pixels within 1, {percent} wanted");
        if got < percent {
            short.push(scene.to_owned());
        }
    });
    assert!(short.is_empty(), "too many pixels differ in {short:?}");
}

#[test]
fn the_courses_dumps_come_out_the_same() {
    each(|scene, path, _| {
        let run = cargo_bin_cmd!().arg("dump").arg(path.with_extension("txt")).assert().success();
        let actual = String::from_utf8_lossy(&run.get_output().stdout).into_owned();
        let expected = fs::read_to_string(path.with_extension("log")).expect("the course's dump");
        assert!(actual == expected, "{scene} dumps\n{actual}\nnot\n{expected}");
    });
}
