//! Files of SURFER and its renderer, jsurf: Java properties, one on a line.

use super::expression::{self, Dialect, Names, Read, Value};
use super::notes::Notes;
use super::picture::{Clip, Light, Look, Picture, Surface};
use glam::{DMat3, DVec3};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use tabray_core::text::shortest;
use tabray_exact::formula::is_taken;
use tabray_lang::reader::Fault;

/// The width and height of the image, which files do not give.
const PIXELS: u32 = 240;

/// The number of lamps.
const LIGHTS: usize = 8;

const MATRIX: [f64; 16] = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];

/// Reads a file.
pub fn read(text: &str, notes: &mut Notes) -> Option<Picture> {
    let file = File::new(text);
    let Some(equation) = file.find("surface_equation") else {
        let fault = Fault::error(
            Some(0..text.lines().next().map_or(0, str::len)),
            "this file has no `surface_equation`",
        );
        notes.add(fault.help("a file of SURFER has a line such as `surface_equation=x^2+y^2+z^2-a`"));
        return None;
    };
    let mut parameters = Parameters::default();
    for entry in &file.entries {
        if let Some(name) = file.text[entry.key.clone()].strip_prefix("surface_parameter_")
            && !parameters.places.contains_key(name)
        {
            let value = file.numbers(&file.text[entry.key.clone()], [0.0], notes);
            let ours = if is_taken(name) || !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
                format!("parameter_{name}")
            } else {
                name.to_owned()
            };
            parameters.places.insert(name.to_owned(), parameters.all.len());
            parameters.all.push((ours, value[0]));
        }
    }
    let formula = expression::read(text, equation, Dialect::Surfer, &mut parameters);
    let picture = file.picture(formula, parameters, notes);
    let used = file.used.take();
    for entry in &file.entries {
        let key = &file.text[entry.key.clone()];
        if used.contains(key) {
            continue;
        }
        notes.leave(key, entry.key.start);
    }
    picture
}

/// The parameters of a formula.
#[derive(Default)]
struct Parameters {
    /// Their names in the scene, and their values.
    all: Vec<(String, f64)>,
    /// Their places by their names in the formula.
    places: BTreeMap<String, usize>,
}

impl Names for Parameters {
    fn value(&self, name: &str) -> Option<Value> {
        let (ours, value) = &self.all[*self.places.get(name)?];
        Some(Value::named(ours, *value))
    }

    fn function(&mut self, _formula: &str) -> String {
        unreachable!("only scripts turn formulas")
    }

    fn help(&self, name: &str) -> String {
        format!("a line such as `surface_parameter_{name}=1` gives it one")
    }
}

/// A property: its name and its value.
struct Entry {
    key: Range<usize>,
    value: Range<usize>,
}

/// Returns the properties of a file. A line that ends in `\` continues on the next one.
fn entries(text: &str) -> Vec<Entry> {
    let mut entries = Vec::new();
    let mut at = 0;
    while at < text.len() {
        let start = at;
        loop {
            let line = text[at..].split_inclusive('\n').next().unwrap_or_default();
            at += line.len();
            let body = line.trim_end_matches(['\n', '\r']);
            let slashes = body.len() - body.trim_end_matches('\\').len();
            if slashes.is_multiple_of(2) || at == text.len() || body.trim_start().starts_with(['#', '!']) {
                break;
            }
        }
        let line = text[start..at].trim_end();
        let from = start + (line.len() - line.trim_start().len());
        let line = line.trim_start();
        if line.is_empty() || line.starts_with(['#', '!']) {
            continue;
        }
        let length = line.find(|c: char| c == '=' || c == ':' || c.is_whitespace()).unwrap_or(line.len());
        let rest = line[length..].trim_start();
        let rest = rest.strip_prefix(['=', ':']).unwrap_or(rest).trim_start();
        entries.push(Entry {
            key: from..from + length,
            value: from + line.len() - rest.len()..from + line.len(),
        });
    }
    entries
}

struct File<'t> {
    text: &'t str,
    entries: Vec<Entry>,
    /// The place of each property's value. The last occurrence counts.
    values: BTreeMap<&'t str, Range<usize>>,
    /// The names of the properties that were used.
    used: RefCell<BTreeSet<String>>,
}

impl<'t> File<'t> {
    fn new(text: &'t str) -> Self {
        let entries = entries(text);
        let values = entries.iter().map(|Entry { key, value }| (&text[key.clone()], value.clone())).collect();
        Self { text, entries, values, used: RefCell::default() }
    }

    /// Returns the place of a property's value.
    fn find(&self, key: &str) -> Option<Range<usize>> {
        self.used.borrow_mut().insert(key.to_owned());
        self.values.get(key).cloned()
    }

    fn word(&self, key: &str) -> Option<&str> {
        self.find(key).map(|range| &self.text[range])
    }

    /// Returns the numbers of a property, or the default if it is not given.
    fn numbers<const N: usize>(&self, key: &str, default: [f64; N], notes: &mut Notes) -> [f64; N] {
        let Some(range) = self.find(key) else { return default };
        let words = self.text[range.clone()].split_whitespace();
        let numbers: Vec<f64> =
            words.map_while(|word| word.parse().ok()).filter(|number: &f64| number.is_finite()).collect();
        let count = self.text[range.clone()].split_whitespace().count();
        match numbers.try_into() {
            Ok(numbers) if count == N => numbers,
            _ => {
                let what = if N == 1 { "a number".to_owned() } else { format!("{N} numbers") };
                let place = if range.is_empty() { range.start.saturating_sub(1)..range.end } else { range };
                notes.add(Fault::error(Some(place), format!("`{key}` must be {what}")));
                default
            }
        }
    }

    fn colour(&self, key: &str, default: f64, notes: &mut Notes) -> DVec3 {
        DVec3::from(self.numbers(key, [default; 3], notes)).max(DVec3::ZERO)
    }

    /// Returns the linear part and the offset of a matrix in row order.
    fn matrix(&self, key: &str, notes: &mut Notes) -> (DMat3, DVec3) {
        let m = self.numbers(key, MATRIX, notes);
        let row = |at: usize| DVec3::new(m[at], m[at + 1], m[at + 2]);
        (DMat3::from_cols(row(0), row(4), row(8)).transpose(), DVec3::new(m[3], m[7], m[11]))
    }

    fn look(&self, side: &str, notes: &mut Notes) -> Look {
        let colour = self.colour(&format!("{side}_material_color"), 0.5, notes);
        let [ambient] = self.numbers(&format!("{side}_material_ambient_intensity"), [0.1], notes);
        let [diffuse] = self.numbers(&format!("{side}_material_diffuse_intensity"), [0.232_32], notes);
        let strengths = ["specular_intensity", "specular_iIntensity"].map(|key| {
            let [strength] = self.numbers(&format!("{side}_material_{key}"), [0.0], notes);
            strength
        });
        let [shininess] = self.numbers(&format!("{side}_material_shininess"), [0.0], notes);
        let highlight = strengths[0].max(strengths[1]).max(0.0);
        Look {
            ambient: ambient * colour,
            diffuse: diffuse * colour,
            highlight,
            shininess: shininess.max(0.0),
        }
    }

    fn picture(&self, formula: Read<Value>, parameters: Parameters, notes: &mut Notes) -> Option<Picture> {
        let [height] = self.numbers("camera_height", [2.0], notes);
        let (camera, moved) = self.matrix("camera_transform", notes);
        self.find("camera_fov_y");
        if let Some(range) =
            self.find("camera_type").filter(|range| self.text[range.clone()] == *"PERSPECTIVE_CAMERA")
        {
            notes.add(
                Fault::warning(Some(range), "perspective is left out").label("the scene shows parallel rays"),
            );
        }
        let (transform, transform_moved) = self.matrix("transform_matrix", notes);
        let (rotation, rotation_moved) = self.matrix("rotation_matrix", notes);
        let (surface, surface_moved) = self.matrix("surface_transform_matrix", notes);
        let [scale] = self.numbers("scale_factor", [0.0], notes);
        let scale = libm::pow(10.0, scale);
        // The picture's z is 0 at the distance of the moved camera. From there, the maps lead to coordinates where a
        // ball of radius 1 around 0 cuts the surface, and on to the coordinates of the formula.
        let middle = DVec3::new(0.0, 0.0, moved.z);
        let to_ball = transform * rotation * camera.inverse();
        let ball_moved = transform_moved + transform * rotation_moved - to_ball * (moved - middle);
        let map = (surface * scale * to_ball, surface * scale * ball_moved + surface_moved);
        let ball = Clip::Ball(-(to_ball.inverse() * ball_moved), 1.0 / to_ball.x_axis.length());
        let sides = ["front", "back"].map(|side| self.look(side, notes));
        let mut lights = Vec::new();
        for index in 0..LIGHTS {
            let is_on = self.word(&format!("light_status_{index}")) == Some("ON");
            let at = DVec3::from(self.numbers(&format!("light_position_{index}"), [0.0; 3], notes));
            let colour = self.colour(&format!("light_color_{index}"), 1.0, notes);
            let [intensity] = self.numbers(&format!("light_intensity_{index}"), [1.0], notes);
            if is_on && intensity > 0.0 {
                lights.push(Light { at: at - middle, colour: intensity * colour });
            }
        }
        let background = self.colour("background_color", 1.0, notes);
        for (key, value) in [("camera_height", height), ("scale_factor", scale)] {
            if !(value > 0.0 && value.is_finite()) || map.0.determinant() == 0.0 {
                let place = self.find(key).or_else(|| self.find("rotation_matrix"));
                notes.add(Fault::error(place, "the surface has no size in the picture"));
                return None;
            }
        }
        let formula = formula.map_err(|fault| notes.add(*fault)).ok()?;
        Some(Picture {
            numbers: parameters.all.into_iter().map(|(ours, value)| (ours, shortest(value))).collect(),
            functions: Vec::new(),
            surfaces: vec![Surface { formula, map, sides }],
            clips: vec![ball],
            lights,
            background,
            size: [height; 2],
            pixels: [PIXELS; 2],
        })
    }
}
