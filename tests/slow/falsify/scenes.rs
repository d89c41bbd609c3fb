//! Scenes as text: a viewer, the ray through the middle of the image plane, and shapes placed in its way.

use super::random::{Point, Random, moved, unit};
use std::f64::consts::TAU;
use std::fmt::Write;

/// A scene, and the pixels whose first hits are asked for.
pub struct Question {
    pub text: String,
    /// The text of `mesh.obj`, beside the scene; empty if there is none.
    pub mesh: String,
    pub pixels: Vec<[usize; 2]>,
    /// Whether the whole image is rendered as well.
    pub is_picture: bool,
}

/// A viewer, and the ray through the middle of the image plane, on which objects are placed.
pub struct Aim {
    pub eye: Point,
    /// The unit vector along the ray through the middle of the image plane.
    pub u: Point,
    /// A point of that ray at which to place an object; `far` is its distance from the eye.
    pub target: Point,
    pub far: f64,
    screen: [f64; 2],
    /// The factor that all lengths are multiplied by, a power of two.
    scale: f64,
}

impl Question {
    /// Returns the question with the text of `mesh.obj`.
    pub fn with_mesh(self, mesh: String) -> Self {
        Self { mesh, ..self }
    }

    /// Returns the question with entities before all others, to which these refer.
    pub fn with_patterns(self, patterns: &str) -> Self {
        Self { text: format!("{patterns}{}", self.text), ..self }
    }
}

impl Aim {
    /// Returns a random viewer and target, up to about 10^`far` world units away from the image plane.
    pub fn new(random: &mut Random, far: f64) -> Self {
        let middle = [random.power(0.0, 1.0), random.power(0.0, 1.0), 0.0];
        let away = if random.once_in(2) { random.between(0.5, 12.0) } else { random.power(0.0, far) };
        let mut back = random.direction();
        back[2] = if random.once_in(3) { 1.0 } else { back[2].abs() + 0.05 };
        if random.once_in(8) {
            back = [0.0, 0.0, 1.0];
        }
        let eye = moved(middle, away, unit(back));
        let beyond = if random.once_in(2) { random.between(0.5, 12.0) } else { random.power(0.0, far) };
        Self::through(eye, middle, beyond)
    }

    /// Aims from an eye through the middle of the image plane, at a point `beyond` world units behind it.
    pub fn through(eye: Point, middle: Point, beyond: f64) -> Self {
        let u = unit([0, 1, 2].map(|axis| middle[axis] - eye[axis]));
        let screen = [2.0 * middle[0], 2.0 * middle[1]];
        let far = (eye[2] / -u[2]) + beyond;
        Self { eye, u, target: moved(middle, beyond, u), far, screen, scale: 1.0 }
    }

    /// Returns a viewer near that of the notes or farther away, and a target in the notes' scene.
    pub fn plain(random: &mut Random, far: f64) -> Self {
        let away = if random.once_in(2) { 6.0 } else { random.power(0.0, far) };
        let eye = [random.between(2.0, 6.0), random.between(2.0, 4.0), away];
        Self::through(eye, [4.0, 3.0, 0.0], random.between(2.0, 9.0))
    }

    /// Multiplies all lengths by 2^`power`.
    pub fn scaled(&mut self, power: i32) {
        self.scale = 2_f64.powi(power);
    }

    /// Writes a length, multiplied by the scale.
    pub fn length(&self, of: f64) -> String {
        format!("{:?}", of * self.scale)
    }

    pub fn lengths<const N: usize>(&self, of: [f64; N]) -> String {
        of.map(|length| self.length(length)).join(" ")
    }

    /// Returns the scene of a single pixel with these objects, each given as its type and its attributes without the
    /// material.
    pub fn question(&self, objects: &[String]) -> Question {
        let pixels = vec![[0, 0]];
        self.with(objects, [1, 1], pixels, false)
    }

    /// Returns the scene with 24 random pixels of a fine grid.
    pub fn many(&self, random: &mut Random, objects: &[String]) -> Question {
        let size = [random.whole(2, 3000) as usize, random.whole(2, 3000) as usize];
        let pixels = (0..24).map(|_| size.map(|side| random.below(side as u64) as usize)).collect();
        self.with(objects, size, pixels, false)
    }

    /// Returns the scene with all pixels of a small image.
    pub fn picture(&self, objects: &[String]) -> Question {
        let [width, height] = [16, 12];
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y])).collect();
        self.with(objects, [width, height], pixels, true)
    }

    fn with(
        &self,
        objects: &[String],
        [width, height]: [usize; 2],
        pixels: Vec<[usize; 2]>,
        is_picture: bool,
    ) -> Question {
        let mut text = format!(
            "camera eye {{ pixeldim {width} {height} worlddim {} viewpoint {} }}\n",
            self.lengths(self.screen),
            self.lengths(self.eye),
        );
        for (index, object) in objects.iter().enumerate() {
            let colour = ["1e300 0 0", "0 1e300 0", "0 0 1e300", "1e300 1e300 0"][index];
            let (kind, rest) = object.split_once(' ').expect("a type and attributes");
            writeln!(text, "material m{index} {{ ambient {colour} }}").expect("room");
            writeln!(text, "{kind} o{index} {{ material m{index} {rest} }}").expect("room");
        }
        Question { text, mesh: String::new(), pixels, is_picture }
    }

    pub fn angle(&self, random: &mut Random) -> f64 {
        if random.once_in(4) { TAU / 4.0 * random.whole(0, 3) } else { random.between(0.0, TAU) }
    }
}

/// Writes numbers that are not lengths.
pub fn numbers<const N: usize>(of: [f64; N]) -> String {
    of.map(|number| format!("{number:?}")).join(" ")
}
