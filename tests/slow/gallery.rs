//! The charts of the docs: writes the images that `docs/accuracy.md` shows.
//!
//! `cargo test --profile dist --test slow -- --ignored --nocapture gallery`

use crate::common::root;
use assert_cmd::cargo::cargo_bin_cmd;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// The scenes whose charts the docs show.
const SCENES: [&str; 1] = ["hard/flange-from-above"];

/// The place of the first panel in a chart: left, top, width and height.
const PANEL: [u32; 4] = [0, 104, 520, 566];

/// Runs the program, which must succeed, and returns its standard output.
fn tabray(arguments: &[&str], folder: &Path) -> String {
    let output = cargo_bin_cmd!("tabray").current_dir(folder).args(arguments).output().expect("it runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

/// Asserts that a chart shows the name of every choice, however crowded it is. The choices of samples are left out,
/// because their names are numbers, which axes have, too; so are choices that find nothing, which have no error and no
/// place in the chart.
fn every_choice_has_its_name(table: &str, drawing: &str) {
    let rows = table.lines().skip(1).filter(|row| !row.starts_with("\"samples"));
    let has_error = |row: &str| row.rsplit(',').nth(8).is_some_and(|error| error != "NaN");
    let mut names: Vec<_> =
        rows.filter(|row| has_error(row)).filter_map(|row| row.split('"').nth(3)).collect();
    names.sort_unstable();
    for same in names.chunk_by(|one, other| one == other) {
        let drawn = drawing.lines().filter(|line| line.starts_with(same[0])).count();
        assert!(drawn >= same.len(), "{} names of {} points `{}`", drawn, same.len(), same[0]);
    }
}

#[test]
#[ignore = "runs for minutes; its times are a document"]
fn the_gallery_of_charts_is_drawn() {
    let pictures = root().join("docs/charts");
    let folder = TempDir::new().expect("a folder");
    for scene in SCENES {
        let path = root().join("scenes").join(scene).with_extension("ray");
        let verdict =
            tabray(&["chart", path.to_str().expect("UTF-8"), "-o", ".", "--time-limit", "1h"], folder.path());
        let name = path.file_stem().expect("a name").to_str().expect("UTF-8");
        let file = |extension: &str| folder.path().join(format!("{name}-chart.{extension}"));
        fs::copy(file("csv"), pictures.join(format!("{name}.csv"))).expect("a copy");
        // The first panel alone can be read on a phone.
        let chart = image::open(file("png")).expect("a picture");
        let [left, top, width, height] = PANEL;
        let panel = chart.crop_imm(left, top, width, height);
        panel.save(pictures.join(format!("{name}.png"))).expect("room for a picture");
        let read = |extension: &str| fs::read_to_string(file(extension)).expect("it is written");
        every_choice_has_its_name(&read("csv"), &read("svg"));
        println!("{scene}\n{verdict}");
    }
    for method in ["classic", "exact"] {
        let picture = format!("{method}.png");
        let scene = root().join("scenes/hard/ripples.ray");
        let scene = scene.to_str().expect("UTF-8");
        let arguments = ["render", scene, "--method", method, "--aov", "cost,error", "-o", &picture];
        tabray(&arguments, folder.path());
        for aov in ["cost", "error"] {
            let name = format!("{method}-{aov}.png");
            // The cost of the two is about the same.
            if name != "exact-cost.png" {
                fs::copy(folder.path().join(&name), pictures.join(format!("ripples-{name}")))
                    .expect("a copy");
            }
        }
    }
}
