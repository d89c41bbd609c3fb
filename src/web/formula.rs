//! The formula of a scene's surface.

use crate::surfaces;
use crate::text::view as read;
use serde::Deserialize;
use serde_json::Value;
use std::ops::Range;
use tabray_editor::{self as editor, View};
use tabray_lang::registry::Registry;
use tabray_lang::syntax::Syntax;

/// A formula, and the text that will contain it.
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

/// Returns the formula of the first `implicit` of a text; null without one.
pub fn of(registry: &Registry, text: &str) -> Value {
    let view = read(registry, text);
    place(&view).map_or(Value::Null, |place| view.slice(place).into())
}

/// Replaces the formula of a text's first `implicit`, and the name of its surface at the text's beginning. A text
/// without an `implicit` is replaced as a whole. In the notes' syntax, names that the text does not define become
/// numbers in it, with the value 1, and numbers of the formula before that nothing needs any more go.
///
/// # Errors
/// Returns why the formula cannot stand there.
pub fn changed(registry: &Registry, body: &str) -> Result<String, String> {
    let FormulaRequest { text, formula } =
        serde_json::from_str(body).map_err(|_| "this is not a formula".to_owned())?;
    let formula = formula.trim();
    // People write `x^2 + y^2 = 1`.
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
        Some(place) => {
            let before = view.slice(place.clone());
            without_unneeded(&titled(view.text.edited(place, &formula).as_str(), &formula), before)
        }
        None => surfaces::of_formula(&surfaces::heading(&formula), &formula, 2.0, &[]),
    };
    Ok(with_unknown(registry, text))
}

/// Names the surface of a formula at the beginning of a text that names another surface there.
fn titled(text: &str, formula: &str) -> String {
    let rest = text.strip_prefix("# ").and_then(|rest| rest.split_once('\n'));
    match rest.filter(|(words, _)| surfaces::is_heading(words)) {
        Some((_, rest)) => format!("# {}\n{rest}", surfaces::heading(formula)),
        None => text.to_owned(),
    }
}

/// Removes the lines with a `let` that the formula before needed, and that the rest of a text does not need.
fn without_unneeded(text: &str, before: &str) -> String {
    fn words(line: &str) -> impl Iterator<Item = &str> {
        line.split(|letter: char| !letter.is_alphanumeric() && letter != '_').filter(|word| !word.is_empty())
    }
    let names = |line: &str, name: &str| words(line).any(|word| word == name);
    let is_needed = |line: &&str| {
        let mut first = words(line);
        let (Some("let"), Some(name)) = (first.next(), first.next()) else { return true };
        first.any(|word| word == "let")
            || !names(before, name)
            || text.split_inclusive('\n').any(|other| other != *line && names(other, name))
    };
    text.split_inclusive('\n').filter(is_needed).collect()
}

/// Adds a `let` to a text in the notes' syntax for each name of the first formula that the text does not define.
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
    // Comments at the beginning stay first.
    let lines = text.split_inclusive('\n').take_while(|line| line.starts_with('#') || line.trim().is_empty());
    let at = lines.map(str::len).sum::<usize>();
    view.text.edited(at..at, &lets).as_str().to_owned()
}
