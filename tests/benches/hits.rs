//! `cargo bench --bench hits`: the cost of a ray's hit for each entity, one ray at a time and in packets.
//!
//! The rays are those of the entity's own scene in `scenes/entities`, through every tenth pixel in both directions.

use divan::{Bencher, black_box, counter::ItemsCount};
use std::fs;
use std::path::Path;
use tabray::geometry::{HitRecordMut, MISS, Ray, RayPacket, RayRange};
use tabray::scene::{self, Model, Registry};
use tabray::simd::{Cpu, Vectors};

/// The number of rays of a packet.
const WIDE: usize = 64;

fn main() {
    divan::main();
}

/// Returns the entities that rays hit, by the names of their scenes.
fn shapes() -> impl Iterator<Item = String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/entities");
    let stem = |entry: fs::DirEntry| Some(entry.path().file_stem()?.to_str()?.to_owned());
    let mut names: Vec<_> = fs::read_dir(folder)
        .expect("the scenes of the entities")
        .filter_map(|entry| stem(entry.expect("an entry")))
        .filter(|name| load(name).objects.iter().any(|object| object.args.entity().name == name))
        .collect();
    names.sort();
    names.into_iter()
}

fn load(name: &str) -> Model {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/entities");
    let file = format!("{name}.ray");
    let bytes = fs::read(folder.join(&file)).expect("a scene");
    let registry = Registry::get().expect("no two plugins claim one name");
    match scene::read(registry, &file, &folder, &bytes, None) {
        Ok(loaded) => loaded.model,
        Err(report) => panic!("{report}"),
    }
}

/// Returns the model, the index of the entity's object in it, and rays.
fn setting(name: &str) -> (Model, usize, Vec<Ray>) {
    let model = load(name);
    let object = model.objects.iter().position(|object| object.args.entity().name == name);
    let camera = &model.camera.value;
    let [width, height] = camera.pixels;
    let rays = (0..height).step_by(10).flat_map(|y| (0..width).step_by(10).map(move |x| (x, y)));
    let rays = rays.map(|(x, y)| camera.ray(x as f64, y as f64)).collect();
    (model, object.expect("a shape of this type"), rays)
}

/// Measures one ray after another, with the exact distance.
#[divan::bench(args = shapes())]
fn distance(bencher: Bencher, name: &str) {
    let (model, object, rays) = setting(name);
    let shape = &model.objects[object].shape;
    bencher.counter(ItemsCount::new(rays.len())).bench_local(|| {
        for ray in &rays {
            black_box(shape.distance(black_box(ray), &RayRange::ALL));
        }
    });
}

/// Measures packets, with the best instructions of the machine.
#[divan::bench(args = shapes())]
fn meet(bencher: Bencher, name: &str) {
    let (model, object, rays) = setting(name);
    let shape = &model.objects[object].shape;
    let packets: Vec<_> = rays
        .chunks_exact(WIDE)
        .map(|rays| {
            let (mut origin, mut dir) = (Vectors::<WIDE>::ZERO, Vectors::<WIDE>::ZERO);
            for (lane, ray) in rays.iter().enumerate() {
                origin.set(lane, ray.origin);
                dir.set(lane, ray.dir);
            }
            (origin, dir)
        })
        .collect();
    let cpu = Cpu::best();
    bencher.counter(ItemsCount::new(packets.len() * WIDE)).bench_local(|| {
        for (origin, dir) in &packets {
            let (mut near, mut far) = ([MISS; WIDE], [MISS; WIDE]);
            let (mut hit_ids, mut doubt) = ([0; WIDE], [0; WIDE]);
            let nearest =
                HitRecordMut { near: &mut near, far: &mut far, hit_ids: &mut hit_ids, doubt: &mut doubt };
            shape.closest_hits(cpu, RayPacket::new(origin.view(WIDE), dir.view(WIDE), 0.0), 1, nearest);
            black_box((&near, &far, &hit_ids));
        }
    });
}
