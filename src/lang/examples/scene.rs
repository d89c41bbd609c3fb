//! Reads a scene, finds the first hit of a ray, and renders the scene: `cargo run -p tabray-lang --example scene`.

use std::fmt::Write;
use std::path::Path;
use tabray_core::render::{Plan, Renderer, trace};
use tabray_lang::{Registry, read};
// Links the entity types, which register themselves.
use tabray_plugins as _;

const SCENE: &str = "
    camera   cam   { pixeldim 56 20  worlddim 8 6  viewpoint 4 3 8 }
    material white { ambient 1 1 1  diffuse 6 6 6 }
    material blue  { ambient 0.2 0.2 2  diffuse 3 3 6  specular 0.3 }
    plane    floor { material white  normal 0 1 0  point 0 0 0 }
    sphere   ball  { material blue  center 4 2.2 -3  radius 2 }
    light    lamp  { location 0 8 2  emissivity 12 12 12 }
";

/// Describes the hit of the ray through the middle of the image, and shows the image as letters.
pub fn answer() -> Result<String, Box<dyn std::error::Error>> {
    let loaded = read(Registry::get()?, "scene", Path::new(""), SCENE.as_bytes(), None)?;
    let plan = Plan::new(&loaded.model);
    let mut out = String::new();
    let sight = plan.camera.sight(28.0, 10.0);
    match trace::first_hit(&plan, &sight) {
        Some(hit) => {
            writeln!(out, "`{}` is hit at a distance of {:.6}", hit.object.args.name(), hit.distance)?
        }
        None => writeln!(out, "nothing is hit")?,
    }
    let bytes = Renderer::default().picture(&plan);
    for row in bytes.chunks(3 * plan.camera.pixels[0]) {
        let shades = row.chunks(3).map(|pixel| {
            let sum: usize = pixel.iter().map(|byte| usize::from(*byte)).sum();
            char::from(b" .:-=+*#%@"[sum * 10 / (3 * 256)])
        });
        writeln!(out, "{}", shades.collect::<String>().trim_end())?;
    }
    Ok(out)
}

#[allow(dead_code, reason = "a test compares the answer")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    print!("{}", answer()?);
    Ok(())
}
