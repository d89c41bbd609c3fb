//! `render --samples MIN..MAX` and `--max-error`: pixels that take different numbers of samples.

use crate::common::program::{folder, outcome, scene, tabray};
use image::RgbImage;
use std::fs;

/// Renders a scene at a small size with these options.
fn picture(name: &str, options: &[&str]) -> RgbImage {
    let folder = folder();
    let mut command = tabray(&folder);
    command.arg("render").arg(scene(name)).args(["--size", "100", "-o", "-"]).args(options);
    let (status, out, err) = outcome(&mut command);
    assert_eq!(status, 0, "{options:?}: {err}");
    image::load_from_memory(&out).expect("a picture").into_rgb8()
}

#[test]
fn adaptive_samples_depend_on_neither_threads_nor_instructions() {
    for options in [["--samples", "2..32"], ["--max-error", "3"]] {
        let with = |others: &[&str]| picture("gallery/marbles.ray", &[&options[..], others].concat());
        let one = with(&["--threads", "1"]);
        assert!(with(&["--threads", "4"]) == one, "{options:?}");
        assert!(with(&["--threads", "3", "--cpu", "baseline"]) == one, "{options:?}");
    }
}

#[test]
fn a_pixel_with_so_many_samples_has_the_colour_of_a_picture_with_as_many() {
    let name = "gallery/stained-glass.ray";
    let fixed = [2, 4, 8, 16].map(|samples: u32| picture(name, &["--samples", &samples.to_string()]));
    let adaptive = picture(name, &["--samples", "2..16"]);
    let mut used = [0; 4];
    for (x, y, pixel) in adaptive.enumerate_pixels() {
        let same = fixed.iter().map(|picture| picture.get_pixel(x, y) == pixel);
        let which = same.enumerate().find(|(_, same)| *same).map(|(which, _)| which);
        used[which.unwrap_or_else(|| panic!("pixel {x} {y} is of none of the pictures"))] += 1;
    }
    assert!(used[0] > used[1] && used[3] > 0, "{used:?}");
}

/// Returns the largest difference of a pixel's channels.
fn off(one: &RgbImage, other: &RgbImage, [x, y]: [u32; 2]) -> u8 {
    let (one, other) = (one.get_pixel(x, y).0, other.get_pixel(x, y).0);
    one.iter().zip(other).map(|(one, other)| one.abs_diff(other)).max().expect("three channels")
}

#[test]
fn rows_of_tiles_between_samples_are_not_missed() {
    let name = "pplane/rainbow_tiles.ray";
    let [right, fixed, adaptive] =
        ["1024", "64", "4..256"].map(|samples| picture(name, &["--samples", samples]));
    let (mut sums, mut places) = ([0; 2], 0);
    for (x, y, _) in right.enumerate_pixels() {
        let errors = [&fixed, &adaptive].map(|picture| off(picture, &right, [x, y]));
        sums = [sums[0] + u32::from(errors[0]), sums[1] + u32::from(errors[1])];
        places += u32::from(errors[1] > 16);
    }
    assert_eq!(places, 0, "pixels that are more than 16 levels off");
    assert!(sums[1] < 2 * sums[0], "{sums:?}");
}

#[test]
fn samples_are_counted_and_shown() {
    let folder = folder();
    let arguments =
        ["--size", "60", "-o", "out.png", "--max-error", "4", "--aov", "samples", "--stats", "json"];
    let mut command = tabray(&folder);
    let (status, _, err) =
        outcome(command.arg("render").arg(scene("gallery/three-lamps.ray")).args(arguments));
    assert_eq!(status, 0, "{err}");
    let json = err.lines().find(|line| line.starts_with('{')).expect("statistics");
    let stats: serde_json::Value = serde_json::from_str(json).expect("JSON");
    let counts = stats["samples"]["pixels"].as_object().expect("counts of pixels");
    let number = |count: &serde_json::Value| count.as_u64().expect("a count");
    assert_eq!(counts.values().map(number).sum::<u64>(), 60 * 45);
    let exact = image::open(folder.path().join("out-samples.exr")).expect("an EXR").into_rgb32f();
    for (samples, pixels) in counts {
        let samples: f32 = samples.parse().expect("a number");
        let shown = exact.pixels().filter(|pixel| pixel.0[0] == samples).count() as u64;
        assert_eq!(shown, number(pixels), "{samples} samples");
    }
    assert!(fs::exists(folder.path().join("out-samples.png")).expect("a folder"));
}

#[test]
fn a_small_object_between_samples_is_not_lost() {
    // About a sixth of a pixel across, and far from the centre of any.
    let text = "camera eye { pixeldim 40 30  worlddim 8 6  viewpoint 4 3 8 }
        material white { ambient 8 8 8 }
        sphere dot { material white  center 4.04 3.04 -2  radius 0.021 }";
    let folder = folder();
    fs::write(folder.path().join("dot.ray"), text).expect("a file");
    let render = |samples: &str| {
        let arguments = ["render", "dot.ray", "-o", "-", "--samples", samples];
        let (status, out, err) = outcome(tabray(&folder).args(arguments));
        assert_eq!(status, 0, "{err}");
        image::load_from_memory(&out).expect("a picture").into_rgb8()
    };
    assert!(render("1..64") == render("64"));
}

#[test]
fn adaptive_samples_do_not_depend_on_what_the_image_does_not_need() {
    // The red lamp adds nothing to the green floor, and `aside` is seen by pixels around the image only.
    let text = "camera eye { pixeldim 40 30  worlddim 8 6  viewpoint 4 3 8 }
        material green { ambient 0 0.2 0  diffuse 0 3 0 }
        material white { ambient 8 8 8 }
        light green { location 2 6 -3  emissivity 0 3 0 }
        light red { location 6 6 -3  emissivity 3 0 0 }
        sphere ball { material green  center 4 2 -3  radius 1 }
        sphere aside { material white  center -1.2 3 0  radius 1.09 }
        plane floor { material green  normal 0 1 0  point 0 0 0 }";
    let folder = folder();
    fs::write(folder.path().join("a.ray"), text).expect("a file");
    let render = |options: &[&str]| {
        let arguments = ["render", "a.ray", "-o", "-", "--samples", "2..64", "--stats", "json"];
        let (status, out, err) = outcome(tabray(&folder).args(arguments).args(options));
        assert_eq!(status, 0, "{err}");
        let json = err.lines().find(|line| line.starts_with('{')).expect("statistics");
        let stats: serde_json::Value = serde_json::from_str(json).expect("JSON");
        (out, stats["samples"].clone())
    };
    assert_eq!(render(&[]), render(&["--keep-all"]));
}

#[test]
fn plan_says_how_many_samples_pixels_take() {
    let says = |options: &[&str]| {
        let (status, out, err) =
            outcome(tabray(&folder()).arg("plan").arg(scene("gallery/marbles.ray")).args(options));
        assert_eq!(status, 0, "{err}");
        String::from_utf8(out).expect("text").lines().next().expect("a line").to_owned()
    };
    assert_eq!(
        says(&["--samples", "4..64"]),
        "image        640 x 480 pixels, 4 to 64 evenly spread samples in each: more where its colour is less certain"
    );
    assert!(
        says(&["--max-error", "1%"])
            .ends_with("until its error is estimated to be at most 2.55 of 255 levels")
    );
}

#[test]
fn choose_measures_one_sample_under_a_sky_that_lights() {
    let folder = folder();
    let text = "look_at c { pixeldim 32 24 position 0 2.5 6 target 0 0.8 0 angle 45 }
        material w { diffuse 0.7 0.7 0.7 }
        plane back { material w normal 0 0 1 point 0 0 -3 }
        sky s { lights yes horizon 0.5 0.5 0.5 zenith 0.1 0.1 0.9 ground 0.1 0.1 0.1 }";
    fs::write(folder.path().join("sky.ray"), text).expect("a file");
    for goal in [["--max-error", "0.5"], ["--max-time", "1"]] {
        let (status, _, err) = outcome(tabray(&folder).args(["choose", "sky.ray"]).args(goal));
        assert!(matches!(status, 0 | 1) && !err.contains("internal error"), "{err}");
    }
}

#[test]
fn choose_says_in_how_many_pixels_samples_may_have_missed_something() {
    let folder = folder();
    let scene = |lamp: &str| {
        let text = format!(
            "look_at eye {{ pixeldim 32 24 position 0 1 6 target 0 0.7 0 angle 45 }}
             material grey {{ ambient 0.3 0.3 0.3 }}
             material bright {{ ambient {lamp} {lamp} {lamp} }}
             plane floor {{ material grey normal 0 1 0 point 0 0 0 }}
             sphere lamp {{ material bright center 0.3 0.9 0 radius 0.004 }}"
        );
        fs::write(folder.path().join("lamp.ray"), text).expect("a file");
    };
    let says = |options: &[&str]| {
        let (status, out, err) = outcome(tabray(&folder).args(["choose", "lamp.ray"]).args(options));
        assert_eq!(status, 0, "{err}");
        String::from_utf8(out).expect("text")
    };
    let missed = "samples may have missed something bright and small";
    scene("300");
    let said = says(&["--max-error", "60"]);
    assert!(said.contains(&format!("In 1 of 768 pixels, {missed}.")), "{said}");
    let said = says(&["--max-error", "60", "--certain"]);
    assert!(said.contains(&format!("In 1 of 768 pixels, {missed}; bounds include it.")), "{said}");
    scene("0.5");
    let said = says(&["--max-error", "60"]);
    assert!(!said.contains(missed), "{said}");
}
