//! `--alpha`: image files that are transparent where they show no object.

use crate::common::program::{folder, outcome, tabray};
use image::{DynamicImage, RgbImage, RgbaImage};
use std::fs;
use tempfile::TempDir;

const SCENE: &str = "look_at eye { pixeldim 96 72  position 0 1.2 6  target 0 0.9 0  samples 16 }
background far { colour 0.3 0.5 0.8 }
material red { ambient 0.1 0.05 0.05  diffuse 0.6 0.1 0.1  specular 0.1 } glass crystal {}
sphere one { material red  center -1 1 0  radius 0.8 } sphere two { material crystal  center 0.8 0.8 0  radius 0.7 }
light key { location 3 6 5  emissivity 1 1 1 }\n";

fn run(folder: &TempDir, arguments: &[&str]) -> (i32, String) {
    let (status, out, err) = outcome(tabray(folder).args(arguments));
    (status, String::from_utf8_lossy(&out).into_owned() + &err)
}

fn scene() -> TempDir {
    let folder = folder();
    fs::write(folder.path().join("a.ray"), SCENE).expect("a file");
    folder
}

/// Renders the scene with these options.
fn render(folder: &TempDir, name: &str, options: &[&str]) -> DynamicImage {
    let (status, said) = run(folder, &[&["render", "a.ray", "-o", name], options].concat());
    assert_eq!(status, 0, "{said}");
    image::open(folder.path().join(name)).expect("an image")
}

fn bytes(folder: &TempDir, name: &str) -> Vec<u8> {
    fs::read(folder.path().join(name)).expect("a file")
}

/// Shows a transparent image before a colour, by light that is encoded as sRGB.
fn before(image: &RgbaImage, behind: [f64; 3]) -> RgbImage {
    let decoded = |byte: u8| match f64::from(byte) / 255.0 {
        code if code <= 0.040_45 => code / 12.92,
        code => ((code + 0.055) / 1.055).powf(2.4),
    };
    let encoded =
        |light: f64| if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 };
    RgbImage::from_fn(image.width(), image.height(), |x, y| {
        let pixel = image.get_pixel(x, y);
        let alpha = f64::from(pixel[3]) / 255.0;
        let over = |channel: usize| alpha * decoded(pixel[channel]) + (1.0 - alpha) * behind[channel];
        image::Rgb([0, 1, 2].map(|channel| (255.0 * encoded(over(channel))).round() as u8))
    })
}

#[test]
fn a_transparent_png_over_its_background_is_the_opaque_one_within_two_levels() {
    let folder = scene();
    let (opaque, clear) = (render(&folder, "o.png", &[]), render(&folder, "c.png", &["--alpha"]));
    let DynamicImage::ImageRgba8(clear) = clear else { panic!("no alpha") };
    let (opaque, over) = (opaque.into_rgb8(), before(&clear, [0.3, 0.5, 0.8]));
    let most = opaque.iter().zip(over.iter()).map(|(one, other)| one.abs_diff(*other)).max();
    assert!(most <= Some(2), "{most:?}");
    let mut counts = [0; 3];
    for (pixel, one) in clear.pixels().zip(opaque.pixels()) {
        match pixel[3] {
            0 => assert_eq!(pixel.0, [0; 4]),
            255 => assert_eq!(pixel.0[..3], one.0),
            _ => counts[1] += 1,
        }
        counts[if pixel[3] == 0 { 0 } else { 2 }] += 1;
    }
    assert!(counts.iter().all(|count| *count > 100), "{counts:?}");
    // The scene may say so itself.
    assert!(render(&folder, "own.png", &["--set", "eye.alpha=yes"]).into_rgba8() == clear);
}

#[test]
fn an_exr_has_premultiplied_alpha() {
    let folder = scene();
    let opaque = render(&folder, "o.exr", &[]).into_rgb32f();
    let DynamicImage::ImageRgba32F(clear) = render(&folder, "c.exr", &["--alpha", "--threads", "3"]) else {
        panic!("no alpha")
    };
    for (pixel, one) in clear.pixels().zip(opaque.pixels()) {
        for (channel, behind) in [0.3, 0.5, 0.8].into_iter().enumerate() {
            let over = pixel[channel] + (1.0 - pixel[3]) * behind;
            assert!((over - one[channel]).abs() < 1e-5, "{over} for {}", one[channel]);
        }
    }
}

#[test]
fn parts_make_the_bytes_of_one_render() {
    let folder = scene();
    for name in ["a.png", "a.exr"] {
        for part in ["1/3", "2/3", "3/3"] {
            let (status, said) = run(&folder, &["render", "a.ray", "-o", name, "--alpha", "--part", part]);
            assert_eq!(status, 0, "{said}");
        }
        let (status, said) = run(&folder, &["merge", name, "--remove-parts"]);
        assert_eq!(status, 0, "{said}");
        let whole = name.replace('a', "whole");
        render(&folder, &whole, &["--alpha", "--threads", "1"]);
        assert!(bytes(&folder, name) == bytes(&folder, &whole), "{name}");
    }
    // Parts of an opaque image belong to another one.
    for (part, option) in [("1/2", "--alpha"), ("2/2", "--keep-all")] {
        assert_eq!(run(&folder, &["render", "a.ray", "-o", "b.png", option, "--part", part]).0, 0);
    }
    let (status, said) = run(&folder, &["merge", "b.png"]);
    assert!(status == 2 && said.contains("the background was transparent and is opaque"), "{said}");
}

#[test]
fn frames_that_are_complete_are_not_rendered_again() {
    let folder = scene();
    let frames = |option: &str| {
        run(&folder, &["render", "a.ray", "-o", "a.png", "--frames", "1..1", "--resume", option]).1
    };
    assert!(frames("--alpha").contains("wrote"));
    assert!(frames("--alpha").contains("exists already"));
    assert!(frames("--keep-all").contains("wrote"), "an opaque one");
}

#[test]
fn what_cannot_be_transparent_is_refused_with_the_cure() {
    let folder = scene();
    for (name, lacking) in
        [("a.ppm", "a PPM has no alpha"), ("a.pfm", "a PFM has no alpha"), ("-", "a PPM has no alpha")]
    {
        for (option, cure) in
            [("--alpha", "leave out `--alpha`"), ("--set=eye.alpha=yes", "give `--set eye.alpha=no`")]
        {
            let (status, said) = run(&folder, &["render", "a.ray", "-o", name, option]);
            assert!(status == 2 && said.contains(lacking) && said.contains(cure), "{said}");
            let other = if name == "-" { "give `--format png`, or" } else { "name a .png or .exr file, or" };
            assert!(said.contains(other), "{said}");
        }
    }
    assert_eq!(run(&folder, &["render", "a.ray", "-o", "-", "--format", "png", "--alpha"]).0, 0);
    let certain = ["render", "a.ray", "-o", "a.png", "--max-error", "2", "--certain"];
    let (status, said) = run(&folder, &[&certain[..], &["--set", "eye.alpha=yes"]].concat());
    assert!(status == 2 && said.contains("cannot prove alpha"), "{said}");
    assert_eq!(run(&folder, &[&certain[..], &["--alpha"]].concat()).0, 2);
    assert!(fs::read_dir(folder.path()).expect("a folder").count() == 1, "nothing is written");
}

#[test]
fn what_compares_and_joins_images_refuses_transparent_ones_with_the_cure() {
    let folder = scene();
    for name in ["c.png", "c.exr", "f-0001.png"] {
        render(&folder, name, &["--alpha"]);
    }
    for arguments in [
        &["diff", "c.png", "c.png"][..],
        &["diff", "c.exr", "c.exr"],
        &["grade", "a.ray", "c.png"],
        &["film", "f.png", "--sheet", "sheet.png"],
    ] {
        let (status, said) = run(&folder, arguments);
        assert!(status == 2 && said.contains("it is transparent in places"), "{said}");
        assert!(said.contains("render it without `--alpha`"), "{said}");
    }
    // What fills the image is opaque.
    for name in ["full.png", "full.exr"] {
        let near = ["--alpha", "--set", "one.center=0 1.2 5.5", "--set", "eye.position=0 1.2 5.5"];
        render(&folder, name, &near);
        assert_eq!(run(&folder, &["diff", name, name]).0, 0);
    }
}

/// The notes' program has no other format.
#[test]
fn a_transparent_scene_on_standard_input_is_refused_with_the_cure() {
    let folder = folder();
    let scene = SCENE.replace("samples 16", "samples 16  alpha yes");
    let (status, out, said) = outcome(tabray(&folder).write_stdin(scene));
    assert_eq!((status, out.len()), (2, 0), "{said}");
    assert!(
        said.contains("cannot be transparent") && said.contains("tabray render SCENE -o image.png"),
        "{said}"
    );
}
