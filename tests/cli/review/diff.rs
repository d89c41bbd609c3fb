//! The numbers and the exit statuses of `tabray diff`.

use crate::review::{pictures, tabray, with_pictures};
use image::{DynamicImage, RgbImage};
use std::fs;

#[test]
fn a_difference_is_counted_measured_and_located() {
    let (status, out, err) = tabray(with_pictures().path(), &["diff", "old.png", "new.ppm"]);
    assert_eq!((status, err.as_str()), (1, ""));
    assert_eq!(
        out,
        "1 of 12 pixels differs (8.3333 %); largest difference 30 levels, RMS 5.0000\n\
         first at 1 from the left and 2 from the bottom: (10, 20, 30) became (10, 20, 60)\n"
    );
}

#[test]
fn the_pixel_that_differs_most_is_located_beside_the_first() {
    let folder = with_pictures();
    let [mut picture, _] = pictures();
    let old = picture.clone();
    picture.put_pixel(1, 0, image::Rgb(old.get_pixel(1, 0).0.map(|byte| byte ^ 3)));
    picture.put_pixel(2, 1, image::Rgb(old.get_pixel(2, 1).0.map(|byte| byte ^ 64)));
    picture.save(folder.path().join("both.png")).expect("room for a picture");
    let (status, out, _) = tabray(folder.path(), &["diff", "old.png", "both.png"]);
    let lines: Vec<_> = out.lines().collect();
    assert_eq!((status, lines.len()), (1, 3), "{out}");
    assert!(lines[1].starts_with("first at 1 from the left and 2 from the bottom: "), "{out}");
    assert!(lines[2].starts_with("most at 2 from the left and 1 from the bottom: "), "{out}");
}

#[test]
fn pictures_are_the_same_within_the_tolerance() {
    let folder = with_pictures();
    let status = |args: &[&str]| tabray(folder.path(), &[&["diff"], args].concat()).0;
    assert_eq!(status(&["old.png", "old.png"]), 0);
    assert_eq!(status(&["old.png", "new.ppm", "--tolerance", "30"]), 0);
    assert_eq!(status(&["old.png", "new.ppm", "--tolerance", "29"]), 1);
}

#[test]
fn trouble_is_no_difference() {
    let folder = with_pictures();
    let path = folder.path();
    DynamicImage::new_rgb16(4, 3).save(path.join("deep.png")).expect("room for a picture");
    DynamicImage::new_rgba8(4, 3).save(path.join("clear.png")).expect("room for a picture");
    RgbImage::new(4, 4).save(path.join("tall.png")).expect("room for a picture");
    fs::write(path.join("text.png"), "no picture").expect("room for a file");
    for (args, message) in [
        (&["nothing.png"][..], "cannot read `nothing.png`"),
        (&["text.png"], "cannot read `text.png`"),
        (&["deep.png"], "8 bits per channel"),
        (&["clear.png"], "`clear.png`: it is transparent in places"),
        (&["tall.png"], "`old.png` has 4 x 3 pixels, and `tall.png` has 4 x 4 pixels"),
        (&["new.ppm", "-o", "new.ppm"], "end it in .html"),
        (&["new.ppm", "-o", "no/page.html"], "cannot write `no/page.html`"),
        (&["new.ppm", "--tolerance", "256"], "256"),
    ] {
        let (status, out, err) = tabray(path, &[&["diff", "old.png"], args].concat());
        assert_eq!((status, out.as_str()), (2, ""), "{args:?}: {err}");
        assert!(err.contains(message), "{err}");
    }
    assert_eq!(image::open(path.join("new.ppm")).expect("still a picture").into_rgb8(), pictures()[1]);
}
