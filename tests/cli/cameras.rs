//! Cameras of every type through the program: what depends on them, and what some of them refuse.

use crate::common::program::{folder, outcome, scene, tabray};
use std::fs;
use tempfile::TempDir;

/// A floor and two balls in the light of a lamp, without a camera.
const SCENE: &str = "material paper { ambient 0.4 0.4 0.3  diffuse 3 3 3 }
    light lamp { location 2 8 4  emissivity 9 8 7 }
    plane floor { material paper  normal 0 1 0  point 0 0 0 }
    sphere ball { material paper  center 4 1.5 -3  radius 1.2 }
    sphere near { material paper  center 3 0.5 1  radius 0.5 }";

const CAMERAS: [&str; 4] = ["look_at", "orthographic", "fisheye", "thin_lens"];

/// Writes the scene with a camera of this type.
fn written(folder: &TempDir, camera: &str) -> String {
    let own = match camera {
        "orthographic" => "width 7",
        "thin_lens" => "aperture 0.5  focus 7",
        _ => "angle 60",
    };
    let text = format!("{camera} eye {{ pixeldim 32 24  position 1 4 7  target 4 1 -2  {own} }}\n{SCENE}");
    fs::write(folder.path().join("scene.ray"), text).expect("room for a file");
    "scene.ray".to_owned()
}

#[test]
fn first_hits_of_every_camera_are_proven() {
    for camera in CAMERAS {
        let folder = folder();
        let scene = written(&folder, camera);
        let assumed = match camera {
            "orthographic" => "assumed: starts of rays as computed, rounded to f64 (`orthographic`)\n",
            "fisheye" => "assumed: rays as computed, rounded to f64 (`fisheye`)\n",
            "thin_lens" => "assumed: rays as computed, rounded to f64 (`thin_lens`)\n",
            _ => "",
        };
        let (status, out, err) = outcome(tabray(&folder).args(["verify", &scene]));
        assert_eq!(
            (status, &*String::from_utf8_lossy(&out)),
            (0, &*format!("768 of 768 pixels proven (100.0000 %), 0 ties, 0 contradicted\n{assumed}")),
            "{err}"
        );
    }
}

#[test]
fn images_of_every_camera_depend_on_neither_threads_nor_instructions() {
    for camera in CAMERAS {
        let folder = folder();
        let scene = written(&folder, camera);
        for samples in [&["--samples", "1"][..], &["--samples", "5"], &["--max-error", "4"]] {
            let with = |options: &[&str]| {
                let mut command = tabray(&folder);
                command.args(["render", &scene, "-o", "out.ppm"]).args(samples).args(options);
                let (status, _, err) = outcome(&mut command);
                assert_eq!(status, 0, "{camera}: {err}");
                fs::read(folder.path().join("out.ppm")).expect("an image")
            };
            let one = with(&["--threads", "1"]);
            assert!(with(&["--threads", "4"]) == one, "{camera} {samples:?}");
            assert!(with(&["--threads", "3", "--cpu", "baseline"]) == one, "{camera} {samples:?}");
        }
    }
}

#[test]
fn colours_of_pixels_are_certain_where_the_camera_says_what_they_see() {
    for camera in CAMERAS {
        let folder = folder();
        let scene = written(&folder, camera);
        let args = ["render", &scene, "-o", "out.ppm", "--max-error", "4", "--certain"];
        let (status, _, err) = outcome(tabray(&folder).args(args));
        if ["look_at", "orthographic"].contains(&camera) {
            assert!(
                status == 0 && err.contains("are certain to be within 4 of 255 levels"),
                "{camera}: {err}"
            );
        } else {
            assert_eq!(status, 2, "{camera}: {err}");
            assert!(
                err.contains("needs a camera that says where all rays through a pixel lie"),
                "{camera}: {err}"
            );
        }
    }
}

#[test]
fn a_lens_is_said_to_need_samples_in_every_pixel() {
    let lens = scene("entities/thin_lens.ray");
    let folder = folder();
    let (status, out, err) = outcome(tabray(&folder).arg("plan").arg(lens).args(["--max-error", "4"]));
    let out = String::from_utf8_lossy(&out);
    assert_eq!(status, 0, "{err}");
    assert!(
        out.contains("the camera does not say where objects are seen, so each pixel takes 64 samples"),
        "{out}"
    );
}

#[test]
fn every_camera_survives_a_conversion() {
    for camera in CAMERAS {
        let folder = folder();
        let scene = written(&folder, camera);
        let convert = |from: &str, to: &str| {
            let (status, _, err) = outcome(tabray(&folder).args(["convert", from, to]));
            assert_eq!(status, 0, "{err}");
            fs::read_to_string(folder.path().join(to)).expect("a text")
        };
        assert!(convert(&scene, "again.toml").contains(&format!("[{camera}.eye]")));
        assert_eq!(convert("again.toml", "again.ray"), convert(&scene, "same.ray"), "{camera}");
    }
}
