//! Two images compared on the page.

use crate::common::{model, render};
use crate::watch::browser::Browser;
use crate::watch::page::{canvas, opened, shown};
use crate::watch::program::{Watching, ball};
use assert_cmd::cargo::cargo_bin_cmd;
use image::RgbImage;
use std::fs;
use tabray::output::Comparison;

/// A scene whose image the classic method computes otherwise: a ball whose shadow begins on itself.
fn shaded() -> String {
    "camera eye { pixeldim 80 60 worlddim 8 6 viewpoint 4 3 6 }
    light lamp { location 7 6 4 emissivity 30 30 30 } material paint { diffuse 9 9 9 ambient 0.1 0.1 0.1 }
    sphere ball { material paint center 4 3 -3 radius 2 }"
        .to_owned()
}

/// Returns the pixels of the image left of the line.
fn before(browser: &Browser) -> RgbImage {
    browser.run("window.first = document.querySelector('canvas'); window.first.parentNode.prepend(document.querySelector('#before'))");
    let image = canvas(browser);
    browser.run("window.first.parentNode.prepend(window.first)");
    image
}

fn words(browser: &Browser) -> String {
    browser.text("return document.querySelector('#comparing span').textContent")
}

fn compared(browser: &Browser, what: &str) {
    browser.wait(&format!("document.documentElement.dataset.compared === '{what}'"));
}

fn choose(browser: &Browser, means: &str) {
    browser.run(&format!(
        "const all = document.querySelector('#comparing select'); all.value = '{means}'
         all.dispatchEvent(new Event('change', {{ bubbles: true }}))"
    ));
}

/// Compares two images as `tabray diff` does.
fn diff(old: &RgbImage, new: &RgbImage) -> String {
    Comparison::new(old, new, 0).expect("the same size").to_string()
}

/// Renders the scene that is watched with these options.
fn rendered(watching: &Watching, options: &[&str]) -> RgbImage {
    let image = watching.folder.path().join("other.png");
    cargo_bin_cmd!("tabray")
        .arg("render")
        .arg(watching.scene())
        .args(options)
        .arg("-o")
        .arg(&image)
        .assert()
        .success();
    image::open(image).expect("an image").to_rgb8()
}

#[test]
fn the_image_of_a_moment_is_compared_with_those_that_follow() {
    let Some((watching, browser)) = opened(&ball("9 0 0")) else { return };
    browser.press('d');
    compared(&browser, "1 pinned");
    assert_eq!(words(&browser), "none of 4800 pixels differs");
    watching.save(&ball("9 0.05 0"));
    compared(&browser, "2 pinned");
    let [old, new] = ["9 0 0", "9 0.05 0"].map(|ambient| render(&model(&ball(ambient))));
    assert_eq!(words(&browser), diff(&old, &new));
    assert!(words(&browser).contains("largest difference "), "{}", words(&browser));
    assert!(before(&browser) == old && canvas(&browser) == new);
    browser.run("document.querySelector('#comparing button').click()");
    compared(&browser, "2 pinned");
    assert_eq!(words(&browser), "none of 4800 pixels differs");
    watching.save(&ball("9 0 0").replace("80 60", "40 30"));
    shown(&browser, 3);
    assert_eq!(words(&browser), "the image before has 80 × 60 pixels, and this one 40 × 30");
    assert_eq!(browser.run("return document.querySelector('#before').hidden"), true);
    browser.press('d');
    assert_eq!(browser.run("return document.querySelector('#comparing').hidden"), true);
}

#[test]
fn an_image_is_not_compared_with_one_of_the_scene_before() {
    let Some((watching, browser)) = opened(&shaded()) else { return };
    browser.press('d');
    choose(&browser, "classic");
    compared(&browser, "1 classic");
    // The other image of the next version does not come.
    browser.run("window.fetch = () => new Promise(() => {})");
    fs::write(watching.scene(), shaded().replace("radius 2", "radius 1")).expect("a file");
    shown(&browser, 2);
    assert_eq!(words(&browser), "rendering the other image");
}

#[test]
fn the_line_is_dragged_and_moved_by_keys() {
    let Some((watching, browser)) = opened(&ball("9 0 0")) else { return };
    browser.press('d');
    watching.save(&ball("0 9 0"));
    compared(&browser, "2 pinned");
    let at = |part: f64| {
        let place = browser.run(&format!(
            "const box = document.querySelector('canvas').getBoundingClientRect()
             return [box.left + {part} * box.width, box.top + box.height / 4]"
        ));
        [0, 1].map(|side| place[side].as_f64().expect("a number").round() as i64)
    };
    let line = || {
        browser.run("return +document.querySelector('#comparing input').value").as_f64().expect("a number")
    };
    // What the screen shows a little left of the middle, where the ball is.
    let seen = || {
        let shot = image::load_from_memory(&browser.screenshot()).expect("an image").to_rgb8();
        let [x, _] = at(0.45);
        let y = browser.run("const box = document.querySelector('canvas').getBoundingClientRect(); return box.top + box.height / 2");
        let [red, green, _] = shot.get_pixel(x as u32, y.as_f64().expect("a number") as u32).0;
        [red > 99, green > 99]
    };
    assert_eq!((line(), seen()), (50.0, [true, false]), "the image before");
    browser.drag(0, None, &[at(0.5), at(0.4), at(0.25)]);
    assert!((line() - 25.0).abs() < 1.0, "{}", line());
    assert_eq!(seen(), [false, true], "the image that came");
    let before = line();
    for _ in 0..3 {
        browser.press('.');
    }
    browser.press(',');
    assert_eq!(line(), before + 4.0);
    assert_eq!(browser.run("return document.querySelector('#told').hidden"), true, "the drag is no click");
}

#[test]
fn an_accuracy_or_a_number_of_samples_is_compared_with_the_scenes_own() {
    let Some((watching, browser)) = opened(&shaded()) else { return };
    let own = render(&model(&shaded()));
    browser.press('d');
    compared(&browser, "1 pinned");
    for (means, options) in [
        ("classic", &["--method", "classic"] as &[_]),
        ("strict", &["--accuracy", "strict"]),
        ("16", &["--samples", "16"]),
    ] {
        choose(&browser, means);
        compared(&browser, &format!("1 {means}"));
        let other = rendered(&watching, options);
        assert!(before(&browser) == other, "{means}");
        assert_eq!(words(&browser), diff(&other, &own), "{means}");
    }
    assert!(words(&browser).contains("differ ("), "samples smooth the edge: {}", words(&browser));
    // It follows each change of the scene.
    fs::write(watching.scene(), shaded().replace("radius 2", "radius 1")).expect("a file");
    compared(&browser, "2 16");
    assert_eq!(words(&browser), diff(&rendered(&watching, &["--samples", "16"]), &rendered(&watching, &[])));
    for path in ["other/2/0", "other/2/fast", "other/2/-1"] {
        assert_eq!(watching.get(path).0, 404, "{path}");
    }
    assert_eq!(watching.get("other/1/classic").0, 410);
}
