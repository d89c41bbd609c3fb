//! The rules of light as a user meets them: how light becomes bytes, and what is said of images that are black, burnt or
//! empty.

use crate::common::program::{folder, outcome, tabray};
use image::{Rgb, Rgb32FImage, RgbImage};
use std::fs;
use tempfile::TempDir;

/// Looks at the middle of a small image.
const EYE: &str = "look_at eye { pixeldim 5 5  position 0 0 5  target 0 0 0  angle 40 ";

/// Writes a scene and runs a command on it. Returns the status, and what is said.
fn run(folder: &TempDir, scene: &str, arguments: &[&str]) -> (i32, String) {
    fs::write(folder.path().join("a.ray"), scene).expect("room for a file");
    let (status, _, said) = outcome(tabray(folder).args(arguments));
    (status, said)
}

/// Renders a scene, and returns the middle pixel, and what is said.
fn middle(folder: &TempDir, scene: &str, options: &[&str]) -> ([u8; 3], String) {
    let (status, said) = run(folder, scene, &[&["render", "a.ray", "-o", "a.png"], options].concat());
    assert_eq!(status, 0, "{said}");
    let image = image::open(folder.path().join("a.png")).expect("an image").into_rgb8();
    (image.get_pixel(image.width() / 2, image.height() / 2).0, said)
}

#[test]
fn bytes_show_light_by_exposure_tone_and_transfer() {
    let folder = folder();
    for (rows, light, byte) in [
        ("rules free", 0.5, 188),
        ("rules free  transfer linear", 0.5, 128),
        ("rules free  exposure 1", 0.25, 188),
        ("rules free  tone neutral", 1.04, 241),
        ("rules free  tone neutral  transfer linear", 1.04, 224),
        ("rules notes", 0.5, 127),
    ] {
        let scene = format!("{EYE} {rows} }} background all {{ colour {light} {light} {light} }}");
        let (pixel, said) = middle(&folder, &scene, &[]);
        assert_eq!(pixel, [byte; 3], "{rows}: {said}");
    }
}

#[test]
fn the_classic_method_means_the_notes_light_and_files_of_full_range_are_before_all_else() {
    let folder = folder();
    let scene = format!("{EYE} rules free  exposure 1 }} background all {{ colour 0.25 0.25 0.25 }}");
    assert_eq!(middle(&folder, &scene, &["--method", "classic"]).0, [63; 3]);
    // An exposure on the command line adds to that of the scene.
    assert_eq!(middle(&folder, &scene, &["--exposure", "-1"]).0, [137; 3]);
    let (status, said) = run(&folder, &scene, &["render", "a.ray", "-o", "a.exr"]);
    assert_eq!(status, 0, "{said}");
    let exr = image::open(folder.path().join("a.exr")).expect("an image").into_rgb32f();
    assert_eq!(exr.get_pixel(2, 2).0, [0.25; 3]);
}

#[test]
fn rows_that_the_notes_rules_do_not_know_are_told() {
    let folder = folder();
    let scene = format!("{EYE} rules notes  exposure 3 }} background all {{ colour 0.25 0.25 0.25 }}");
    let (pixel, said) = middle(&folder, &scene, &[]);
    assert_eq!(pixel, [63; 3]);
    assert!(said.contains("`exposure` has no effect under the notes' rules of light"), "{said}");
}

#[test]
fn textures_show_the_light_that_an_image_shows_with_their_bytes() {
    let folder = folder();
    RgbImage::from_pixel(4, 2, Rgb([100, 30, 200])).save(folder.path().join("t.png")).expect("a texture");
    let light = Rgb32FImage::from_pixel(4, 2, Rgb([7.5, 0.25, 0.125]));
    light.save(folder.path().join("t.exr")).expect("a texture");
    let scene = |rows: &str, end: &str| {
        format!("{EYE} {rows} }} texture t {{ filename t.{end} }} environment all {{ texture t }}")
    };
    for (rows, bytes) in [
        ("rules free", [100, 30, 200]),
        ("rules free  transfer linear", [100, 30, 200]),
        // 255 / 256 of them, rounded down.
        ("rules notes", [99, 29, 199]),
    ] {
        assert_eq!(middle(&folder, &scene(rows, "png"), &[]).0, bytes, "{rows}");
    }
    let (status, said) = run(&folder, &scene("rules free", "exr"), &["render", "a.ray", "-o", "a.exr"]);
    assert_eq!((status, said.contains("cut to 1")), (0, false), "{said}");
    let exr = image::open(folder.path().join("a.exr")).expect("an image").into_rgb32f();
    assert_eq!(exr.get_pixel(2, 2).0, [7.5, 0.25, 0.125]);
}

#[test]
fn light_of_surfaces_that_counts_twice_or_not_at_all_is_told() {
    let folder = folder();
    let ball = "sphere ball { material paint center 0 0 0 radius 1 }";
    let check = |scene: &str| {
        let (status, said) = run(&folder, scene, &["check", "a.ray"]);
        assert_eq!(status, 0, "{said}");
        said
    };
    let paint = "material paint { ambient 0.3 0.3 0.3 diffuse 0.5 0.5 0.5 }";
    let said = check(&format!("{EYE} bounces 2 samples 4 }} {paint} {ball}"));
    assert!(said.contains("the `ambient` of `paint` counts beside the light of `bounces`"), "{said}");
    let said = check(&format!("{EYE} }} {paint} {ball}"));
    assert!(!said.contains("bounces"), "{said}");
    let sides = "material glow { emission 1 1 1 } shader both { sides back glow }";
    let paint = "material paint { emission 0.3 0.3 0.3 }";
    let said = check(&format!("{EYE} }} {paint} {ball}"));
    assert!(!said.contains("black") && !said.contains("emission"), "{said}");
    let coated = ball.replace("radius", "shader both radius");
    let said =
        check(&format!("{EYE} }} {paint} {} {coated}", sides.replace("shader both { sides", "sides both {")));
    assert!(said.contains("the `emission` of `glow` does not count here"), "{said}");
    // Samples aim at a ball, not at a cylinder.
    let said = check(&format!("{EYE} bounces 2 samples 4 }} {paint} {ball}"));
    assert!(!said.contains("chance"), "{said}");
    let rod = "cylinder rod { material paint base 0 0 0 height 1 radius 1 }";
    let said = check(&format!("{EYE} bounces 2 samples 4 }} {paint} {rod}"));
    assert!(said.contains("samples meet the light of `rod` by chance alone"), "{said}");
}

#[test]
fn a_room_that_no_lamp_lights_directly_is_told_of_bounces() {
    let folder = folder();
    let room = "material white { diffuse 0.8 0.8 0.8 }
        sphere room { material white center 0 0 0 radius 9 }
        sphere screen { material white center 0 0 -5 radius 3.4 }
        light lamp { location 0 0 -8.7 emissivity 1 1 1 }";
    let scene = |rows: &str| format!("{EYE} {rows} }} {room}").replace("pixeldim 5 5", "pixeldim 64 48");
    let (_, said) = middle(&folder, &scene(""), &[]);
    assert!(said.contains("matt surfaces do not light each other") && said.contains("`bounces 4`"), "{said}");
    let (pixel, said) = middle(&folder, &scene("bounces 4 samples 16"), &[]);
    assert!(pixel[0] > 20 && !said.contains("bounces"), "{pixel:?} {said}");
}

/// A ball 100 units wide, 400 units away, as a part in millimetres is.
const PART: &str = "material grey { diffuse 0.8 0.8 0.8 }
    sphere part { material grey  center 0 0 0  radius 50 }
    light key { location 100 200 300  emissivity 1 1 1 }";

const FAR: &str = "look_at eye { pixeldim 40 30  position 0 0 400  target 0 0 0  angle 20 ";

#[test]
fn black_burnt_and_empty_images_say_why() {
    let folder = folder();
    let black = format!("{FAR} rules notes }} {PART}");
    let burnt = format!("{FAR} }} {}", PART.replace("emissivity 1 1 1", "emissivity 30 30 30"));
    let empty =
        format!("{} rules free }} sky day {{ }} {PART}", FAR.replace("target 0 0 0", "target 0 0 900"));
    let metal =
        PART.replace("material grey { diffuse 0.8 0.8 0.8 }", "metal grey { roughness 0.3 } sky day { }");
    let dim = PART.replace("emissivity 1 1 1", "emissivity 0.1 0.1 0.1");
    let (rough, sky) = (format!("{FAR} }} {metal}"), format!("{FAR} }} sky day {{ lights yes }} {dim}"));
    for (scene, says, cure) in [
        (&rough, "`part` has a rough material", "`samples 64`"),
        (&sky, "which sees a single direction", "`samples 64`"),
        (&black, "under the notes' rules adds up to", "`rules free`"),
        (&burnt, "of the image is burnt to white: `key` adds up to", "`rules notes`"),
        (&empty, "no object is in view", "`target 0 0 0` looks at their middle"),
    ] {
        for command in ["render", "check"] {
            let (status, said) = run(&folder, scene, &[command, "a.ray"]);
            assert!(status == 0 && said.contains(says) && said.contains(cure), "{command}: {said}");
            assert_eq!(said.matches("warning: ").count(), 1, "{said}");
            assert!(!run(&folder, scene, &[command, "a.ray", "-q"]).1.contains("warning"));
        }
    }
    // The notes' own program prints the dump alone.
    let (status, _, said) = outcome(tabray(&folder).write_stdin(black));
    assert!(status == 0 && !said.contains("warning"), "{said}");
}

#[test]
fn a_check_of_some_pixels_says_so_and_advises_what_a_camera_takes() {
    let folder = folder();
    let hole = "look_at eye { pixeldim 8 6  position 0 0 9  target 0 0 0  angle 5 }  material grey { }
        torus ring { material grey  center 0 0 0  direction 0 0 1  radius 2  tube 0.5 }
        light lamp { location 0 5 5  emissivity 1 1 1 }";
    let (_, said) = run(&folder, hole, &["check", "a.ray"]);
    assert!(
        said.contains("the image seems to be black: none of 48 pixels that were looked at shows an object"),
        "{said}"
    );
    let faint =
        format!("{FAR} rules free }} {}", PART.replace("emissivity 1 1 1", "emissivity 1e-14 1e-14 1e-14"));
    let (_, said) = run(&folder, &faint, &["check", "a.ray"]);
    assert!(said.contains("seems to be black") && said.contains("`key` with an emissivity of"), "{said}");
    // The exposure would be of more than 32 stops.
    assert!(!said.contains("`exposure"), "{said}");
}

#[test]
fn images_that_are_as_they_should_be_are_not_remarked() {
    let folder = folder();
    let lit = format!("{FAR} rules free }} {PART}");
    let paper = format!("{FAR} rules free }} background all {{ colour 1 1 1 }} {PART}");
    for scene in [lit, paper] {
        for command in ["render", "check"] {
            let (status, said) = run(&folder, &scene, &[command, "a.ray"]);
            assert!(status == 0 && !said.contains("warning"), "{said}");
        }
    }
}

#[test]
fn previews_and_parts_do_not_replace_finished_images() {
    let folder = folder();
    let scene = format!("{FAR} rules free }} {PART}");
    let render = |options: &[&str]| run(&folder, &scene, &[&["render", "a.ray"], options].concat());
    let size = |name: &str| image::image_dimensions(folder.path().join(name)).expect("an image");
    assert_eq!(render(&["--quick"]).0, 0);
    assert_eq!((render(&[]).0, size("a.png")), (0, (40, 30)));
    for option in [&["--quick"][..], &["--size", "20"], &["--crop", "1,2,3,4"]] {
        let (status, said) = render(option);
        assert_eq!((status, size("a.png")), (2, (40, 30)), "{said}");
        assert!(said.contains("`a.png` is an image of 40 x 30 pixels, and this one would have"), "{said}");
    }
    assert!(render(&["--quick"]).1.contains("`-o a.quick.png`"));
    assert_eq!((render(&["--quick", "-o", "a.quick.png"]).0, size("a.quick.png")), (0, (10, 7)));
    assert_eq!((render(&["--size", "40x30"]).0, size("a.png")), (0, (40, 30)));
    assert_eq!((render(&["--quick", "--force"]).0, size("a.png")), (0, (10, 7)));
    // A draft gives way to a larger image, of whichever options.
    assert_eq!((render(&["--size", "20"]).0, size("a.png")), (0, (20, 15)));
}
