//! The meaning of a word, in Markdown.

use super::names::describe;
use super::project::{Group, definitions};
use super::types::{ExpectedValue, expected_value, value_name};
use super::view::{Attribute, Entity, Item, View, Word};
use std::ops::Range;
use tabray_core::scene::attribute;
use tabray_core::scene::entity;
use tabray_core::scene::value::Datum;
use tabray_core::text::{list, shown};
use tabray_lang::reader::Keyword;
use tabray_lang::syntax::Syntax;

/// The maximum number of lines of a definition that are shown.
const MAX_LINES: usize = 16;

/// The explanation of a word.
#[derive(Clone, Debug)]
pub struct Hover {
    /// The text, in Markdown.
    pub text: String,
    /// The range of the word.
    pub place: Range<usize>,
}

/// Describes the word at a position of the group's first file.
pub fn hover(group: &Group, at: usize) -> Option<Hover> {
    let (_, view) = group.first()?;
    let found = match view.at(at)? {
        Item::Entity(entity) => in_entity(view, entity, at),
        Item::Include(_) | Item::Let(_) | Item::Repeat(_) => None,
    };
    found.or_else(|| name(group, view, at)).or_else(|| keyword(view, at))
}

fn in_entity(view: &View, entity: &Entity, at: usize) -> Option<Hover> {
    let known = entity.known?;
    if entity.kind.has(at) {
        return Some(Hover { text: about_type(view.syntax, known), place: entity.kind.place() });
    }
    let (attribute, word) = entity.attributes.iter().find_map(|attribute| {
        let mut words = std::iter::once(&attribute.name).chain(&attribute.values);
        words.find(|word| word.has(at)).map(|word| (attribute, *word))
    })?;
    let known_attribute = attribute.known?;
    if word == attribute.name {
        let text = format!(
            "**{}** of {}: {}",
            known_attribute.name(),
            known.name,
            about(view.syntax, known_attribute)
        );
        return Some(Hover { text, place: word.place() });
    }
    value(view, entity, attribute, known_attribute, word)
}

/// Describes a value other than a name.
fn value(
    view: &View,
    entity: &Entity,
    attribute: &Attribute,
    known: &dyn attribute::Attribute,
    word: Word,
) -> Option<Hover> {
    let said = view.word(word);
    let text = match expected_value(entity, known) {
        ExpectedValue::Choice(choices) => {
            let chosen = said.parse().ok().and_then(|number| choices.numbered(number));
            let chosen = chosen.or_else(|| choices.named(&said))?;
            let number = chosen.number.map(|number| format!(" ({number})")).unwrap_or_default();
            format!(
                "**{}**{number}, {}: {}",
                chosen.name,
                tabray_core::text::with_article(choices.what),
                chosen.meaning
            )
        }
        ExpectedValue::Numbers if word.form == super::view::Form::Bare => {
            let index = attribute.values.iter().position(|value| *value == word)?;
            let name = value_name(known, index);
            let name = if name.is_empty() || known.arity().most() == 1 {
                String::new()
            } else {
                format!("**{name}** of ")
            };
            format!("{name}**{}**: {}", known.name(), about(view.syntax, known))
        }
        _ => return None,
    };
    Some(Hover { text, place: word.place() })
}

/// Shows the definition of the name at a position.
fn name(group: &Group, view: &View, at: usize) -> Option<Hover> {
    let names = view.names();
    let (name, _) = names.at(at)?;
    let found = definitions(group, at).into_iter().next()?;
    let (path, other) = group.iter().find(|(path, _)| *path == found.path)?;
    let all = other.names();
    let definition = all.definitions.iter().find(|definition| definition.name.place == found.place)?;
    let whole = other.slice(definition.whole.clone()).trim_end();
    let mut lines: Vec<_> = whole.lines().take(MAX_LINES + 1).collect();
    if lines.len() > MAX_LINES {
        lines[MAX_LINES] = "...";
    }
    let language = if view.syntax == Syntax::Toml { "toml" } else { "tabray" };
    let file = if *path == group[0].0 { String::new() } else { format!(" of `{}`", shown(path)) };
    let text = format!(
        "{} `{}`{file}\n\n```{language}\n{}\n```",
        describe(name.namespace),
        definition.name.text,
        lines.join("\n")
    );
    Some(Hover { text, place: name.place.clone() })
}

/// Describes a keyword.
fn keyword(view: &View, at: usize) -> Option<Hover> {
    let text = view.text.as_str();
    let is_part = |c: char| c.is_ascii_alphabetic();
    let start = text[..at]
        .rfind(|c| !is_part(c))
        .map_or(0, |end| end + text[end..].chars().next().map_or(1, char::len_utf8));
    let end = text[at..].find(|c| !is_part(c)).map_or(text.len(), |length| at + length);
    let keyword = Keyword::of(&text[start..end])?;
    let usage = match view.syntax {
        Syntax::Notes => keyword.usage(),
        Syntax::Toml => keyword.usage_in_toml(),
    };
    Some(Hover { text: usage.to_owned(), place: start..end })
}

/// Describes a type of entities: its meaning, its notation, and its attributes.
fn about_type(syntax: Syntax, known: &'static entity::Entity) -> String {
    let mut text = format!("**{}**, {}: {}\n\n", known.name, known.kind().with_article(), known.meaning);
    text += &format!("{}\n\n", syntax.entity_usage(known, "NAME"));
    for attribute in known.attributes() {
        let default = match attribute.default() {
            None => ", required".to_owned(),
            Some(_) => String::new(),
        };
        text += &format!("- `{}`: {}{default}\n", attribute.name(), attribute.meaning());
    }
    for group in known.groups() {
        text +=
            &format!("\nExactly one of {} is given: {}.\n", list(group.names.iter().copied()), group.meaning);
    }
    text
}

/// Describes an attribute: its meaning, the type and the unit of its values, its rule and its default.
pub fn about(syntax: Syntax, attribute: &dyn attribute::Attribute) -> String {
    let mut text = format!("{}\n\n", attribute.meaning());
    let unit = if attribute.unit().is_empty() { String::new() } else { format!(", in {}", attribute.unit()) };
    text += &format!("Takes {}{unit}", attribute.takes());
    if attribute.each().len() > 1 && attribute.arity().most() > 1 {
        text += &format!(": {}", attribute.each().join(", "));
    }
    text += ".";
    if !attribute.rule().is_empty() {
        text += &format!(" It must be {}.", attribute.rule());
    }
    text += &match attribute.default() {
        None => " Required.".to_owned(),
        Some(Datum::Absent) => String::new(),
        Some(default) => {
            let values = syntax.values(&default);
            if values.is_empty() { String::new() } else { format!(" Default: `{}`.", values.join(" ")) }
        }
    };
    if !attribute.aliases().is_empty() {
        text += &format!(" Also written {}.", list(attribute.aliases().iter().copied()));
    }
    text
}
