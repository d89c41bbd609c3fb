//! Images whose colours are neither clamped nor rounded, and `--exposure`.

use crate::common::program::{folder, outcome, scene, tabray};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::iter;
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

/// Returns the numbers of a NumPy array in a file, 4 or 8 bytes each, if it begins like this.
fn array<const N: usize>(folder: &TempDir, name: &str, head: &str) -> Vec<[u8; N]> {
    let bytes = fs::read(folder.path().join(name)).expect("an array");
    let at = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    assert_eq!(String::from_utf8_lossy(&bytes[10..at]).trim_end(), head, "{name}");
    bytes[at..].as_chunks().0.to_vec()
}

#[test]
fn objects_faces_and_distances_are_numbers_in_files() {
    let folder = folder();
    let scene = scene("entities/box.ray");
    let scene = scene.to_str().expect("a path");
    let options = ["--size", "24", "--aov", "object,face,depth", "-o", "a.png"];
    let (status, said) = run(&folder, &[&["render", scene], &options[..]].concat());
    assert_eq!(status, 0, "{said}");
    let head = |descr: &str| format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': (18, 24), }}");
    let [objects, faces] = ["a-object.npy", "a-face.npy"].map(|name| {
        array(&folder, name, &head("<i4")).into_iter().map(i32::from_le_bytes).collect::<Vec<_>>()
    });
    let depths: Vec<_> =
        array(&folder, "a-depth.npy", &head("<f8")).into_iter().map(f64::from_le_bytes).collect();
    for index in (0..24 * 18).step_by(43) {
        let [x, y] = [index % 24, 17 - index / 24].map(|at| at.to_string());
        let (_, told) = run(&folder, &["probe", scene, &x, &y, "--set", "eye.pixeldim=24 18", "--json"]);
        let told: Value = serde_json::from_str(&told).expect("JSON");
        let first = &told["rays"][0];
        assert_eq!(i64::from(objects[index]), first["number"].as_i64().unwrap_or(-1), "{x} {y}");
        let depth = first["distance"].as_f64().unwrap_or(f64::INFINITY);
        assert_eq!(depths[index], depth, "{x} {y}: to the last digit");
    }
    // Of the scene, only the boxes have faces: their fronts are seen, the top of one and the left side of another.
    let seen: BTreeSet<_> = iter::zip(objects, faces).filter(|(_, face)| *face >= 0).collect();
    assert_eq!(seen, BTreeSet::from([(2, 2), (2, 5), (3, 2), (3, 3), (4, 2)]));
    for name in ["a-object.exr", "a-face.exr"] {
        let bytes = fs::read(folder.path().join(name)).expect("an EXR");
        assert!(bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]), "{name}");
    }
    assert!(fs::exists(folder.path().join("a-face.png")).expect("a folder"), "it can be looked at");
}
