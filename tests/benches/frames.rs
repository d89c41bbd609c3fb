//! `cargo bench --bench frames`: the time of whole frames without writing a file, on one core and on two, and that of
//! encoding a file.

use divan::{Bencher, black_box, counter::ItemsCount};
use tabray::output::{Compression, Format};
use tabray::render::Plan;
use tabray::scene::{self, Model, Registry};
use tabray::tools::bench::scenes;
use tabray::tools::threads::renderer_with;

fn main() {
    divan::main();
}

/// The scenes that `tabray bench` has built in.
const SCENES: [&str; 4] = ["3 planes and 2 spheres", "a vase", "1000 spheres", "20000 triangles"];

fn model(name: &str) -> Model {
    let registry = Registry::get().expect("no two plugins claim one name");
    let scene = scenes::all().into_iter().find(|scene| scene.0 == name).expect("a scene of this name").1;
    match scene::build(registry, scene) {
        Ok(built) => built.model,
        Err(report) => panic!("{report}"),
    }
}

/// Measures frames; the items are the primary rays.
#[divan::bench(args = SCENES, consts = [1, 2])]
fn frame<const THREADS: usize>(bencher: Bencher, name: &str) {
    let (renderer, model) = (renderer_with(THREADS).expect("threads"), model(name));
    let plan = Plan::new(&model);
    let [width, height] = plan.camera.pixels;
    bencher.counter(ItemsCount::new(width * height)).bench_local(|| renderer.picture(&plan));
}

/// Measures the encoding of the first scene as a PNG or a PPM, in memory.
#[divan::bench(args = ["ppm", "png fast", "png default", "png best"])]
fn encode(bencher: Bencher, format: &str) {
    let model = model(SCENES[0]);
    let picture = renderer_with(0).expect("threads").picture(&Plan::new(&model));
    let format = match format {
        "ppm" => Format::Ppm,
        "png fast" => Format::Png(Compression::Fast),
        "png default" => Format::Png(Compression::Balanced),
        _ => Format::Png(Compression::High),
    };
    bencher.bench_local(|| {
        let mut out = Vec::new();
        let bands = std::iter::once(Ok(picture.clone()));
        format.write(&mut out, model.camera.value.pixels, bands).expect("memory takes it");
        black_box(out)
    });
}
