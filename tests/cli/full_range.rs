//! Images whose colours are neither clamped nor rounded, and `--exposure`.

use crate::common::program::{folder, outcome, scene, tabray};
use std::fs;
use tempfile::TempDir;

/// Runs a command in a folder, and returns its status, and what it says.
fn run(folder: &TempDir, arguments: &[&str]) -> (i32, String) {
    let (status, out, err) = outcome(tabray(folder).args(arguments));
    (status, String::from_utf8(out).expect("text") + &err)
}

#[test]
fn full_range_images_have_the_colours_behind_the_bytes() {
    let folder = folder();
    let scene = scene("gallery/three-lamps.ray");
    let scene = scene.to_str().expect("a path");
    for (name, others) in [
        ("a.png", &[][..]),
        ("a.exr", &[]),
        ("b.pfm", &["--threads", "3"]),
        ("part.pfm", &["--crop", "20,3,37,29"]),
        ("part.png", &["--crop", "20,3,37,29"]),
    ] {
        let arguments = ["render", scene, "--size", "80", "--samples", "2..8", "-o", name];
        let (status, said) = run(&folder, &[&arguments[..], others].concat());
        assert_eq!(status, 0, "{said}");
    }
    assert_eq!(run(&folder, &["diff", "a.exr", "b.pfm"]), (0, "none of 4800 pixels differs\n".to_owned()));
    let exr = image::open(folder.path().join("a.exr")).expect("an EXR").into_rgb32f();
    let png = image::open(folder.path().join("a.png")).expect("a PNG").into_rgb8();
    assert!(exr.iter().any(|number| *number > 1.5), "it is brighter than white");
    let byte = |number: &f32| (255.0 * f64::from(*number)) as u8;
    // A number of 32 bits may round up to the next level.
    let off = exr.iter().zip(png.iter()).filter(|(number, level)| byte(number) != **level).count();
    assert!(off < 5, "{off} of {} bytes", png.len());
    let (status, said) = run(&folder, &["diff", "part.pfm", "part.png", "--tolerance", "255"]);
    assert!(status == 0 || said.contains("largest difference"), "{said}");
}

#[test]
fn exposure_doubles_colours() {
    let folder = folder();
    fs::copy(scene("sphere/in-front.ray"), folder.path().join("a.ray")).expect("a copy");
    let render = |name: &str, stops: &str| {
        let (status, said) = run(&folder, &["render", "a.ray", "-o", name, "--exposure", stops]);
        assert_eq!(status, 0, "{said}");
        image::open(folder.path().join(name)).expect("an image").into_rgb32f().into_raw()
    };
    let (plain, brighter) = (render("a.exr", "0"), render("b.exr", "1"));
    assert!(plain.iter().zip(&brighter).all(|(one, other)| 2.0 * one == *other));
    assert!(plain.iter().any(|number| *number > 0.0));
    render("a.png", "0");
    let darker = render("b.png", "-2");
    let white = plain.iter().copied().fold(0.0, f32::max).min(4.0) / 4.0;
    assert!(darker.iter().all(|number| *number <= white));
}

#[test]
fn full_range_images_are_refused_where_they_cannot_be_had() {
    let folder = folder();
    fs::copy(scene("sphere/in-front.ray"), folder.path().join("a.ray")).expect("a copy");
    for (options, says) in [
        (&["--resume"][..], "cannot be resumed"),
        (&["--size", "2000", "--max-memory", "60MiB"], "of memory is not enough for this image"),
        (&["--exposure", "lots"], "give stops as `1.5` or `-2`"),
    ] {
        let (status, said) = run(&folder, &[&["render", "a.ray", "-o", "a.exr"], options].concat());
        assert!(status == 2 && said.contains(says), "{options:?}: {said}");
    }
    fs::write(folder.path().join("bad.pfm"), "PF\n9 9\n-1\n").expect("a file");
    let (status, said) = run(&folder, &["diff", "bad.pfm", "bad.pfm"]);
    assert!(status == 2 && said.contains("it is not a PFM of three channels"), "{said}");
    assert!(!fs::exists(folder.path().join("a.exr")).expect("a folder"));
}
