//! What wild formulas cost, in instructions of the program.

use crate::common::instructions::instructions;
use std::fs;

/// The most instructions for a ray: about 6 ms. The small picture bears the search of the box for parts without the
/// surface, which all rays share.
const MAX_INSTRUCTIONS: f64 = 2e7;

/// Formulas with poles, jumps, the ends of domains and waves without end. Before the work for a ray was limited, they took
/// 5e7 to 5e8.
const FORMULAS: [&str; 5] = [
    "(y/2)^2/fract(0.2/z) + y - 0.9",
    "mod(x + ln(z), sinh(y)) - 0.9",
    "x*mod(z, x*z)^(-0.5) - 0.2",
    "if(x <= y^2*x, sqrt(y^2*x), ln(2*y))",
    "min(max(y, 0.3)^-0.5, mod(y*z, y + y*z)) - 0.2",
];

#[test]
fn a_ray_at_a_wild_formula_takes_a_limited_number_of_instructions() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.ray");
    let path = path.to_str().expect("a path that is text");
    let (width, height) = (12, 9);
    let mut long = Vec::new();
    for formula in FORMULAS {
        let scene = format!(
            "look_at eye {{ pixeldim {width} {height}  position 3.15 1.95 3.9  target 0 0 0  angle 45 }}
             material m {{ ambient 1 1 1 }}
             implicit s {{ material m  formula \"{formula}\"  box -1.2 -1.2 -1.2 1.2 1.2 1.2 }}"
        );
        fs::write(path, scene).expect("a file");
        let image = format!("{path}.ppm");
        let Some(count) = instructions(&["render", path, "-o", &image, "--quiet"]) else { return };
        let a_ray = count as f64 / f64::from(width * height);
        println!("{a_ray:8.0} {formula}");
        if a_ray > MAX_INSTRUCTIONS {
            long.push(format!("{formula}: {a_ray:.0}"));
        }
    }
    assert!(long.is_empty(), "{long:#?}");
}
