//! What several tests need: the registry, scenes and decoded pictures.
#![allow(dead_code, reason = "each test program uses a part of it")]

pub mod program;

use image::RgbImage;
use std::fs;
use std::path::{Path, PathBuf};
use tabray::render::{Plan, Renderer};
use tabray::scene::{self, Model, Registry};

/// The entity types of the program.
pub fn registry() -> &'static Registry {
    Registry::get().expect("no two plugins claim one name")
}

/// The folder of the package.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The model of a scene's text, which has no faults.
pub fn model(text: &str) -> Model {
    model_in(Path::new(""), text)
}

/// The model of a scene's text, whose file names start from `folder`.
pub fn model_in(folder: &Path, text: &str) -> Model {
    match scene::read(registry(), "scene", folder, text.as_bytes(), None) {
        Ok(loaded) => loaded.model,
        Err(report) => panic!("{report}\n{text}"),
    }
}

/// The model of a scene's file, which has no faults.
pub fn load(path: &Path) -> Model {
    model_in(path.parent().expect("a folder"), &fs::read_to_string(path).expect("a scene that is text"))
}

/// The first block of code with a text in a page of the docs.
pub fn block_with(page: &str, text: &str) -> String {
    let block = page.split("```").skip(1).step_by(2).find(|block| block.contains(text));
    let block = block.unwrap_or_else(|| panic!("the page has a block with {text}"));
    block.split_once('\n').expect("a first line, which names the language").1.to_owned()
}

/// The picture of a model.
pub fn render(model: &Model) -> RgbImage {
    let [width, height] = model.camera.value.pixels.map(|side| side as u32);
    let bytes = Renderer::new(0).expect("threads").picture(&Plan::new(model));
    RgbImage::from_raw(width, height, bytes).expect("three bytes for each pixel")
}

/// Every scene of `scenes/` that has a picture, sorted.
pub fn scenes() -> Vec<PathBuf> {
    fn collect(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).expect("a folder of scenes") {
            let path = entry.expect("its entries").path();
            if path.is_dir() {
                collect(&path, found);
            } else if path.extension().is_some_and(|extension| extension == "ray" || extension == "toml") {
                found.push(path);
            }
        }
    }
    let mut found = Vec::new();
    collect(&root().join("scenes"), &mut found);
    found.retain(|path| !path.starts_with(root().join("scenes/wrong")));
    found.sort();
    assert!(found.len() > 20, "the scenes of {} are there", root().display());
    found
}
