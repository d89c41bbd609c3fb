//! Asks a mesh in memory about a million rays: `cargo run --release -p tabray-lang --example mesh`.

use std::fmt::Write;
use tabray_core::glam::DVec3;
use tabray_core::query::{Query, QueryRay};
use tabray_core::shapes::mesh::{Mesh, Surface};
use tabray_core::world::accuracy::{Accuracy, Exact};
use tabray_core::world::any_shape::AnyShape;
use tabray_lang::{Registry, reader};
// Links the entity types, which register themselves.
use tabray_plugins as _;

const RAYS: u32 = 1_000_000;

/// The number of squares along each side of the mesh, each of two triangles.
const SIDE: u32 = 100;

/// Says how many rays hit a saddle, and what is proven about the first ray.
pub fn answer() -> Result<String, Box<dyn std::error::Error>> {
    let grid = |count: u32| (0..count * count).map(move |index| (index % count, index / count));
    let at = |step: u32| f64::from(step) / f64::from(SIDE);
    let vertices = grid(SIDE + 1).map(|(x, y)| DVec3::new(at(x), at(y), at(x) * at(y)));
    let faces = grid(SIDE).flat_map(|(x, y)| {
        let [low, high] = [y, y + 1].map(|y| y * (SIDE + 1) + x);
        [[low, low + 1, high + 1], [low, high + 1, high]]
    });
    let surface =
        Surface::of_arrays(vertices.collect(), faces.collect()).map_err(|error| error.to_string())?;
    let mesh = AnyShape::of_packets(Mesh::<Exact>::new(surface.into(), Accuracy::Exact));
    let model = reader::model_of_shape(Registry::get()?, mesh)?;
    let query = Query::new(&model);

    // From one point to places on a square that is wider than the mesh.
    let viewer = DVec3::new(0.5, 0.5, 3.0);
    let place = |index: u32, step: f64| 1.5 * (f64::from(index) * step).fract() - 0.25;
    let target = |index: u32| DVec3::new(place(index, 0.754_877_666), place(index, 0.569_840_291), 0.0);
    let rays: Vec<_> = (1..=RAYS).filter_map(|index| QueryRay::new(viewer, target(index) - viewer)).collect();
    let hits = query.traced(&rays).iter().filter(|answer| answer.object.is_some()).count();
    let mut out = String::new();
    writeln!(out, "{hits} of {RAYS} rays hit the mesh")?;
    for answer in query.proven(&rays[..1], true) {
        writeln!(out, "{:?}: t from {} to {}", answer.verdict, answer.bounds.low, answer.bounds.high)?;
    }
    Ok(out)
}

#[allow(dead_code, reason = "a test compares the answer")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    print!("{}", answer()?);
    Ok(())
}
