//! Several scenes at once: which of them are read, and the list that the page has of them.

use crate::common::{model, render};
use crate::watch::browser::Browser;
use crate::watch::page::{canvas, shown};
use crate::watch::program::{PATIENCE, Watching, ball};
use assert_cmd::cargo::cargo_bin_cmd;
use serde_json::{Value, json};
use std::fs;
use std::thread;
use std::time::{Duration, Instant};
use tempfile::TempDir;

const PORT: &[&str] = &["--port", "0"];

/// A scene whose image takes days.
fn heavy() -> String {
    ball("9 0 0").replace("80 60", "4000 4000").replace("viewpoint", "samples 65536 viewpoint")
}

/// Makes a folder with these files.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = TempDir::new().expect("a folder");
    for (name, text) in files {
        fs::write(folder.path().join(name), text).expect("a file");
    }
    folder
}

/// Returns the names in a list of scenes, with their numbers.
fn names(list: &Value) -> Vec<(u64, &str)> {
    let scenes = list.as_array().expect("a list").iter();
    scenes
        .map(|one| (one["number"].as_u64().expect("a number"), one["name"].as_str().expect("a name")))
        .collect()
}

#[test]
fn each_scene_has_its_own_image_faults_and_values() {
    let broken = ball("0 9 0").replace("radius", "raduis");
    let folder =
        folder(&[("red.ray", &ball("9 0 0")), ("broken.ray", &broken), ("blue.ray", &ball("0 0 9"))]);
    let (watching, what) = Watching::start_all(folder, &["red.ray", "broken.ray", "blue.ray"], PORT);
    assert_eq!(what, "3 scenes");
    let mut red = watching.events();
    assert_eq!(names(&red.until("scenes")), [(0, "red.ray"), (1, "broken.ray"), (2, "blue.ray")]);
    assert_eq!(red.until("scene")["text"], ball("9 0 0"));
    red.until("done");
    let mut blue = watching.events_at("of/2/events");
    assert_eq!(blue.until("scene")["name"], "blue.ray");
    blue.until("done");
    let fault = watching.events_at("of/1/events").until("fault");
    assert_eq!((&fault["name"], &fault["lines"]), (&json!("broken.ray"), &json!([6])));
    let beside = watching.folder.path().join("blue.ray~");
    fs::write(&beside, ball("0 9 9")).expect("a file");
    fs::rename(&beside, watching.folder.path().join("blue.ray")).expect("in its place");
    assert_eq!(blue.until("scene")["text"], ball("0 9 9"));
    // The other one has not been read again.
    assert_eq!(watching.get("probe/1/0/0").0, 200);
    assert_eq!(watching.get("of/3/events"), (404, b"there is no such scene\n".to_vec()));
    assert_eq!(watching.get("of/x/").0, 404);
}

#[test]
fn a_scene_is_rendered_only_while_a_page_looks_at_it() {
    let folder = folder(&[("heavy.ray", &heavy()), ("light.ray", &ball("9 0 0"))]);
    let (watching, _) = Watching::start_all(folder, &["."], PORT);
    watching.events_at("of/1/events").until("done");
    assert_eq!(watching.get("probe/1/0/0").0, 410, "nobody has looked at it yet");
    let mut page = watching.events();
    page.until("scene");
    assert_eq!(watching.get("probe/1/0/0").0, 200);
    drop(page);
    let start = Instant::now();
    while watching.get("probe/1/0/0").0 == 200 {
        assert!(start.elapsed() < PATIENCE, "the image stays");
        thread::sleep(Duration::from_millis(20));
    }
    // All threads are free for the other one, which is read again.
    let mut light = watching.events_at("of/1/events");
    assert_eq!(light.until("scene")["text"], ball("9 0 0"));
    light.until("done");
}

#[test]
fn two_hundred_scenes_in_a_folder_are_listed_without_being_read() {
    let heavy = heavy();
    let names: Vec<_> = (0..200).map(|number| format!("scene{number:03}.ray")).collect();
    let files: Vec<_> = names.iter().map(|name| (&**name, &*heavy)).collect();
    let folder = folder(&files);
    let start = Instant::now();
    let (watching, what) = Watching::start_all(folder, &["."], PORT);
    println!("200 scenes are watched after {} ms", start.elapsed().as_millis());
    assert_eq!(what, "200 scenes");
    let mut events = watching.events_at("of/117/events");
    assert_eq!(events.until("scenes").as_array().map(Vec::len), Some(200));
    assert!(events.until("scene")["name"].as_str().is_some_and(|name| name.ends_with("scene117.ray")));
    for number in [0, 116, 118, 199] {
        assert_eq!(watching.get(&format!("of/{number}/probe/1/0/0")).0, 410, "{number} has not been read");
    }
}

#[test]
fn scenes_that_come_and_go_are_followed() {
    let folder = folder(&[("b.ray", &ball("9 0 0")), ("notes.txt", "no scene"), (".hidden.ray", "")]);
    let at = folder.path().join("b.ray");
    let (watching, what) = Watching::start_all(folder, &["."], PORT);
    assert_eq!(what, "1 scene");
    let mut events = watching.events();
    assert_eq!(names(&events.until("scenes")), [(0, "./b.ray")]);
    events.until("done");
    fs::write(watching.folder.path().join("a.toml"), "").expect("a file");
    assert_eq!(names(&events.until("scenes")), [(1, "./a.toml"), (0, "./b.ray")]);
    fs::remove_file(&at).expect("it was there");
    // On a busy machine, either may be told first.
    let mut all = |wanted: [(&str, &str); 2]| {
        let mut seen = [false; 2];
        while seen != [true; 2] {
            let (name, data) = events.next();
            for (wanted, seen) in wanted.iter().zip(&mut seen).filter(|((wanted, _), _)| *wanted == name) {
                assert!(data.contains(wanted.1), "{name}: {data}");
                *seen = true;
            }
        }
    };
    all([("scenes", r#"[{"number":1,"name":"./a.toml"}]"#), ("fault", "cannot read `./b.ray`")]);
    fs::write(&at, ball("0 9 0")).expect("a file");
    all([("scene", "ambient 0 9 0"), ("scenes", "b.ray")]);
}

#[test]
fn what_is_no_scene_is_refused_before_anything_is_watched() {
    let folder = folder(&[("a.ray", &ball("9 0 0"))]);
    fs::create_dir(folder.path().join("empty")).expect("a folder");
    for (args, status, said) in [
        (&["a.ray", "-"] as &[_], 2, "standard input cannot be watched"),
        (&["-", "-"], 2, "standard input cannot be watched"),
        (&["a.ray", "empty"], 1, "there is no scene in the folder `empty`"),
        (&["a.ray", "b.ray"], 1, "cannot read `b.ray`"),
        (&[], 2, "SCENE|DIR"),
    ] {
        let output = cargo_bin_cmd!("tabray")
            .current_dir(folder.path())
            .arg("watch")
            .args(args)
            .output()
            .expect("the program runs");
        let err = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(status), "{args:?}: {err}");
        assert!(err.starts_with("error: ") && err.contains(said), "{args:?}: {err}");
    }
}

#[test]
fn the_page_has_a_list_of_the_scenes_and_keys_that_go_through_it() {
    let folder = folder(&[("a.ray", &ball("9 0 0")), ("b.ray", &ball("0 9 0")), ("c.ray", &ball("0 0 9"))]);
    let (watching, _) = Watching::start_all(folder, &["."], PORT);
    let Some(browser) = Browser::open(&watching.url("")) else { return };
    let shows = |name: &str, ambient: &str| {
        browser.wait(&format!("document.querySelector('#name')?.textContent === './{name}'"));
        browser.wait("document.documentElement.dataset.shown === document.documentElement.dataset.version");
        assert!(canvas(&browser) == render(&model(&ball(ambient))), "{name}");
        assert_eq!(
            browser.text("const all = document.querySelector('#scenes'); return all.selectedOptions[0].text"),
            format!("./{name}")
        );
    };
    shows("a.ray", "9 0 0");
    browser.press('n');
    shows("b.ray", "0 9 0");
    browser.press('p');
    shows("a.ray", "9 0 0");
    browser.press('p');
    shows("c.ray", "0 0 9");
    browser.run(
        "const all = document.querySelector('#scenes'); all.value = '1'
         all.dispatchEvent(new Event('change', { bubbles: true }))",
    );
    shows("b.ray", "0 9 0");
    assert_eq!(browser.text("return document.activeElement.id"), "scenes");
    fs::write(watching.folder.path().join("b.ray"), ball("9 9 0")).expect("a file");
    // Its version is the number of times that it was read, which depends on when the program noticed that the page had left.
    browser.wait("document.querySelector('#text').textContent.includes('ambient 9 9 0')");
    shows("b.ray", "9 9 0");
    fs::remove_file(watching.folder.path().join("b.ray")).expect("it was there");
    browser.wait("document.querySelector('#scenes').selectedOptions[0].text === './b.ray (gone)'");
    browser.wait("document.querySelector('#report').textContent.includes('cannot read')");
    // The list takes letters itself while it has the focus.
    browser.run("document.activeElement.blur()");
    browser.press('n');
    shows("a.ray", "9 0 0");
}

#[test]
fn one_scene_has_no_list() {
    let watching = Watching::text(&ball("9 0 0"));
    let Some(browser) = Browser::open(&watching.url("")) else { return };
    shown(&browser, 1);
    assert_eq!(browser.run("return document.querySelector('#scenes').hidden"), true);
    browser.press('n');
    assert_eq!(browser.text("return location.pathname"), "/");
}
