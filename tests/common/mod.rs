//! Helpers for several tests: the registry, scenes and decoded images.
#![allow(dead_code, reason = "each test program uses a part of it")]

pub mod glass;
pub mod instructions;
pub mod program;

use image::RgbImage;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tabray::render::{Plan, TraceObserver};
use tabray::scene::{self, Model, Registry};
use tabray::tools::threads::renderer_with;
use tabray::world::Accuracy;

/// An observer that sees each event and does nothing.
pub struct Onlooker;

impl TraceObserver for Onlooker {
    fn sees_events(&self) -> bool {
        true
    }
}

/// Returns the entity types of the program.
pub fn registry() -> &'static Registry {
    Registry::get().expect("no two plugins claim one name")
}

/// Returns the folder of the package.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Returns settings for snapshots that are in this folder of `snapshots/`.
pub fn snapshots(folder: &str) -> insta::Settings {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(root().join("snapshots").join(folder));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings
}

/// Returns a folder of the course's scenes, `what` these are, if it exists.
pub fn course(folder: &str, what: &str) -> Option<PathBuf> {
    let folder = root().join("../shared").join(folder);
    if folder.is_dir() {
        return Some(folder);
    }
    // Not `eprintln!`, which the test harness hides.
    let _ = writeln!(io::stderr(), "SKIPPED: {what} are not in {}", folder.display());
    None
}

/// Returns the model of a scene's text, which must have no faults.
pub fn model(text: &str) -> Model {
    model_in(Path::new(""), text)
}

/// Returns the model of a scene's text; its file names are relative to `folder`.
pub fn model_in(folder: &Path, text: &str) -> Model {
    match scene::read(registry(), "scene", folder, text.as_bytes(), None) {
        Ok(loaded) => loaded.model,
        Err(report) => panic!("{report}\n{text}"),
    }
}

/// Returns the model of a scene's file, which must have no faults.
pub fn load(path: &Path) -> Model {
    model_in(path.parent().expect("a folder"), &fs::read_to_string(path).expect("a scene that is text"))
}

/// Loads a scene with few pixels and samples.
pub fn small(path: &Path, accuracy: Option<Accuracy>) -> Model {
    let bytes = fs::read(path).expect("a scene");
    let name = path.display().to_string();
    let mut model = match scene::read(registry(), &name, path.parent().expect("a folder"), &bytes, accuracy) {
        Ok(loaded) => loaded.model,
        // With the notes' method come their rules, which refuse some lights.
        Err(report)
            if accuracy == Some(Accuracy::Classic)
                && report.to_string().contains("rules of light do not") =>
        {
            return small(path, Some(Accuracy::Exact));
        }
        Err(report) => panic!("{report}"),
    };
    let camera = &mut model.camera.value;
    // Mirrors that touch cost 20,000 rays per pixel, and rays that graze 1 ms each. Neither width nor height is a multiple
    // of the tile size.
    let is_costly = ["touching-mirrors.ray", "grazing.ray"].iter().any(|name| path.ends_with(name));
    camera.pixels = if is_costly { [5, 3] } else { [36, 27] };
    camera.samples = camera.samples.min(3);
    model
}

/// Returns the first block of code that contains a text in a page of the docs.
pub fn block_with(page: &str, text: &str) -> String {
    let block = page.split("```").skip(1).step_by(2).find(|block| block.contains(text));
    let block = block.unwrap_or_else(|| panic!("the page has a block with {text}"));
    block.split_once('\n').expect("a first line, which names the language").1.to_owned()
}

/// Returns the names of all fields of a JSON value, at any depth, except those that are names of entity types.
pub fn fields(value: &Value) -> BTreeSet<&str> {
    match value {
        Value::Object(object) => {
            let inner = object.values().flat_map(fields);
            let names = object.keys().map(String::as_str);
            names.filter(|name| registry().find(name).is_none()).chain(inner).collect()
        }
        Value::Array(values) => values.iter().flat_map(fields).collect(),
        _ => BTreeSet::new(),
    }
}

/// Asserts that the docs tell the meaning of each field of a JSON value, under the name of what prints it.
pub fn assert_tells_fields(of: &str, value: &Value) {
    let table = fs::read_to_string(root().join("docs/data/fields.csv")).expect("the table of fields");
    let rows = table.lines().filter_map(|row| row.strip_prefix(of)?.strip_prefix(','));
    // Some fields are written with the object that they are in, `outer.inner`.
    let told: BTreeSet<_> =
        rows.filter_map(|row| row.split(',').next()).flat_map(|name| name.split('.')).collect();
    for field in fields(value) {
        assert!(told.contains(field), "docs/data/fields.csv does not tell what `{field}` of {of} is");
    }
}

/// Renders the image of a model.
pub fn render(model: &Model) -> RgbImage {
    let [width, height] = model.camera.value.pixels.map(|side| side as u32);
    let bytes = renderer_with(0).expect("threads").picture(&Plan::new(model));
    RgbImage::from_raw(width, height, bytes).expect("three bytes for each pixel")
}

/// Returns every scene of `scenes/` that has an image, sorted, but for generated ones.
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
    // What the README's commands have generated is too large to be tested.
    found.retain(|path| {
        !["wrong", "generated"].iter().any(|kind| path.starts_with(root().join("scenes").join(kind)))
    });
    found.sort();
    assert!(found.len() > 20, "the scenes of {} are there", root().display());
    found
}
