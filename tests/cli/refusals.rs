//! What the program says where it does not do what it was asked to, apart from the faults of scenes.

mod common;

use common::program::{folder, outcome, scene, tabray};
use common::root;
use image::DynamicImage;
use insta::Settings;
use std::fs;
use tempfile::TempDir;

/// A working directory with a sound scene, a scene with a texture, and something in the way of a picture.
fn workplace() -> TempDir {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    fs::copy(scene("sphere/in-front.ray"), at("ball.ray")).expect("a copy");
    fs::copy(scene("textures/bricks.png"), at("bricks.png")).expect("a copy");
    fs::write(at("textured.ray"), TEXTURED).expect("a file");
    fs::write(at("large.ray"), "camera eye { pixeldim 9000 9000  worlddim 8 6  viewpoint 4 3 6 }")
        .expect("a file");
    fs::write(at("tall.ray"), "camera eye { pixeldim 1 100  worlddim 8 6  viewpoint 4 3 6 }")
        .expect("a file");
    DynamicImage::new_rgb8(4, 3).save(at("small.png")).expect("a picture");
    DynamicImage::new_rgba8(4, 3).save(at("clear.png")).expect("a picture");
    fs::write(at("vast.png"), vast()).expect("a file");
    fs::create_dir(at("odd")).expect("a folder");
    for (name, text) in ODD {
        fs::write(at("odd").join(name), text).expect("a file");
    }
    fs::create_dir(at("odd/folder.snap.new.png")).expect("a folder");
    fs::create_dir_all(at("folder.png/wall")).expect("a folder");
    fs::write(at("protected.png"), "precious").expect("a file");
    let mut permissions = fs::metadata(at("protected.png")).expect("there").permissions();
    permissions.set_readonly(true);
    fs::set_permissions(at("protected.png"), permissions).expect("read-only");
    folder
}

/// A PNG that says it has 70000 x 70000 pixels.
fn vast() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 70_000, 70_000);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header().expect("memory takes it");
    writer.write_chunk(png::chunk::IDAT, &[0; 9]).expect("memory takes it");
    drop(writer);
    bytes
}

/// Files that are named as pending snapshots and are none.
const ODD: [(&str, &str); 5] = [
    ("broken.snap.new", "---\nextension: png\nsnapshot_kind: binary\n---\n"),
    ("broken.snap.new.png", "no picture"),
    ("folder.snap.new", "---\nextension: png\nsnapshot_kind: binary\n---\n"),
    ("headless.snap.new", "a text\n"),
    ("nameless.snap.new", "---\nsnapshot_kind: binary\n---\n"),
];

const TEXTURED: &str = "camera eye { pixeldim 8 6  worlddim 8 6  viewpoint 4 3 6 }
material white { ambient 2 2 2 }
texture bricks { filename bricks.png }
texplane wall { material white  normal 0 0 1  point 0 0 -8  xdir 1 0 0  dimensions 8 6  texname bricks  mode 0 }";

#[test]
fn every_refusal_is_explained_as_before() {
    let mut settings = Settings::clone_current();
    settings.set_snapshot_path(root().join("snapshots/refusals"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    for (name, line) in REFUSALS {
        let folder = workplace();
        let (status, out, err) = outcome(tabray(&folder).args(line.split(' ')));
        assert!(status == 1 || status == 2, "{line}: {status}");
        assert!(out.is_empty(), "{line} prints nothing but its message");
        assert_eq!(fs::read(folder.path().join("protected.png")).expect("still there"), b"precious");
        let told = format!("$ tabray {line}\n{err}[exit status {status}]");
        settings.bind(|| insta::assert_snapshot!(name, told));
    }
}

/// A name for each refusal, and the command line that it answers.
const REFUSALS: [(&str, &str); 55] = [
    ("scene-not-there", "render bell.ray"),
    ("scene-not-there-nor-one-like-it", "check no-such-scene.ray"),
    ("scene-is-a-folder", "dump ."),
    ("picture-without-a-format", "render ball.ray -o ball.jpeg"),
    ("picture-in-no-folder", "render ball.ray -o no/such/folder/ball.png"),
    ("picture-is-a-folder", "render ball.ray -o folder.png"),
    ("picture-is-read-only", "render ball.ray -o protected.png"),
    ("picture-of-standard-input", "render -"),
    ("samples-out-of-range", "render ball.ray --samples 0"),
    ("size-of-nothing", "render ball.ray --size 0x600"),
    ("size-with-too-many-rows", "render tall.ray --size 5000"),
    ("size-too-large", "render ball.ray --size 100000x100001"),
    ("quick-and-size", "render ball.ray --quick --size 80"),
    ("crop-outside", "render ball.ray --crop 150,0,20,20"),
    ("crop-of-three-numbers", "render ball.ray --crop 1,2,3"),
    ("method-with-accuracy", "render ball.ray --method classic --accuracy draft"),
    ("aov-beside-standard-output", "render ball.ray -o - --aov depth"),
    ("aov-too-large", "render large.ray --aov depth"),
    ("aov-unknown", "render ball.ray --aov deepness"),
    ("debug-at-no-pixel", "render ball.ray --debug pix --at 160,0"),
    ("debug-at-half-a-pixel", "render ball.ray --debug pix --at 1.5,0"),
    ("probe-outside", "probe ball.ray 160 120"),
    ("verify-without-a-format", "verify ball.ray -o proof"),
    ("convert-to-no-spelling", "convert ball.ray ball"),
    ("convert-to-another-spelling", "convert ball.ray ball.toml --to ray"),
    ("convert-away-from-its-texture", "convert textured.ray folder.png/copy.toml"),
    ("convert-to-a-folder", "convert ball.ray folder.png --to ray"),
    ("list-misspelt", "list spere"),
    ("list-of-nothing-known", "list xylophone"),
    ("command-misspelt", "redner ball.ray"),
    ("option-misspelt", "render ball.ray --sample 4"),
    ("new-scene-in-the-place-of-another", "new scene ball"),
    ("new-scene-in-another-spelling", "new scene a.ray --toml"),
    ("new-plugin-outside-of-a-checkout", "new plugin gem"),
    ("chart-in-the-place-of-a-file", "chart ball.ray -o ball.ray"),
    ("man-in-the-place-of-a-file", "man ball.ray"),
    ("resume-to-standard-output", "render ball.ray -o - --resume"),
    ("memory-of-no-size", "render ball.ray --max-memory lots"),
    ("time-of-no-length", "render ball.ray --time-limit soon"),
    ("cpu-unknown", "render ball.ray --cpu mmx"),
    ("format-unknown", "render ball.ray --format gif"),
    ("diff-of-no-picture", "diff ball.ray bricks.png"),
    ("diff-of-two-sizes", "diff bricks.png small.png"),
    ("diff-of-transparency", "diff clear.png bricks.png"),
    ("diff-of-a-vast-picture", "diff bricks.png vast.png"),
    ("diff-into-no-page", "diff bricks.png bricks.png -o page.txt"),
    ("review-of-no-snapshot", "review odd"),
    ("review-of-nothing", "review nowhere"),
    ("review-of-nothing-pending", "review ball.ray"),
    ("watch-of-standard-input", "watch -"),
    ("watch-not-there", "watch bell.ray"),
    ("bench-of-no-time", "bench ball.ray --seconds -1"),
    ("choose-without-a-limit", "choose ball.ray"),
    ("choose-without-an-error", "choose ball.ray --max-error 0"),
    ("chart-not-there", "chart bell.ray"),
];

#[test]
fn every_snapshot_is_of_a_refusal() {
    for entry in fs::read_dir(root().join("snapshots/refusals")).expect("the snapshots") {
        let path = entry.expect("an entry").path();
        // What is pending is of another test's concern.
        if path.extension() != Some("snap".as_ref()) {
            continue;
        }
        let name = path.file_stem().and_then(|stem| stem.to_str()).expect("a name in UTF-8");
        let is_known = name == PLUGINS || REFUSALS.iter().any(|(known, _)| *known == name);
        assert!(is_known, "{} is of nothing", path.display());
    }
}

/// The snapshot of `tests/readme.rs`, which builds plugins that contradict each other.
const PLUGINS: &str = "plugins-that-contradict-each-other";
