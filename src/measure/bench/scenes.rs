//! Built-in scenes to measure when no scene is given.

use glam::{DVec3, dvec3};
use std::f64::consts::TAU;
use tabray_lang::reader::Parsed;

/// Returns the built-in scenes with their names.
pub fn all() -> [(&'static str, Vec<Parsed<'static>>); 4] {
    [
        ("3 planes and 2 spheres", planes_and_spheres()),
        ("a vase", vase()),
        ("1000 spheres", spheres(1000)),
        ("20000 triangles", triangles(20_000)),
    ]
}

/// Two spheres in the corner of a room, with two lights.
pub fn planes_and_spheres() -> Vec<Parsed<'static>> {
    let plane = |name, normal: [f64; 3]| {
        Parsed::new("plane", name)
            .set("material", "white")
            .set("normal", normal)
            .set("point", [0.0, 0.0, -8.0])
    };
    let mut scene = setting(dvec3(4.0, 3.0, 6.0));
    scene.extend([
        plane("floor", [0.0, 1.0, 0.0]),
        plane("wall", [1.0, 0.0, 0.0]),
        plane("back", [0.0, 0.0, 1.0]),
        sphere("one", dvec3(3.0, 2.0, -4.0), 1.5),
        sphere("other", dvec3(5.5, 3.5, -5.0), 1.0),
    ]);
    scene
}

/// The course notes' vase, with its profile as a formula.
pub fn vase() -> Vec<Parsed<'static>> {
    let mut scene = setting(dvec3(4.0, 3.0, 7.0));
    scene.push(
        Parsed::new("revsurf", "vase")
            .set("material", "white")
            .set("profile", "2 + sin(y)")
            .set("direction", [0.0, 1.0, 0.0])
            .set("base", [4.0, 0.0, -4.0])
            .set("height", 6.25),
    );
    scene
}

/// This many spheres in a box behind the image plane. Together they cover about the same area of it, however many there
/// are.
pub fn spheres(count: usize) -> Vec<Parsed<'static>> {
    let radius = 1.5 / (count as f64).sqrt();
    let mut scene = setting(dvec3(4.0, 3.0, 7.0));
    scene.extend((0..count).map(|index| sphere(&format!("s{index}"), scattered(index), radius)));
    scene
}

/// This many triangles or one less: the notes' vase, in rings of facets.
pub fn triangles(count: usize) -> Vec<Parsed<'static>> {
    let rings = ((count / 2) as f64).sqrt() as usize;
    let around = count / 2 / rings.max(1);
    let at = |ring: usize, step: usize| {
        let (y, angle) = (6.25 * ring as f64 / rings as f64, TAU * (step % around) as f64 / around as f64);
        let radius = 2.0 + libm::sin(y);
        dvec3(4.0 + radius * libm::cos(angle), y, -4.0 + radius * libm::sin(angle))
    };
    let mut scene = setting(dvec3(4.0, 3.0, 7.0));
    for index in 0..rings * around {
        let (ring, step) = (index / around, index % around);
        let corners = [at(ring, step), at(ring, step + 1), at(ring + 1, step), at(ring + 1, step + 1)];
        for (name, [a, b, c]) in [("low", [0, 1, 2]), ("high", [1, 3, 2])] {
            let corners = [corners[a], corners[b], corners[c]];
            scene.push(triangle(&format!("{name}{index}"), corners));
        }
    }
    scene
}

fn setting(viewpoint: DVec3) -> Vec<Parsed<'static>> {
    let light = |name, location: [f64; 3]| {
        Parsed::new("light", name).set("location", location).set("emissivity", [3.0, 3.0, 3.0])
    };
    vec![
        Parsed::new("camera", "eye")
            .set("pixeldim", [640, 480])
            .set("worlddim", [8.0, 6.0])
            .set("viewpoint", viewpoint),
        Parsed::new("material", "white").set("ambient", [1.0; 3]).set("diffuse", [4.0; 3]),
        light("left", [2.0, 4.0, 0.0]),
        light("right", [6.0, 4.0, 0.0]),
    ]
}

fn sphere(name: &str, center: DVec3, radius: f64) -> Parsed<'static> {
    Parsed::new("sphere", name).set("material", "white").set("center", center).set("radius", radius)
}

fn triangle(name: &str, corners: [DVec3; 3]) -> Parsed<'static> {
    let [a, b, c] = corners;
    Parsed::new("triangle", name)
        .set("material", "white")
        .set("vertex1", a)
        .set("vertex2", b)
        .set("vertex3", c)
}

/// Returns a point in the box. The points are spread evenly: multiples of powers of the plastic ratio (Roberts, "The
/// Unreasonable Effectiveness of Quasirandom Sequences", 2018).
fn scattered(index: usize) -> DVec3 {
    const STEP: DVec3 = dvec3(0.819_172_513_396_164_5, 0.671_043_606_703_789_3, 0.549_700_477_901_970_2);
    let part = ((index + 1) as f64 * STEP).fract();
    dvec3(8.0, 6.0, -8.0) * part - dvec3(0.0, 0.0, 1.0)
}
