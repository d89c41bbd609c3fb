//! Recognises texts in other languages, which are not read as scenes.

use super::fault::Fault;
use super::notes::has_entities;
use super::report::Report;
use super::tokens::{Token, Tokens};
use crate::import::{self, Program};
use crate::registry::Registry;
use crate::syntax::Syntax;
use std::collections::HashSet;
use std::ops::Range;

/// Words that begin a statement of POV-Ray's language, and do not occur in scenes. Those with a `#` begin a line.
const POV: [&str; 12] = [
    "#declare",
    "#include",
    "#local",
    "#macro",
    "#version",
    "finish",
    "global_settings",
    "light_source",
    "phong",
    "pigment",
    "rgb",
    "rgbt",
];

/// The number of different signs that prove POV-Ray's language, because scenes may have some of these words.
const ENOUGH: usize = 2;

/// Other languages, with the beginnings of their texts.
const OTHERS: [Language; 4] = [
    Language { name: "a Mitsuba scene", begins: &["<?xml", "<scene", "<!--"], has: &["<scene"] },
    Language { name: "an XML file, not a scene", begins: &["<?xml", "<"], has: &["</"] },
    Language {
        name: "a JSON file, not a scene",
        begins: &["{", "[{", "[ {", "[\n", "[\r\n"],
        has: &["\":", "\" :"],
    },
    Language {
        name: "a pbrt scene",
        begins: &[],
        has: &["\nWorldBegin", "\nAttributeBegin", "Camera \"", "Sampler \"", "Integrator \""],
    },
];

/// Another language.
struct Language {
    name: &'static str,
    /// The possible beginnings of a text, or none if a text may begin with anything.
    begins: &'static [&'static str],
    /// Signs of a text. It has at least one of them, and two if it may begin with anything.
    has: &'static [&'static str],
}

impl Language {
    fn recognised(&self, text: &str) -> Option<Fault> {
        let body = text.trim_start();
        let start = text.len() - body.len();
        let enough = if self.begins.is_empty() { ENOUGH } else { 1 };
        let is_begun = self.begins.is_empty() || self.begins.iter().any(|begin| body.starts_with(begin));
        let found = self.has.iter().filter(|sign| text.contains(**sign)).take(enough).count();
        (is_begun && found == enough).then(|| {
            let line = body.lines().next().unwrap_or_default().trim_end();
            in_another_language(start..start + line.len(), self.name)
        })
    }
}

fn in_another_language(place: Range<usize>, what: &str) -> Fault {
    let what = if what.contains(", ") { what.to_owned() } else { format!("{what}, in another language") };
    Fault::error(Some(place), format!("this is {what}"))
        .help("`tabray new scene NAME` writes a scene to start from; `tabray list` lists the entity types")
}

/// Returns the report on a text that cannot be read as a scene: the given one, or a report that the text is in another
/// language.
pub fn recognised(
    registry: &Registry,
    report: Report<'static>,
    name: &str,
    text: &str,
    syntax: Syntax,
) -> Result<Report<'static>, Report<'static>> {
    let fault = match syntax {
        Syntax::Toml => of_notes(registry, name, text).or_else(|| of_others(text)),
        Syntax::Notes => {
            // A scene made around a mesh has the mesh's name.
            let mesh = || of_meshes(name, text).filter(|_| has_entities(registry, text).is_none());
            of_surfaces(name, text)
                .or_else(mesh)
                .or_else(|| of_pov(text, name))
                .or_else(|| of_others(text))
                .or_else(|| of_numbers(registry, text))
        }
    };
    let Some(fault) = fault else { return Err(report) };
    let mut report = Report::new(name, text.to_owned(), syntax);
    report.add(fault);
    Ok(report)
}

fn of_others(text: &str) -> Option<Fault> {
    OTHERS.iter().find_map(|other| other.recognised(text))
}

/// Recognises a text in the notes' syntax.
fn of_notes(registry: &Registry, name: &str, text: &str) -> Option<Fault> {
    // Well-formed TOML may look like an entity, for example an inline table.
    let is_toml = || text.parse::<toml::Table>().is_ok();
    // Most texts in TOML have no braces, but entities of the notes' syntax do.
    if Syntax::of_name(name) != Some(Syntax::Toml) || !text.contains('{') || is_toml() {
        return None;
    }
    let first = has_entities(registry, text)?;
    Some(
        Fault::error(Some(first), "this scene is in the syntax of .ray files, not in TOML")
            .label("in TOML, an entity is a table, `[TYPE.NAME]`")
            .help("give the file a name that ends in .ray; `tabray convert A.ray A.toml` writes it in TOML"),
    )
}

/// Recognises a scene of POV-Ray.
fn of_pov(text: &str, name: &str) -> Option<Fault> {
    // In scenes, entities have names, and values have no brackets.
    if !(text.contains('<') && text.contains('>')) {
        return None;
    }
    let mut found = HashSet::new();
    let mut first = None;
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        let start = at + (line.len() - line.trim_start().len());
        at += line.len();
        let code = line.split("//").next().unwrap_or_default();
        for word in code.split(|c: char| !(c.is_alphanumeric() || c == '_' || c == '#')) {
            if POV.contains(&word) && (!word.starts_with('#') || line.trim_start().starts_with(word)) {
                found.insert(word);
                first.get_or_insert(start..start + line.trim().len());
            }
        }
        // A shape without a name begins with its position: `sphere { <0, 1, 2>, 2`.
        if code.split('{').skip(1).any(|rest| rest.trim_start().starts_with('<')) {
            found.insert("{ <");
        }
    }
    let is_told = found.len() >= ENOUGH || name.ends_with(".pov");
    let place = first.filter(|_| is_told && !found.is_empty())?;
    Some(in_another_language(place, "a POV-Ray scene"))
}

/// Recognises a file of SURFER or surf.
fn of_surfaces(name: &str, text: &str) -> Option<Fault> {
    let Program { what, cure, .. } = import::program(name, text)?;
    let first = text.lines().next().map_or(0, str::len);
    let fault = Fault::error(Some(0..first), format!("this is {what}, not a scene"));
    Some(fault.help(*cure))
}

/// The extensions of mesh files.
const MESHES: [&str; 5] = [".glb", ".gltf", ".obj", ".ply", ".stl"];

/// Returns the report on a file that is not text: the given one, or a report that the file is a mesh, by its name.
pub fn of_bytes(report: Report<'static>, name: &str) -> Report<'static> {
    let Some(fault) = of_meshes(name, "") else { return report };
    let mut report = Report::new(name, String::new(), Syntax::default());
    report.add(fault);
    report
}

/// Recognises a mesh by its name.
fn of_meshes(name: &str, text: &str) -> Option<Fault> {
    let ending = &name[name.rfind('.')?..];
    let is_one = MESHES.iter().any(|known| ending.eq_ignore_ascii_case(known));
    let first = text.lines().next().map(|line| 0..line.trim_end().len()).filter(|first| !first.is_empty());
    is_one.then(|| {
        Fault::error(first, "this is a mesh, not a scene")
            .help(format!("`tabray new scene NAME --mesh {name}` writes a scene that shows it"))
    })
}

/// Recognises a scene that consists of numbers in place of words.
fn of_numbers(registry: &Registry, text: &str) -> Option<Fault> {
    let nowhere = &mut Report::default();
    let mut tokens = Tokens::of(text, nowhere);
    let is_number = |word: &str| word.parse::<f64>().is_ok();
    let first: Token = tokens.ahead[0].filter(|first| is_number(tokens.raw(*first)))?;
    let (mut words, mut numbers) = (0, 0);
    while let Some(token) = tokens.step(nowhere) {
        words += 1;
        numbers += usize::from(is_number(tokens.raw(token)));
    }
    let is_told = numbers > 3 && 2 * numbers > words && has_entities(registry, text).is_none();
    is_told.then(|| {
        Fault::error(Some(first.place()), "this is a scene of numbers: entities and attributes have no names")
            .label("this number stands for a type, or for a value")
            .help(registry.first_steps(Syntax::Notes))
    })
}

#[cfg(test)]
mod tests {
    use crate::reader::{ReadOptions, read_by};
    use crate::registry::Registry;
    use std::path::Path;

    #[test]
    fn a_scene_with_the_name_of_its_mesh_is_told_its_own_faults() {
        let registry = Registry::get().expect("entity types");
        let faults = |text: &str| {
            let read = read_by(registry, "part.obj", Path::new(""), text.as_bytes(), ReadOptions::default());
            read.map(drop).expect_err("a fault").to_string()
        };
        let scene = faults("camera eye { pixeldim 4 3  worlddim 4 3  viewpoint 0 0 9  colour 1 }");
        assert!(scene.contains("`colour`") && !scene.contains("this is a mesh"), "{scene}");
        let mesh = faults("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        assert!(mesh.contains("this is a mesh, not a scene"), "{mesh}");
    }
}
