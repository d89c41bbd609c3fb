//! The content of a scene of numbers, as entities of the scene language.

use super::codes::{Numbers, Rule};
use super::found::{Found, Given};
use super::rows::Number;
use super::unmapped::Unmapped;
use crate::reader::fault::Fault;
use crate::reader::parsed::{Form, Parsed, Word};
use crate::reader::report::Report;
use crate::reader::statement::Statement;
use std::ops::Range;
use std::path::Path;
use tabray_core::files;
use tabray_core::text::shortest;

/// The width of the image, in pixels. The programs of the time took it from their command line.
const WIDTH: f64 = 400.0;

/// The maximum number of pixels of a side.
const MAX_PIXELS: f64 = 100_000.0;

/// The entities of a scene. Each is named after its kind and its number.
pub struct Entities<'a, 'r> {
    pub statements: Vec<Statement<'a>>,
    folder: &'r Path,
    /// The vector from the lower left corner of the screen, the origin of other scenes, to its middle, the origin of
    /// these scenes.
    shift: [f64; 2],
    materials: usize,
    objects: usize,
    textures: usize,
    shaders: usize,
}

/// An entity in construction.
struct Draft<'a, 'r, 't> {
    parsed: Parsed<'a>,
    report: &'r mut Report<'t>,
}

impl<'a> Draft<'a, '_, '_> {
    fn word(&mut self, attribute: &'static str, word: impl Into<String>, place: &Range<usize>) {
        self.parsed.value(Word::at(word.into(), Form::Text, place.clone()));
        self.parsed.add(Word::at(attribute, Form::Any, place.clone()), self.report);
    }

    fn numbers(&mut self, attribute: &'static str, values: &[f64], places: &[Range<usize>]) {
        for (value, place) in values.iter().zip(places) {
            self.parsed.value(Word::at(shortest(*value), Form::Number, place.clone()));
        }
        let place = places.first().cloned().unwrap_or_default();
        self.parsed.add(Word::at(attribute, Form::Any, place), self.report);
    }

    fn done(mut self, end: usize) -> Statement<'a> {
        let start = self.parsed.kind.place.as_ref().map_or(0, |place| place.start);
        self.parsed.place = Some(start..end.max(start));
        Statement::Entity(self.parsed)
    }
}

fn draft<'a, 'r, 't>(
    kind: &'static str,
    name: String,
    place: &Range<usize>,
    report: &'r mut Report<'t>,
) -> Draft<'a, 'r, 't> {
    let [kind, name] = [kind.to_owned(), name].map(|word| Word::at(word, Form::Text, place.clone()));
    Draft { parsed: Parsed::begin(kind, name), report }
}

fn places(values: &[Number]) -> Vec<Range<usize>> {
    values.iter().map(|value| value.place.clone()).collect()
}

/// Returns the next number of a counter.
fn next(count: &mut usize) -> usize {
    *count += 1;
    *count - 1
}

impl<'a, 'r> Entities<'a, 'r> {
    /// Begins a scene. Its file names are relative to a folder.
    pub fn new(folder: &'r Path) -> Self {
        let statements = Vec::new();
        Self { statements, folder, shift: [0.0; 2], materials: 0, objects: 0, textures: 0, shaders: 0 }
    }

    /// Adds the camera. Other positions count from the middle of its screen.
    pub fn camera(
        &mut self,
        size: [f64; 2],
        viewpoint: [f64; 3],
        place: Range<usize>,
        report: &mut Report<'_>,
    ) {
        self.shift = size.map(|side| side / 2.0);
        let height = (WIDTH * size[1] / size[0]).round().clamp(1.0, MAX_PIXELS);
        let mut camera = draft("camera", "c".to_owned(), &place, report);
        let [two, three] = [2, 3].map(|count| vec![place.clone(); count]);
        camera.numbers("pixeldim", &[WIDTH, height], &two);
        camera.numbers("worlddim", &size, &two);
        camera.numbers("viewpoint", &self.shifted(&viewpoint), &three);
        self.statements.push(camera.done(place.end));
    }

    /// Returns a point in the coordinates of other scenes.
    fn shifted(&self, point: &[f64]) -> Vec<f64> {
        let shift = self.shift.iter().chain([&0.0]);
        point.iter().zip(shift).map(|(value, shift)| value + shift).collect()
    }

    /// Returns the numbers of a line in the notation of other scenes.
    fn values(&self, line: &Given) -> Vec<f64> {
        let values: Vec<_> = line.values.iter().map(|number| number.value).collect();
        if line.line.rule == Rule::Point { self.shifted(&values) } else { values }
    }

    /// Adds an object or a light, and the entities that it refers to.
    pub fn add(&mut self, found: Found<'a>, unmapped: &mut Unmapped, report: &mut Report<'_>) {
        let mut materials = Vec::new();
        for lines in &found.materials {
            materials.push(self.material(lines, &found, unmapped, report));
        }
        let transparencies: Vec<_> = found.materials.iter().filter_map(|lines| lines.get(3)).collect();
        if let [first, second] = transparencies[..]
            && first.values[0].value != second.values[0].value
        {
            unmapped.add("all tiles of a plane are as transparent as the first", second.place());
        }
        let texture = self.texture(&found, report);
        let shader = self.shader(&found, texture.as_deref(), unmapped, report);
        let end = found.lines.last().map_or(found.place.end, |line| line.place().end);
        let kind = match (found.code.entity, &texture) {
            ("texplane", None) => "fplane",
            (kind, _) => kind,
        };
        self.objects += 1;
        let mut object = draft(kind, format!("o{}", self.objects), &found.place, report);
        if let Some(material) = materials.first() {
            object.word("material", material, &found.place);
        }
        for line in &found.lines {
            let Numbers { attribute, .. } = line.line;
            let (values, places) = (self.values(line), places(&line.values));
            match (found.code.name, line.line.name) {
                (name, "radius and height") => round(&mut object, name, [values[0], values[1]], &places),
                (_, "mode") if kind == "texplane" => {
                    object.numbers("mode", &[values[0] - 1.0], &places);
                }
                ("tiled plane", "point") => {
                    object.numbers("point", &values, &places);
                    object.numbers("origin", &values, &places);
                }
                _ if attribute.is_empty() => {}
                _ => object.numbers(attribute, &values, &places),
            }
        }
        if let [_, other] = &materials[..] {
            object.word("altmaterial", other, &found.place);
            object.word("altmirror", "yes", &found.place);
        }
        if let (Some(texture), "texplane") = (&texture, kind) {
            object.word("texname", texture, &found.place);
        }
        if let Some(shader) = shader {
            object.word("shader", shader, &found.place);
        }
        self.statements.push(object.done(end));
        if let Some(drawn) = found.code.drawn {
            unmapped.add(drawn, found.place);
        }
    }

    fn material(
        &mut self,
        lines: &[Given],
        found: &Found<'_>,
        unmapped: &mut Unmapped,
        report: &mut Report<'_>,
    ) -> String {
        let name = format!("m{}", next(&mut self.materials));
        let place = lines.first().map_or(found.place.clone(), Given::place);
        let mut material = draft("material", name.clone(), &place, report);
        for line in lines {
            let first = &line.values[0];
            match line.line.name {
                "index of refraction" => unmapped.index(first),
                "transparency" if first.value == 0.0 => {}
                name => {
                    if name == "transparency" {
                        let what = "what is transparent tints what is behind it, by its diffuse colour";
                        unmapped.add(what, line.place());
                    }
                    material.numbers(line.line.attribute, &self.values(line), &places(&line.values));
                }
            }
        }
        let end = lines.last().map_or(place.end, |line| line.place().end);
        self.statements.push(material.done(end));
        name
    }

    /// Adds the texture of the file that an object names, if it is used and the file exists.
    fn texture(&mut self, found: &Found<'_>, report: &mut Report<'_>) -> Option<String> {
        let (file, place) = found.file.as_ref().filter(|_| found.code.drawn.is_none())?;
        let path = self.folder.join(file);
        if !files::is_file(&path) {
            let message =
                format!("there is no file `{file}`: this {} has its plain colours", found.code.name);
            report.add(
                Fault::warning(Some(place.clone()), message)
                    .help("the name is relative to the scene's folder"),
            );
            report.add_file(path);
            return None;
        }
        let name = format!("t{}", next(&mut self.textures));
        let mut texture = draft("texture", name.clone(), place, report);
        texture.word("filename", *file, place);
        self.statements.push(texture.done(place.end));
        Some(name)
    }

    /// Adds the shader of an object, if it has one.
    fn shader(
        &mut self,
        found: &Found<'_>,
        texture: Option<&str>,
        unmapped: &mut Unmapped,
        report: &mut Report<'_>,
    ) -> Option<String> {
        if let ("sphere", Some(texture)) = (found.code.entity, texture) {
            let name = format!("s{}", next(&mut self.shaders));
            let mut image = draft("image", name.clone(), &found.place, report);
            image.word("texture", texture, &found.place);
            self.statements.push(image.done(found.place.end));
            return Some(name);
        }
        let number = &found.lines.iter().find(|line| line.line.name == "shader")?.values[0];
        unmapped.shader(number);
        let anchor = found.lines.iter().find(|line| line.line.rule == Rule::Point)?;
        let at = self.values(anchor);
        let ambient = &found.materials.first()?.first()?.values;
        let colour = [0, 1, 2].map(|channel| ambient[channel].value);
        let formulas = match number.value {
            1.0 => swirl([at[0], at[1]], colour),
            2.0 => hues([at[0], at[1]], colour),
            _ => return None,
        };
        let name = format!("s{}", next(&mut self.shaders));
        let mut shader = draft("formula", name.clone(), &number.place, report);
        for formula in formulas {
            shader.parsed.value(Word::at(formula, Form::Text, number.place.clone()));
        }
        let attribute = Word::at("ambient", Form::Any, number.place.clone());
        shader.parsed.add(attribute, shader.report);
        self.statements.push(shader.done(number.place.end));
        Some(name)
    }
}

/// Writes the radius and the height of a round shape.
fn round(object: &mut Draft<'_, '_, '_>, name: &str, [radius, height]: [f64; 2], places: &[Range<usize>]) {
    let [r, h] = [radius, height].map(shortest);
    match name {
        "cone" => object.word("profile", format!("{r}*(1 - y/{h})"), &places[0]),
        "paraboloid" => object.word("profile", format!("{r}*sqrt(1 - y/{h})"), &places[0]),
        _ => {
            object.numbers("radius", &[radius], places);
            object.word("open", "yes", &places[0]);
        }
    }
    object.numbers("height", &[height], &places[1..]);
}

/// Returns the difference between a variable and a number as a formula.
fn from(variable: &str, at: f64) -> String {
    match at {
        0.0 => variable.to_owned(),
        at if at < 0.0 => format!("({variable} + {})", shortest(-at)),
        at => format!("({variable} - {})", shortest(at)),
    }
}

/// Returns the notes' swirl: tiles along u v^2 + u v, alternately without red and without blue.
fn swirl(at: [f64; 2], [red, green, blue]: [f64; 3]) -> [String; 3] {
    let [u, v] = [from("x", at[0]), from("y", at[1])];
    let odd = format!("mod(floor({u}*{v}*({v} + 1)/100), 2)");
    [format!("{}*(1 - {odd})", shortest(red)), shortest(green), format!("{}*{odd}", shortest(blue))]
}

/// Returns hues around a point: 1 + cos(2t + 2 pi k/3) for the angle t of (u, v), with k = 0, 1 and 2.
fn hues(at: [f64; 2], colour: [f64; 3]) -> [String; 3] {
    let [u, v] = [from("x", at[0]), from("y", at[1])];
    let square = format!("({u}^2 + {v}^2)");
    let cosine = format!("({u}^2 - {v}^2)/{square}");
    let sine = format!("sqrt(3)*{u}*{v}/{square}");
    let [red, green, blue] = colour.map(shortest);
    [
        format!("{red}*(1 + {cosine})"),
        format!("{green}*(1 - {cosine}/2 - {sine})"),
        format!("{blue}*(1 - {cosine}/2 + {sine})"),
    ]
}
