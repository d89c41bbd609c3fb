//! Messages where the program refuses a request, apart from the faults of scenes.

use crate::common::program::{folder, outcome, scene, tabray};
use crate::common::{root, snapshots};
use image::DynamicImage;
use std::fs;
use tempfile::TempDir;

/// Makes a working directory with the scenes, images and folders that the refusals need.
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

/// Makes a PNG that claims to have 70000 x 70000 pixels.
fn vast() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 70_000, 70_000);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header().expect("memory takes it");
    writer.write_chunk(png::chunk::IDAT, &[0; 9]).expect("memory takes it");
    drop(writer);
    bytes
}

/// Files that are named like pending snapshots and are not valid ones.
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

/// Runs a command line that is refused, and compares the messages with the snapshot of this name.
fn is_explained_as_before(name: &str, line: &str) {
    let settings = snapshots("refusals");
    let folder = workplace();
    let (status, out, err) = outcome(tabray(&folder).args(line.split(' ')));
    assert!(status == 1 || status == 2, "{line}: {status}");
    assert!(out.is_empty(), "{line} prints nothing but its message");
    assert_eq!(fs::read(folder.path().join("protected.png")).expect("still there"), b"precious");
    let told = format!("$ tabray {line}\n{err}[exit status {status}]");
    settings.bind(|| insta::assert_snapshot!(name.replace('_', "-"), told));
}

/// Defines a test for each refusal, with the command line that causes it.
macro_rules! refusals {
    ($($name:ident: $line:literal,)*) => {
        const REFUSALS: &[&str] = &[$(stringify!($name)),*];

        $(#[test]
        fn $name() {
            is_explained_as_before(stringify!($name), $line);
        })*
    };
}

refusals! {
    scene_not_there: "render bell.ray",
    scene_not_there_nor_one_like_it: "check no-such-scene.ray",
    scene_is_a_folder: "dump .",
    picture_without_a_format: "render ball.ray -o ball.jpeg",
    picture_in_no_folder: "render ball.ray -o no/such/folder/ball.png",
    picture_is_a_folder: "render ball.ray -o folder.png",
    picture_is_read_only: "render ball.ray -o protected.png",
    picture_of_standard_input: "render -",
    samples_out_of_range: "render ball.ray --samples 0",
    samples_with_a_fraction: "render ball.ray --samples 4.5",
    size_of_nothing: "render ball.ray --size 0x600",
    size_with_too_many_rows: "render tall.ray --size 5000",
    size_too_large: "render ball.ray --size 100000x100001",
    quick_and_size: "render ball.ray --quick --size 80",
    crop_outside: "render ball.ray --crop 150,0,20,20",
    crop_of_three_numbers: "render ball.ray --crop 1,2,3",
    method_with_accuracy: "render ball.ray --method classic --accuracy draft",
    aov_beside_standard_output: "render ball.ray -o - --aov depth",
    aov_too_large: "render large.ray --aov depth",
    aov_unknown: "render ball.ray --aov deepness",
    debug_at_no_pixel: "render ball.ray --debug pix --at 160,0",
    debug_at_half_a_pixel: "render ball.ray --debug pix --at 1.5,0",
    probe_outside: "probe ball.ray 160 120",
    verify_without_a_format: "verify ball.ray -o proof",
    convert_to_no_spelling: "convert ball.ray ball",
    convert_to_another_spelling: "convert ball.ray ball.toml --to ray",
    convert_away_from_its_texture: "convert textured.ray folder.png/copy.toml",
    convert_to_a_folder: "convert ball.ray folder.png --to ray",
    list_misspelt: "list spere",
    list_of_nothing_known: "list xylophone",
    command_misspelt: "redner ball.ray",
    option_misspelt: "render ball.ray --sample 4",
    scene_without_a_command: "ball.ray",
    several_scenes_into_one_image: "render ball.ray textured.ray -o both.png",
    several_scenes_with_one_name: "render ball.ray odd/ball.toml",
    several_scenes_and_standard_input: "render ball.ray -",
    several_scenes_resumed_to_standard_output: "render ball.ray textured.ray -o -",
    new_scene_in_the_place_of_another: "new scene ball",
    new_scene_in_another_spelling: "new scene a.ray --toml",
    new_plugin_outside_of_a_checkout: "new plugin gem",
    chart_in_the_place_of_a_file: "chart ball.ray -o ball.ray",
    man_in_the_place_of_a_file: "man ball.ray",
    resume_to_standard_output: "render ball.ray -o - --resume",
    memory_of_no_size: "render ball.ray --max-memory lots",
    time_of_no_length: "render ball.ray --time-limit soon",
    cpu_unknown: "render ball.ray --cpu mmx",
    format_unknown: "render ball.ray --format gif",
    diff_of_no_picture: "diff ball.ray bricks.png",
    diff_of_two_sizes: "diff bricks.png small.png",
    diff_of_transparency: "diff clear.png bricks.png",
    diff_of_a_vast_picture: "diff bricks.png vast.png",
    diff_into_no_page: "diff bricks.png bricks.png -o page.txt",
    review_of_no_snapshot: "review odd",
    review_of_nothing: "review nowhere",
    review_of_nothing_pending: "review ball.ray",
    watch_of_standard_input: "watch -",
    watch_not_there: "watch bell.ray",
    bench_of_no_time: "bench ball.ray --seconds -1",
    choose_without_a_limit: "choose ball.ray",
    choose_without_an_error: "choose ball.ray --max-error 0",
    choose_with_the_error_of_white: "choose ball.ray --max-error 100%",
    choose_with_a_part_of_white: "choose ball.ray --max-error 0.01",
    render_with_a_part_of_white: "render ball.ray --max-error 0.01",
    chart_not_there: "chart bell.ray",
}

#[test]
fn every_snapshot_is_of_a_refusal() {
    for entry in fs::read_dir(root().join("snapshots/refusals")).expect("the snapshots") {
        let path = entry.expect("an entry").path();
        // Pending snapshots concern another test.
        if path.extension() != Some("snap".as_ref()) {
            continue;
        }
        let name = path.file_stem().and_then(|stem| stem.to_str()).expect("a name in UTF-8");
        let is_known = name == PLUGINS || REFUSALS.iter().any(|known| known.replace('_', "-") == name);
        assert!(is_known, "{} is of nothing", path.display());
    }
}

/// The snapshot of `tests/slow/plugins.rs`, which builds plugins that contradict each other.
const PLUGINS: &str = "plugins-that-contradict-each-other";
