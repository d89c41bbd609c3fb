//! Scenes under the free rules, made at random from a seed: rough metal, glass, patterns, wires, soft light and skies.

use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng;
use std::fmt::Write;

/// Numbers that look random.
struct Random(Pcg32);

impl Random {
    fn number(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * f64::from(self.0.next_u32()) / f64::from(u32::MAX)
    }

    fn is(&mut self, probability: f64) -> bool {
        self.number(0.0, 1.0) < probability
    }

    fn below(&mut self, count: usize) -> usize {
        self.0.next_u32() as usize % count
    }

    fn colour(&mut self, least: f64, most: f64) -> String {
        let [red, green, blue] = [0; 3].map(|_| self.number(least, most));
        format!("{red:.3} {green:.3} {blue:.3}")
    }
}

/// Makes the scene of a seed, with an image of this size.
pub fn free(seed: u64, [width, height]: [usize; 2]) -> String {
    let mut random = Random(Pcg32::new(seed, 0xf4ee));
    let (x, y, angle) = (random.number(-3.0, 3.0), random.number(0.6, 4.0), random.number(30.0, 55.0));
    let mut text = format!(
        "look_at eye {{ pixeldim {width} {height} position {x:.2} {y:.2} 6 target 0 0.7 0 angle {angle:.0} }}\n"
    );
    let out = &mut text;
    for name in ["a", "b", "c"] {
        let (diffuse, ambient) = (random.colour(0.05, 0.9), random.colour(0.0, 0.1));
        let shine = if random.is(0.3) { "specular 0.1 shininess 60" } else { "" };
        let _ = writeln!(out, "material {name} {{ diffuse {diffuse} ambient {ambient} {shine} }}");
    }
    let (colour, rough) = (random.colour(0.5, 1.0), [0.0, 0.05, 0.15, 0.3, 0.5][random.below(5)]);
    let _ = writeln!(out, "metal m {{ colour {colour} roughness {rough} }}");
    let tea = if random.is(0.5) { "attenuation 0.7 0.35 0.1 at 1" } else { "" };
    let _ = writeln!(out, "glass g {{ index {:.2} {tea} }}", random.number(1.3, 1.8));
    let side = random.number(0.1, 0.8);
    let _ = writeln!(out, "checker k {{ squares {0} {0} altmaterial b }}", 4 + random.below(40));
    let _ = match random.below(3) {
        0 => writeln!(out, "plane floor {{ material a normal 0 1 0 point 0 0 0 }}"),
        1 => writeln!(out, "plane floor {{ material m normal 0 1 0 point 0 0 0 }}"),
        _ => writeln!(
            out,
            "tiled_plane floor {{ material a altmaterial c normal 0 1 0 point 0 0 0 xdir 1 0 0 dimensions {side:.2} {side:.2} }}"
        ),
    };
    if random.is(0.4) {
        let _ = writeln!(out, "plane back {{ material c normal 0 0 1 point 0 0 -3 }}");
    }
    for index in 0..2 + random.below(4) {
        let material = ["a", "b", "c", "m", "m", "g"][random.below(6)];
        let (x, z, size) = (random.number(-2.0, 2.0), random.number(-2.0, 2.5), random.number(0.2, 0.9));
        let _ = match random.below(6) {
            0 => writeln!(
                out,
                "box o{index} {{ material {material} center {x:.2} {size:.3} {z:.2} size 0.6 {:.3} 0.5 }}",
                2.0 * size
            ),
            1 => writeln!(
                out,
                "cylinder o{index} {{ material {material} base {x:.2} 0 {z:.2} height {:.2} radius {:.3} }}",
                2.0 * size,
                0.5 * size
            ),
            2 => writeln!(
                out,
                "torus o{index} {{ material {material} center {x:.2} {size:.3} {z:.2} direction 0.3 1 0.4 radius {size:.3} tube {:.3} }}",
                0.3 * size
            ),
            3 => writeln!(
                out,
                "sphere o{index} {{ material a center {x:.2} {size:.3} {z:.2} radius {size:.3} shader k }}"
            ),
            _ => writeln!(
                out,
                "sphere o{index} {{ material {material} center {x:.2} {size:.3} {z:.2} radius {size:.3} }}"
            ),
        };
    }
    if random.is(0.25) {
        let (radius, material) = (random.number(0.003, 0.03), ["b", "m"][random.below(2)]);
        let _ = writeln!(
            out,
            "repeat i {} {{ cylinder wire {{ material {material} base \"-3+0.5*i\" 0 -1 direction 0.1 1 0 height 3 radius {radius:.4} }} }}",
            4 + random.below(9)
        );
    }
    let is_open = random.is(0.5);
    if is_open {
        let lights = if random.is(0.5) { "lights yes" } else { "" };
        let (horizon, zenith) = (random.colour(0.3, 1.0), random.colour(0.1, 0.8));
        let _ = writeln!(out, "sky s {{ {lights} horizon {horizon} zenith {zenith} ground 0.2 0.2 0.2 }}");
    }
    let (x, y, z) = (random.number(-3.0, 3.0), random.number(2.0, 5.0), random.number(-1.0, 4.0));
    let _ = match random.below(if is_open { 6 } else { 5 }) {
        0 => {
            let (radius, sent) = (random.number(0.02, 0.4), random.number(0.3, 2.0));
            let sent = sent / (radius * radius);
            writeln!(
                out,
                "sphere_light bulb {{ location {x:.2} {y:.2} {z:.2} radius {radius:.3} emissivity {sent:.1} {sent:.1} {sent:.1} }}"
            )
        }
        1 => {
            let (side, sent) = (random.number(0.2, 1.5), random.number(2.0, 20.0));
            let sent = sent / (side * side);
            writeln!(
                out,
                "area_light key {{ location {x:.2} {y:.2} {z:.2} target 0 0.7 0 dimensions {side:.2} {side:.2} emissivity {sent:.1} {sent:.1} {sent:.1} }}"
            )
        }
        2 => writeln!(
            out,
            "sun low {{ direction {x:.2} {y:.2} {z:.2} angle {:.2} emissivity 1 0.95 0.85 }}",
            random.number(0.5, 6.0)
        ),
        3 | 4 => writeln!(out, "light l {{ location {x:.2} {y:.2} {z:.2} emissivity 0.9 0.9 0.9 }}"),
        _ => Ok(()),
    };
    text
}
