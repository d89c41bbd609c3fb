//! The collection of pending snapshots, and the commands that accept or reject them.

use crate::review::{data, files, folder, tabray, with_pending};
use image::RgbImage;
use serde_json::{Value, json};
use std::fs;
use std::process::Command;
use tempfile::TempDir;

fn page_of(folder: &TempDir) -> Value {
    let (status, out, err) = tabray(folder.path(), &["review"]);
    assert_eq!((status, out.as_str()), (0, ""), "{err}");
    assert!(err.ends_with("wrote review.html\n"), "{err}");
    let html = fs::read_to_string(folder.path().join("review.html")).expect("the page");
    assert_eq!(html.matches("</script>").count(), 2, "no snapshot ends a script");
    data(&html)
}

#[test]
fn a_review_gathers_what_is_pending() {
    let data = page_of(&with_pending());
    let items = data["items"].as_array().expect("a list");
    let summaries: Vec<_> = items.iter().map(|item| item["summary"].as_str().expect("a text")).collect();
    assert_eq!(
        summaries,
        [
            "1 of 12 pixels differs (8.3333 %); largest difference 30 levels, RMS 5.0000",
            "lines: 1 removed, 2 added",
            "new"
        ]
    );
    assert_eq!(
        items[1]["lines"],
        json!([
            [" ", 1, 1, "one"],
            ["-", 2, null, "two"],
            ["+", null, 2, "---"],
            ["+", null, 3, "</script>2"]
        ])
    );
}

#[test]
fn a_picture_of_another_size_is_called_so() {
    let folder = with_pending();
    let path = folder.path().join("snapshots/it's <b>/ball.snap.new.png");
    RgbImage::new(5, 3).save(path).expect("room for a picture");
    assert_eq!(page_of(&folder)["items"][0]["summary"], "the size differs: 4 x 3 pixels became 5 x 3 pixels");
}

#[test]
fn nothing_pending_is_no_failure_and_no_page() {
    let folder = folder();
    fs::create_dir(folder.path().join("snapshots")).expect("room for a folder");
    assert_eq!(
        tabray(folder.path(), &["review"]),
        (0, String::new(), "nothing is pending in `snapshots`\n".into())
    );
    assert!(!folder.path().join("review.html").exists());
    let (status, _, err) = tabray(folder.path(), &["review", "elsewhere"]);
    assert_eq!(status, 2);
    assert!(err.contains("there is no folder or snapshot `elsewhere`"), "{err}");
}

#[test]
fn what_cannot_be_shown_is_told_and_the_rest_is_shown() {
    let folder = with_pending();
    fs::remove_file(folder.path().join("snapshots/it's <b>/ball.snap.new.png")).expect("it is there");
    let (status, _, err) = tabray(folder.path(), &["review"]);
    assert_eq!(status, 2);
    assert!(err.contains("ball.snap.new`: the file beside it is missing"), "{err}");
    let html = fs::read_to_string(folder.path().join("review.html")).expect("the page");
    assert_eq!(data(&html)["items"].as_array().map(Vec::len), Some(2));
}

#[cfg(unix)]
#[test]
fn the_commands_on_the_page_work_as_they_stand() {
    let folder = with_pending();
    let before = files(&folder);
    let data = page_of(&folder);
    let run = |index: usize, verb: &str| {
        let command = data["items"][index]["decision"][verb].as_str().expect("a command");
        let done =
            Command::new("sh").args(["-c", command]).current_dir(folder.path()).output().expect("a shell");
        assert!(done.status.success(), "{command}: {}", String::from_utf8_lossy(&done.stderr));
    };
    run(0, "accept");
    run(1, "reject");
    run(2, "accept");
    let mut expected = before.clone();
    for new in ["ball.snap.new", "dump.snap.new", "later.snap.new"] {
        expected.remove(new);
    }
    expected.insert("ball.snap.png".into(), expected["ball.snap.new.png"].clone());
    expected.remove("ball.snap.new.png");
    expected.insert("later.snap".into(), b"---\nsource: tests/a.rs\n---\nsomething\n".to_vec());
    assert_eq!(files(&folder), expected);
}
