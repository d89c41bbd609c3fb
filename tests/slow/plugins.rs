//! What the docs tell authors of plugins: the page's plugin is dropped in and works, mistakes are told as the page has
//! it, and the crate of its own builds and runs.

mod common;

use common::copy::{Copy, copy_all};
use common::{block_with, root};
use std::fs;

fn page() -> String {
    fs::read_to_string(root().join("docs/plugins.md")).expect("the page")
}

/// Whether the page has a message.
fn tells(message: &str) -> bool {
    page().contains(message)
}

#[test]
fn the_pages_plugin_is_made_as_it_says_and_its_mistakes_are_told() {
    let copy = Copy::new("documented");
    let plugin = copy.folder.join("plugins/box.rs");
    fs::write(&plugin, "").expect("room for a file");
    // A constructor that asks for what is not in its table.
    let forgetful = block_with(&page(), "struct Brick").replace("&[&CENTER, &SIZE]", "&[&CENTER]");
    fs::write(copy.folder.join("plugins/brick.rs"), forgetful.replace("\"box\"", "\"brick\"")).expect("room");
    // One that takes three numbers for one.
    let confused = block_with(&page(), "struct Brick")
        .replace(
            "const TABLE",
            "static WIDE: Pparm<f64> = Pparm::required(\"size\", \"its width\");\n\nconst TABLE",
        )
        .replace("0.5 * args.get(&SIZE)", "DVec3::splat(0.5 * args.get(&WIDE))");
    fs::write(copy.folder.join("plugins/slab.rs"), confused.replace("\"box\"", "\"slab\"")).expect("room");
    let said = copy.build();
    let warning = "plugins/box.rs registers nothing, so that no scene can use it";
    assert!(said.contains(warning) && tells(warning), "{said}");
    assert!(!copy.prints(&["list"]).contains("box "));

    let scene = "camera eye { pixeldim 1 1 worlddim 8 6 viewpoint 4 3 6 } material m { ambient 1 1 1 }
        brick b { material m center 1 1 1 }";
    let said = copy.run(&["check", "-"], scene);
    let message = |name: &str| {
        format!(
            "the plugin `{name}` asks for `size`, which is not in the table it registers at plugins/{name}.rs:17: add it there"
        )
    };
    assert!(said.contains("panicked at src/../plugins/brick.rs:"), "the plugin's own line is told: {said}");
    assert!(said.contains(&message("brick")) && tells(&message("box")), "{said}");
    let said = copy.run(
        &["check", "-"],
        &scene.replace("brick b", "slab b").replace("center 1 1 1", "center 1 1 1 size 1 1 1"),
    );
    let message = "the plugin `slab` asks for `size` as a type that is not the one in the table it registers at plugins/slab.rs:19: give both the same type";
    assert!(said.contains("panicked at src/../plugins/slab.rs:") && said.contains(message), "{said}");
    for plugin in ["brick.rs", "slab.rs"] {
        fs::remove_file(copy.folder.join("plugins").join(plugin)).expect("it was there");
    }

    fs::write(&plugin, block_with(&page(), "struct Brick").replace("\"box\"", "\"sphere\"")).expect("room");
    copy.build();
    let said = copy.run(&["list"], "");
    let message =
        "the entity type `sphere` is registered twice, at plugins/box.rs:17 and at plugins/sphere.rs:";
    assert!(said.contains(message) && tells(message), "{said}");

    fs::write(&plugin, block_with(&page(), "struct Brick")).expect("room for a file");
    assert!(!copy.build().contains("plugins/box.rs"), "the page's plugin gives no warning");
    let listed = block_with(&page(), "box NAME");
    assert_eq!(copy.prints(&["list", "box"]), listed);

    let scene = copy.outside("box.ray");
    fs::write(&scene, block_with(&page(), "box brick")).expect("room for a file");
    assert_shows(&copy, "tabray", scene.to_str().expect("a path in UTF-8"), "box");
}

#[test]
fn a_plugin_in_a_crate_of_its_own_is_a_program_of_its_own() {
    let copy = Copy::new("elsewhere");
    let folder = copy.folder.join("docs/example-plugin");
    fs::create_dir_all(folder.join("src")).expect("room for a folder");
    copy_all(&root().join("docs/example-plugin/src"), &folder.join("src"));
    fs::copy(root().join("docs/example-plugin/Cargo.toml"), folder.join("Cargo.toml")).expect("a copy");
    // With the crates that are here.
    fs::copy(root().join("Cargo.lock"), folder.join("Cargo.lock")).expect("a copy");
    copy.cargo(&folder, &["build", "--offline"]);

    assert!(copy.program_prints("example-plugin", &["list"]).contains("tangle "));
    let version = format!("example-plugin (tabray {})\n", env!("CARGO_PKG_VERSION"));
    assert_eq!(copy.program_prints("example-plugin", &["--version"]), version);
    for args in [&["--help"][..], &["render", "--help"], &["completions", "bash"], &["completions", "zsh"]] {
        let said = copy.program_prints("example-plugin", args);
        assert!(said.contains("example-plugin") && !said.contains("tabray "), "{args:?}: {said}");
    }
    assert!(
        copy.program_prints("example-plugin", &["render", "--help"])
            .contains("Usage: example-plugin render ")
    );
    let scene = root().join("docs/example-plugin/tangle.ray");
    assert_shows(&copy, "example-plugin", scene.to_str().expect("a path in UTF-8"), "tangle");
    let program = fs::read_to_string(folder.join("src/main.rs")).expect("a program");
    assert!(page().contains(&program), "the page shows another program");
}

/// The picture in the docs is the one that a program makes of a scene.
fn assert_shows(copy: &Copy, program: &str, scene: &str, name: &str) {
    let picture = copy.outside(name).with_extension("png");
    copy.program_prints(program, &["render", scene, "-o", picture.to_str().expect("a path in UTF-8")]);
    let open = |path| image::open(path).expect("a picture").into_rgb8();
    let shown = root().join("docs").join(name).with_extension("png");
    assert!(open(picture) == open(shown), "docs/{name}.png is stale: docs/plugins.md says how to make it");
}
