//! Inside a pixel: `probe`, the notes' debug lines, and the auxiliary images.

use crate::common::{load, model, render, root, scenes, snapshots};
use assert_cmd::cargo::cargo_bin_cmd;
use glam::DVec3;
use std::fs;
use std::path::Path;
use tabray::render::{Plan, RayStats, Renderer, trace};
use tabray::tools::debug::{self, LogLine};
use tabray::tools::probe;
use tabray::tools::threads::renderer_with;
use tempfile::TempDir;

const ALL: [LogLine; 6] =
    [LogLine::Pix, LogLine::Hit, LogLine::Drgb, LogLine::Irgb, LogLine::Offset, LogLine::Find];

fn explained(scene: &str, x: usize, y: usize) -> String {
    let mut out = Vec::new();
    probe::pixel(&Plan::new(&load(&root().join("scenes").join(scene))), x, y, &mut out)
        .expect("memory takes it");
    String::from_utf8(out).expect("a text")
}

fn debugged(scene: &str, x: usize, y: usize, lines: &[LogLine]) -> String {
    let mut out = Vec::new();
    debug::pixel(&Plan::new(&load(&root().join("scenes").join(scene))), x, y, lines, &mut out)
        .expect("memory takes it");
    String::from_utf8(out).expect("a text")
}

#[test]
fn pixels_are_explained_as_before() {
    let settings = snapshots("probe");
    settings.bind(|| {
        insta::assert_snapshot!("in-the-light", explained("sphere/in-front.ray", 80, 60));
        insta::assert_snapshot!("nothing", explained("sphere/in-front.ray", 0, 119));
        insta::assert_snapshot!("in-shadow", explained("light/shadow.ray", 75, 30));
        insta::assert_snapshot!("through-glass", explained("material/coloured-shadow.ray", 80, 30));
        insta::assert_snapshot!("mirrored", explained("material/facing-mirrors.ray", 60, 60));
        insta::assert_snapshot!("too-far", explained("light/too-far.ray", 100, 65));
        insta::assert_snapshot!("beside-the-spot", explained("spotlight/edge.ray", 5, 5));
        insta::assert_snapshot!("sampled", explained("camera/samples.ray", 50, 50));
    });
}

/// Renders the tile of an image that a pixel is in, and returns the pixel's bytes. `y` counts from the bottom.
fn bytes(renderer: &Renderer, plan: &Plan, x: usize, y: usize) -> [u8; 3] {
    const TILE: usize = 16;
    let [width, height] = plan.camera.pixels;
    let tile = |at: usize, end: usize| at / TILE * TILE..end.min((at / TILE + 1) * TILE);
    let row = height - 1 - y;
    let (columns, rows) = (tile(x, width), tile(row, height));
    let pixel = (row - rows.start) * columns.len() + x - columns.start;
    let nobody = |_: RayStats| {};
    let bands = renderer.bands(plan, columns, rows, &nobody);
    let bytes: Vec<u8> = bands.flat_map(|band| band.bytes(usize::MAX).concat()).collect();
    [0, 1, 2].map(|channel| bytes[3 * pixel + channel])
}

#[test]
fn an_explanation_ends_with_the_bytes_of_the_picture() {
    let renderer = renderer_with(0).expect("threads");
    for path in scenes() {
        let model = load(&path);
        let [width, height] = model.camera.value.pixels;
        if path.ends_with("touching-mirrors.ray") || width * height > 160 * 120 {
            continue;
        }
        let plan = Plan::new(&model);
        for (x, y) in [(0, 0), (width / 2, height / 2), (width / 3, height / 4), (width - 1, height - 1)] {
            let mut out = Vec::new();
            probe::pixel(&plan, x, y, &mut out).expect("memory takes it");
            let text = String::from_utf8(out).expect("a text");
            let [r, g, b] = bytes(&renderer, &plan, x, y);
            let last = format!("bytes            ({r}, {g}, {b})\n");
            assert!(text.ends_with(&last), "{} at {x} {y}: not {last}\n{text}", path.display());
        }
    }
}

#[test]
fn debug_lines_are_those_of_the_notes() {
    // The formats of the notes' `fprintf` calls, in the order in which their program comes to them.
    let lines = [LogLine::Pix, LogLine::Find, LogLine::Hit, LogLine::Drgb, LogLine::Irgb, LogLine::Offset];
    assert_eq!(
        debugged("light/shadow.ray", 75, 30, &lines),
        fs::read_to_string(root().join("snapshots/probe/debug.txt")).expect("the accepted lines")
    );
    assert_eq!(debugged("notes/sphere.ray", 3, 4, &[LogLine::Pix]), "\nPIX    4    3 - ");
    assert_eq!(debugged("notes/sphere.ray", 3, 4, &[]), "");
}

#[test]
fn debug_prints_bytes_that_the_file_has_at_that_offset() {
    let scene = "sphere/through-the-floor.ray";
    let model = load(&root().join("scenes").join(scene));
    let picture = render(&model);
    let [width, height] = model.camera.value.pixels;
    for (x, y) in [(0, 0), (width / 2, height / 2), (width - 1, height - 1)] {
        let text = debugged(scene, x, y, &[LogLine::Irgb, LogLine::Offset]);
        let numbers: Vec<usize> = text
            .split(|c: char| !c.is_ascii_digit())
            .filter(|word| !word.is_empty())
            .map(|word| word.parse().expect("a number"))
            .collect();
        let [r, g, b, offset] = numbers[..] else { panic!("{text}") };
        assert_eq!([r, g, b].map(|byte| byte as u8), picture.as_raw()[3 * offset..][..3], "{x} {y}");
    }
}

#[test]
fn watching_changes_no_colour() {
    let model = load(&root().join("scenes/gallery/stained-glass.ray"));
    let plan = Plan::new(&model);
    for (x, y) in (0..640).step_by(53).zip((0..480).step_by(31)) {
        let mut out = Vec::new();
        debug::pixel(&plan, x, y, &ALL, &mut out).expect("memory takes it");
        let watched = trace::observe_pixel(&plan, x, y, &mut ());
        assert_eq!(trace::pixel(&plan, x, y), watched);
    }
}

/// Renders a scene with these images of `--aov`; returns the folder and the messages.
fn with_aov(scene: &Path, names: &str) -> (TempDir, String) {
    let folder = TempDir::new().expect("a folder");
    let output = cargo_bin_cmd!("tabray")
        .current_dir(folder.path())
        .arg("render")
        .arg(scene)
        .args(["-o", "a.png", "--aov", names])
        .output()
        .expect("the program runs");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    (folder, said)
}

#[test]
fn depth_and_normal_are_written_exactly() {
    let path = root().join("scenes/sphere/through-the-floor.ray");
    let (folder, _) = with_aov(&path, "depth,normal");
    let model = load(&path);
    let [width, height] = model.camera.value.pixels;
    let exact = |name: &str| image::open(folder.path().join(name)).expect("an EXR").into_rgb32f();
    let (depths, normals) = (exact("a-depth.exr"), exact("a-normal.exr"));
    assert_eq!(depths.dimensions(), (width as u32, height as u32));
    let plan = Plan::new(&model);
    let mut hits = 0;
    for (column, row, depth) in depths.enumerate_pixels() {
        let (x, y) = (column as usize, height - 1 - row as usize);
        let hit = trace::first_hit(&plan, &model.camera.value.sight(x as f64, y as f64));
        let expected = hit.as_ref().map_or(f32::INFINITY, |hit| hit.distance as f32);
        assert_eq!(depth.0, [expected; 3], "{x} {y}");
        let normal = hit.as_ref().map_or(DVec3::ZERO, |hit| hit.object.shape.normal(hit.point));
        assert_eq!(normals.get_pixel(column, row).0, normal.as_vec3().to_array(), "{x} {y}");
        hits += usize::from(hit.is_some());
    }
    assert!(hits > 1000, "{hits}");
}

#[test]
fn objects_differ_in_colour_and_near_is_brighter_than_far() {
    let path = root().join("scenes/sphere/through-the-floor.ray");
    let (folder, said) = with_aov(&path, "object,depth,cost");
    let model = load(&path);
    let (_, costly) = said.split_once("the most expensive pixel is ").expect("it is told");
    let words: Vec<_> = costly.lines().next().expect("a line").split(' ').collect();
    assert!(matches!(words[..], [_, _, "with", rays, "rays"] if rays != "0"), "{said}");
    let [width, height] = model.camera.value.pixels;
    let open = |name: &str| image::open(folder.path().join(name)).expect("a PNG").into_rgb8();
    let (objects, depths, costs) = (open("a-object.png"), open("a-depth.png"), open("a-cost.png"));
    assert_eq!(costs.pixels().map(|pixel| pixel.0[0]).max(), Some(255));
    let plan = Plan::new(&model);
    let mut seen = Vec::new();
    for (column, row, colour) in objects.enumerate_pixels() {
        let (x, y) = (column as usize, height - 1 - row as usize);
        let hit = trace::first_hit(&plan, &model.camera.value.sight(x as f64, y as f64));
        seen.push((hit.map(|hit| (hit.index, hit.distance)), colour.0, depths.get_pixel(column, row).0[0]));
    }
    assert_eq!(seen.len(), width * height);
    for (a, colour_of_a, depth_of_a) in seen.iter().step_by(7) {
        for (b, colour_of_b, depth_of_b) in seen.iter().step_by(911) {
            let same = a.map(|a| a.0) == b.map(|b| b.0);
            assert_eq!(colour_of_a == colour_of_b, same, "{a:?} {b:?}");
            let nearness = |hit: &Option<(usize, f64)>| hit.map_or(0.0, |(_, distance)| 1.0 / distance);
            assert!(nearness(a) <= nearness(b) || depth_of_a >= depth_of_b, "{a:?} {b:?}");
        }
    }
}

#[test]
fn costs_are_counted_where_only_a_part_of_a_light_shines() {
    let (folder, _) = with_aov(&root().join("scenes/light/size.ray"), "cost");
    let costs = image::open(folder.path().join("a-cost.png")).expect("a PNG").into_rgb8();
    assert!(
        costs.pixels().any(|pixel| pixel.0[0] < 255),
        "not every sample's ray meets the ball or the floor"
    );
}

#[test]
fn errors_are_where_edges_are_and_red_where_another_object_is_seen() {
    let folder = TempDir::new().expect("a folder");
    let render = |name: &str, method: &str| {
        let scene = root().join("scenes/hard/ripples.ray");
        let mut render = cargo_bin_cmd!("tabray");
        let render = render.current_dir(folder.path()).arg("render").arg(scene);
        let output =
            render.args(["--aov", "error", "-o", name, "--method", method]).output().expect("it runs");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success() && said.contains("\nthe greatest error is "), "{said}");
        let stem = name.trim_end_matches(".png");
        let picture =
            image::open(folder.path().join(format!("{stem}-error.png"))).expect("a PNG").into_rgb8();
        let exact =
            image::open(folder.path().join(format!("{stem}-error.exr"))).expect("an EXR").into_rgb32f();
        (picture, exact)
    };
    let (picture, exact) = render("exact.png", "exact");
    assert!(picture.pixels().all(|pixel| pixel.0[0] == pixel.0[1]), "no other object is seen");
    assert!(exact.pixels().all(|pixel| pixel.0[1] == 0.0 && pixel.0[2] == 0.0), "every distance is right");
    let wrong = exact.pixels().filter(|pixel| pixel.0[0] > 0.02).count();
    assert!((200..6000).contains(&wrong), "only at edges: {wrong}");
    let (picture, exact) = render("classic.png", "classic");
    let red = picture.pixels().filter(|pixel| pixel.0 == [255, 0, 0]).count();
    assert_eq!(red, exact.pixels().filter(|pixel| pixel.0[2] == 1.0).count());
    assert!(red > 50, "{red}");
    assert!(exact.pixels().any(|pixel| pixel.0[1] > 1e-6), "its distances are off");
}

#[test]
fn a_pixel_outside_the_picture_is_refused() {
    let scene = root().join("scenes/sphere/in-front.ray");
    for (x, y) in [("160", "0"), ("0", "120"), ("-1", "0")] {
        let mut probe = cargo_bin_cmd!("tabray");
        let output = probe.arg("probe").arg(&scene).args([x, y]).output().expect("the program runs");
        let err = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{err}");
        let message = format!("error: the image of 160 x 120 pixels has no pixel {x} {y}\n");
        assert!(err.starts_with(&message) && err.contains("from 0 to 159"), "{err}");
    }
}

#[test]
fn a_rectangle_is_printed_in_the_notes_order_whichever_its_corners() {
    let scene = root().join("scenes/sphere/in-front.ray");
    let printed = |corners: &str| {
        let folder = TempDir::new().expect("a folder");
        let mut render = cargo_bin_cmd!("tabray");
        let render = render.current_dir(folder.path()).arg("render").arg(&scene);
        let output = render.args(["--debug", "pix", "--at", corners]).output().expect("the program runs");
        let err = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{err}");
        err.split("wrote").next().unwrap_or_default().to_owned()
    };
    let expected = "\nPIX    5    3 - \nPIX    5    4 - \nPIX    6    3 - \nPIX    6    4 - \n";
    assert_eq!(printed("3,5,4,6"), expected);
    assert_eq!(printed("4,6,3,5"), expected);
}

#[test]
fn pictures_beside_standard_output_are_refused() {
    let scene = root().join("scenes/sphere/in-front.ray");
    let mut render = cargo_bin_cmd!("tabray");
    let output =
        render.arg("render").arg(&scene).args(["-o", "-", "--aov", "depth"]).output().expect("it runs");
    assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
    assert!(String::from_utf8_lossy(&output.stderr).contains("name a file for the main image"));
}

#[test]
fn a_probe_of_an_empty_pixel_says_that_nothing_was_met() {
    let scene = model(
        "camera cam { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 } \
         material m { ambient 1 1 1 } sphere ball { material m center 4 3 -4 radius 1 }",
    );
    let mut out = Vec::new();
    probe::pixel(&Plan::new(&scene), 0, 0, &mut out).expect("memory takes it");
    let text = String::from_utf8(out).expect("a text");
    assert!(text.contains("hit      nothing\n") && text.ends_with("bytes            (0, 0, 0)\n"), "{text}");
}

#[test]
fn probe_tells_the_bytes_of_the_image_where_light_bounces() {
    let scene = model(
        "look_at eye { pixeldim 4 3 position 0 2 6 target 0 0 0 rules free bounces 1 } material m { diffuse 0.8 0.8 0.8 }
         sphere ball { material m center 0 1 0 radius 1 } plane floor { material m normal 0 1 0 point 0 0 0 }
         sky day { lights yes }",
    );
    let plan = Plan::new(&scene);
    let image = Renderer::default().picture(&plan);
    for (index, bytes) in image.chunks(3).enumerate() {
        let (x, y) = (index % 4, 2 - index / 4);
        let mut out = Vec::new();
        probe::pixel(&plan, x, y, &mut out).expect("memory takes it");
        let text = String::from_utf8(out).expect("a text");
        let shown = format!("({}, {}, {})", bytes[0], bytes[1], bytes[2]);
        assert!(text.trim_end().ends_with(&shown), "{shown} in {text}");
    }
}
