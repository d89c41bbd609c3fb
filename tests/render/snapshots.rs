//! The dump and the image of every scene, and the messages about every faulty scene, compared with the accepted ones.
//!
//! A new scene needs only its file. Look at the results with `cargo run --release -- review --serve`, and accept them
//! there.

use crate::common::{load, registry, render, root, snapshots};
use image::RgbImage;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use insta::internals::SnapshotContents;
use insta::{Comparator, Settings, Snapshot};
use std::fs;
use std::path::Path;
use tabray::output::Comparison;
use tabray::scene::{self, Type, dump, reference};

#[test]
fn every_scene_dumps_as_before() {
    insta::glob!("../../scenes", "**/*.{ray,toml,txt}", |path| {
        if let Some(settings) = settings(path) {
            let name = format!("{}.dump", stem(path));
            settings.bind(|| insta::assert_snapshot!(name, dump::notes(&load(path))));
        }
    });
}

#[test]
fn every_scene_looks_as_before() {
    insta::glob!("../../scenes", "**/*.{ray,toml,txt}", |path| {
        if let Some(mut settings) = settings(path) {
            let mut model = load(path);
            if path.starts_with(root().join("scenes/gallery")) {
                // A thumbnail shows enough, and keeps the repository small.
                let camera = &mut model.camera.value;
                camera.pixels = [128, 96];
                if camera.bounces != 0 {
                    camera.samples = camera.samples.min(8);
                }
            }
            let mut png = Vec::new();
            let encoder = PngEncoder::new_with_quality(&mut png, CompressionType::Best, FilterType::Adaptive);
            render(&model).write_with_encoder(encoder).expect("a picture can be encoded");
            let scene = path.strip_prefix(root()).expect("a scene of this package").with_extension("");
            settings.set_comparator(Box::new(SamePixels { scene: scene.display().to_string() }));
            let name = format!("{}.png", stem(path));
            settings.bind(|| insta::assert_binary_snapshot!(&name, png));
        }
    });
}

#[test]
fn every_mistake_is_explained_as_before() {
    insta::glob!("../../scenes/wrong", "*.{ray,toml,txt}", |path| {
        let name = path.strip_prefix(root()).expect("a scene of this package").display().to_string();
        let report = match scene::read(
            registry(),
            &name,
            path.parent().expect("a folder"),
            &fs::read(path).expect("a file"),
            None,
        ) {
            Ok(loaded) => loaded.warnings,
            Err(report) => report,
        };
        assert!(!report.faults().is_empty(), "{name} has no fault");
        folder("wrong").bind(|| insta::assert_snapshot!(stem(path), without_lists(report.to_string())));
    });
}

/// Returns a message without the lists of everything that plugins register.
fn without_lists(message: String) -> String {
    let names: Vec<_> = registry().iter().map(|entity| format!("`{}`", entity.name)).collect();
    let types = (names.join(", "), "[all types]".to_owned());
    let choices = registry().iter().flat_map(|entity| entity.attributes()).filter_map(|attribute| {
        let Type::Choice(choices) = attribute.value_type() else { return None };
        // Plugins register no accuracies.
        (choices.what != "accuracy").then(|| (choices.listed(), format!("[all {}s]", choices.what)))
    });
    choices.chain([types]).fold(message, |message, (list, short)| {
        message.replace(&format!(" are {list}\n"), &format!(" are {short}\n"))
    })
}

#[test]
fn every_word_has_its_page() {
    for (name, page) in reference::pages(registry()) {
        folder("reference").bind(|| insta::assert_binary_snapshot!(&format!("{name}.md"), page.into_bytes()));
    }
}

/// Returns the snapshot settings for a scene, by its folder; `None` for scenes that have no image.
fn settings(path: &Path) -> Option<Settings> {
    let subject = path.strip_prefix(root().join("scenes")).ok()?.parent()?.to_str()?;
    // What the README's commands have generated is too large to be tested.
    (!["wrong", "generated"].contains(&subject)).then(|| folder(subject))
}

fn folder(subject: &str) -> Settings {
    let mut settings = snapshots(subject);
    // `glob!` would make up a suffix that depends on which other files exist.
    settings.remove_snapshot_suffix();
    settings.remove_input_file();
    settings
}

fn stem(path: &Path) -> &str {
    path.file_stem().and_then(|stem| stem.to_str()).expect("a name in UTF-8")
}

/// Compares images by their pixels, and reports how they differ.
#[derive(Clone)]
struct SamePixels {
    scene: String,
}

impl Comparator for SamePixels {
    fn matches(&self, reference: &Snapshot, test: &Snapshot) -> bool {
        let (Some(expected), Some(actual)) = (picture(reference), picture(test)) else { return false };
        let comparison = Comparison::new(&expected, &actual, 0);
        if comparison.as_ref().is_some_and(|comparison| comparison.differing == 0) {
            return true;
        }
        let told = match comparison {
            Some(comparison) => comparison.to_string(),
            None => format!("{:?} pixels became {:?}", expected.dimensions(), actual.dimensions()),
        };
        eprintln!("{}: {told}; see it with `cargo run --release -- review`", self.scene);
        false
    }

    fn dyn_clone(&self) -> Box<dyn Comparator> {
        Box::new(self.clone())
    }
}

fn picture(snapshot: &Snapshot) -> Option<RgbImage> {
    match snapshot.contents() {
        SnapshotContents::Binary(Some(bytes)) => Some(image::load_from_memory(bytes).ok()?.into_rgb8()),
        _ => None,
    }
}

#[test]
fn no_snapshot_is_left_of_a_scene_that_is_gone() {
    let mut folders = vec![root().join("snapshots")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder of snapshots") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                // Tables of meshes, explanations, plans, proofs and refusals have names other than those of scenes.
                if !["meshes", "probe", "plan", "proofs", "refusals"]
                    .iter()
                    .any(|folder| path.ends_with(folder))
                {
                    folders.push(path);
                }
                continue;
            }
            let subject = path.parent().and_then(|folder| folder.strip_prefix(root().join("snapshots")).ok());
            let name = path.file_name().and_then(|name| name.to_str()).expect("a name in UTF-8");
            let stem = name.split('.').next().expect("a stem");
            // Answers to editors, and what is said of pictures that are graded.
            if [Path::new("editor"), Path::new("grade")].map(Some).contains(&subject) {
                continue;
            }
            if subject == Some(Path::new("reference")) {
                let is_there = reference::pages(registry()).any(|(word, _)| word == stem);
                assert!(is_there, "{} is of no plugin", path.display());
                continue;
            }
            let scene = root().join("scenes").join(subject.expect("a subject")).join(stem);
            let is_there =
                ["ray", "toml", "txt"].iter().any(|extension| scene.with_extension(extension).is_file());
            assert!(is_there, "{} has no scene", path.display());
        }
    }
}

#[test]
fn every_entity_has_its_scene_and_a_mistake() {
    let mistakes: Vec<_> = fs::read_dir(root().join("snapshots/wrong"))
        .expect("the messages")
        .map(|entry| fs::read_to_string(entry.expect("an entry").path()).expect("a text"))
        .collect();
    for entity in registry().iter() {
        let name = entity.name;
        let path = root().join("scenes/entities").join(name).with_extension("ray");
        assert!(
            path.is_file(),
            "{entity:?} has no scene of its own: add scenes/entities/{name}.ray, which shows it"
        );
        let scene = load(&path);
        let shown = scene.entities(entity.kind()).iter().any(|given| given.entity().name == name);
        assert!(shown, "scenes/entities/{name}.ray shows no {name}");
        for snapshot in [format!("{name}.dump.snap"), format!("{name}.snap.png")] {
            let path = root().join("snapshots/entities").join(&snapshot);
            assert!(
                path.is_file(),
                "there is no {}: look at what the scene gives with `tabray review`, and accept it",
                path.display()
            );
        }
        let title = format!("{name} `");
        assert!(
            mistakes.iter().any(|message| message.contains(&title)),
            "no mistake is about {entity:?}: add a scene with one to scenes/wrong, and accept its message"
        );
    }
}
