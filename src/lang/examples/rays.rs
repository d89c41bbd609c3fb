//! Asks for the exact hits of rays with a scene: `cargo run -p tabray-lang --example rays`.

use std::fmt::Write;
use std::path::Path;
use tabray_core::glam::DVec3;
use tabray_core::query::{Query, QueryRay, Verdict};
use tabray_lang::{Registry, read};
// Links the entity types, which register themselves.
use tabray_plugins as _;

const SCENE: &str = "
    look_at  eye  { pixeldim 4 3  position 0 0 9  target 0 0 0  angle 40 }
    material grey { }
    sphere   ball { material grey  center 0 0 0  radius 5 }
    sphere   twin { material grey  center 3 0 0  radius 5 }
";

/// Describes the proven hits of three rays.
pub fn answer() -> Result<String, Box<dyn std::error::Error>> {
    let loaded = read(Registry::get()?, "scene", Path::new(""), SCENE.as_bytes(), None)?;
    let query = Query::new(&loaded.model);
    // A ray's direction may have any length, and is the unit of t.
    let rays: Vec<_> =
        [[-9.0, 0.0, 0.0, 3.0, 0.0, 0.0], [0.0, 0.0, 9.0, 1.0, 1.0, 0.0], [1.5, 0.0, 9.0, 0.0, 0.0, -1.0]]
            .iter()
            .filter_map(|[x, y, z, dx, dy, dz]| {
                QueryRay::new(DVec3::new(*x, *y, *z), DVec3::new(*dx, *dy, *dz))
            })
            .collect();
    let mut out = String::new();
    for answer in query.proven(&rays, true) {
        let name = answer.object.map(|object| loaded.model.objects[object].args.name());
        match (answer.verdict, name) {
            (Verdict::Hit, Some(name)) => {
                writeln!(
                    out,
                    "`{name}` is hit at t = {}: from {} to {}",
                    answer.t, answer.bounds.low, answer.bounds.high
                )?;
            }
            (Verdict::Tie, Some(name)) => {
                writeln!(out, "`{name}` and others are hit at once, at t = {}", answer.t)?
            }
            (verdict, _) => writeln!(out, "{verdict:?}")?,
        }
    }
    Ok(out)
}

#[allow(dead_code, reason = "a test compares the answer")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    print!("{}", answer()?);
    Ok(())
}
