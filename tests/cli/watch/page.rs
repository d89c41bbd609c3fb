//! The page in a browser: it shows the image, follows edits, shows errors and explains pixels. These tests are skipped
//! where there is no Chromium.

use crate::common::{load, model, render, root};
use crate::watch::browser::Browser;
use crate::watch::program::{Watching, ball};
use image::RgbImage;
use serde_json::Value;
use std::fs;
use std::time::{SystemTime, UNIX_EPOCH};
use tabray::render::Plan;
use tabray::tools::probe;
use tempfile::TempDir;

/// Opens the page of a scene in a browser, and waits for the whole image.
pub fn opened(text: &str) -> Option<(Watching, Browser)> {
    let watching = Watching::text(text);
    let browser = Browser::open(&watching.url(""))?;
    shown(&browser, 1);
    Some((watching, browser))
}

/// Waits for the whole image of a version.
pub fn shown(browser: &Browser, version: u64) {
    browser.wait(&format!("document.documentElement.dataset.shown === '{version}'"));
}

/// Returns the pixels of the page's image.
pub fn canvas(browser: &Browser) -> RgbImage {
    let pixels = browser.run(
        "const c = document.querySelector('canvas');
         return [c.width, c.height, ...c.getContext('2d').getImageData(0, 0, c.width, c.height).data]",
    );
    let numbers: Vec<u64> = pixels.as_array().expect("numbers").iter().filter_map(|n| n.as_u64()).collect();
    let [width, height] = [numbers[0], numbers[1]].map(|side| side as u32);
    let (pixels, _) = numbers[2..].as_chunks::<4>();
    let bytes = pixels.iter().flat_map(|[r, g, b, _]| [*r as u8, *g as u8, *b as u8]).collect();
    RgbImage::from_raw(width, height, bytes).expect("all pixels")
}

/// Clicks on the centre of a pixel: column from the left, row from the bottom.
pub fn click(browser: &Browser, [x, y]: [u32; 2]) {
    let place = browser.run(&format!(
        "const c = document.querySelector('canvas'), box = c.getBoundingClientRect();
         return [box.left + box.width * ({x} + 0.5) / c.width, box.bottom - box.height * ({y} + 0.5) / c.height]"
    ));
    browser.click([0, 1].map(|side| place[side].as_f64().expect("a number").floor() as i64));
}

const REPORT: &str = "document.querySelector('#report')";
const TOLD: &str = "document.querySelector('#told')";

#[test]
fn the_page_shows_the_bytes_that_render_writes() {
    let folder = TempDir::new().expect("a folder");
    let path = root().join("scenes/light/shadow.ray");
    fs::copy(&path, folder.path().join("scene.ray")).expect("a copy");
    let watching = Watching::start(folder, &["--port", "0"]);
    let Some(browser) = Browser::open(&watching.url("")) else { return };
    shown(&browser, 1);
    assert!(canvas(&browser) == render(&load(&path)));
    assert_eq!(browser.text("return document.title"), "scene.ray – tabray");
    let text = browser
        .text("return [...document.querySelectorAll('#text div')].map(d => d.textContent).join('\\n')");
    assert_eq!(text, fs::read_to_string(&path).expect("a text"));
    assert_eq!(browser.run(&format!("return {REPORT}.hidden")), true);
}

#[test]
fn the_page_follows_edits() {
    let Some((watching, browser)) = opened(&ball("9 0 0")) else { return };
    for (version, text) in [(2, ball("0 9 0")), (3, ball("0 0 9").replace("80 60", "100 50"))] {
        watching.save(&text);
        shown(&browser, version);
        assert!(canvas(&browser) == render(&model(&text)), "{text}");
    }
}

#[test]
fn the_page_shows_errors_over_the_last_good_picture() {
    let Some((watching, browser)) = opened(&ball("9 0 0")) else { return };
    watching.save(&ball("0 9 0").replace("radius 2", "raduis 2"));
    browser.wait(&format!("!{REPORT}.hidden"));
    let report = browser.text(&format!("return {REPORT}.textContent"));
    assert!(report.contains("did you mean `radius`?"), "{report}");
    assert!(canvas(&browser) == render(&model(&ball("9 0 0"))), "the last good one");
    let wrong =
        browser.text("return [...document.querySelectorAll('.wrong')].map(d => d.textContent).join()");
    assert_eq!(wrong, "    center 4 3 -3  raduis 2");
    watching.save(&ball("0 9 0"));
    shown(&browser, 2);
    assert_eq!(browser.run(&format!("return {REPORT}.hidden")), true);
    assert!(canvas(&browser) == render(&model(&ball("0 9 0"))));
}

#[test]
fn a_click_explains_a_pixel_and_marks_the_lines_of_its_object() {
    let Some((_watching, browser)) = opened(&ball("9 0 0")) else { return };
    let explanation = |x, y| {
        let mut told = Vec::new();
        probe::pixel(&Plan::new(&model(&ball("9 0 0"))), x, y, &mut told).expect("memory takes it");
        String::from_utf8(told).expect("text")
    };
    let marked =
        || browser.text("return [...document.querySelectorAll('.marked')].map(d => d.textContent).join('|')");
    click(&browser, [40, 30]);
    browser.wait(&format!("!{TOLD}.hidden"));
    assert_eq!(browser.text("return document.querySelector('#told pre').textContent"), explanation(40, 30));
    assert_eq!(marked(), "sphere ball|{|    material paint|    center 4 3 -3  radius 2|}");

    click(&browser, [1, 2]);
    browser
        .wait("document.querySelector('#told pre').textContent.startsWith('pixel 1 from the left and 2 ')");
    assert_eq!(browser.text("return document.querySelector('#told pre').textContent"), explanation(1, 2));
    assert_eq!(marked(), "");
}

#[test]
fn exposure_shows_what_is_dark_and_keys_switch_layers() {
    let Some((watching, browser)) = opened(&ball("0.01 0.02 0.03")) else { return };
    let dark = canvas(&browser);
    for _ in 0..20 {
        browser.press(']');
    }
    let bright = canvas(&browser);
    // The exposure is raised by ten stops. Light of 0.01 has travelled about 7 units.
    let middle = |picture: &RgbImage| picture.get_pixel(40, 30).0;
    assert_eq!(middle(&dark), [0, 0, 1]);
    let [red, green, blue] = render(&model(&ball("10.24 20.48 30.72"))).get_pixel(40, 30).0;
    assert_eq!(middle(&bright), [red, green, blue]);
    browser.press('=');
    assert!(canvas(&browser) == dark);

    for (key, name) in [('2', "depth"), ('3', "normal"), ('4', "object"), ('5', "cost")] {
        browser.press(key);
        browser.wait(&format!("document.documentElement.dataset.layer === '1 {name}'"));
        let (_, bytes) = watching.get(&format!("layer/1/{name}"));
        assert!(canvas(&browser).into_raw() == bytes, "{name}");
    }
    browser.press('1');
    assert!(canvas(&browser) == dark);
}

#[test]
fn a_save_is_on_the_page_soon() {
    let Some((watching, browser)) = opened(&ball("9 0 0")) else { return };
    let now = || SystemTime::now().duration_since(UNIX_EPOCH).expect("a clock").as_millis() as i64;
    let mut took = Vec::new();
    for version in 2..=21 {
        let start = now();
        watching.save(&ball(&format!("{} 9 0", version % 10)));
        shown(&browser, version);
        let at = browser.text("return document.documentElement.dataset.shownAt");
        took.push(at.parse::<i64>().expect("a time") - start);
    }
    took.sort_unstable();
    let (median, most) = (took[took.len() / 2], took[took.len() - 1]);
    println!("from a save to the whole image on the page: median {median} ms, at most {most} ms");
    assert!(canvas(&browser) == render(&model(&ball("1 9 0"))));
}

/// Changes the number in a field of the page, as typing does.
pub fn type_in(browser: &Browser, field: &str, value: &str) {
    browser.wait(&format!("document.querySelector('{field}')"));
    browser.run(&format!(
        "const box = document.querySelector('{field}'); box.focus(); box.value = '{value}';
         box.dispatchEvent(new Event('input', {{ bubbles: true }}))"
    ));
}

#[test]
fn a_value_that_is_tried_shows_and_is_written_into_the_scene_alone() {
    let text = ball("9 0 0").replace("radius 2", "radius   2 # its size");
    assert!(text.contains("# its size"), "{text}");
    let Some((watching, browser)) = opened(&text) else { return };
    click(&browser, [40, 30]);
    type_in(&browser, "#field-radius-0", "1.25");
    shown(&browser, 2);
    let smaller = text.replace("radius   2 #", "radius   1.25 #");
    assert!(canvas(&browser) == render(&model(&smaller)));
    assert_eq!(fs::read_to_string(watching.scene()).expect("a scene"), text, "nothing is written yet");
    browser.run("document.querySelector('#write').click()");
    browser.wait("document.querySelector('#fields p span').textContent === 'written'");
    assert_eq!(fs::read_to_string(watching.scene()).expect("a scene"), smaller);
}

#[test]
fn a_click_on_a_ball_offers_the_colour_of_its_material() {
    let text = ball("1 0 0");
    let Some((watching, browser)) = opened(&text) else { return };
    click(&browser, [40, 30]);
    browser.wait("document.querySelector('#fields input[type=color]')");
    let label = "return document.querySelector('#fields label').textContent";
    assert_eq!(browser.text(label), "paint ambient");
    browser.run(
        "const box = document.querySelector('#fields input[type=color]');
         box.value = '#00ff00'; box.dispatchEvent(new Event('input', { bubbles: true }))",
    );
    shown(&browser, 2);
    let green = text.replace("ambient 1 0 0", "ambient 0 1 0");
    assert!(canvas(&browser) == render(&model(&green)));
    browser.run("document.querySelector('#write').click()");
    browser.wait("document.querySelector('#fields p span').textContent === 'written'");
    assert_eq!(fs::read_to_string(watching.scene()).expect("a scene"), green);
}

#[test]
fn sliders_of_what_may_not_be_negative_end_at_0() {
    let Some((_watching, browser)) = opened(&ball("9 0 0")) else { return };
    let least = |entity: &str, field: &str| {
        browser.run(&format!(
            "const all = document.querySelector('#fields select'); all.value = '{entity}';
             all.dispatchEvent(new Event('change', {{ bubbles: true }}))"
        ));
        browser.wait(&format!("document.querySelector('{field}')"));
        let least = browser.text(&format!("return document.querySelector('{field}').previousSibling.min"));
        least.parse::<f64>().expect("a number")
    };
    click(&browser, [40, 30]);
    browser.wait("document.querySelector('#field-radius-0')");
    // A radius of 0 is refused: the slider ends at its first step.
    let radius = least("sphere ball", "#field-radius-0");
    assert!(radius > 0.0 && radius < 0.02, "{radius}");
    assert!(least("sphere ball", "#field-center-0") < 0.0);
    // A colour may be negative, but hardly is meant to be.
    assert_eq!(least("material paint", "#field-ambient-0"), 0.0);
    assert_eq!(least("material paint", "#field-shininess-0"), 0.0);
    assert!(least("camera eye", "#field-worlddim-0") > 0.0);
}

#[test]
fn the_image_fills_its_place_and_the_text_has_colours() {
    let text = format!("# a ball\nlet k 1.5\n{}", ball("9 0 0"));
    let Some((_watching, browser)) = opened(&text) else { return };
    let sides = "const [image, place] = ['canvas', '#stage'].map((one) => document.querySelector(one).getBoundingClientRect())
         return [place.width - image.width, place.height - image.height]";
    let sides = browser.run(sides);
    let least = sides.as_array().expect("two").iter().filter_map(Value::as_f64).fold(f64::INFINITY, f64::min);
    assert!((0.0..=17.0).contains(&least), "{sides}");
    let of = |kind: &str| {
        browser.text(&format!(
            "return [...document.querySelectorAll('#text .{kind}')].map((piece) => piece.textContent).join('|')"
        ))
    };
    assert_eq!(of("comment"), "# a ball");
    assert_eq!(of("keyword"), "let");
    assert_eq!(of("type"), "camera|material|sphere");
    assert_eq!(of("number"), "1.5|80|60|8|6|4|3|6|9|0|0|4|3|-3|2");
}

#[test]
fn the_camera_has_values_too_and_they_stay_while_the_image_follows() {
    let text = ball("9 0 0");
    let Some((watching, browser)) = opened(&text) else { return };
    browser.run("document.querySelector('#values').click()");
    type_in(&browser, "#field-viewpoint-0", "5");
    shown(&browser, 2);
    assert!(canvas(&browser) == render(&model(&text.replace("viewpoint 4", "viewpoint 5"))));
    browser.run(
        "const select = document.querySelector('#fields select'); select.value = 'material paint';
         select.dispatchEvent(new Event('change', { bubbles: true }))",
    );
    type_in(&browser, "#field-ambient-1", "7");
    shown(&browser, 3);
    assert_eq!(browser.text("return document.querySelector('#fields select').value"), "material paint");
    browser.run("document.querySelector('#write').click()");
    browser.wait("document.querySelector('#fields p span').textContent === 'written'");
    let written = text.replace("viewpoint 4", "viewpoint 5").replace("ambient 9 0 0", "ambient 9 7 0");
    assert_eq!(fs::read_to_string(watching.scene()).expect("a scene"), written);
}

#[test]
fn what_is_discarded_leaves_the_scene_as_it_was() {
    let text = ball("9 0 0");
    let Some((watching, browser)) = opened(&text) else { return };
    click(&browser, [40, 30]);
    type_in(&browser, "#field-radius-0", "-1");
    browser.wait("!document.querySelector('#report').hidden");
    browser.run("document.querySelector('#discard').click()");
    shown(&browser, 2);
    assert!(canvas(&browser) == render(&model(&text)));
    assert_eq!(fs::read_to_string(watching.scene()).expect("a scene"), text);
}

#[test]
fn a_scene_that_was_changed_elsewhere_is_not_overwritten() {
    let text = ball("9 0 0");
    let Some((watching, browser)) = opened(&text) else { return };
    click(&browser, [40, 30]);
    type_in(&browser, "#field-radius-0", "1.5");
    shown(&browser, 2);
    // An error, so that the page still shows the scene before.
    let broken = text.replace("radius", "raduis");
    watching.save(&broken);
    browser.wait("!document.querySelector('#report').hidden");
    browser.run("document.querySelector('#write').click()");
    browser.wait("document.querySelector('#fields p span').textContent.includes('has changed')");
    assert_eq!(fs::read_to_string(watching.scene()).expect("a scene"), broken);
}

/// `cargo test --release --test cli -- --ignored --nocapture from_a_slider_to_the_image`
#[test]
#[ignore = "measures"]
fn from_a_slider_to_the_image() {
    let folder = TempDir::new().expect("a folder");
    fs::copy(root().join("scenes/gallery/marbles.ray"), folder.path().join("scene.ray")).expect("a copy");
    let watching = Watching::start(folder, &["--port", "0"]);
    let browser = Browser::open(&watching.url("")).expect("a browser");
    shown(&browser, 1);
    click(&browser, [300, 150]);
    browser.wait("document.querySelector('#field-radius-0')");
    // The page itself takes the times, from the event of the slider to the first pixels of the image that follows.
    browser.run(
        "window.times = []
         const root = document.documentElement, slider = document.querySelector('#fields input[type=range]')
         slider.focus()
         const move = (left) => {
           const from = performance.now(), before = root.dataset.begun
           slider.value = 3 + left % 50 / 10
           slider.dispatchEvent(new Event('input', { bubbles: true }))
           const look = () => {
             if (root.dataset.begun === before) return requestAnimationFrame(look)
             window.times.push(performance.now() - from)
             if (left > 1) move(left - 1); else root.dataset.measured = 1
           }
           look()
         }
         move(100)",
    );
    browser.wait("document.documentElement.dataset.measured");
    println!("{}", told(&browser.run("return window.times.sort((a, b) => a - b)")));
}

/// Tells the median and the worst of sorted times in milliseconds.
pub fn told(times: &Value) -> String {
    let times: Vec<f64> = times.as_array().expect("numbers").iter().filter_map(Value::as_f64).collect();
    let (median, worst) = (times[times.len() / 2], times[times.len() - 1]);
    format!("{} moves: median {median:.0} ms, worst {worst:.0} ms", times.len())
}
