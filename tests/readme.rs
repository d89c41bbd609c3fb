//! What the README shows: its plugin is dropped in and works, its scene loads, its pictures are fresh.

mod common;

use common::copy::Copy;
use common::program::{folder, outcome, tabray};
use common::{block_with, load, model, render, root};
use std::collections::BTreeSet;
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

#[test]
fn a_plugin_is_one_file_dropped_in() {
    let copy = Copy::new("dropped-in");
    copy.build();
    assert!(!copy.prints(&["list"]).contains("disc "), "nothing was dropped in yet");
    let new = copy.new_plugins();
    let before = copy.files();

    let plugins =
        [("disc", block_with(&readme(), "struct Disc").as_str()), ("barrel", BARREL), ("stripes", STRIPES)]
            .map(|(name, text)| {
                (copy.folder.join("plugins").join(name).with_extension("rs"), text.to_owned())
            });
    for (path, text) in &plugins {
        fs::write(path, text).expect("room for a file");
    }
    copy.build();
    // What is dropped in and what `tabray new` writes keeps its contract, of each kind.
    copy.keeps_contracts();
    let dropped: BTreeSet<_> = copy.files().difference(&before).map(|(path, _)| path.clone()).collect();
    assert_eq!(dropped, plugins.into_iter().map(|(path, _)| path).collect(), "no other file changes");

    let disc = copy.prints(&["list"]).lines().find(|line| line.starts_with("disc ")).map(str::to_owned);
    assert!(disc.expect("the list has it").contains("a round piece of a plane"));
    assert!(copy.prints(&["list", "disc"]).contains("the distance from its middle to its rim"));

    let scene = copy.outside("disc.ray");
    fs::write(&scene, block_with(&readme(), "disc target")).expect("room for a file");
    let scene = scene.to_str().expect("a path in UTF-8");
    let dump = copy.prints(&["dump", scene]);
    assert!(
        dump.contains("\ndisc         target \nmaterial     red \nnormal         0.0   0.0   1.0 \n"),
        "{dump}"
    );
    assert!(dump.contains("\nradius         2.0 \n"), "{dump}");

    let picture = copy.outside("disc.png");
    copy.prints(&["render", scene, "-o", picture.to_str().expect("a path in UTF-8")]);
    let picture = image::open(&picture).expect("a picture").into_rgb8();
    let red = picture.pixels().filter(|pixel| pixel.0 == [255, 0, 0]).count() as f64;
    // The disc's radius of 2, seen through the screen, is 2 * 6 / 9 of its 8 by 6 units.
    let area = std::f64::consts::PI * (2.0_f64 * 6.0 / 9.0).powi(2) / (8.0 * 6.0);
    assert!((red / (160.0 * 120.0) - area).abs() < 0.005, "a round disc of the right size, {red} pixels");

    let named = "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 } material m { ambient 5 5 5 }
        revsurf cask { material m surfer barrel base 4 0 -4 direction 0 1 0 height 4 }
        psphere ball { material m shader stripes center 4 3 -3 radius 1 }";
    assert!(copy.run(&["check", "-"], named).contains("-: sound"));

    let message = copy.run(&["check", "-"], "disc d { radius 0 }");
    assert!(message.contains("`radius` of disc `d` must be positive, not 0"), "{message}");

    for (name, scene) in new {
        let picture = copy.outside(&format!("{name}.png"));
        let scene = copy.folder.join(scene);
        let paths = [&scene, &picture].map(|path| path.to_str().expect("a path in UTF-8"));
        copy.prints(&["render", paths[0], "-o", paths[1]]);
        let picture = image::open(&picture).expect("a picture").into_rgb8();
        let orange = picture.pixels().filter(|pixel| pixel.0[0] > 60 && pixel.0[0] / 2 > pixel.0[2]).count();
        assert!(orange > 300, "{name} shows something orange, {orange} pixels");
        let mistake = copy.folder.join("scenes/wrong").join(name).with_extension("ray");
        if let Ok(mistake) = fs::read_to_string(mistake) {
            let message = copy.run(&["check", "-"], &mistake);
            assert!(message.contains(&format!("{name} `")) && message.contains("2 errors"), "{message}");
        }
    }
    contradictions_are_told_with_their_places(&copy);
}

/// Plugins that claim what others have, and one whose file is no module.
fn contradictions_are_told_with_their_places(copy: &Copy) {
    let plugin = |name: &str| copy.folder.join("plugins").join(name);
    fs::write(plugin("Bad-Name.rs"), "").expect("room for a file");
    let message = copy.cargo_build().expect_err("no module can have this name");
    assert!(message.contains("Bad-Name.rs: a plugin's file name is a Rust module name"), "{message}");
    fs::remove_file(plugin("Bad-Name.rs")).expect("it was there");

    fs::write(plugin("rival.rs"), RIVAL).expect("room for a file");
    copy.build();
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(root().join("snapshots/refusals"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    let told = copy.run(&["list"], "");
    settings.bind(|| insta::assert_snapshot!("plugins-that-contradict-each-other", told));
}

const RIVAL: &str = "//! What others have already.

use crate::prelude::*;

inventory::submit! { Entity::shape(\"sphere\", \"another ball\", &[], |_| unreachable!()) }
inventory::submit! { Profile::new(\"cone\", \"another cone\", \"1\") }
inventory::submit! { Profile::new(\"crooked\", \"no formula\", \"2 +\") }
inventory::submit! { ProceduralShader::new(\"checks\", \"its number is that of tiles\", |_| unreachable!()).on_plane(0) }
";

const BARREL: &str = "//! A barrel.

use crate::prelude::*;

inventory::submit! {
    Profile::new(\"barrel\", \"a barrel 4 high\", \"1.5 - 0.1 * (y - 2)^2\")
}
";

const STRIPES: &str = "//! Stripes, as wide as a tenth of the anchor's unit.

use crate::prelude::*;

inventory::submit! {
    ProceduralShader::new(\"stripes\", \"stripes across y\", |anchor| Box::new(Stripes(anchor)))
}

struct Stripes(Anchor);

impl Shader for Stripes {
    fn ambient(&self, material: &Material, at: DVec3) -> Rgb {
        let stripe = (10.0 * (at - self.0.origin).y / self.0.unit).floor();
        if stripe.rem_euclid(2.0) == 0.0 { material.ambient } else { Rgb::ZERO }
    }
}
";
