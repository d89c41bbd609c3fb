//! Recognises texts in other languages, which are not read as scenes.

use super::fault::Fault;
use super::notes::has_entities;
use super::report::Report;
use super::tokens::{Token, Tokens};
use crate::registry::Registry;
use crate::syntax::Syntax;
use std::collections::HashSet;

/// Words with which a statement of POV-Ray's language begins, and which scenes have no use for. Those with a `#` begin
/// a line.
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

/// The number of different signs that tell POV-Ray's language for certain: some words may be those of a scene.
const ENOUGH: usize = 2;

/// Returns the report on a text that is not read as a scene: the one given, or that it is one in another language.
pub fn recognised(
    registry: &Registry,
    report: Report<'static>,
    name: &str,
    text: &str,
    syntax: Syntax,
) -> Result<Report<'static>, Report<'static>> {
    let fault = match syntax {
        Syntax::Toml => of_notes(registry, name, text),
        Syntax::Notes => of_pov(text, name).or_else(|| of_numbers(registry, text)),
    };
    let Some(fault) = fault else { return Err(report) };
    let mut report = Report::new(name, text.to_owned(), syntax);
    report.add(fault);
    Ok(report)
}

/// Recognises a text in the notes' syntax.
fn of_notes(registry: &Registry, name: &str, text: &str) -> Option<Fault> {
    // Most texts in TOML have no braces, and entities of the notes' syntax do.
    if Syntax::of_name(name) != Some(Syntax::Toml) || !text.contains('{') {
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
    // Entities of scenes have names, and values no brackets.
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
        // A shape without a name begins with its place: `sphere { <0, 1, 2>, 2`.
        if code.split('{').skip(1).any(|rest| rest.trim_start().starts_with('<')) {
            found.insert("{ <");
        }
    }
    let is_told = found.len() >= ENOUGH || name.ends_with(".pov");
    first.filter(|_| is_told && !found.is_empty()).map(|place| {
        Fault::error(Some(place), "this is a POV-Ray scene, in another language").help(
            "`tabray new scene NAME` writes a scene to start from; `tabray list` lists the entity types",
        )
    })
}

/// Recognises a scene of numbers, which stand for what other scenes say in words.
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
