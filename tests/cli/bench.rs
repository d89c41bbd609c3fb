//! `tabray bench`: the numbers that it counts. Times are not tested.

use crate::common;
use crate::common::program::folder;
use crate::common::root;
use assert_cmd::cargo::cargo_bin_cmd;
use serde_json::Value;
use std::fs;
use tabray::scene;
use tabray::simd::Cpu;
use tabray::tools::bench::scenes;

/// Runs `tabray bench`, and returns the values that it prints in JSON.
fn measured(args: &[&str]) -> Vec<Value> {
    let run = cargo_bin_cmd!("tabray")
        .args(["bench", "--json", "--seconds", "0"])
        .args(args)
        .current_dir(root())
        .assert()
        .success();
    serde_json::from_slice(&run.get_output().stdout).expect("a list of scenes")
}

/// Returns the number of rays of a kind that a frame traces.
fn rays(scene: &Value, kind: &str) -> u64 {
    scene["rays"][kind]["rays"].as_u64().expect("a number of rays")
}

#[test]
fn bench_without_scenes_measures_those_that_are_built_in() {
    let measured = measured(&[]);
    let names: Vec<_> = measured.iter().map(|scene| scene["scene"].as_str().expect("a name")).collect();
    assert_eq!(names, ["3 planes and 2 spheres", "a vase", "1000 spheres", "20000 triangles"]);
    for scene in &measured {
        assert_eq!(rays(scene, "primary"), 640 * 480);
        assert!(scene["rays"]["all"]["rays_per_second"].as_f64().is_some_and(|rate| rate > 0.0), "{scene}");
        for tests in scene["tests"].as_array().expect("a list of entities") {
            assert!(tests["tests"].as_u64() > Some(0), "{tests}");
            assert!(tests["closest_ns"].as_f64().is_some_and(|time| time > 0.0), "{tests}");
        }
    }
    let share = |scene: &Value| scene["share_of_ceiling"].as_f64();
    assert!(share(&measured[0]).is_some_and(|share| 0.0 < share && share < 1.0), "{}", measured[0]);
    assert_eq!(share(&measured[1]), None, "no textbook has a formula for a vase");
}

#[test]
fn rays_are_counted_by_their_kind() {
    let [room, matt, dark, glass] = &measured(&[
        "scenes/material/facing-mirrors.ray",
        "scenes/light/shadow.ray",
        "scenes/entities/material.ray",
        "scenes/material/transparent.ray",
    ])[..] else {
        panic!("four scenes")
    };
    assert!(rays(room, "onward") > 0, "mirrors: {room}");
    assert!(rays(glass, "onward") > 0, "glass: {glass}");
    assert_eq!(rays(matt, "onward"), 0, "neither: {matt}");
    assert!(rays(matt, "shadow") > 0, "lights: {matt}");
    for scene in [room, matt, dark, glass] {
        let sum: u64 = ["primary", "shadow", "onward"].iter().map(|kind| rays(scene, kind)).sum();
        assert_eq!(sum, rays(scene, "all"), "each ray is of one kind: {scene}");
    }
}

#[test]
fn every_sample_is_a_ray() {
    let scene = &measured(&["scenes/camera/samples.ray"])[0];
    let pixels: u64 = scene["pixels"].as_array().expect("two").iter().filter_map(Value::as_u64).product();
    assert!(rays(scene, "primary") > pixels, "{scene}");
    assert_eq!(rays(scene, "primary") % pixels, 0, "{scene}");
}

#[test]
fn each_level_of_instructions_can_be_measured_and_casts_the_same_rays() {
    let counts: Vec<_> = Cpu::all()
        .map(|cpu| {
            let scene = &measured(&["--cpu", &cpu.to_string(), "scenes/light/shadow.ray"])[0];
            assert_eq!(scene["cpu"], cpu.to_string());
            (rays(scene, "primary"), rays(scene, "shadow"))
        })
        .collect();
    assert!(counts.windows(2).all(|pair| pair[0] == pair[1]), "{counts:?}");
}

#[test]
fn the_table_has_a_row_for_each_kind_and_each_entity() {
    let run = cargo_bin_cmd!("tabray")
        .args(["bench", "--seconds", "0", "scenes/light/shadow.ray"])
        .current_dir(root())
        .assert()
        .success();
    let table = String::from_utf8(run.get_output().stdout.clone()).expect("text");
    for row in
        ["scenes/light/shadow.ray: 160 x 120 pixels, ", "\nprimary ", "\nshadow ", "\nplane ", "\nsphere "]
    {
        assert!(table.contains(row), "{row}: {table}");
    }
}

#[test]
fn a_wrong_command_line_says_what_would_be_right() {
    for (status, args, message) in [
        (2, &["--seconds", "-1"][..], "must be from 0 to 3600 seconds"),
        (2, &["--seconds", "nan"], "must be from 0 to 3600 seconds"),
        (2, &["--cpu", "mmx"], "baseline"),
        (1, &["missing.ray"], "cannot read `missing.ray`"),
    ] {
        let run = cargo_bin_cmd!("tabray").arg("bench").args(args).assert().code(status);
        let told = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
        assert!(told.contains(message), "{told}");
        assert!(run.get_output().stdout.is_empty(), "nothing was measured");
    }
}

#[test]
fn a_scene_has_as_many_objects_as_it_is_asked_for() {
    for count in [10, 100, 1000] {
        for (scene, least) in [(scenes::spheres(count), count), (scenes::triangles(count), count * 8 / 10)] {
            let model = scene::build(common::registry(), scene).map(|built| built.model);
            let objects = model.unwrap_or_else(|report| panic!("{report}")).objects.len();
            assert!((least..=count).contains(&objects), "{objects} of {count}");
        }
    }
}

#[test]
fn what_is_kept_of_samples_is_not_measured_again() {
    let (folder, scene) = (tempfile::tempdir().expect("a folder"), "scenes/light/size.ray");
    let table = || {
        let kept = folder.path().to_str().expect("a name in Unicode");
        let run = cargo_bin_cmd!("tabray")
            .args(["bench", "--sampling", "rms", "--size", "8x6", "--keep", kept, scene])
            .current_dir(root())
            .assert()
            .success();
        String::from_utf8(run.get_output().stdout.clone()).expect("text")
    };
    let first = table();
    assert!(first.contains("| size | 4..64 |"), "{first}");
    assert_eq!(table(), first, "the times too");
}

#[test]
fn a_chart_of_sampling_does_not_replace_a_texture() {
    let folder = folder();
    let place = |name: &str| folder.path().join(name);
    fs::copy(root().join("scenes/textures/dusk.png"), place("dusk.png")).expect("a texture");
    let scene = "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 }
        texture dusk { filename dusk.png } material m { ambient 1 1 1 }
        texplane wall { material m normal 0 0 1 point 0 0 -4 xdir 1 0 0 dimensions 8 6 texname dusk mode 0 }";
    fs::write(place("wall.ray"), scene).expect("a scene");
    let before = fs::read(place("dusk.png")).expect("a texture");
    let run = cargo_bin_cmd!("tabray")
        .args(["bench", "wall.ray", "--sampling", "limits", "--size", "2x2", "-o", "dusk.png"])
        .current_dir(folder.path())
        .assert()
        .code(2);
    let said = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
    assert!(said.contains("`dusk.png` is the image of texture `dusk`"), "{said}");
    assert_eq!(fs::read(place("dusk.png")).expect("a texture"), before);
}
