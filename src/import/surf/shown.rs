//! The picture described by the settings and the surfaces of a script.

use super::script::{CLIPS, SURFACES, Script};
use crate::expression::{Names, turn};
use crate::picture::{Clip, Light, Look, Picture, Surface};
use glam::{DMat3, DVec3};
use tabray_lang::reader::Fault;

/// The visible extent along the shorter side of a picture.
const SEEN: f64 = 20.0;

/// The maximum width and height of a picture.
const MAX_PIXELS: f64 = 100_000.0;

impl Script<'_, '_> {
    fn number(&self, name: &str, default: f64) -> f64 {
        self.settings.get(name).map_or(default, |(number, _)| *number)
    }

    fn numbers(&self, names: [String; 3], default: [f64; 3]) -> DVec3 {
        DVec3::from([0, 1, 2].map(|at| self.number(&names[at], default[at])))
    }

    /// Returns a colour with channels from 0 to 1, from settings in bytes.
    fn colour(&self, what: &str, default: [f64; 3]) -> DVec3 {
        self.numbers(["red", "green", "blue"].map(|channel| format!("{what}_{channel}")), default)
            .max(DVec3::ZERO)
            / 255.0
    }

    fn axes(&self, what: &str, default: f64) -> DVec3 {
        self.numbers(["x", "y", "z"].map(|axis| format!("{what}_{axis}")), [default; 3])
    }

    fn looks(&self, number: &str) -> [Look; 2] {
        let has = |word: &str| self.number(&format!("has_{word}"), 1.0);
        let ambient = has("ambient") * self.number(&format!("ambient{number}"), 25.0) / 100.0;
        let diffuse = has("diffuse") * self.number(&format!("diffuse{number}"), 60.0) / 100.0;
        let outside = self.colour(&format!("surface{number}"), [123.0, 104.0, 238.0]);
        let inside = self.colour(&format!("inside{number}"), [230.0, 180.0, 30.0]);
        [outside, inside].map(|colour| Look {
            ambient: ambient * colour,
            diffuse: diffuse * colour,
            highlight: 0.0,
            shininess: 0.0,
        })
    }

    fn clips(&mut self) -> Vec<Clip> {
        let middle = self.axes("center", 0.0);
        let radius = self.number("radius", 10.0);
        let kind = self.number("clip", 0.0);
        let mut clips = match CLIPS.get(kind as usize) {
            Some(&"sphere") => vec![Clip::Ball(middle, radius)],
            Some(&"cube") => vec![Clip::Cube(middle, radius)],
            Some(&"cylinder") => vec![Clip::Cylinder(middle, radius)],
            Some(&"none") | None => Vec::new(),
            Some(name) => {
                let place = self.settings["clip"].1.clone();
                let fault =
                    Fault::warning(Some(place), format!("the surface is cut by a ball, not by a {name}"));
                self.notes.add(fault.help("`sphere`, `cube`, `cylinder` and `none` are kept"));
                vec![Clip::Ball(middle, radius)]
            }
        };
        for (name, sign) in [("clip_front", 1.0), ("clip_back", -1.0)] {
            clips.extend(self.settings.get(name).map(|(z, _)| Clip::Plane(*z, sign)));
        }
        clips
    }

    /// Returns the picture, unless it cannot be converted.
    pub fn picture(mut self) -> Option<Picture> {
        let middle = self.axes("origin", 0.0);
        let scale = self.axes("scale", 1.0);
        let angles = self.axes("rot", 0.0);
        let pixels = ["width", "height"].map(|side| self.number(side, 200.0).round());
        let turned = turn(2, angles.z) * turn(0, angles.x) * turn(1, angles.y);
        let back = turned.transpose() * DMat3::from_diagonal(scale);
        let mut surfaces = Vec::new();
        for index in SURFACES {
            let number = if index == 1 { String::new() } else { index.to_string() };
            let name = format!("surface{number}");
            if let Some(formula) = self.scope.value(&name) {
                let around = formula.turn.transpose();
                let map = (around * back, -(around * middle));
                surfaces.push(Surface { formula, map, sides: self.looks(&number) });
            }
        }
        let lights = SURFACES.filter_map(|index| {
            // By default, lights are in three rows of three in front of the picture.
            let (column, row) = ((index - 1) % 3, (index - 1) / 3);
            let default = [100.0 * (column as f64 - 1.0), 100.0 * (1.0 - row as f64), 100.0];
            let at = self.numbers(["x", "y", "z"].map(|axis| format!("light{index}_{axis}")), default);
            let strength = match index {
                1 => 50.0,
                3 => 70.0,
                _ => 0.0,
            };
            let strength = self.number(&format!("light{index}_vol"), strength) / 100.0;
            let colour = strength * self.colour(&format!("light{index}"), [255.0; 3]);
            (colour != DVec3::ZERO).then_some(Light { at, colour })
        });
        let lights = lights.collect();
        self.say_what_is_left();
        for (name, is_right) in [
            ("width", (1.0..=MAX_PIXELS).contains(&pixels[0])),
            ("height", (1.0..=MAX_PIXELS).contains(&pixels[1])),
            ("radius", self.number("radius", 1.0) > 0.0),
            ("scale_x", scale.x != 0.0),
            ("scale_y", scale.y != 0.0),
            ("scale_z", scale.z != 0.0),
        ] {
            if !is_right {
                let place = self.settings[name].1.clone();
                self.notes
                    .add(Fault::error(Some(place), format!("`{name}` cannot be {}", self.number(name, 0.0))));
            }
        }
        if surfaces.is_empty() {
            // Errors in formulas come first.
            if !self.notes.report.is_fatal() {
                let fault = Fault::error(
                    Some(0..self.text.lines().next().map_or(0, str::len)),
                    "this script has no surface",
                );
                self.notes
                    .add(fault.help("a script of surf has a line such as `surface = x^2 + y^2 + z^2 - 25;`"));
            }
            return None;
        }
        let shorter = pixels[0].min(pixels[1]);
        Some(Picture {
            surfaces,
            clips: self.clips(),
            lights,
            background: self.colour("background", [0.0; 3]),
            size: pixels.map(|side| SEEN * side / shorter),
            pixels: pixels.map(|side| side as u32),
            numbers: self.scope.numbers,
            functions: self.scope.functions,
        })
    }

    /// Warns of settings that change the picture, and lists those that do not.
    fn say_what_is_left(&mut self) {
        let mut is_told = false;
        for (name, (value, place)) in &self.settings {
            let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
            let warning = match stem {
                "transparence" if *value != 0.0 => Some("the transparency of a surface is left out"),
                "perspective" if *value != 0.0 => {
                    Some("perspective is left out: the scene shows parallel rays")
                }
                "reflected" if *value != 0.0 && !is_told => {
                    is_told = true;
                    Some("highlights are left out: give the materials `highlight` and `shininess`")
                }
                "reflected" | "smoothness" | "thickness" | "transmitted" | "spec_z" => {
                    self.notes.left.push((name.clone(), place.start));
                    None
                }
                _ => None,
            };
            if let Some(warning) = warning {
                self.notes.report.add(Fault::warning(Some(place.clone()), warning));
            }
        }
        self.notes.left.sort_by_key(|(_, at)| *at);
    }
}
