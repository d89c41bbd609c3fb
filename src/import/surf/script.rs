//! The reader of a script's statements.

use crate::expression::{self, Dialect, Names, Value};
use crate::notes::Notes;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use tabray_exact::formula::is_taken;
use tabray_lang::reader::Fault;

/// The numbers of the possible surfaces and lamps of a script.
pub const SURFACES: Range<usize> = 1..10;

/// The clipping bodies, in the order of their numbers.
pub const CLIPS: [&str; 8] =
    ["sphere", "tetrahedron", "cube", "octahedron", "dodecahedron", "icosahedron", "cylinder", "none"];

/// Prefixes of words that control the computation or the use of a picture, and do not affect a scene.
const LEFT: [&str; 21] = [
    "antialiasing",
    "background_dither",
    "change",
    "color_file_format",
    "curve_",
    "depth_cueing",
    "depth_value",
    "dither",
    "epsilon",
    "filename",
    "gamma",
    "iterations",
    "max_light",
    "normalize",
    "pixel_size",
    "print",
    "resolution",
    "root_finder",
    "save_",
    "stereo_",
    "tone_scale",
];

/// Prefixes of words that draw lines beside or on a surface.
const LINES: [&str; 6] =
    ["curve", "cut_with_plane", "cut_with_surface", "draw_curve", "plane", "cut_distance"];

/// Returns a text with comments replaced by spaces.
pub fn without_comments(text: &str) -> String {
    let mut bytes = text.as_bytes().to_vec();
    let mut at = 0;
    while at < bytes.len() {
        let end = match &bytes[at..] {
            [b'"', rest @ ..] => {
                at + 2 + rest.iter().position(|byte| matches!(byte, b'"' | b'\n')).unwrap_or(rest.len())
            }
            [b'/', b'/', ..] => text[at..].find('\n').map_or(text.len(), |length| at + length),
            [b'/', b'*', ..] => text[at + 2..].find("*/").map_or(text.len(), |length| at + length + 4),
            _ => at + 1,
        };
        if bytes[at] == b'/' && end > at + 1 {
            bytes[at..end].iter_mut().filter(|byte| **byte != b'\n').for_each(|byte| *byte = b' ');
        }
        at = end;
    }
    // Whole comments are replaced, and thus whole characters.
    String::from_utf8(bytes).unwrap_or_default()
}

/// The maximum length of all of a script's formulas together, in bytes, with the names of others written out.
const LONGEST: usize = 1 << 26;

/// The variables of a script.
#[derive(Default)]
pub struct Scope {
    variables: BTreeMap<String, Value>,
    /// The length of the formulas of all variables together.
    length: usize,
    /// The numbers and functions of the scene, by their names there, with their formulas.
    pub numbers: Vec<(String, String)>,
    pub functions: Vec<(String, String)>,
    /// The names of both.
    names: BTreeSet<String>,
    /// The number that a name with a number was last given.
    last: BTreeMap<String, usize>,
}

impl Scope {
    /// Returns an unused name for the scene, which is used from now on.
    fn free(&mut self, name: &str) -> String {
        let name = if name.starts_with(|c: char| c.is_ascii_alphabetic()) {
            name.to_owned()
        } else {
            format!("n{name}")
        };
        let is_free = |free: &String| !is_taken(free) && !self.names.contains(free);
        let first = self.last.get(&name).map_or(2, |last| last + 1);
        let mut numbered = (first..).map(|number| (format!("{name}_{number}"), number));
        let free = match Some(name.clone()).filter(is_free) {
            Some(free) => free,
            None => {
                let (free, number) =
                    numbered.find(|(free, _)| is_free(free)).unwrap_or((name.clone(), first));
                self.last.insert(name, number);
                free
            }
        };
        self.names.insert(free.clone());
        free
    }

    /// Gives a variable its value; returns whether there is room for it.
    fn set(&mut self, name: &str, value: Value) -> bool {
        let before = self.variables.get(name).map_or(0, |known| known.text.len());
        let length = self.length - before + value.text.len();
        if length > LONGEST {
            return false;
        }
        self.length = length;
        self.variables.insert(name.to_owned(), value);
        true
    }
}

impl Names for Scope {
    fn value(&self, name: &str) -> Option<Value> {
        self.variables.get(name).cloned()
    }

    fn function(&mut self, formula: &str) -> String {
        let name = self.free("turned");
        self.functions.push((name.clone(), formula.to_owned()));
        name
    }

    fn help(&self, name: &str) -> String {
        format!("`double {name} = 1;` before this line gives it one")
    }
}

/// A script, and the results of reading it.
pub struct Script<'t, 'n> {
    /// The text without its comments.
    pub text: &'t str,
    at: usize,
    pub scope: Scope,
    /// The settings: numbers other than variables, by their names, and their places.
    pub settings: BTreeMap<String, (f64, Range<usize>)>,
    /// The number of drawn surfaces.
    parts: usize,
    pub notes: &'n mut Notes,
}

impl<'t, 'n> Script<'t, 'n> {
    /// Reads a text without comments.
    pub fn read(text: &'t str, notes: &'n mut Notes) -> Self {
        let mut script =
            Self { text, at: 0, scope: Scope::default(), settings: BTreeMap::new(), parts: 0, notes };
        while script.statement() {}
        script
    }
}

impl Script<'_, '_> {
    fn space(&mut self) {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
    }

    /// Returns the place of the next word, and skips the word.
    fn word(&mut self) -> Range<usize> {
        self.space();
        let rest = &self.text[self.at..];
        let length = rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(rest.len());
        self.at += length;
        self.at - length..self.at
    }

    fn fault(&mut self, fault: Fault) -> bool {
        self.notes.add(fault);
        false
    }

    /// Reads a statement, and tells whether another one follows.
    fn statement(&mut self) -> bool {
        let mut place = self.word();
        let mut word = &self.text[place.clone()];
        if ["int", "double", "poly", "string", "bool"].contains(&word) {
            place = self.word();
            word = &self.text[place.clone()];
        }
        self.space();
        let next = self.text[self.at..].chars().next();
        if word.is_empty() {
            let Some(next) = next else { return false };
            self.at += next.len_utf8();
            let place = self.at - next.len_utf8()..self.at;
            return next == ';' || self.fault(Fault::error(Some(place), "no statement can begin like this"));
        }
        let end = self.end();
        let after = (end + 1).min(self.text.len());
        if self.parts > 0 {
            self.notes.leave(word, place.start);
        } else if ["if", "goto", "while", "for"].contains(&word) || next == Some(':') {
            let fault = Fault::error(Some(place), "a script with jumps is not read");
            return self
                .fault(fault.help("leave out its jumps, and give its variables the values of one picture"));
        } else if end == self.text.len() {
            return self
                .fault(Fault::error(Some(place), "this statement has no end").help("statements end in `;`"));
        } else if next == Some('=') {
            self.assign(word, place, self.at + 1..end);
        } else if next != Some(';') {
            let place = self.at..self.at + next.map_or(0, char::len_utf8);
            return self.fault(
                Fault::error(Some(place), "no statement can continue like this")
                    .help("write statements as `a = 1;` or `draw_surface;`"),
            );
        } else if word == "draw_surface" {
            self.parts = 1;
        } else if LINES.contains(&word) {
            self.notes.add(Fault::warning(Some(place), "lines are left out"));
        } else {
            self.notes.leave(word, place.start);
        }
        self.at = after;
        true
    }

    /// Returns the end of the statement: its `;`, outside of strings.
    fn end(&self) -> usize {
        let mut is_text = false;
        let found = self.text[self.at..].find(|c| {
            is_text ^= c == '"';
            c == ';' && !is_text
        });
        found.map_or(self.text.len(), |length| self.at + length)
    }

    fn assign(&mut self, name: &str, place: Range<usize>, range: Range<usize>) {
        let value = self.text[range.clone()].trim();
        if LEFT.iter().any(|left| name.starts_with(left)) || value.starts_with('"') {
            return self.notes.leave(name, place.start);
        }
        if LINES.contains(&name) {
            return self.notes.add(Fault::warning(Some(place), "lines are left out"));
        }
        if name.starts_with("clip_surface") {
            if self.settings.insert("clip_surface".to_owned(), (1.0, place.clone())).is_none() {
                let fault = Fault::warning(Some(place), "the cuts of a surface through others are left out");
                self.notes.add(fault.label("`clip` and `radius` are kept"));
            }
            return;
        }
        if name == "illumination" {
            for word in ["ambient", "diffuse", "reflected"] {
                let is_on = value.contains(&format!("{word}_light"));
                self.settings.insert(format!("has_{word}"), (f64::from(u8::from(is_on)), range.clone()));
            }
            return;
        }
        let word = CLIPS.iter().position(|clip| *clip == value).or((value == "ball").then_some(0));
        if let Some(number) = word.filter(|_| name == "clip") {
            self.settings.insert(name.to_owned(), (number as f64, place));
            return;
        }
        if let Some(number) = ["parallel", "perspective"].iter().position(|kind| *kind == value) {
            self.settings.insert(name.to_owned(), (number as f64, place));
            return;
        }
        match expression::read(self.text, range.clone(), Dialect::Surf, &mut self.scope) {
            Ok(value) => self.keep(name, place, range, value),
            Err(fault) => self.notes.add(*fault),
        }
    }

    fn keep(&mut self, name: &str, place: Range<usize>, range: Range<usize>, value: Value) {
        let is_surface = surface_number(name).is_some();
        let value = match value.number {
            Some(number) if !number.is_finite() => {
                let start = range.end - self.text[range.clone()].trim_start().len();
                return self.notes.add(Fault::error(Some(start..range.end), "this is not a number"));
            }
            Some(number) if is_setting(name) => {
                self.settings.insert(name.to_owned(), (number, place));
                return;
            }
            // `a = a` does not define another number.
            Some(number) if !is_surface && !self.scope.names.contains(&value.text) => {
                let ours = self.scope.free(name);
                self.scope.numbers.push((ours.clone(), value.text));
                Value::named(&ours, number)
            }
            None if is_setting(name) => {
                return self.notes.add(Fault::error(Some(place), format!("`{name}` must be a number")));
            }
            _ => value,
        };
        if is_surface {
            self.settings.insert(name.to_owned(), (0.0, place.clone()));
        }
        if !self.scope.set(name, value) {
            let message = format!("written out, the formulas have more than {LONGEST} letters together");
            self.notes.add(Fault::error(Some(place), message).help("leave out those that no surface needs"));
        }
    }
}

/// Returns the number of a surface, given its name.
fn surface_number(name: &str) -> Option<usize> {
    SURFACES
        .into_iter()
        .find(|index| name == if *index == 1 { "surface".to_owned() } else { format!("surface{index}") })
}

/// Tells whether a name is that of a setting, which is a number.
fn is_setting(name: &str) -> bool {
    let (stem, part) = name.rsplit_once('_').unwrap_or((name, ""));
    let stem = stem.trim_end_matches(|c: char| c.is_ascii_digit());
    match stem {
        "rot" | "scale" | "origin" | "center" => ["x", "y", "z"].contains(&part),
        "surface" | "inside" | "background" => ["red", "green", "blue"].contains(&part),
        "light" => ["x", "y", "z", "vol", "red", "green", "blue"].contains(&part),
        "clip" => ["", "front", "back"].contains(&part),
        "spec" => part == "z",
        _ => {
            part.is_empty()
                && [
                    "width",
                    "height",
                    "radius",
                    "perspective",
                    "ambient",
                    "diffuse",
                    "reflected",
                    "transmitted",
                    "smoothness",
                    "thickness",
                    "transparence",
                ]
                .contains(&stem)
        }
    }
}
