//! `render --size`, `--quick` and `--crop`: the size of the image, and the part of it that is rendered.

use crate::common::program::{folder, names_in, outcome, scene, tabray};
use image::{RgbImage, imageops};

/// Renders a scene with these options.
fn picture(name: &str, options: &[&str]) -> RgbImage {
    let (status, out, err) =
        outcome(tabray(&folder()).arg("render").arg(scene(name)).args(options).args(["-o", "-"]));
    assert_eq!(status, 0, "{options:?}: {err}");
    image::load_from_memory(&out).expect("a picture").into_rgb8()
}

#[test]
fn a_part_is_as_it_is_in_the_whole_picture() {
    let scene = "gallery/stained-glass.ray";
    for options in [
        &["--size", "90"][..],
        &["--size", "90", "--samples", "3"],
        &["--size", "90", "--samples", "2..16"],
        &["--quick"],
    ] {
        let whole = picture(scene, options);
        let [left, bottom, wide, high] = [11, 7, 40, 23];
        let part = picture(scene, &[options, &["--crop", "11,7,40,23"]].concat());
        let top = whole.height() - bottom - high;
        assert!(part == imageops::crop_imm(&whole, left, top, wide, high).to_image(), "{options:?}");
    }
}

#[test]
fn the_edges_of_a_picture_belong_to_it() {
    let (name, size) = ("sphere/in-front.ray", ["--size", "12x9"]);
    let whole = picture(name, &size);
    assert!(picture(name, &[&size[..], &["--crop", "0,0,12,9"]].concat()) == whole);
    let corner = picture(name, &[&size[..], &["--crop", "11,8,1,1"]].concat());
    assert_eq!((corner.dimensions(), corner.get_pixel(0, 0)), ((1, 1), whole.get_pixel(11, 0)));
}

#[test]
fn a_width_alone_keeps_the_proportion() {
    let name = "sphere/in-front.ray";
    assert_eq!(picture(name, &[]).dimensions(), (160, 120));
    assert_eq!(picture(name, &["--size", "80"]).dimensions(), (80, 60));
    assert_eq!(picture(name, &["--size", "1"]).dimensions(), (1, 1));
    assert_eq!(picture(name, &["--size", "80x20"]).dimensions(), (80, 20));
}

#[test]
fn a_quick_picture_is_a_small_one_with_one_ray_a_pixel() {
    let name = "entities/heart.ray";
    assert!(picture(name, &["--quick"]) == picture(name, &["--size", "40x30", "--samples", "1"]));
}

#[test]
fn what_a_picture_does_not_have_is_refused_and_nothing_is_written() {
    for (options, says) in [
        (&["--crop", "150,0,11,1"][..], "the image of 160 x 120 pixels has no part of 11 x 1 at 150 0"),
        (&["--crop", "0,119,1,2"], "has no part of 1 x 2 at 0 119"),
        (&["--crop", "0,0,0,1"], "has no part of 0 x 1 at 0 0"),
        (
            &["--crop", "-1,0,2,2"],
            "X counts from the left and Y from the bottom, both from 0; W and H are at least 1, X + W at most 160, and Y + H at most 120",
        ),
        (&["--crop", "9223372036854775807,0,9223372036854775807,1"], "has no part"),
        (&["--crop", "1,2,3"], "give the part as `X,Y,W,H`, whole numbers"),
        (&["--size", "0"], "each from 1 to 100000"),
        (&["--size", "800,600"], "give a width as `800`, or both as `800x600`"),
        (&["--size", "100001"], "each from 1 to 100000"),
        (&["--quick", "--size", "80"], "cannot be used with"),
        (&["--crop", "0,0,1,1", "--aov", "depth"], "cannot be used with"),
    ] {
        let folder = folder();
        let (status, _, err) =
            outcome(tabray(&folder).arg("render").arg(scene("sphere/in-front.ray")).args(options));
        assert_eq!(status, 2, "{options:?}: {err}");
        assert!(err.contains(says), "{options:?}: {err}");
        assert!(names_in(folder.path()).is_empty());
    }
}

#[test]
fn a_height_that_follows_from_the_width_keeps_within_bounds() {
    let tall = "camera eye { pixeldim 1 90000  worlddim 1 90000  viewpoint 0 0 1 }";
    let folder = folder();
    let render = ["render", "-", "-o", "a.png", "--size", "2"];
    let (status, _, err) = outcome(tabray(&folder).args(render).write_stdin(tall));
    assert_eq!(status, 2);
    assert!(err.contains("an image 2 pixels wide would be 180000 high"), "{err}");
}
