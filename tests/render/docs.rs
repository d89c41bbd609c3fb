//! The pages of the docs: they are few and short, their pictures are up to date, and their scenes can be read.

use crate::common::program::folder;
use crate::common::{block_with, model_in, registry, root};
use crate::readme::part_of;
use image::imageops;
use std::fs;
use std::path::{Path, PathBuf};
use tabray::scene::Kind;

/// Returns the pages of the docs and the number of words of each.
fn pages() -> Vec<(PathBuf, usize)> {
    let entries = fs::read_dir(root().join("docs")).expect("a folder").map(|entry| entry.expect("an entry"));
    let pages =
        entries.map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|end| end == "md"));
    let words = |page: &Path| fs::read_to_string(page).expect("a page").split_whitespace().count();
    pages.map(|page| (page.clone(), words(&page))).collect()
}

/// A reader finds a page, and reads it.
#[test]
fn the_docs_are_few_and_short() {
    let pages = pages();
    let words: usize = pages.iter().map(|(_, words)| words).sum();
    assert!(pages.len() <= 16 && words <= 20_000, "{} pages of {words} words", pages.len());
    for (page, words) in pages {
        assert!(!page.ends_with("mathematicians.md") || words <= 400, "{} has {words} words", page.display());
    }
}

#[test]
fn the_mathematicians_pictures_are_those_of_their_scene() {
    let page = fs::read_to_string(root().join("docs/mathematicians.md")).expect("the page");
    let folder = folder();
    let scene = folder.path().join("cubic.ray");
    let text = block_with(&page, "implicit cubic");
    for (name, a) in [("cubic", "1"), ("cubic-1.5", "1.5")] {
        fs::write(&scene, text.replace("let a 1\n", &format!("let a {a}\n"))).expect("room for a file");
        let shown = image::open(root().join(format!("docs/{name}.png"))).expect("the picture").into_rgb8();
        let strip = imageops::crop_imm(&shown, 0, 60, 320, 8).to_image();
        assert!(
            part_of(&scene, "0,172,320,8") == strip,
            "docs/{name}.png: CONTRIBUTING.md says how to make it"
        );
    }
}

/// Returns the lines of scenes that a page shows: its blocks without a language, and in its tables `ball { ... }`.
fn shown_in(page: &str) -> Vec<String> {
    let page = fs::read_to_string(root().join("docs").join(page)).expect("a page");
    let blocks = page.split("```").skip(1).step_by(2).filter_map(|block| block.strip_prefix('\n'));
    let cells =
        page.lines().filter_map(|line| line.strip_suffix(" |")?.rsplit_once("| ")).map(|(_, cell)| cell);
    let cells = cells.filter_map(|cell| cell.strip_prefix('`')?.strip_suffix('`'));
    let scenes = blocks.chain(cells).filter(|text| text.trim_end().ends_with('}'));
    // A scene has one background, and a block shows all types of them.
    let one_each = |text: &str| match text.starts_with("background ") {
        true => text.lines().map(str::to_owned).collect(),
        false => vec![text.to_owned()],
    };
    scenes.flat_map(one_each).collect()
}

/// Tells whether a text defines a name.
fn defines(text: &str, name: &str) -> bool {
    text.lines().any(|line| line.split_whitespace().nth(1) == Some(name))
}

#[test]
fn the_scenes_that_the_docs_show_are_read() {
    for (page, least) in [("language.md", 12), ("light.md", 2), ("gallery.md", 25), ("figures.md", 4)] {
        let shown = shown_in(page);
        assert!(shown.len() >= least, "{page} shows {shown:?}");
        for shown in shown {
            let names = ["red", "blue", "grey", "white", "green", "gold", "ivory", "violet", "orange"];
            let materials = names.map(|name| format!("material {name} {{ ambient 1 1 1 }}\n"));
            let textures = ["dusk", "letter"].map(|name| format!("texture {name} {{ filename dusk.png }}\n"));
            let names = ["cube", "ball", "around", "round", "one", "two", "three", "four", "five", "six"];
            let balls = names.map(|name| format!("sphere {name} {{ material red center 0 0 0 radius 1 }}\n"));
            let mut scene = String::new();
            for line in materials.iter().chain(&textures).chain(&balls) {
                let name = line.split_whitespace().nth(1).expect("a name");
                if !defines(&shown, name) {
                    scene += line;
                }
            }
            let is_camera =
                |entity: &str| registry().find(entity).is_some_and(|entity| entity.kind() == Kind::Camera);
            if !shown.split_whitespace().next().is_some_and(is_camera) {
                scene += "look_at eye { pixeldim 8 6 position 4 3 6 target 4 3 0 }\n";
            }
            // There is no chair here.
            let shown = shown.replace("chair.glb", "../models/lantern.obj");
            model_in(&root().join("scenes/textures"), &(scene + &shown));
        }
    }
}

/// Returns the names by which links lead to the headings of a page.
fn headings(page: &str) -> Vec<String> {
    let outside = page.split("```").step_by(2).flat_map(str::lines);
    let titles = outside.filter(|line| line.starts_with('#')).map(|line| line.trim_start_matches('#').trim());
    let letters =
        |title: &str| title.to_lowercase().replace(|c: char| !c.is_alphanumeric() && !" -_".contains(c), "");
    titles.map(|title| letters(title).replace(' ', "-")).collect()
}

#[test]
fn links_lead_to_headings_that_are_there() {
    let read = |path: &Path| fs::read_to_string(path).unwrap_or_default();
    let pages = pages().into_iter().map(|(page, _)| page);
    for page in pages.chain(["README.md", "CONTRIBUTING.md", "SECURITY.md"].map(|name| root().join(name))) {
        let text = read(&page);
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let Some((file, heading)) = link.split_once('#').filter(|(file, _)| !file.contains("://")) else {
                continue;
            };
            let there = if file.is_empty() { page.clone() } else { page.with_file_name(file) };
            let is_there = headings(&read(&there)).iter().any(|title| title == heading);
            assert!(is_there, "{} links to {link}, which is not there", page.display());
        }
    }
}
