//! Checkpoints that `--resume` refuses, and what it says about them.

use crate::common::program::{folder, names_in, scene};
use crate::stop::{Running, bytes, render, rgb, stop_midway, tabray_path, workplace};
use image::Rgb;
use sha2::{Digest, Sha256};
use std::fs;
use std::path::Path;

const HELP: &str = " |\n = help: leave out `--resume` to start from the beginning\n";

/// A scene with a texture, which is slow to render.
const TEXTURED: &str = "camera eye { pixeldim 640 480  worlddim 8 6  viewpoint 4 3 6 }
material white { ambient 2 2 2 }
texture bricks { filename bricks.png }
texplane wall { material white  normal 0 0 1  point 0 0 -8  xdir 1 0 0  dimensions 8 6  texname bricks  mode 0 }
mesh lid { material white  file lid.obj }";

/// A triangle behind the wall.
const LID: &str = "v 0 0 -9\nv 1 0 -9\nv 0 1 -9\nf 1 2 3\n";

#[test]
fn what_differs_is_named() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let copy = |from: &str, to: &str| fs::copy(scene(from), at(to)).expect("a copy");
    copy("textures/bricks.png", "bricks.png");
    fs::write(at("wall.ray"), TEXTURED).expect("a file");
    fs::write(at("lid.obj"), LID).expect("a file");
    let args = ["wall.ray", "--samples", "144", "-o", "a.png"];
    stop_midway(&folder, &args);
    let checkpoint = bytes(&folder, "a.png.checkpoint");
    let picture = bytes(&folder, "a.png");
    let refused = |args: &[&str], differs: &str| {
        let (status, _, err) = render(&folder, &[args, &["--resume"]].concat());
        let said = format!("error: `a.png.checkpoint` belongs to another image: {differs}\n{HELP}");
        assert_eq!((status, err), (2, said), "{args:?}");
        let kept = bytes(&folder, "a.png") == picture && bytes(&folder, "a.png.checkpoint") == checkpoint;
        assert!(kept, "{args:?} changes no file");
    };
    refused(&["wall.ray", "-o", "a.png"], "the number of samples was 144 and is 1");
    refused(
        &[&args[..], &["--size", "320", "--sampler", "random"]].concat(),
        "the size was 640 x 480 and is 320 x 240, the sampler was sobol and is random",
    );
    refused(&[&args[..], &["--crop", "1,2,3,4"]].concat(), "the crop was none and is 1,2,3,4");
    refused(&[&args[..], &["--method", "classic"]].concat(), "the accuracy was exact and is classic");
    fs::write(at("wall.ray"), TEXTURED.replace("ambient 2 2 2", "ambient 2 2 2.0000000000000004"))
        .expect("a file");
    refused(&args, "the scene has changed");
    fs::write(at("wall.ray"), TEXTURED).expect("a file");
    refused(&[&args[..], &["--set", "white.ambient=2 2 3"]].concat(), "the scene has changed");
    let mut bricks = rgb(&folder, "bricks.png");
    bricks.put_pixel(3, 2, Rgb([1, 2, 3]));
    bricks.save(at("bricks.png")).expect("a picture");
    refused(&args, "the image of texture `bricks` has changed");
    copy("textures/bricks.png", "bricks.png");
    fs::write(at("lid.obj"), LID.replace("v 1", "v 1.5")).expect("a file");
    refused(&args, "the file of mesh `lid` has changed");
    fs::write(at("lid.obj"), LID).expect("a file");

    // A byte after the end of the program changes its file, but not what the system loads.
    let mut program = fs::read(tabray_path()).expect("the program's file");
    program.push(0);
    let other = at("other");
    fs::write(&other, program).expect("a file");
    fs::set_permissions(&other, fs::metadata(tabray_path()).expect("there").permissions())
        .expect("permissions");
    let (status, err) =
        Running::start(&other, &folder, &[&["render"], &args[..], &["--resume"]].concat()).end();
    let said = format!("error: `a.png.checkpoint` belongs to another image: the program was rebuilt\n{HELP}");
    assert_eq!((status, err), (2, said));

    let version = format!("\"version\":\"{}\"", env!("CARGO_PKG_VERSION"));
    rewrite(&at("a.png.checkpoint"), |text| text.replace(&version, "\"version\":\"0.0.9\""));
    let (status, _, err) = render(&folder, &[&args[..], &["--resume"]].concat());
    let now = env!("CARGO_PKG_VERSION");
    let said = format!(
        "error: `a.png.checkpoint` belongs to another image: the version of tabray was 0.0.9 and is {now}\n{HELP}"
    );
    assert_eq!((status, err), (2, said));
}

/// Changes the second line of a checkpoint, which tells what its image depends on.
fn rewrite(path: &Path, change: impl FnOnce(String) -> String) {
    let bytes = fs::read(path).expect("a checkpoint");
    let mut lines = bytes[..bytes.len() - 32].splitn(3, |byte| *byte == b'\n');
    let [first, label, rest] = [(); 3].map(|()| lines.next().expect("three lines"));
    let changed = change(String::from_utf8_lossy(label).into_owned());
    let mut text = [first, changed.as_bytes(), rest].join(&b'\n');
    text.extend_from_slice(&Sha256::digest(&text));
    fs::write(path, text).expect("room");
}

#[test]
fn what_is_no_checkpoint_is_refused_and_harms_nothing() {
    let folder = workplace();
    let args = ["hall.ray", "--size", "300", "--samples", "4", "-o", "a.png"];
    stop_midway(&folder, &args);
    let (checkpoint, path) = (bytes(&folder, "a.png.checkpoint"), folder.path().join("a.png.checkpoint"));
    let plain = fs::read(scene("textures/bricks.png")).expect("a picture");
    fs::write(folder.path().join("a.png"), "precious").expect("a file");
    let cut = |at: usize| checkpoint[..at].to_vec();
    for broken in [Vec::new(), b"no picture".to_vec(), plain, cut(100), cut(checkpoint.len() / 2)] {
        fs::write(&path, &broken).expect("a file");
        let (status, _, err) = render(&folder, &[&args[..], &["--resume"]].concat());
        let said = format!(
            "error: cannot read `a.png.checkpoint`: it is not a checkpoint, or it is corrupt\n{HELP}"
        );
        assert_eq!((status, err), (2, said), "of {} bytes", broken.len());
        assert!(bytes(&folder, "a.png") == b"precious" && fs::read(&path).expect("there") == broken);
        assert_eq!(names_in(folder.path()), ["a.png", "a.png.checkpoint", "hall.ray"]);
    }
    fs::remove_file(&path).and_then(|()| fs::create_dir(&path)).expect("a folder");
    let (status, _, err) = render(&folder, &[&args[..], &["--resume"]].concat());
    assert_eq!((status, err), (2, format!("error: cannot read `a.png.checkpoint`: is a directory\n{HELP}")));
}
