//! The README and the docs: their scene loads, their images are up to date, and their links lead to files.

use crate::common;
use crate::common::program::{folder, outcome, tabray};
use crate::common::{block_with, load, model, root};
use image::{RgbImage, imageops};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use tabray::scene::reference;

fn readme() -> String {
    fs::read_to_string(root().join("README.md")).expect("the README")
}

#[test]
fn the_readmes_scene_is_one() {
    assert_eq!(model(&block_with(&readme(), "look_at eye")).objects.len(), 2);
}

#[test]
fn the_readmes_picture_is_that_of_its_scene() {
    let folder = folder();
    let scene = folder.path().join("ball.ray");
    fs::write(&scene, block_with(&readme(), "look_at eye")).expect("room for a file");
    let shown = image::open(root().join("docs/ball.png")).expect("the picture").into_rgb8();
    assert!(part_of(&scene, "0,0,320,240") == shown, "CONTRIBUTING.md says how to make it");
}

/// A newcomer reads it to its end.
#[test]
fn the_readme_is_short() {
    let lines = readme().lines().count();
    assert!(lines <= 160, "{lines} lines");
}

#[test]
fn the_readmes_mistake_is_told_as_it_says() {
    let folder = folder();
    let scene = block_with(&readme(), "look_at eye").replace("radius", "raduis");
    fs::write(folder.path().join("ball.ray"), scene).expect("room for a file");
    let (status, _, err) = outcome(tabray(&folder).args(["render", "ball.ray"]));
    assert_eq!((status, err), (2, block_with(&readme(), "raduis")));
}

#[test]
fn the_pictures_of_the_docs_are_fresh() {
    for entry in fs::read_dir(root().join("scenes/gallery")).expect("a folder of scenes") {
        let scene = entry.expect("an entry").path();
        let stem = scene.file_stem().expect("a name");
        let picture = root().join("docs").join(stem).with_extension("png");
        let shown = image::open(&picture).expect("a picture for each scene").into_rgb8();
        // All of them take minutes of CPU time: a strip across the middle of each is compared.
        let camera = &load(&scene).camera.value;
        let [width, height] = [shown.width(), shown.height()];
        let rows = height / if camera.bounces == 0 { 24 } else { 96 };
        let top = (height - rows) / 2;
        let part = imageops::crop_imm(&shown, 0, top, width, rows).to_image();
        let is_fresh = camera.pixels == [width as usize, height as usize]
            && part_of(&scene, &format!("0,{},{width},{rows}", height - rows - top)) == part;
        assert!(is_fresh, "{} is stale: CONTRIBUTING.md says how to make it", picture.display());
    }
}

/// Renders some columns and rows of a scene's image, as `--crop` counts them.
pub fn part_of(scene: &Path, crop: &str) -> RgbImage {
    let folder = folder();
    let (status, _, err) =
        outcome(tabray(&folder).arg("render").arg(scene).args(["--crop", crop, "-o", "it.png"]));
    assert_eq!(status, 0, "{err}");
    image::open(folder.path().join("it.png")).expect("a picture").into_rgb8()
}

#[test]
fn the_reference_has_every_word_and_what_it_means() {
    let reference = reference::markdown(common::registry());
    assert!(
        reference.starts_with(&fs::read_to_string(root().join("docs/language.md")).expect("the language"))
    );
    for (name, page) in reference::pages(common::registry()) {
        let (_, section) = reference.split_once(&format!("\n### {name}\n")).expect(name);
        let section = section.split("\n### ").next().expect("a section");
        let meaning = page.split(": ").nth(1).and_then(|rest| rest.split(". Its").next()).expect("a meaning");
        let rows = page.lines().filter(|line| line.starts_with("| ") || line.starts_with("Its number"));
        // In one of the two, the text begins with a capital letter.
        let meaning: String = meaning.chars().skip(1).collect();
        for told in rows.chain([&*meaning]) {
            assert!(section.contains(told), "{name} has no {told}");
        }
    }
}

/// Returns the files that a Markdown page links to or shows.
fn links(page: &Path) -> Vec<PathBuf> {
    let text = fs::read_to_string(page).expect("a page");
    let links = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    let files = links.filter(|link| !link.contains("://")).filter_map(|link| link.split('#').next());
    files.filter(|file| !file.is_empty()).map(|file| page.with_file_name(file)).collect()
}

#[test]
fn links_lead_to_files_that_are_there() {
    let mut pages = ["README.md", "CONTRIBUTING.md", "SECURITY.md"].map(|page| root().join(page)).to_vec();
    for folder in ["docs", "snapshots/reference"] {
        let entries = fs::read_dir(root().join(folder)).expect("a folder");
        let files = entries.map(|entry| entry.expect("an entry").path());
        // A page that is not yet accepted has no files beside it.
        pages.extend(files.filter(|path| {
            let name = path.to_string_lossy();
            name.ends_with(".md") && !name.ends_with(".snap.new.md")
        }));
    }
    for page in pages {
        for file in links(&page) {
            assert!(file.exists(), "{} links to {}, which is not there", page.display(), file.display());
        }
    }
}

/// Returns the text files in a folder, or the text of a single file.
fn texts(path: &Path) -> Vec<(PathBuf, String)> {
    if !path.is_dir() {
        return fs::read_to_string(path).map(|text| (path.to_owned(), text)).into_iter().collect();
    }
    let entries = fs::read_dir(path).expect("a folder").map(|entry| entry.expect("an entry").path());
    entries.filter(|path| !path.ends_with("target")).flat_map(|path| texts(&path)).collect()
}

#[test]
fn no_file_lists_the_plugins() {
    // Such a list would have to be edited for each new plugin.
    let parts =
        ["README.md", "CONTRIBUTING.md", "Cargo.toml", ".ci", "docs", "scenes", "snapshots", "src", "tests"];
    for (path, text) in parts.iter().flat_map(|part| texts(&root().join(part))) {
        // A test makes the stub for type checkers, which need not know a new plugin, from the tables.
        if path.ends_with("tabray/entities.pyi") {
            continue;
        }
        let words: BTreeSet<_> = text.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
        let lacks = common::registry().iter().any(|entity| !words.contains(entity.name));
        assert!(lacks, "{} names all entity types", path.display());
    }
}
