//! The page that `tabray diff` writes.

use crate::common::root;
use crate::review::{data, folder, pictures, tabray, with_pictures};
use assert_cmd::cargo::cargo_bin;
use image::Rgb;
use serde_json::json;
use std::fs;
use std::io::Write;
use std::process::{Command, Stdio};

#[test]
fn a_page_stands_alone_and_escapes_names() {
    let folder = with_pictures();
    let name = "<b onclick=a>.png";
    pictures()[0].save(folder.path().join(name)).expect("room for a picture");
    let (status, _, err) = tabray(folder.path(), &["diff", name, "new.ppm", "-o", "page.html"]);
    assert_eq!(status, 1, "{err}");
    let html = fs::read_to_string(folder.path().join("page.html")).expect("the page");
    for link in ["http://", "https://", "src=", "href=\"/", "url(", "@import", name] {
        assert!(!html.contains(link), "{link}");
    }
    let data = data(&html);
    let item = &data["items"][0];
    assert_eq!(item["names"], json!([name, "new.ppm"]));
    assert_eq!(item["first"]["x"], 1);
    assert_eq!(item["first"]["y"], 2);
    for side in ["old", "new"] {
        assert!(item[side].as_str().expect("a picture").starts_with("data:image/png;base64,"));
    }
}

#[test]
fn the_first_difference_is_explained_and_a_wrong_explanation_is_called_so() {
    let folder = folder();
    let path = folder.path();
    let scene = root().join("scenes/sphere/in-front.ray").display().to_string();
    let (status, _, err) = tabray(path, &["render", &scene, "-o", "new.png"]);
    assert_eq!(status, 0, "{err}");
    let mut old = image::open(path.join("new.png")).expect("a picture").into_rgb8();
    let [r, g, b] = old.get_pixel(80, 60).0;
    old.put_pixel(80, 60, Rgb([r ^ 1, g, b]));
    old.save(path.join("old.png")).expect("room for a picture");
    let program = cargo_bin!("tabray").to_str().expect("a path in UTF-8");
    let args = ["diff", "old.png", "new.png", "-o", "page.html", "--scene", &scene, "--before", program];
    assert_eq!(tabray(path, &args).0, 1);
    let html = fs::read_to_string(path.join("page.html")).expect("the page");
    let explanations = &data(&html)["items"][0]["explanations"];
    let text = |index: usize| explanations[index][1].as_str().expect("a text").to_owned();
    let probe = tabray(path, &["probe", &scene, "80", "59"]).1;
    assert_eq!(text(1), probe);
    let wrong = format!("the image has ({}, {g}, {b}) here, so it was not made like this:\n\n{probe}", r ^ 1);
    assert_eq!(text(0), wrong);
}

#[test]
fn a_program_that_does_not_explain_is_told() {
    let folder = with_pictures();
    let scene = folder.path().join("scene.ray");
    let eye = |size: &str| format!("camera eye {{ pixeldim {size}  worlddim 8 6  viewpoint 4 3 6 }}");
    let explained = |size: &str, program: &str| {
        fs::write(&scene, eye(size)).expect("room for a file");
        let args =
            ["diff", "old.png", "new.ppm", "-o", "a.html", "--scene", "scene.ray", "--before", program];
        let (status, _, err) = tabray(folder.path(), &args);
        assert_eq!(status, 1, "{err}");
        let html = fs::read_to_string(folder.path().join("a.html")).expect("the page");
        data(&html)["items"][0]["explanations"][0].to_string()
    };
    for (size, program, said) in [
        ("4 3", "./no-such-program", "cannot start `./no-such-program`: no such file or directory"),
        ("8 6", "false", "the image does not have the size in its scene"),
        ("4 3", "false", "the program says\\n\\n"),
    ] {
        let told = format!("[\"Before, by {program}\",\"no explanation: {said}\"]");
        assert_eq!(explained(size, program), told);
    }
}

#[test]
fn a_browser_shows_the_page() {
    let folder = with_pictures();
    tabray(folder.path(), &["diff", "old.png", "new.ppm", "-o", "page.html"]);
    let page = format!("file://{}", folder.path().join("page.html").display());
    let profile = format!("--user-data-dir={}", folder.path().join("profile").display());
    let shown = Command::new("chromium")
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=5000", "--dump-dom"])
        .args([&profile, &page])
        .stderr(Stdio::null())
        .output();
    let Ok(shown) = shown else {
        let _ = writeln!(std::io::stderr(), "SKIPPED: there is no chromium here");
        return;
    };
    let page = String::from_utf8_lossy(&shown.stdout);
    assert!(page.contains("<h1>old.png and new.ppm</h1>"), "{page}");
    assert_eq!(page.matches("<canvas").count(), 3, "old, difference and new");
    assert!(page.contains("1 from the left, 2 from the bottom"), "the first pixel that differs is marked");
    assert!(page.contains("difference 0 0 30"), "its bytes are read from the pictures");
}
