//! Scenes made at random from a seed, to measure what `choose` promises: with things that are much smaller than a
//! pixel, and without.

use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng;
use std::fmt::Write;

/// A scene made at random.
pub struct Made {
    pub text: String,
    /// The mesh to which the scene refers, in the format OBJ.
    pub mesh: String,
    /// What it has that is much smaller than a pixel and bright; empty if nothing.
    pub small: Vec<&'static str>,
}

struct Random(Pcg32);

impl Random {
    fn number(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * f64::from(self.0.next_u32()) / f64::from(u32::MAX)
    }

    /// A number whose logarithm is spread evenly.
    fn scale(&mut self, from: f64, to: f64) -> f64 {
        self.number(from.ln(), to.ln()).exp()
    }

    fn is(&mut self, probability: f64) -> bool {
        self.number(0.0, 1.0) < probability
    }

    fn below(&mut self, count: u32) -> u32 {
        (self.0.next_u32() >> 8) % count
    }

    fn colour(&mut self, least: f64, most: f64) -> String {
        let [red, green, blue] = [0; 3].map(|_| self.number(least, most));
        format!("{red:.3} {green:.3} {blue:.3}")
    }

    /// A place in front of the wall and above the floor, in what is seen.
    fn place(&mut self) -> String {
        let (x, y, z) = (self.number(0.5, 7.5), self.number(0.4, 5.2), self.number(-6.0, -1.0));
        format!("{x:.3} {y:.3} {z:.3}")
    }
}

/// What is much smaller than a pixel, of which a scene has some.
const SMALL: [&str; 6] = ["lamps", "star", "wires", "glints", "lamp in a mirror", "lamp in glass"];

/// Makes the scene of a seed, with an image of this size. Every fifth has two kinds of small things, two of five have
/// one, and two of five have none.
pub fn made(seed: u64, [width, height]: [usize; 2]) -> Made {
    let mut random = Random(Pcg32::new(seed, 0x7ab));
    let kinds = [2, 1, 1, 0, 0][seed as usize % 5];
    let mut small: Vec<&str> = (0..kinds).map(|_| SMALL[random.below(SMALL.len() as u32) as usize]).collect();
    small.dedup();
    let mut text = format!("camera eye {{ pixeldim {width} {height}  worlddim 8 6  viewpoint 4 3 7 }}\n");
    let out = &mut text;
    for index in 0..4 {
        let (ambient, diffuse) = (random.colour(0.0, 2.0), random.colour(0.0, 4.0));
        let shine = match index {
            1 => format!("specular {:.2}", random.number(0.1, 0.6)),
            2 => format!("specular {:.2} shininess {:.0}", random.number(0.1, 0.5), random.scale(5.0, 60.0)),
            _ => String::new(),
        };
        let _ = writeln!(out, "material m{index} {{ ambient {ambient} diffuse {diffuse} {shine} }}");
    }
    out.push_str("material clear { ambient 0.1 0.1 0.1 diffuse 0.1 0.1 0.1 transparency 0.8 }\nglass crystal { index 1.5 }\n");
    out.push_str("material mirror { ambient 0.1 0.1 0.1 specular 0.8 }\n");
    if random.is(0.6) {
        let side = random.number(0.4, 2.0);
        let _ = writeln!(
            out,
            "tiled_plane floor {{ material m0 altmaterial m3 normal 0 1 0 point 0 0 0 xdir 1 0 0 dimensions {side:.2} {side:.2} }}"
        );
    } else {
        out.push_str("plane floor { material m3 normal 0 1 0 point 0 0 0 }\n");
    }
    if random.is(0.6) {
        out.push_str("plane back { material m3 normal 0 0 1 point 0 0 -8 }\n");
    }
    for index in 0..1 + random.below(4) {
        let (material, place, radius) = (random.below(4), random.place(), random.number(0.25, 1.1));
        let _ = match random.below(4) {
            0 => writeln!(
                out,
                "cylinder o{index} {{ material m{material} base {place} direction 0.3 1 {radius:.2} height 1 radius {radius:.3} }}"
            ),
            1 => writeln!(
                out,
                "box o{index} {{ material m{material} center {place} size {radius:.3} 1.2 {radius:.3} }}"
            ),
            _ => {
                writeln!(out, "sphere o{index} {{ material m{material} center {place} radius {radius:.3} }}")
            }
        };
    }
    if random.is(0.25) {
        let material = ["crystal", "clear"][random.below(2) as usize];
        let (place, radius) = (random.place(), random.number(0.5, 1.1));
        let _ = writeln!(out, "sphere lens {{ material {material} center {place} radius {radius:.3} }}");
    }
    if random.is(0.2) {
        let (place, radius) = (random.place(), random.number(0.4, 1.0));
        let _ = writeln!(out, "sphere chrome {{ material mirror center {place} radius {radius:.3} }}");
    }
    if random.is(0.2) {
        let (place, turn) = (random.place(), random.number(0.0, 90.0));
        let smooth = random.below(2);
        let _ = writeln!(
            out,
            "mesh knot {{ material m2 file ring.obj rotation {turn:.1} 20 0 translation {place} smooth {smooth} }}"
        );
    }
    for kind in &small {
        add(out, kind, &mut random);
    }
    for index in 0..1 + random.below(2) {
        let (x, y, z) = (random.number(-2.0, 10.0), random.number(6.0, 9.0), random.number(-3.0, 5.0));
        let size = if random.is(0.3) { random.number(0.1, 1.0) } else { 0.0 };
        let emitted = random.colour(1.0, 6.0);
        let _ = writeln!(
            out,
            "light l{index} {{ location {x:.2} {y:.2} {z:.2} emissivity {emitted} size {size:.2} }}"
        );
    }
    let mesh = ring(random.number(0.5, 1.0), random.number(0.15, 0.4), 16, 8);
    Made { text, mesh, small }
}

/// Adds small things of a kind.
fn add(out: &mut String, kind: &str, random: &mut Random) {
    let _ = match kind {
        "lamps" => {
            let ambient = random.scale(100.0, 3000.0);
            let _ = writeln!(out, "material lamp {{ ambient {ambient:.0} {ambient:.0} {ambient:.0} }}");
            for index in 0..1 + random.below(8) {
                let (place, radius) = (random.place(), random.scale(0.004, 0.02));
                let _ =
                    writeln!(out, "sphere lamp{index} {{ material lamp center {place} radius {radius:.4} }}");
            }
            Ok(())
        }
        "star" => {
            let (ambient, place, radius) =
                (random.scale(3e3, 3e4), random.place(), random.scale(0.001, 0.006));
            writeln!(
                out,
                "material star {{ ambient {ambient:.0} {ambient:.0} {ambient:.0} }}\nsphere star {{ material star center {place} radius {radius:.4} }}"
            )
        }
        "wires" => {
            let ambient = random.scale(20.0, 1000.0);
            let _ = writeln!(out, "material wire {{ ambient {ambient:.0} {ambient:.0} {ambient:.0} }}");
            for index in 0..1 + random.below(3) {
                let (place, height, radius) =
                    (random.place(), random.number(0.05, 2.0), random.scale(0.0005, 0.01));
                let [x, y, z] = [0; 3].map(|_| random.number(-1.0, 1.0));
                let _ = writeln!(
                    out,
                    "capsule wire{index} {{ material wire base {place} direction {x:.2} {y:.2} {z:.2} height {height:.3} radius {radius:.5} }}"
                );
            }
            Ok(())
        }
        "glints" => {
            let (specular, sharp) = (random.number(0.2, 0.8), random.scale(300.0, 30_000.0));
            let _ = writeln!(
                out,
                "material chip {{ diffuse 0.002 0.002 0.002 specular {specular:.2} shininess {sharp:.0} }}"
            );
            for index in 0..1 + random.below(4) {
                let (place, radius) = (random.place(), random.scale(0.05, 0.6));
                let _ =
                    writeln!(out, "sphere chip{index} {{ material chip center {place} radius {radius:.3} }}");
            }
            // Bright, but only the chips are in its narrow cone.
            let sent = random.scale(50.0, 5000.0);
            let (x, z) = (random.number(2.0, 6.0), random.number(0.0, 4.0));
            writeln!(
                out,
                "material dark {{ ambient 0.3 0.3 0.3 }}\nspotlight sun {{ location {x:.2} 9 {z:.2} emissivity {sent:.0} {sent:.0} {sent:.0} point {x:.2} 3 -4 theta 4 }}\nsphere near {{ material chip center {x:.2} 3 -4 radius 0.3 }}"
            )
        }
        "lamp in a mirror" => {
            let (ambient, radius, place) =
                (random.scale(300.0, 10_000.0), random.scale(0.005, 0.05), random.place());
            let (x, z) = (random.number(0.0, 8.0), random.number(8.0, 9.0));
            writeln!(
                out,
                "material bulb {{ ambient {ambient:.0} {ambient:.0} {ambient:.0} }}\nsphere bulb {{ material bulb center {x:.2} 5 {z:.2} radius {radius:.4} }}\nsphere globe {{ material mirror center {place} radius {:.2} }}",
                random.number(0.3, 1.0)
            )
        }
        "lamp in glass" => {
            let (ambient, radius) = (random.scale(300.0, 10_000.0), random.scale(0.003, 0.02));
            let (x, y) = (random.number(2.0, 6.0), random.number(1.5, 4.5));
            writeln!(
                out,
                "material spark {{ ambient {ambient:.0} {ambient:.0} {ambient:.0} }}\nsphere spark {{ material spark center {x:.2} {y:.2} -5 radius {radius:.4} }}\nsphere ball {{ material crystal center {x:.2} {y:.2} -3 radius {:.2} }}",
                random.number(0.4, 0.9)
            )
        }
        other => unreachable!("{other}"),
    };
}

/// A ring of triangles around the y axis.
fn ring(radius: f64, tube: f64, around: usize, across: usize) -> String {
    let mut obj = String::new();
    for u in 0..around {
        for v in 0..across {
            let [u, v] =
                [(u, around), (v, across)].map(|(at, of)| std::f64::consts::TAU * at as f64 / of as f64);
            let out = radius + tube * v.cos();
            let _ = writeln!(obj, "v {} {} {}", out * u.cos(), tube * v.sin(), out * u.sin());
        }
    }
    for u in 0..around {
        for v in 0..across {
            let at = |u: usize, v: usize| 1 + (u % around) * across + v % across;
            let _ = writeln!(obj, "f {} {} {} {}", at(u, v), at(u, v + 1), at(u + 1, v + 1), at(u + 1, v));
        }
    }
    obj
}
