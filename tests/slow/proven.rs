//! What is proven of the pixels of every scene.

use crate::common::{load, root, scenes, snapshots};
use rayon::prelude::*;
use std::path::Path;
use tabray::render::Plan;
use tabray::render::footprint;
use tabray::render::plan::depth::Depth;
use tabray::scene::Model;
use tabray::tools::colours::{self, Verdict};
use tabray::tools::threads::renderer_with;
use tabray::world::Accuracy;

/// The size of the images, in pixels.
const SIZE: [usize; 2] = [20, 15];

/// The size of those whose pixels take a hundred times as long as most, and these scenes.
const FEW: [usize; 2] = [8, 6];
const COSTLY: [&str; 14] = [
    "gallery/curvature.ray",
    "gallery/cut-open.ray",
    "gallery/facing-mirrors.ray",
    "gallery/gold.ray",
    "gallery/hall-of-mirrors.ray",
    "gallery/heights.ray",
    "gallery/one-sided.ray",
    "gallery/rings.ray",
    "glass/bubbles.ray",
    "hard/copies.ray",
    "hard/lantern-inside.ray",
    "hard/lantern.ray",
    "heart/glass.ray",
    "material/touching-mirrors.ray",
];

/// The error within which pixels are certified, where 1 is white.
const ERROR: f64 = 2.0 / 255.0;

/// Proofs may only become better. A snapshot says how many pixels are certified within two levels, and how many bytes have
/// each verdict.
#[test]
fn as_many_pixels_are_proven_as_before() {
    // Deep reflections take a stack as large as those of the program's threads.
    let table = renderer_with(2).expect("threads").run(table);
    let settings = snapshots("proofs");
    settings.bind(|| insta::assert_snapshot!("shares", table));
}

fn table() -> String {
    let rows: Vec<_> = scenes().par_iter().filter_map(|path| row(path)).collect();
    String::from("certified proven rounded open uncertified contradicted\n") + &rows.concat()
}

/// Returns the line of a scene.
fn row(path: &Path) -> Option<String> {
    let name = path.strip_prefix(root().join("scenes")).expect("a scene").display().to_string();
    // A table of these would have to be edited for each new entity type.
    if name.starts_with("entities") {
        return None;
    }
    let mut model = load(path);
    let camera = &mut model.camera.value;
    if camera.accuracy == Accuracy::Classic {
        return None;
    }
    (camera.pixels, camera.samples) = (if COSTLY.contains(&&*name) { FEW } else { SIZE }, 1);
    let (certified, [proven, rounded, open, uncertified, contradicted]) =
        (certified(&model), verdicts(&model));
    assert_eq!(contradicted, 0, "{name}");
    Some(format!("{certified:9} {proven:6} {rounded:7} {open:4} {uncertified:11} {contradicted:12} {name}\n"))
}

/// Returns the coordinates of all pixels.
fn pixels(model: &Model) -> impl Iterator<Item = [usize; 2]> {
    let [width, height] = model.camera.value.pixels;
    (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]))
}

/// Counts the pixels whose mean colours are certified.
fn certified(model: &Model) -> usize {
    let (prover, depth) = (footprint::PixelProver::new(model), Depth::new(model));
    let camera = &model.camera.value;
    let display = camera.display();
    let proof = |pixel| prover.pixel((model, depth.as_ref()), camera, pixel, ERROR);
    pixels(model).filter(|pixel| proof(*pixel).is_within(ERROR, &display)).count()
}

/// Counts the bytes of each verdict.
fn verdicts(model: &Model) -> [usize; 5] {
    let plan = Plan::new(model);
    let prover = colours::Prover::new(&plan);
    let mut counts = [0; Verdict::ALL.len()];
    for [x, y] in pixels(model) {
        prover.traced(x, y).channels.iter().for_each(|verdict| counts[*verdict as usize] += 1);
    }
    counts
}
