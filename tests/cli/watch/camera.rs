//! The camera by pointer and keys.

use crate::common::{model, render, root};
use crate::watch::browser::Browser;
use crate::watch::page::{canvas, click, opened, told};
use crate::watch::program::{Watching, ball, client};
use image::Rgb;
use std::fs;
use tempfile::TempDir;

/// A scene with another camera, on several lines and with comments.
pub const LOOK_AT: &str = "look_at eye\n{\n    pixeldim 80 60 # small\n    position 4 3   6 # the viewer\n    \
    target   4 3 -3\n}\nmaterial paint { ambient 9 0 0 }\nsphere ball { material paint center 4 3 -3  radius 2 }\n";

const SHIFT: char = '\u{e008}';
const RIGHT: char = '\u{e014}';
const UNDER: &str = "document.querySelector('#under').textContent";

/// Returns positions in the window: the middle of the image, and from there these many pixels of the screen right and down.
/// They are read at once, as what stands above the image may still be laid out.
pub fn around_middle<const N: usize>(browser: &Browser, places: [[i64; 2]; N]) -> [[i64; 2]; N] {
    let place = browser.run(
        "const box = document.querySelector('canvas').getBoundingClientRect();
         return [box.left + box.width / 2, box.top + box.height / 2]",
    );
    let middle = [0, 1].map(|side| place[side].as_f64().expect("a number") as i64);
    places.map(|[right, down]| [middle[0] + right, middle[1] + down])
}

/// Writes what is tried out into the scene, waits for its image, and returns the text.
pub fn written(watching: &Watching, browser: &Browser) -> String {
    browser.run(
        "document.querySelector('#fields p span').textContent = ''; document.querySelector('#write').click()",
    );
    browser.wait("document.querySelector('#fields p span').textContent === 'written'");
    let text = fs::read_to_string(watching.scene()).expect("a scene");
    browser.wait(&format!(
        "[...document.querySelectorAll('#text div')].map(d => d.textContent).join('\\n') === {}
         && document.documentElement.dataset.shown === document.documentElement.dataset.version",
        serde_json::to_string(&text).expect("JSON")
    ));
    assert!(canvas(browser) == render(&model(&text)), "{text}");
    text
}

/// Returns the numbers of an attribute that stands on a line of its own, or after another one.
pub fn numbers<const N: usize>(text: &str, attribute: &str) -> [f64; N] {
    let (_, rest) = text.split_once(&format!("{attribute} ")).unwrap_or_else(|| panic!("{text}"));
    let mut words = rest.split_whitespace();
    [(); N].map(|()| {
        let word = words.next().expect("a number");
        assert!(word.len() <= 7, "few digits: {word}");
        word.parse().unwrap_or_else(|_| panic!("a number: {word}"))
    })
}

/// Sends a body to a path, as a page does; returns the status and what is said.
pub fn post(watching: &Watching, path: &str, body: &str) -> (u16, String) {
    let origin = format!("http://127.0.0.1:{}", watching.port);
    let mut answer =
        client().post(watching.url(path)).header("Origin", origin).send(body).expect("an answer");
    (answer.status().as_u16(), answer.body_mut().read_to_string().expect("text"))
}

pub fn distance(one: [f64; 3], other: [f64; 3]) -> f64 {
    one.iter().zip(other).map(|(one, other)| (one - other).powi(2)).sum::<f64>().sqrt()
}

#[test]
fn a_drag_in_the_mode_takes_the_camera_around_and_only_its_numbers_are_written() {
    let Some((watching, browser)) = opened(LOOK_AT) else { return };
    browser.press('c');
    browser.wait("!document.querySelector('#fields').hidden");
    let [from, over, to] = around_middle(&browser, [[0, 0], [60, 10], [100, -30]]);
    browser.drag(0, None, &[from, over, to]);
    let text = written(&watching, &browser);
    let [position, target] = [numbers(&text, "position"), numbers(&text, "target  ")];
    // The middle pixel shows the ball at (4, 3, -1). What is seen goes to the right and up, the viewer left and down.
    assert!((distance(position, [4.0, 3.0, -1.0]) - 7.0).abs() < 0.05, "{text}");
    assert!(position[0] < 3.0 && position[1] < 2.9 && position[2] < 6.0, "{text}");
    assert!(distance(position, target) - 9.0 < 0.01, "it does not come nearer: {text}");
    let same = |line: &&str| !line.contains("position") && !line.contains("target");
    assert!(text.lines().filter(same).eq(LOOK_AT.lines().filter(same)), "{text}");
    assert!(text.contains(" # the viewer\n"), "{text}");
}

#[test]
fn shift_and_the_right_button_pan_and_the_wheel_goes_nearer() {
    let Some((watching, browser)) = opened(LOOK_AT) else { return };
    browser.press('c');
    let [from, to] = around_middle(&browser, [[0, 0], [90, 0]]);
    let position = |text: &str| numbers::<3>(text, "position");
    browser.drag(0, Some(SHIFT), &[from, to]);
    let once = written(&watching, &browser);
    browser.drag(2, None, &[from, to]);
    let twice = written(&watching, &browser);
    let [first, second] = [position(&once), position(&twice)];
    assert!(first[0] < 4.0 && first[1..] == [3.0, 6.0], "{once}");
    assert!(second[0] < first[0] && second[1..] == [3.0, 6.0], "{twice}");
    browser.wheel(from, -240);
    let nearer = written(&watching, &browser);
    assert!(distance(position(&nearer), second) > 2.0, "{nearer}");
    assert!(position(&nearer)[2] < 4.0, "{nearer}");
}

#[test]
fn keys_move_the_camera_as_the_pointer_does() {
    let Some((watching, browser)) = opened(LOOK_AT) else { return };
    browser.press('c');
    browser.press(RIGHT);
    let around = numbers::<3>(&written(&watching, &browser), "position");
    assert!(around[0] < 4.0 && around[2] < 6.0 && around[1] == 3.0, "{around:?}");
    browser.run("document.querySelector('#stage').focus()");
    browser.press('+');
    let nearer = numbers::<3>(&written(&watching, &browser), "position");
    assert!(nearer[2] < around[2], "{nearer:?}");
    browser.press('c');
    browser.press('+');
    assert_eq!(
        numbers::<3>(&written(&watching, &browser), "position"),
        nearer,
        "outside of the mode, keys zoom"
    );
}

#[test]
fn the_camera_goes_around_the_point_that_was_clicked() {
    let text = LOOK_AT.replace("target   4 3 -3", "target   3 3 -3");
    let Some((watching, browser)) = opened(&text) else { return };
    browser.press('c');
    click(&browser, [47, 30]);
    browser.wait("!document.querySelector('#told').hidden");
    let probe = browser.text("return document.querySelector('#told pre').textContent");
    assert!(probe.contains("ball"), "{probe}");
    let [from, to] = around_middle(&browser, [[0, 0], [80, 0]]);
    browser.drag(0, None, &[from, to]);
    let after = written(&watching, &browser);
    // The same pixel shows nearly the same point of the ball, which is not in the middle.
    let point = |text: &str| {
        let model = model(text);
        let sight = model.camera.value.ray(47.0, 30.0);
        let (at, dir) = (sight.origin.to_array(), sight.dir.to_array());
        let to_ball = [4.0 - at[0], 3.0 - at[1], -3.0 - at[2]];
        let along: f64 = to_ball.iter().zip(dir).map(|(to, dir)| to * dir).sum();
        let off = to_ball.iter().map(|to| to * to).sum::<f64>() - along * along;
        let t = along - (4.0 - off).sqrt();
        [0, 1, 2].map(|axis| at[axis] + t * dir[axis])
    };
    assert!(distance(point(&text), point(&after)) < 0.01, "{after}");
}

#[test]
fn the_notes_camera_moves_before_its_image_plane() {
    let text = ball("9 0 0");
    let Some((watching, browser)) = opened(&text) else { return };
    browser.press('c');
    let [from, to] = around_middle(&browser, [[0, 0], [50, 0]]);
    browser.drag(0, Some(SHIFT), &[from, to]);
    let after = written(&watching, &browser);
    let [x, y, z] = numbers(&after, "viewpoint");
    assert!(x > 4.0 && y == 3.0 && z == 6.0, "{after}");
    assert_eq!(after, text.replace("viewpoint 4", &format!("viewpoint {x}")));
    // Right through the image plane: it stays where it last could be.
    browser.drag(0, None, &around_middle(&browser, [[0, 0], [0, 290]]));
    let [_, _, z] = numbers(&written(&watching, &browser), "viewpoint");
    assert!(z > 0.0);
    assert_eq!(browser.text(&format!("return {UNDER}")), "the camera cannot go there");
}

#[test]
fn a_camera_that_turns_into_a_look_at_shows_the_same_view() {
    for (pixels, plane) in [("60 60", "6 6  viewpoint 3 3 6"), ("80 60", "8 6  viewpoint 4 3 6")] {
        let text = ball("9 0 0").replace("pixeldim 80 60", &format!("pixeldim {pixels}"));
        let text = text.replace("8 6 viewpoint 4 3 6", plane);
        let watching = Watching::text(&text);
        watching.events().until("scene");
        let (status, said) = post(&watching, "turn", "");
        assert_eq!(status, 200, "{said}");
        let after = fs::read_to_string(watching.scene()).expect("a scene");
        assert!(after.starts_with("look_at eye {") && after.contains("rules notes }"), "{after}");
        let [before, after] = [text, after].map(|text| render(&model(&text)));
        let is_other = |(before, after): &(&Rgb<u8>, &Rgb<u8>)| {
            before.0.iter().zip(after.0).any(|(one, other)| one.abs_diff(other) > 1)
        };
        let others = before.pixels().zip(after.pixels()).filter(is_other).count();
        // Where the image is not square, its pixels shift by a fourteenth of one at the edges.
        let most = if plane.starts_with('6') { 0 } else { 4 };
        assert!(others <= most, "{others}");
    }
}

#[test]
fn a_camera_that_looks_from_aside_turns_to_the_middle_and_the_answer_says_by_how_much() {
    let watching = Watching::text(&ball("9 0 0").replace("viewpoint 4 3", "viewpoint 4 3.5"));
    watching.events().until("scene");
    let (status, said) = post(&watching, "turn", "");
    assert!(status == 200 && said.contains("the view turns by 4.76"), "{status} {said}");
    let after = fs::read_to_string(watching.scene()).expect("a scene");
    assert!(after.contains("target 4 3 0 position 4 3.5 6"), "{after}");
}

#[test]
fn a_camera_that_no_look_at_replaces_stays_and_the_answer_says_why() {
    for (text, reason) in [
        (ball("9 0 0").replace("worlddim 8 6", "worlddim 8 8"), "as wide as high"),
        (LOOK_AT.to_owned(), "only a `camera` can become a `look_at`"),
    ] {
        let watching = Watching::text(&text);
        watching.events().until("scene");
        let (status, said) = post(&watching, "turn", "");
        assert!(status == 409 && said.contains(reason), "{status} {said}");
        assert_eq!(fs::read_to_string(watching.scene()).expect("a scene"), text);
    }
}

#[test]
fn a_key_turns_the_notes_camera_into_one_that_orbits() {
    let Some((watching, browser)) = opened(&ball("9 0 0")) else { return };
    browser.press('c');
    browser.wait("!document.querySelector('#turn').hidden");
    browser.press('l');
    browser.wait("document.querySelector('#fields p span').textContent.startsWith('turned')");
    browser.wait("document.querySelector('#turn').hidden");
    let [from, to] = around_middle(&browser, [[0, 0], [100, 0]]);
    browser.drag(0, None, &[from, to]);
    let text = written(&watching, &browser);
    let position = numbers(&text, "position");
    assert!(position[0] < 3.0 && (distance(position, [4.0, 3.0, -1.0]) - 7.0).abs() < 0.05, "{text}");
}

#[test]
fn a_camera_that_is_computed_says_why_it_stays() {
    let text = LOOK_AT.replace("position 4", "position \"2+2\"");
    let Some((watching, browser)) = opened(&text) else { return };
    browser.press('c');
    let [from, to] = around_middle(&browser, [[0, 0], [50, 0]]);
    browser.drag(0, None, &[from, to]);
    let reason = "the camera cannot be moved by its `position`: it is a formula: change the text";
    browser.wait(&format!("{UNDER} === '{reason}'"));
    assert_eq!(fs::read_to_string(watching.scene()).expect("a scene"), text);
    assert_eq!(browser.text("return document.documentElement.dataset.version"), "1");
}

#[test]
fn a_camera_from_another_file_says_why_it_stays() {
    let Some((watching, browser)) = opened(&ball("9 0 0")) else { return };
    let (camera, rest) = LOOK_AT.split_once("material").expect("both");
    fs::write(watching.folder.path().join("eye.ray"), camera).expect("a file");
    watching.save(&format!("include eye.ray\nmaterial{rest}"));
    browser.wait("document.documentElement.dataset.shown === '2'");
    browser.press('c');
    let [from, to] = around_middle(&browser, [[0, 0], [50, 0]]);
    browser.drag(0, None, &[from, to]);
    browser.wait(&format!("{UNDER} === '`eye` is repeated or included: change the text'"));
}

#[test]
fn outside_of_the_mode_a_drag_moves_the_sheet_alone() {
    let Some((_watching, browser)) = opened(LOOK_AT) else { return };
    let [from, to] = around_middle(&browser, [[0, 0], [50, 20]]);
    browser.drag(0, None, &[from, to]);
    assert_eq!(around_middle(&browser, [[0, 0]]), [to]);
    assert_eq!(browser.text("return document.documentElement.dataset.version"), "1");
}

#[test]
fn what_is_no_movement_is_refused() {
    let watching = Watching::text(LOOK_AT);
    watching.events().until("scene");
    let go = |body: &str| post(&watching, "move", body).0;
    let by = |position: &str, dolly: &str| {
        format!(
            "{{\"stand\":{{\"position\":{position}}},\"around\":[4,3,-1],\"orbit\":[1,1],\"pan\":[0,0],\"dolly\":{dolly}}}"
        )
    };
    for nonsense in ["", "[]", "{\"orbit\":[1,1]}", &by("[\"4\"]", "1"), &by("[4,3,6]", "null")] {
        assert_eq!(go(nonsense), 400, "{nonsense}");
    }
    for (position, dolly) in
        [("[4,3,6]", "0"), ("[4,3,6]", "-1"), ("[4,3]", "1"), ("[4,3,1e200]", "1"), ("[]", "1")]
    {
        assert_eq!(go(&by(position, dolly)), 409, "{position} {dolly}");
    }
    assert_eq!(go(&by("[4,3,6]", "2")), 200);
}

/// `cargo test --release --test cli -- --ignored --nocapture from_a_drag_of_the_camera_to_the_image`
#[test]
#[ignore = "measures"]
fn from_a_drag_of_the_camera_to_the_image() {
    let folder = TempDir::new().expect("a folder");
    fs::copy(root().join("scenes/gallery/marbles.ray"), folder.path().join("scene.ray")).expect("a copy");
    let watching = Watching::start(folder, &["--port", "0"]);
    let browser = Browser::open(&watching.url("")).expect("a browser");
    browser.wait("document.documentElement.dataset.shown === '1'");
    browser.press('c');
    browser.wait("!document.querySelector('#fields').hidden");
    // The page itself takes the times, from the event of the pointer to the first pixels of the image that follows.
    browser.run(
        "window.times = []
         const root = document.documentElement, stage = document.querySelector('#stage')
         const box = stage.getBoundingClientRect()
         const event = (kind, x) => stage.dispatchEvent(new PointerEvent(kind, {
           pointerId: 1, bubbles: true, clientX: box.left + box.width / 2 + x, clientY: box.top + box.height / 2 }))
         stage.setPointerCapture = () => {}
         event('pointerdown', 0)
         const move = (left) => {
           const from = performance.now(), before = root.dataset.begun
           event('pointermove', 5 + left % 50)
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
