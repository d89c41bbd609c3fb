//! The images of the page in docs/.

use crate::common::root;
use crate::watch::browser::Browser;
use crate::watch::page::{click, shown};
use crate::watch::program::Watching;
use std::fs;
use tempfile::TempDir;

/// `cargo test --release --test cli -- --ignored the_screenshots_of_the_docs`
#[test]
#[ignore = "writes docs/watch*.png"]
fn the_screenshots_of_the_docs() {
    let folder = TempDir::new().expect("a folder");
    fs::copy(root().join("scenes/gallery/marbles.ray"), folder.path().join("scene.ray")).expect("a copy");
    let watching = Watching::start(folder, &["--port", "0"]);
    let browser = Browser::open(&watching.url("")).expect("a browser");
    let write = |name: &str| fs::write(root().join("docs").join(name), browser.screenshot()).expect("a file");
    shown(&browser, 1);
    // How long it took says something about this machine alone.
    browser.run("state('done', `${width} × ${height}`)");

    browser.emulate([1360, 850], false, "dark");
    click(&browser, [300, 150]);
    browser.wait("!document.querySelector('#told').hidden && document.querySelector('#field-radius-0')");
    write("watch.png");

    browser.emulate([390, 844], true, "dark");
    write("watch-phone.png");
}
