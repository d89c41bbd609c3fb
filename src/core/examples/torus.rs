//! Defines a shape by one formula, finds where a ray hits it, and draws it:
//! `cargo run -p tabray-core --example torus`.

use std::fmt::Write;
use tabray_core::prelude::*;

/// A torus around the y axis.
struct Torus;

impl Implicit for Torus {
    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        let [x, y, z] = at;
        let from_circle = (x.powi(2) + z.powi(2)).sqrt() - N::constant(2.0);
        from_circle.powi(2) + y.powi(2) - N::constant(0.7)
    }

    fn bounds(&self) -> [DVec3; 2] {
        let corner = DVec3::new(2.9, 0.9, 2.9);
        [-corner, corner]
    }
}

/// Says where a ray hits the torus, and draws it as an orthographic camera sees it from above.
pub fn answer() -> Result<String, std::fmt::Error> {
    let torus = Body::implicit(Torus, Frame::at(DVec3::ZERO)).shape;
    let mut out = String::new();
    let ray = Ray { origin: DVec3::new(5.0, 0.0, 0.0), dir: DVec3::NEG_X };
    let distance = torus.distance(&ray, &RayRange::ALL);
    writeln!(out, "from x = 5, it is {distance:.9} away: sqrt(0.7) before the circle of radius 2")?;
    let (dir, light) = (DVec3::new(0.0, -0.8, -0.6), DVec3::new(-0.6, 0.8, 0.0));
    let up = DVec3::new(0.0, 0.6, -0.8);
    for row in 0..15 {
        let line = (0..48).map(|column| {
            let origin =
                0.125 * f64::from(column - 24) * DVec3::X + 0.35 * f64::from(7 - row) * up - 9.0 * dir;
            let ray = Ray { origin, dir };
            match torus.distance(&ray, &RayRange::ALL) {
                MISS => ' ',
                distance => {
                    let cosine = torus.normal(ray.at(distance)).dot(light).clamp(0.0, 0.99);
                    char::from(b".:-=+*#%@"[(9.0 * cosine) as usize])
                }
            }
        });
        writeln!(out, "{}", line.collect::<String>().trim_end())?;
    }
    Ok(out)
}

#[allow(dead_code, reason = "a test compares the answer")]
fn main() -> Result<(), std::fmt::Error> {
    print!("{}", answer()?);
    Ok(())
}
