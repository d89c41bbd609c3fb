//! The first hour with the program: what a stranger types, and what the program answers. The messages about scenes of
//! other programs are snapshots, of `scenes/wrong/`.

use crate::common::program::{folder, names_in, outcome, scene, tabray};
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// Makes a working directory with a few scenes: two that are sound, one that is faulty.
fn workplace() -> TempDir {
    let folder = folder();
    let copy = |from: &str, to: &str| fs::copy(scene(from), folder.path().join(to)).expect("a copy");
    copy("sphere/in-front.ray", "a.ray");
    copy("material/glint.ray", "b.ray");
    copy("wrong/zero-radius.ray", "faulty.ray");
    folder
}

/// Returns the texts of a PNG, each with its keyword.
fn texts(path: &Path) -> Vec<(String, String)> {
    let file = std::io::BufReader::new(fs::File::open(path).expect("an image"));
    let reader = png::Decoder::new(file).read_info().expect("a PNG");
    let info = reader.info();
    let plain = info.uncompressed_latin1_text.iter().map(|text| (text.keyword.clone(), text.text.clone()));
    let wide = info.utf8_text.iter().map(|text| (text.keyword.clone(), text.get_text().expect("UTF-8")));
    plain.chain(wide).collect()
}

#[cfg(target_os = "linux")]
#[test]
fn the_program_alone_on_a_terminal_prints_its_help() {
    let terminal = nix::pty::openpty(None, None).expect("a terminal");
    let output = Command::new(assert_cmd::cargo::cargo_bin!("tabray"))
        .stdin(terminal.slave)
        .output()
        .expect("the program runs, and does not wait for input");
    let help = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{help}");
    assert!(help.contains("Usage: tabray") && help.contains("render"), "{help}");
}

#[test]
fn the_first_help_fits_on_one_screen() {
    let folder = folder();
    let [help, short] = ["help", "-h"].map(|word| {
        let (status, help, _) = outcome(tabray(&folder).arg(word));
        assert_eq!(status, 0);
        String::from_utf8(help).expect("text")
    });
    assert_eq!(help, short);
    let longest = help.lines().map(|line| line.chars().count()).max();
    assert!(help.lines().count() <= 24 && longest <= Some(80), "{help}");
}

#[test]
fn a_scene_in_the_place_of_a_command_is_told_from_a_misspelt_command() {
    let folder = workplace();
    for word in ["a.ray", "no-such-scene.ray", "dir/b.TOML"] {
        let (status, _, err) = outcome(tabray(&folder).arg(word));
        assert_eq!(status, 2);
        assert!(err.contains(&format!("`{word}` is a scene, not a command")), "{err}");
        assert!(err.contains(&format!("`tabray render {word}` renders it")), "{err}");
    }
    let (_, _, err) = outcome(tabray(&folder).args(["--samples", "4", "a.ray"]));
    assert!(err.contains("`tabray render a.ray` renders it"), "{err}");
    let (_, _, err) = outcome(tabray(&folder).arg("redner"));
    assert!(err.contains("'render'"), "{err}");
}

#[test]
fn a_folder_stands_for_the_scenes_in_it() {
    let folder = workplace();
    fs::write(folder.path().join("notes.txt"), "no scene").expect("a file");
    fs::create_dir(folder.path().join("alone")).expect("a folder");
    fs::copy(scene("sphere/in-front.ray"), folder.path().join("alone/one.ray")).expect("a copy");

    let (status, _, err) = outcome(tabray(&folder).args(["render", ".", "-o", "images", "--size", "8"]));
    assert_eq!(status, 2, "{err}");
    assert!(err.contains("1 of 3 scenes could not be rendered: `./faulty.ray`"), "{err}");
    assert_eq!(names_in(&folder.path().join("images")), ["a.png", "b.png"]);

    // Its only scene has its image in a folder, too.
    let (status, _, err) = outcome(tabray(&folder).args(["render", "alone", "-o", "other", "--size", "8"]));
    assert_eq!(status, 0, "{err}");
    assert_eq!(names_in(&folder.path().join("other")), ["one.png"]);

    let (status, _, err) = outcome(tabray(&folder).args(["check", "alone", "a.ray"]));
    assert!(status == 0 && err.contains("one.ray: no errors") && err.contains("a.ray: no errors"), "{err}");
    let (status, _, err) = outcome(tabray(&folder).args(["check", "images"]));
    assert!(status == 1 && err.contains("there is no scene in the folder `images`"), "{err}");
}

#[test]
fn several_scenes_are_rendered_beside_each_other_and_counted() {
    let folder = workplace();
    let (status, out, err) = outcome(tabray(&folder).args(["render", "a.ray", "b.ray"]));
    assert_eq!((status, out.len()), (0, 0), "{err}");
    let lines: Vec<_> = err.lines().collect();
    assert!(lines[0].starts_with("[1/2] wrote a.png ("), "{err}");
    assert!(lines[1].starts_with("[2/2] wrote b.png ("), "{err}");
    assert!(lines[2].starts_with("rendered 2 scenes in "), "{err}");
    assert_eq!(names_in(folder.path()), ["a.png", "a.ray", "b.png", "b.ray", "faulty.ray"]);
    let (status, _, err) = outcome(tabray(&folder).args(["render", "a.ray", "b.ray", "-o", "new/images"]));
    assert_eq!(status, 0, "{err}");
    assert_eq!(names_in(&folder.path().join("new/images")), ["a.png", "b.png"]);
    let (status, _, err) =
        outcome(tabray(&folder).args(["render", "a.ray", "-o", "one/", "--format", "ppm"]));
    assert_eq!(status, 0, "{err}");
    assert!(err.starts_with("[1/1] wrote one/a.ppm ("), "{err}");
}

#[test]
fn several_scenes_are_all_tried_and_the_worst_status_is_that_of_all() {
    let folder = workplace();
    let (status, _, err) = outcome(tabray(&folder).args(["render", "faulty.ray", "none.ray", "a.ray"]));
    assert_eq!(status, 2, "{err}");
    assert!(err.contains("[3/3] wrote a.png"), "{err}");
    assert!(err.ends_with("error: 2 of 3 scenes could not be rendered: `faulty.ray`, `none.ray`\n"), "{err}");
    let (status, _, err) = outcome(tabray(&folder).args(["render", "none.ray", "a.ray"]));
    assert_eq!(status, 1, "{err}");
    let (status, _, err) = outcome(tabray(&folder).args(["check", "none.ray", "a.ray"]));
    assert_eq!(status, 1);
    assert!(err.ends_with("a.ray: no errors\n"), "{err}");
    let (status, ..) = outcome(tabray(&folder).args(["check", "none.ray", "faulty.ray"]));
    assert_eq!(status, 2);
}

#[test]
fn several_scenes_are_told_as_json_too() {
    let folder = workplace();
    let (status, _, err) =
        outcome(tabray(&folder).args(["render", "a.ray", "faulty.ray", "--message-format", "json"]));
    assert_eq!(status, 2);
    let levels: Vec<_> = err
        .lines()
        .map(|line| serde_json::from_str::<serde_json::Value>(line).expect("JSON")["level"].to_string())
        .collect();
    assert_eq!(levels, ["\"note\"", "\"error\"", "\"error\""]);
}

#[test]
fn a_quiet_program_prints_errors_and_warnings_alone() {
    let folder = workplace();
    for args in [["-q", "render", "a.ray"], ["render", "--quiet", "a.ray"], ["check", "a.ray", "-q"]] {
        let (status, out, err) = outcome(tabray(&folder).args(args));
        assert_eq!((status, out.len(), err.as_str()), (0, 0, ""), "{args:?}");
    }
    let (status, _, err) = outcome(tabray(&folder).args(["render", "-q", "a.ray", "faulty.ray"]));
    assert_eq!(status, 2);
    assert!(err.starts_with("error: ") && !err.contains("wrote"), "{err}");
}

#[test]
fn colours_of_messages_can_be_forced_and_forbidden() {
    let folder = workplace();
    let told = |color: &str, args: &[&str]| outcome(tabray(&folder).args(args).args(["--color", color])).2;
    assert!(told("always", &["check", "faulty.ray"]).contains("\x1b["));
    assert!(!told("never", &["check", "faulty.ray"]).contains("\x1b["));
    assert!(!told("auto", &["check", "faulty.ray"]).contains("\x1b["));
    assert!(
        told("always", &["a.ray"]).contains("\x1b["),
        "a command line that cannot be parsed has colours too"
    );
}

#[test]
fn an_image_carries_what_made_it() {
    let folder = workplace();
    let render = |args: &[&str]| {
        let (status, _, err) = outcome(tabray(&folder).args(["render", "a.ray"]).args(args));
        assert_eq!(status, 0, "{err}");
        fs::read(folder.path().join("a.png")).expect("the image")
    };
    let first = render(&[]);
    let carried = texts(&folder.path().join("a.png"));
    let keywords: Vec<_> = carried.iter().map(|(keyword, _)| keyword.as_str()).collect();
    assert_eq!(keywords, ["Software", "tabray scene", "tabray options"]);
    assert!(carried[0].1.starts_with("tabray "));
    assert!(carried[1].1.starts_with("sha256:") && carried[1].1.len() == 7 + 64);
    assert_eq!(carried[2].1, "--size 160x120 --samples 1 --accuracy exact");
    // The same things have the same bytes, however they are computed.
    assert!(first == render(&["--threads", "3"]) && first == render(&["--cpu", "baseline"]));
    let pixels = |bytes: &[u8]| image::load_from_memory(bytes).expect("a PNG").into_rgb8();
    let other = render(&["--accuracy", "strict"]);
    assert!(first != other && pixels(&first) == pixels(&other));
    fs::write(folder.path().join("old.png"), &first).expect("a file");
    let (status, out, _) = outcome(tabray(&folder).args(["diff", "old.png", "a.png"]));
    assert_eq!((status, String::from_utf8_lossy(&out).as_ref()), (0, "none of 19200 pixels differs\n"));
}

#[test]
fn the_options_that_an_image_carries_make_it_again() {
    let folder = workplace();
    let path = folder.path().join("a.png");
    for options in [
        &["--samples", "4..16", "--crop", "10,20,60,50", "--exposure", "-0.5"][..],
        &["--samples", "9", "--sampler", "random", "--method", "classic", "--size", "40x30"],
        &["--set", "near.radius=1.5", "--set", "red.ambient=0 \"3 * 2\" 0", "--size", "80"],
        &["--max-error", "4"],
    ] {
        // Images of other sizes are replaced.
        let (status, _, err) = outcome(tabray(&folder).args(["render", "a.ray", "--force"]).args(options));
        assert_eq!(status, 0, "{err}");
        let first = fs::read(&path).expect("the image");
        let carried = texts(&path).pop().expect("the options").1;
        let program = assert_cmd::cargo::cargo_bin!("tabray").display();
        let line = format!("{program} render a.ray {carried}");
        let again =
            Command::new("sh").args(["-c", &line]).current_dir(folder.path()).output().expect("sh runs");
        assert!(again.status.success(), "{line}: {}", String::from_utf8_lossy(&again.stderr));
        assert!(first == fs::read(&path).expect("the image"), "{line}");
    }
}

#[cfg(unix)]
#[test]
fn the_older_program_is_given_the_values_that_are_set() {
    use std::os::unix::fs::PermissionsExt;
    let folder = workplace();
    let old = folder.path().join("old-tabray");
    fs::write(&old, "#!/bin/sh\necho \"called with $*\"\n").expect("a script");
    fs::set_permissions(&old, fs::Permissions::from_mode(0o755)).expect("permissions");
    let run = |args: &[&str]| outcome(tabray(&folder).args(args));
    assert_eq!(run(&["render", "a.ray", "-o", "one.png"]).0, 0);
    assert_eq!(run(&["render", "a.ray", "-o", "two.png", "--set", "near.radius=2"]).0, 0);
    let page = ["diff", "one.png", "two.png", "-o", "page.html", "--scene", "a.ray"];
    let (status, out, err) =
        run(&[&page[..], &["--set", "near.radius=2", "--before", "./old-tabray"]].concat());
    assert_eq!(status, 1, "{err}");
    let told = String::from_utf8_lossy(&out).into_owned();
    assert!(told.contains("\nfirst at ") && told.lines().count() <= 3, "{told}");
    let html = fs::read_to_string(folder.path().join("page.html")).expect("the page");
    assert!(
        html.contains("called with probe a.ray --set near.radius=2 "),
        "the page has the old explanation"
    );
}

#[test]
fn a_chart_writes_the_file_that_is_named_and_begins_with_what_to_do() {
    let folder = workplace();
    let text = fs::read_to_string(folder.path().join("a.ray")).expect("a scene").replace("160 120", "8 6");
    fs::write(folder.path().join("tiny.ray"), text).expect("a file");
    let before = names_in(folder.path());
    let (status, out, err) =
        outcome(tabray(&folder).args(["chart", "tiny.ray", "-o", "a.svg", "--time-limit", "1h"]));
    assert_eq!((status, err.lines().last()), (0, Some("wrote a.svg")), "{err}");
    assert!(String::from_utf8_lossy(&out).starts_with("What to do:\n  "));
    assert!(fs::read_to_string(folder.path().join("a.svg")).expect("the chart").contains("<svg"));
    assert_eq!(names_in(folder.path()).len(), before.len() + 1);
}

/// What beginners write in place of the language's own words has its cure.
#[test]
fn what_beginners_write_is_told_with_the_cure() {
    let folder = folder();
    let scene = "camera eye { pixeldim 160 120  worlddim 8 6  viewpoint 4 3 6 }\n\
        material blue { ambient 0.5 0.5 1 }\nsphere ball { material blue  center 4 2 -4  radius 2 }\n";
    for (from, to, cure) in [
        ("ambient 0.5 0.5 1", "ambient red", "`ambient 1 0 0`"),
        ("ambient 0.5 0.5 1", "ambient rgb(0.5, 0.5, 1)", "write `ambient 0.5 0.5 1`"),
        (
            "ambient 0.5 0.5 1",
            "ambient 0.5 0.5 1 diffuse 0.7",
            "a grey is three equal numbers: `diffuse 0.7 0.7 0.7`",
        ),
        ("ambient 0.5 0.5 1", "ambient 70%", "a grey is three equal numbers: `ambient 0.7 0.7 0.7`"),
        ("ambient 0.5 0.5 1", "ambient 70% 5% 100%", "write 70 percent as `0.7`"),
        ("ambient 0.5 0.5 1", "ambient rgb(70%, 5%, 100%)", "write `ambient 0.7 0.05 1`"),
        (
            "ambient 0.5 0.5 1",
            "ambient shiny",
            "such as `ambient 0.8 0.5 0.2`; the name of a material goes after `material`",
        ),
        (
            "ambient 0.5 0.5 1",
            "ambient 0.5 0.5 1 roughness 0.2",
            "`metal` and `plastic` have it; a material takes",
        ),
        ("radius 2", "radius 2 emission 1 1 1", "have it: write it there; a sphere takes"),
        (
            "radius 2",
            "radius 2 roughness 0.2",
            "`metal` and `plastic` have it: write it there; a sphere takes",
        ),
        ("radius 2", "radius 2 texture wood", "have it: `shader` takes the name of one; a sphere takes"),
        (
            "material blue { ambient 0.5 0.5 1",
            "metal blue { colour 1 1 1 diffuse 1 1 1",
            "`material` and `plastic` (as `colour`) have it; a metal takes",
        ),
        ("ambient 0.5 0.5 1", "ambient rgb(255,0,51)", "write `ambient 1 0 0.2`"),
        ("ambient 0.5 0.5 1", "ambient <0.5, 0.5, 1>", "write `0.5 0.5 1`"),
        ("ambient 0.5 0.5 1", "ambient \"0.5 0.5 1\"", "write numbers without quotes: `0.5 0.5 1`"),
        ("160 120", "160x120", "write `pixeldim 160 120`"),
        ("160 120", "160,120", "write `pixeldim 160 120`"),
        ("160 120", "160 120 samples 4x4", "4 x 4 samples are `samples 16`"),
        ("2 -4", "2 - 4", "write `center 4 2 -4`"),
        ("2 -4", "2 \u{2212}4", "write `center 4 2 -4`"),
        ("sphere ball", "sphere big ball", "a name is one word: `sphere big_ball {`"),
        ("sphere ball {", "sphere ball (", "attributes go in braces: `sphere ball { ... }`"),
        ("sphere ball {", "while (true) { sphere ball {", "write `repeat NAME COUNT { ENTITIES }`"),
        ("sphere ball {", "for (i = 0; i < 5; i++) sphere ball {", "write `repeat i 5 {`"),
    ] {
        fs::write(folder.path().join("a.ray"), scene.replace(from, to)).expect("a scene");
        let (status, _, said) = outcome(tabray(&folder).args(["check", "a.ray"]));
        assert!(status == 2 && said.contains(cure), "{to}: {said}");
    }
    let toml = "[camera.eye]\npixeldim = [160, 120]\nworlddim = [8, 6]\nviewpoint = \"4 3 6\"\n";
    fs::write(folder.path().join("a.toml"), toml).expect("a scene");
    let (_, _, said) = outcome(tabray(&folder).args(["check", "a.toml"]));
    assert!(said.contains("write numbers without quotes: `[4, 3, 6]`"), "{said}");
}
