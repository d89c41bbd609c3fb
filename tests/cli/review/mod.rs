//! `tabray diff` and `tabray review`: what they count, what their pages contain, and what accepting and rejecting does.

mod diff;
mod page;
mod pending;
mod served;

use assert_cmd::cargo::cargo_bin_cmd;
use image::{Rgb, RgbImage};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Runs the program in a folder; returns its exit status, standard output and standard error.
fn tabray(folder: &Path, args: &[&str]) -> (i32, String, String) {
    let output = cargo_bin_cmd!("tabray").current_dir(folder).args(args).output().expect("the program runs");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    (output.status.code().unwrap_or(-1), text(output.stdout), text(output.stderr))
}

fn folder() -> TempDir {
    TempDir::new().expect("a folder")
}

/// Makes an image of 4 x 3 pixels, and one in which the second pixel of the top row has more blue.
fn pictures() -> [RgbImage; 2] {
    let old = RgbImage::from_pixel(4, 3, Rgb([10, 20, 30]));
    let mut new = old.clone();
    new.put_pixel(1, 0, Rgb([10, 20, 60]));
    [old, new]
}

/// Makes a folder with both images, one in each format.
fn with_pictures() -> TempDir {
    let folder = folder();
    for (picture, name) in pictures().into_iter().zip(["old.png", "new.ppm"]) {
        picture.save(folder.path().join(name)).expect("room for a picture");
    }
    folder
}

/// Returns the data of a page.
fn data(html: &str) -> Value {
    let (_, data) = html.split_once("id=\"data\">").expect("a page has its data");
    let (data, _) = data.split_once("</script>").expect("the data end");
    serde_json::from_str(data).expect("JSON")
}

/// Makes a folder with the snapshots of failed tests: a changed image, a changed text and a new text.
fn with_pending() -> TempDir {
    let folder = folder();
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join("snapshots/it's <b>").join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("room for a folder");
        fs::write(path, bytes).expect("room for a file");
    };
    let png = |picture: &RgbImage| {
        let mut bytes = std::io::Cursor::new(Vec::new());
        picture.write_to(&mut bytes, image::ImageFormat::Png).expect("memory takes it");
        bytes.into_inner()
    };
    let [old, new] = pictures();
    write("ball.snap", b"---\nsource: tests/a.rs\nextension: png\nsnapshot_kind: binary\n---\n");
    write("ball.snap.png", &png(&old));
    write(
        "ball.snap.new",
        b"---\nsource: tests/a.rs\nassertion_line: 7\nextension: png\nsnapshot_kind: binary\n---\n",
    );
    write("ball.snap.new.png", &png(&new));
    write("dump.snap", b"---\nsource: tests/a.rs\n---\none\ntwo\n");
    write("dump.snap.new", b"---\nsource: tests/a.rs\nassertion_line: 8\n---\none\n---\n</script>2\n");
    write("later.snap.new", b"---\nsource: tests/a.rs\nassertion_line: 9\n---\nsomething\n");
    folder
}

/// Returns the files below a folder of pending snapshots, with their contents.
fn files(folder: &TempDir) -> BTreeMap<String, Vec<u8>> {
    fs::read_dir(folder.path().join("snapshots/it's <b>"))
        .expect("the snapshots")
        .map(|entry| entry.expect("an entry").path())
        .map(|path| {
            (
                path.file_name().expect("a name").to_string_lossy().into_owned(),
                fs::read(&path).expect("a file"),
            )
        })
        .collect()
}
