//! The bytes of images are those of the proven colours, in every scene.

use crate::common::{load, model, model_in, render, root, scenes};
use image::{Rgb, Rgb32FImage};
use std::fs;
use std::thread;
use tabray::render::footprint::PixelProver;
use tabray::render::plan::depth::Depth;
use tabray::render::{Plan, trace};
use tabray::scene::Model;
use tabray::tools::colours::{Prover, Verdict};
use tabray::world::Accuracy;
use tabray::world::sample::Sampler;
use tempfile::TempDir;

/// The scenes that show what is not enclosed: the brightness of a map straight up and down, normals of a copy bent by an image,
/// and what formulas clip, or give by u and v. Many of their pixels remain open, and none is to be contradicted.
const UNENCLOSED: [&str; 6] = [
    "environment/lights.ray",
    "sky/lights.ray",
    "entities/normals.ray",
    "gallery/cut-open.ray",
    "gallery/heights.ray",
    "gallery/one-sided.ray",
];

#[test]
fn no_byte_is_contradicted_and_nearly_every_pixel_is_proven() {
    // Deep reflections take a stack as large as those of the program's threads.
    let thread = thread::Builder::new().stack_size(128 << 20).spawn(all_scenes).expect("a thread");
    thread.join().expect("no failure");
}

#[test]
fn at_an_outline_the_face_is_proven_that_no_other_hides() {
    let model = load(&root().join("scenes/hard/doubled.ray"));
    let plan = Plan::new(&model);
    let prover = Prover::new(&plan);
    // The edges of the box are seen through the middles of these pixels.
    for x in [60, 100] {
        for y in 0..plan.camera.pixels[1] {
            assert_eq!(prover.traced(x, y).verdict(), Verdict::Proven, "{x} {y}");
        }
    }
}

#[test]
fn along_a_wall_of_slivers_the_face_that_is_hit_is_proven() {
    let text = fs::read_to_string(root().join("scenes/hard/lantern-inside.ray")).expect("a scene");
    // The viewer is in the plane of the left wall. The rays of the first column lie in it, and may show either face of the
    // edge that they meet.
    let text = text.replace("viewpoint 4 3 6", "viewpoint 0 3 6");
    let model = model_in(&root().join("scenes/hard"), &text);
    let plan = Plan::new(&model);
    let prover = Prover::new(&plan);
    for y in 0..plan.camera.pixels[1] {
        for x in 1..8 {
            assert_eq!(prover.traced(x, y).verdict(), Verdict::Proven, "{x} {y}");
        }
    }
}

#[test]
fn colours_of_a_mesh_of_several_materials_are_proven() {
    let folder = TempDir::new().expect("a folder");
    let cube = "v 2 1 -4\nv 6 1 -4\nv 6 5 -4\nv 2 5 -4\nv 2 1 -1\nv 6 1 -1\nv 6 5 -2\nv 2 5 -2
        usemtl red\nf 1 4 3 2\nf 5 6 7 8\nusemtl blue\nf 1 2 6 5\nf 3 4 8 7\nf 1 5 8 4\nf 2 3 7 6";
    fs::write(folder.path().join("cube.obj"), cube).expect("a file");
    let model = model_in(
        folder.path(),
        "camera eye { pixeldim 33 21 worlddim 8 6 viewpoint 4 8 9 } material red { ambient 3 1 1 diffuse 9 3 3 }
         material blue { ambient 1 1 3 diffuse 2 2 9 } light lamp { location 1 9 9 emissivity 30 30 30 }
         mesh o { material red file cube.obj }",
    );
    let plan = Plan::new(&model);
    let prover = Prover::new(&plan);
    let pixels = (0..21).flat_map(|y| (0..33).map(move |x| (x, y)));
    let open: Vec<_> = pixels.filter(|(x, y)| prover.traced(*x, *y).verdict() != Verdict::Proven).collect();
    assert!(open.is_empty(), "{open:?}");
    // Both materials are seen.
    let picture = render(&model);
    let shows = |more: usize, less: usize| picture.pixels().any(|pixel| pixel.0[more] > pixel.0[less]);
    assert!(shows(0, 2) && shows(2, 0));
}

#[test]
fn at_the_edge_of_a_box_the_colour_of_a_face_is_not_taken_for_certain() {
    // The middle pixel looks along the right side of the box, and the shader sees that face there.
    let model = model(
        "camera eye { pixeldim 33 21 worlddim 8 6 viewpoint 4 3 6 } material m { ambient 0.25 0.5 1 }
         faces six { colours 2 0 0  0 2 0  0 0 2  2 2 0  0 2 2  2 0 2 }
         box o { material m center 3 3 -2 size 2 0.25 0.5 shader six }",
    );
    let plan = Plan::new(&model);
    let prover = Prover::new(&plan);
    assert_ne!(prover.traced(16, 10).verdict(), Verdict::Contradicted);
    assert_eq!(prover.traced(15, 10).verdict(), Verdict::Proven);
}

/// Lights of each kind, near and far.
const SPREAD_OUT: [&str; 9] = [
    "area_light a { location -1 2.5 1 target 0 0 0 dimensions 1.5 1 emissivity 5 4 3 }",
    "area_light a { location -10 60 20 target 0 0 0 dimensions 1.5 1 emissivity 2500 2000 1500 visible no }",
    "area_light a { location -1 2.5 1 target 0 0 0 radius 0.8 emissivity 5 4 3 visible no }",
    "area_light a { location -1 6 1 target 0 0 0 radius 0.8 emissivity 25 20 15 }",
    "sphere_light a { location -1 1.2 1.4 radius 0.5 emissivity 3 2 2 visible no }",
    "sphere_light a { location -1 0.2 1.4 radius 0.5 emissivity 3 2 2 }",
    "sun a { direction -1 2 1 angle 12 emissivity 0.6 0.6 0.5 }",
    "sky a { lights yes }",
    "texture t { filename lamps.exr } environment a { texture t lights yes }",
];

/// Returns a scene with a floor, a shiny ball, and one of the lights.
fn spread_out(folder: &TempDir, light: &str) -> Model {
    let map = Rgb32FImage::from_fn(16, 8, |x, y| Rgb([if (x, y) == (9, 2) { 9.0 } else { 0.2 }, 0.3, 0.4]));
    map.save(folder.path().join("lamps.exr")).expect("a map");
    let scene = "look_at eye { pixeldim 12 9 position 0 2 6 target 0 0.6 0 angle 40 }
        material floor { diffuse 0.7 0.7 0.6 } material shiny { diffuse 0.6 0.3 0.2 specular 0.1 shininess 30 }
        plane floor { material floor normal 0 1 0 point 0 0 0 }
        sphere ball { material shiny center 0.3 0.8 -0.2 radius 0.8 }\n";
    model_in(folder.path(), &format!("{scene}{light}"))
}

#[test]
fn samples_of_lights_that_are_spread_out_are_proven() {
    let folder = TempDir::new().expect("a folder");
    for (index, light) in SPREAD_OUT.into_iter().enumerate() {
        let model = spread_out(&folder, light);
        let mut plan = Plan::new(&model);
        plan.camera.samples = 3;
        plan.camera.sampler = if index % 2 == 0 { Sampler::Sobol } else { Sampler::Random };
        let (prover, mut proven) = (Prover::new(&plan), 0);
        for (x, y) in (0..12).flat_map(|x| (0..9).map(move |y| (x, y))) {
            let bytes = plan.camera.display().bytes(trace::pixel(&plan, x, y));
            let verdict = prover.pixel(x, y, bytes).verdict();
            assert_ne!(verdict, Verdict::Contradicted, "{light}: {x} {y}");
            if verdict == Verdict::Proven {
                // Another byte would be noticed.
                let wrong = prover.pixel(x, y, bytes.map(|byte| byte ^ 2));
                assert_eq!(wrong.verdict(), Verdict::Contradicted, "{light}: {x} {y}");
                proven += 1;
            }
        }
        assert!(proven >= 80, "{light}: {proven} of 108");
    }
}

#[test]
fn the_mean_over_what_looks_round_lies_in_its_enclosure() {
    let folder = TempDir::new().expect("a folder");
    for light in &SPREAD_OUT[4..7] {
        let model = spread_out(&folder, light);
        let (prover, depth, mut certain) = (PixelProver::new(&model), Depth::new(&model), 0);
        let camera = &model.camera.value;
        let mut plan = Plan::new(&model);
        plan.camera.samples = 1024;
        for pixel in (0..12).flat_map(|x| (0..9).map(move |y| [x, y])) {
            let proof = prover.pixel((&model, depth.as_ref()), camera, pixel, 1.0 / 255.0);
            if proof.is_within(1.0 / 255.0, &camera.display()) {
                let found = trace::pixel(&plan, pixel[0], pixel[1]);
                let off = (proof.low - found).max(found - proof.high).max_element();
                assert!(off < 1e-3, "{light}: {pixel:?}, {found} between {} and {}", proof.low, proof.high);
                certain += 1;
            }
        }
        assert!(certain >= 10, "{light}: {certain} of 108");
    }
}

fn all_scenes() {
    // Proven, rounded, open and contradicted pixels.
    let mut counts = [0; 4];
    for path in scenes() {
        let name = path.strip_prefix(root().join("scenes")).expect("a scene").to_string_lossy().into_owned();
        let model = load(&path);
        if model.camera.value.accuracy == Accuracy::Classic {
            continue;
        }
        let mut plan = Plan::new(&model);
        plan.camera.samples = 1;
        let prover = Prover::new(&plan);
        let [width, height] = plan.camera.pixels;
        let step = if width > 320 { 61 } else { 17 };
        for y in (0..height).step_by(step) {
            for x in (0..width).step_by(step) {
                let verdict = prover.traced(x, y).verdict();
                assert_ne!(verdict, Verdict::Contradicted, "{name}: {x} {y}");
                // A sample of light that goes on by chance is open.
                if !UNENCLOSED.contains(&&*name) && model.camera.value.bounces == 0 {
                    counts[verdict as usize] += 1;
                }
            }
        }
    }
    let [proven, rounded, open, _] = counts;
    assert!(100 * (rounded + open) < proven, "{counts:?}");
}
