//! What the README and the docs show: the scene loads, the pictures and the reference are fresh.

use crate::common;
use crate::common::program::{folder, outcome, tabray};
use crate::common::{block_with, load, model, render, root};
use std::fs;

fn readme() -> String {
    fs::read_to_string(root().join("README.md")).expect("the README")
}

#[test]
fn the_readmes_scene_is_one() {
    assert_eq!(model(&block_with(&readme(), "camera eye\n")).objects.len(), 2);
}

#[test]
fn the_readmes_mistake_is_told_as_it_says() {
    let folder = folder();
    let scene = block_with(&readme(), "camera eye\n").replace("radius", "raduis");
    fs::write(folder.path().join("ball.ray"), scene).expect("room for a file");
    let (status, _, err) = outcome(tabray(&folder).args(["render", "ball.ray"]));
    assert_eq!((status, err), (2, block_with(&readme(), "raduis")));
}

#[test]
fn the_pictures_of_the_docs_are_fresh() {
    for (scenes, pictures) in [("scenes/gallery", "docs"), ("scenes/entities", "docs/entities")] {
        for entry in fs::read_dir(root().join(scenes)).expect("a folder of scenes") {
            let scene = entry.expect("an entry").path();
            let stem = scene.file_stem().expect("a name");
            let picture = root().join(pictures).join(stem).with_extension("png");
            let shown = image::open(&picture).expect("a picture for each scene").into_rgb8();
            assert!(
                render(&load(&scene)) == shown,
                "{} is stale: the README says how to make it",
                picture.display()
            );
        }
    }
}

#[test]
fn the_reference_of_the_language_is_fresh() {
    let written = fs::read_to_string(root().join("docs/language.md")).expect("the reference");
    assert!(
        written == tabray::scene::reference::markdown(common::registry()),
        "docs/language.md is stale: its first lines say how to make it"
    );
}

#[test]
fn the_readme_shows_every_entity() {
    let readme = readme();
    for entity in common::registry().iter() {
        let picture = format!("![{}](docs/entities/{}.png)", entity.name, entity.name);
        assert!(
            readme.contains(&picture),
            "the README shows no {}: add {picture} to its entities",
            entity.name
        );
    }
}
