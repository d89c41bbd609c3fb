//! `--dpi`: files that say how large they are printed.

use crate::common::program::{folder, outcome, scene, tabray};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

fn run(folder: &TempDir, arguments: &[&str]) -> (i32, String) {
    let (status, out, err) = outcome(tabray(folder).args(arguments));
    (status, String::from_utf8(out).expect("text") + &err)
}

/// Returns the pixels per metre that a PNG records in each direction.
fn per_metre(path: &Path) -> Option<[u32; 2]> {
    let png = png::Decoder::new(std::io::BufReader::new(fs::File::open(path).expect("a file")));
    let png = png.read_info().expect("a PNG");
    png.info().pixel_dims.map(|dims| {
        assert_eq!(dims.unit, png::Unit::Meter);
        [dims.xppu, dims.yppu]
    })
}

fn small() -> TempDir {
    let folder = folder();
    fs::copy(scene("sphere/in-front.ray"), folder.path().join("a.ray")).expect("a copy");
    folder
}

#[test]
fn an_image_says_how_densely_it_is_printed_and_keeps_its_pixels() {
    let folder = small();
    let at = |name: &str| folder.path().join(name);
    for arguments in [
        &["render", "a.ray", "-o", "plain.png"][..],
        &["render", "a.ray", "-o", "dense.png", "--dpi", "300", "--aov", "depth"],
        &["render", "a.ray", "-o", "plain.exr"],
        &["render", "a.ray", "-o", "dense.exr", "--dpi", "300"],
    ] {
        let (status, said) = run(&folder, arguments);
        assert_eq!(status, 0, "{said}");
    }
    assert_eq!(["plain.png", "dense.png"].map(|name| per_metre(&at(name))), [None, Some([11_811; 2])]);
    assert_eq!(per_metre(&at("dense-depth.png")), Some([11_811; 2]));
    let pixels = |name: &str| image::open(at(name)).expect("an image").into_rgb32f().into_raw();
    assert_eq!(pixels("plain.png"), pixels("dense.png"));
    assert_eq!(pixels("plain.exr"), pixels("dense.exr"));
    let density = |name: &str| {
        let file = fs::read(at(name)).expect("a file");
        // The name of the attribute, its type, and the length of its value.
        let head = b"xDensity\0float\0\x04\0\0\0";
        let found = file.windows(head.len()).position(|bytes| bytes == head)?;
        file[found + head.len()..].first_chunk().map(|number| f32::from_le_bytes(*number))
    };
    assert_eq!(["plain.exr", "dense.exr"].map(density), [None, Some(300.0)]);
}

#[test]
fn parts_carry_the_density_to_their_image() {
    let folder = small();
    for part in ["1/2", "2/2"] {
        let (status, said) =
            run(&folder, &["render", "a.ray", "-o", "a.png", "--part", part, "--dpi", "150"]);
        assert_eq!(status, 0, "{said}");
    }
    assert_eq!(run(&folder, &["merge", "a.png"]).0, 0);
    assert_eq!(per_metre(&folder.path().join("a.png")), Some([5906; 2]));
    let (status, said) = run(&folder, &["render", "a.ray", "-o", "whole.png", "--dpi", "150"]);
    assert_eq!(status, 0, "{said}");
    let bytes = |name: &str| fs::read(folder.path().join(name)).expect("a file");
    assert!(bytes("a.png") == bytes("whole.png"), "other bytes than those of one render");
    let (_, said) = run(&folder, &["render", "a.ray", "-o", "a.png", "--part", "2/2", "--dpi", "72"]);
    assert!(said.contains("wrote"), "{said}");
    let (status, said) = run(&folder, &["merge", "a.png"]);
    assert!(status != 0 && said.contains("`--dpi` differs"), "{said}");
}

#[test]
fn a_complete_frame_of_another_density_is_rendered_again() {
    let folder = small();
    let frames = |dpi: &str| {
        run(&folder, &["render", "a.ray", "-o", "a.png", "--frames", "1..1", "--resume", "--dpi", dpi])
    };
    assert!(frames("300").1.contains("wrote"));
    assert!(frames("300").1.contains("exists already"));
    assert!(frames("600").1.contains("wrote"));
    assert_eq!(per_metre(&folder.path().join("a-0001.png")), Some([23_622; 2]));
}

#[test]
fn a_format_without_a_place_for_the_density_is_refused_with_the_cure() {
    let folder = small();
    let named = "name a .png or .exr file";
    for (name, lacking, cure) in [
        ("a.ppm", "a PPM has no place", named),
        ("a.pfm", "a PFM has no place", named),
        ("-", "a PPM has no place", "give `--format png`"),
    ] {
        let (status, said) = run(&folder, &["render", "a.ray", "-o", name, "--dpi", "300"]);
        assert!(status == 2 && said.contains(lacking) && said.contains(cure), "{said}");
        assert!(!folder.path().join(name).exists());
    }
    let (_, said) = run(&folder, &["render", "a.ray", "--dpi", "0"]);
    assert!(said.contains("give a whole number from 1 to 100000"), "{said}");
}
