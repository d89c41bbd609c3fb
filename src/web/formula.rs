//! The formula of a scene's surface, and the numbers that it names.

use crate::surfaces;
use crate::text::view as read;
use serde::Deserialize;
use serde_json::{Value, json};
use std::ops::Range;
use tabray_core::scene::model::Model;
use tabray_lang::editor::{self, View};
use tabray_lang::registry::Registry;
use tabray_lang::syntax::Syntax;
use tabray_tools::page::fields;

/// What a page calls the numbers of a scene where it lists entities.
pub const NUMBERS: &str = "numbers";

/// A formula, and the text in which it is to stand.
#[derive(Deserialize)]
struct FormulaRequest {
    text: String,
    formula: String,
}

/// Returns the place of the formula of the first `implicit`, without its quotes.
fn place(view: &View) -> Option<Range<usize>> {
    let mut found = None;
    view.visit(&mut |item, _| {
        let editor::Item::Entity(entity) = item else { return };
        if entity.known.is_none_or(|known| known.name != "implicit") {
            return;
        }
        let formula =
            entity.attributes.iter().find(|given| given.known.is_some_and(|it| it.name() == "formula"));
        found = found.take().or_else(|| Some(formula?.values.first()?.inner()));
    });
    found
}

/// Returns the formula of the first `implicit` of a text; null where there is none.
pub fn of(registry: &Registry, text: &str) -> Value {
    let view = read(registry, text);
    place(&view).map_or(Value::Null, |place| view.slice(place).into())
}

/// Replaces the formula of a text's first `implicit`; a text without an `implicit` is replaced as a whole. Names that
/// the text does not know become numbers in the text, with the value 1.
///
/// # Errors
/// Returns why the formula cannot stand there.
pub fn changed(registry: &Registry, body: &str) -> Result<String, String> {
    let FormulaRequest { text, formula } =
        serde_json::from_str(body).map_err(|_| "this is not a formula".to_owned())?;
    let formula = formula.trim();
    // `x^2 + y^2 = 1` is what people write.
    let formula = match formula.split_once('=') {
        Some((left, right)) if right.trim() == "0" => left.trim().to_owned(),
        Some((left, right)) => format!("{} - ({})", left.trim(), right.trim()),
        None => formula.to_owned(),
    };
    if formula.is_empty() || formula.contains(['"', '\\', '\n', '\r']) {
        return Err("a formula is one line without quotes, as x^2 + y^2 + z^2 - 1".to_owned());
    }
    let view = read(registry, &text);
    let text = match place(&view) {
        Some(place) => view.text.edited(place, &formula).as_str().to_owned(),
        None => surfaces::of_formula("a surface by its formula", &formula, 2.0, &[]),
    };
    Ok(with_unknown(registry, text))
}

/// Adds a `let` for each name of the first formula that the text does not define.
fn with_unknown(registry: &Registry, text: String) -> String {
    let view = read(registry, &text);
    let Some(place) = place(&view) else { return text };
    let unknown = editor::unknown_numbers(&view, &place);
    if unknown.is_empty() {
        return text;
    }
    let lets: String = match view.syntax {
        Syntax::Notes => unknown.iter().map(|name| format!("let {name} 1\n")).collect(),
        Syntax::Toml => return text,
    };
    // Comments at the beginning stay there.
    let lines = text.split_inclusive('\n').take_while(|line| line.starts_with('#') || line.trim().is_empty());
    let at = lines.map(str::len).sum::<usize>();
    view.text.edited(at..at, &lets).as_str().to_owned()
}

/// Returns the places of the numbers that a text names by a `let`, with their names.
fn lets(view: &View) -> Vec<(String, Range<usize>)> {
    let mut found = Vec::new();
    for item in &view.items {
        if let editor::Item::Let(number) = item
            && let (Some(name), Some(value)) = (number.name, number.value)
            && view.word(value).parse::<f64>().is_ok()
        {
            found.push((view.word(name).into_owned(), value.place()));
        }
    }
    found
}

/// Returns the numbers that a text names, in the form of an entity.
pub fn numbers(registry: &Registry, text: &str) -> Value {
    let view = read(registry, text);
    let attribute = |(name, place): (String, Range<usize>)| {
        let values = [view.slice(place).trim_matches(['"', '\'']).to_owned()];
        json!({ "name": name, "about": "a number of the scene", "each": [""], "values": values, "range": null, "whole": false, "fixed": null })
    };
    let attributes: Vec<_> = lets(&view).into_iter().map(attribute).collect();
    json!({ "order": NUMBERS, "kind": "let", "name": NUMBERS, "attributes": attributes })
}

/// Lists the entities of a scene that have numbers; first, if there are any, the numbers themselves.
pub fn entities(registry: &Registry, model: &Model, text: &str) -> Vec<Value> {
    let numbers = json!({ "order": NUMBERS, "kind": "let", "name": NUMBERS });
    let has_numbers = !lets(&read(registry, text)).is_empty();
    let all = fields::all(model).into_iter().filter_map(|named| serde_json::to_value(named).ok());
    has_numbers.then_some(numbers).into_iter().chain(all).collect()
}

/// Returns a text with another value of a number that it names.
///
/// # Errors
/// Returns a message if the text names no such number.
pub fn with_number(registry: &Registry, text: &str, name: &str, value: &str) -> Result<String, String> {
    let view = read(registry, text);
    let found = lets(&view).into_iter().find(|(known, _)| known == name);
    let (_, place) = found.ok_or_else(|| format!("the text has no number `{name}`"))?;
    Ok(view.text.edited(place, value).as_str().to_owned())
}
