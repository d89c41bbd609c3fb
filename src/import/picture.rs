//! The picture of a file of SURFER or surf, and its conversion to a scene.

use super::expression::{Value, linear};
use glam::{DMat3, DQuat, DVec3};
use std::fmt::Write;
use tabray_core::text::shortest;

/// The tolerance for the axes of a view, which should have equal lengths and right angles, relative to their length.
/// Files have seven digits.
const SIMILAR: f64 = 1e-5;

/// The extent of a picture without a clip from the middle, in heights of the picture.
const DEEP: f64 = 5.0;

/// The samples of each pixel, and the operations in formulas up to which there are so many. A surface is first to be seen
/// in a second or two.
const SAMPLES: u32 = 4;
const SHORT: usize = 60;

/// A picture, in its own coordinates: x right, y up and z toward the viewer.
pub struct Picture {
    /// Named numbers, each with its formula.
    pub numbers: Vec<(String, String)>,
    /// Functions of x, y and z.
    pub functions: Vec<(String, String)>,
    pub surfaces: Vec<Surface>,
    /// The bodies that cut the surfaces open.
    pub clips: Vec<Clip>,
    pub lights: Vec<Light>,
    pub background: DVec3,
    /// The width and height of the visible rectangle.
    pub size: [f64; 2],
    pub pixels: [u32; 2],
}

/// A surface, and its placement in the picture.
pub struct Surface {
    pub formula: Value,
    /// The map from the picture's coordinates to those of the formula: a linear map and an offset.
    pub map: (DMat3, DVec3),
    /// The outer side, where the formula is positive, and the inner side.
    pub sides: [Look; 2],
}

/// The appearance of one side.
#[derive(Clone, Copy, PartialEq)]
pub struct Look {
    pub ambient: DVec3,
    pub diffuse: DVec3,
    /// The strength of highlights of lamps, and their exponent.
    pub highlight: f64,
    pub shininess: f64,
}

/// A lamp.
pub struct Light {
    pub at: DVec3,
    pub colour: DVec3,
}

/// A body that cuts a surface.
pub enum Clip {
    /// A ball, by its centre and radius.
    Ball(DVec3, f64),
    /// A cylinder around the z axis, by its centre and radius.
    Cylinder(DVec3, f64),
    /// A cube, by its centre and half its side.
    Cube(DVec3, f64),
    /// A half-space on one side of a plane across the z axis: below the plane if the sign is 1, and above it if the
    /// sign is -1.
    Plane(f64, f64),
}

impl Picture {
    /// Writes the scene. Its coordinates are those of the formula, which stays unchanged. With several formulas in
    /// different places, or a stretched one, the coordinates are those of the picture.
    pub fn scene(&self) -> String {
        let common = self.surfaces[0].map;
        let is_common = self.surfaces.iter().all(|surface| surface.map == common) && is_similar(common.0);
        let (turn, offset) = if is_common { common } else { (DMat3::IDENTITY, DVec3::ZERO) };
        let size = turn.x_axis.length();
        let at = |point: DVec3| turn * point + offset;
        let [low, high] = self.bounds();
        let far = low.abs().max(high.abs()).length() + 1.0;
        let mut bodies = String::new();
        let mut functions = self.functions.clone();
        let middle = at((low + high) / 2.0);
        let half = (high - low) / 2.0;
        let half = (turn.x_axis * half.x).abs() + (turn.y_axis * half.y).abs() + (turn.z_axis * half.z).abs();
        let extent = match self.clips[..] {
            [] => format!("box      {}  {}", point(middle - half), point(middle + half)),
            _ => "clip     cut".to_owned(),
        };
        for (index, surface) in self.surfaces.iter().enumerate() {
            let number = if index == 0 { String::new() } else { (index + 1).to_string() };
            let mut formula = surface.formula.text.clone();
            if !is_common && surface.map != (DMat3::IDENTITY, DVec3::ZERO) {
                let (map, offset) = surface.map;
                let arguments = [0, 1, 2].map(|row| linear(map.row(row).to_array(), offset[row]));
                let name = format!("formula_{}", index + 1);
                functions.push((name.clone(), formula));
                formula = format!("{name}({})", arguments.join(", "));
            }
            let [front, back] = &surface.sides;
            bodies += &material(&format!("front{number}"), front);
            let shader = if front == back {
                String::new()
            } else {
                bodies += &material(&format!("back{number}"), back);
                let _ = writeln!(bodies, "sides both{number} {{ back back{number} }}\n");
                format!("    shader   both{number}\n")
            };
            if index == 0 {
                bodies += &self.cut(turn, offset);
            }
            let _ = writeln!(
                bodies,
                "implicit surface{number}\n{{\n    material front{number}\n{shader}    formula  \"{formula}\"\n    {extent}\n}}\n"
            );
        }
        let mut text = String::new();
        let used = self.used(&bodies, &functions);
        for (name, formula) in &self.numbers {
            if used.contains(&name.as_str()) {
                let is_number = formula.parse::<f64>().is_ok();
                let _ = if is_number {
                    writeln!(text, "let {name} {formula}")
                } else {
                    writeln!(text, "let {name} \"{formula}\"")
                };
            }
        }
        for (name, formula) in &functions {
            let _ = writeln!(text, "let {name}(x, y, z) \"{formula}\"");
        }
        let [wide, high] = self.pixels;
        let formulas = self.surfaces.iter().map(|surface| &surface.formula.text);
        let formulas = formulas.chain(self.functions.iter().map(|(_, formula)| formula));
        let operations: usize =
            formulas.map(|formula| formula.matches(['+', '-', '*', '/', '^']).count()).sum();
        let samples = if operations > SHORT { 1 } else { SAMPLES };
        let _ = writeln!(
            text,
            "\northographic eye\n{{\n    pixeldim {wide} {high}\n    position {}\n    target   {}\n    up       {}\n    width    {}\n    samples  {samples}               # `--size 1000 --samples 16` shows more\n    \
             transfer linear           # colours are bytes there\n}}\n\nbackground behind {{ colour {} }}\n",
            point(at(DVec3::new(0.0, 0.0, far))),
            point(at(DVec3::ZERO)),
            point(turn * DVec3::Y),
            number(size * self.size[0]),
            colour(self.background),
        );
        text += &bodies;
        for (index, light) in self.lights.iter().enumerate() {
            let (at, colour) = (point(at(light.at)), colour(light.colour));
            let _ = writeln!(text, "light lamp_{} {{ location {at}  emissivity {colour} }}", index + 1);
        }
        text
    }

    /// Returns a box around the visible parts, in the picture's coordinates.
    fn bounds(&self) -> [DVec3; 2] {
        let [wide, high] = self.size;
        // Without a clip, the surface is cut at the edges of the picture, with a margin for the outermost pixels.
        let seen = DVec3::new(0.6 * wide, 0.6 * high, DEEP * wide.max(high));
        let mut bounds = [-seen, seen];
        for clip in &self.clips {
            let (middle, half) = match *clip {
                Clip::Ball(middle, radius) | Clip::Cube(middle, radius) => (middle, DVec3::splat(radius)),
                Clip::Cylinder(middle, radius) => (middle, DVec3::new(radius, radius, seen.z)),
                Clip::Plane(..) => continue,
            };
            bounds = [middle - half, middle + half];
        }
        for clip in &self.clips {
            match *clip {
                Clip::Plane(z, 1.0) => bounds[1].z = bounds[1].z.min(z),
                Clip::Plane(z, _) => bounds[0].z = bounds[0].z.max(z),
                _ => {}
            }
        }
        bounds
    }

    /// Writes the closed object that cuts the surfaces, in the scene's coordinates, or an empty text if none does.
    fn cut(&self, turn: DMat3, offset: DVec3) -> String {
        let size = turn.x_axis.length();
        let at = |place: DVec3| point(turn * place + offset);
        let [low, high] = self.bounds();
        match self.clips[..] {
            [] => String::new(),
            [Clip::Ball(middle, radius)] => ball("cut", &at(middle), size * radius),
            [Clip::Ball(middle, radius), ..] => {
                // Only the planes cut the ball: the other sides of the slab are away from it.
                let away = DVec3::splat(0.5 * radius);
                let (mut below, mut above) = (low - away, high + away);
                for clip in &self.clips {
                    match *clip {
                        Clip::Plane(z, 1.0) => above.z = above.z.min(z),
                        Clip::Plane(z, _) => below.z = below.z.max(z),
                        _ => {}
                    }
                }
                let slab = cuboid("slab", turn, &at((below + above) / 2.0), above - below);
                ball("ball", &at(middle), size * radius)
                    + &slab
                    + "intersection cut { objects ball slab }\n\n"
            }
            [Clip::Cylinder(middle, radius), ..] => format!(
                "cylinder cut\n{{\n    material  front\n    base      {}\n    direction {}\n    height    {}\n    radius    {}\n}}\n\n",
                at(middle.with_z(low.z)),
                point(turn * DVec3::Z),
                number(size * (high - low).z),
                number(size * radius),
            ),
            _ => cuboid("cut", turn, &at((low + high) / 2.0), high - low),
        }
    }

    /// Returns the names of the numbers that the scene needs.
    fn used<'s>(&'s self, bodies: &str, functions: &[(String, String)]) -> Vec<&'s str> {
        let mut needed: String = bodies.to_owned();
        functions.iter().for_each(|(_, formula)| needed = format!("{needed} {formula}"));
        let mut used = Vec::new();
        for (name, formula) in self.numbers.iter().rev() {
            let mut words = needed.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
            if words.any(|word| word == name) {
                used.push(name.as_str());
                needed = format!("{needed} {formula}");
            }
        }
        used
    }
}

/// Tells whether a map preserves shapes without mirroring them.
fn is_similar(map: DMat3) -> bool {
    let size = map.x_axis.length_squared();
    let product = map.transpose() * map - DMat3::from_diagonal(DVec3::splat(size));
    size > 0.0
        && map.determinant() > 0.0
        && product.to_cols_array().iter().all(|element| element.abs() <= SIMILAR * size)
}

fn ball(name: &str, middle: &str, radius: f64) -> String {
    format!("sphere {name} {{ material front  center {middle}  radius {} }}\n\n", number(radius))
}

/// Writes a box around a point, with these sides before a map that preserves shapes.
fn cuboid(name: &str, turn: DMat3, middle: &str, sides: DVec3) -> String {
    let size = turn.x_axis.length();
    let sides = point(size * sides);
    let turn = DQuat::from_mat3(&(turn * (1.0 / size)));
    let axis = turn.xyz();
    if axis.length() < SIMILAR {
        return format!("box {name} {{ material front  center {middle}  size {sides} }}\n\n");
    }
    let angle = number((2.0 * libm::atan2(axis.length(), turn.w)).to_degrees());
    let axis = point(axis.normalize());
    format!(
        "box straight {{ material front  center 0 0 0  size {sides} }}\nplace {name} {{ object straight  rotation {axis} {angle}  translation {middle} }}\n\n"
    )
}

fn material(name: &str, look: &Look) -> String {
    let glances = look.highlight > 0.0 && look.shininess > 0.0;
    let highlight = match glances {
        true => {
            format!("    highlight {}\n    shininess {}\n", number(look.highlight), number(look.shininess))
        }
        false => String::new(),
    };
    format!(
        "material {name}\n{{\n    ambient {}\n    diffuse {}\n{highlight}}}\n\n",
        colour(look.ambient),
        colour(look.diffuse)
    )
}

/// Writes a colour to six decimals, a small fraction of a byte's step.
fn colour(of: DVec3) -> String {
    point((1e6 * of).round() / 1e6)
}

fn point(at: DVec3) -> String {
    at.to_array().map(number).join(" ")
}

/// Writes a number to 12 digits, because further digits are rounding errors.
fn number(of: f64) -> String {
    shortest(format!("{of:.11e}").parse::<f64>().unwrap_or(of) + 0.0)
}
