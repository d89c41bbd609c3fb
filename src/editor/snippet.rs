//! Snippets: texts with placeholders in the notation of editors, such as `radius ${1:N}`.

use super::types::{ExpectedValue, expected_value, value_name};
use super::view::{Entity, View};
use tabray_core::scene::attribute::Attribute;
use tabray_core::scene::entity;
use tabray_lang::syntax::Syntax;

/// The maximum number of alternatives of a placeholder.
const MAX_CHOICES: usize = 30;

/// A text with placeholders, numbered from 1.
pub struct Snippet<'v> {
    pub text: String,
    places: usize,
    view: &'v View,
    /// Returns the names of the entities of a kind that can be used here.
    names: &'v dyn Fn(tabray_core::scene::kind::Kind) -> Vec<String>,
}

impl<'v> Snippet<'v> {
    /// Makes an empty snippet.
    pub fn new(view: &'v View, names: &'v dyn Fn(tabray_core::scene::kind::Kind) -> Vec<String>) -> Self {
        Self { text: String::new(), places: 0, view, names }
    }

    fn place(&mut self, shown: &str) {
        self.places += 1;
        let shown = shown.replace('\\', "\\\\").replace('$', "\\$").replace('}', "\\}");
        self.text += &format!("${{{}:{shown}}}", self.places);
    }

    /// Adds a placeholder with alternatives, or with the text `or` if there are none.
    fn one_of(&mut self, all: &[String], or: &str) {
        if all.is_empty() {
            return self.place(or);
        }
        self.places += 1;
        let escaped = |name: &String| {
            name.replace('\\', "\\\\")
                .replace('$', "\\$")
                .replace('}', "\\}")
                .replace(',', "\\,")
                .replace('|', "\\|")
        };
        let all: Vec<_> = all.iter().take(MAX_CHOICES).map(escaped).collect();
        self.text += &format!("${{{}|{}|}}", self.places, all.join(","));
    }

    /// Adds the values of an attribute.
    pub fn values(&mut self, entity: &Entity, attribute: &dyn Attribute) {
        let syntax = self.view.syntax;
        match expected_value(entity, attribute) {
            ExpectedValue::Numbers => {
                let count = attribute.arity().examples().first().copied().unwrap_or(1);
                let is_array = syntax == Syntax::Toml && count > 1;
                self.text += if is_array { "[" } else { "" };
                for index in 0..count {
                    if index > 0 {
                        self.text += if is_array { ", " } else { " " };
                    }
                    let name = if count > 1 { value_name(attribute, index) } else { "" };
                    self.place(if name.is_empty() { "N" } else { name });
                }
                self.text += if is_array { "]" } else { "" };
            }
            ExpectedValue::Name(kind) => {
                let all = (self.names)(kind);
                // The last entity was probably defined for this use.
                let all: Vec<_> = all.into_iter().rev().collect();
                self.quoted(|snippet| snippet.one_of(&all, &kind.to_string()));
            }
            ExpectedValue::Choice(choices) => {
                let all: Vec<_> = choices.all().iter().map(|choice| choice.name.to_owned()).collect();
                self.quoted(|snippet| snippet.one_of(&all, choices.what));
            }
            ExpectedValue::Truth => self.one_of(&super::types::truths(self.view).map(str::to_owned), ""),
            ExpectedValue::File => self.quoted(|snippet| snippet.place("FILE")),
            ExpectedValue::Word => self.quoted(|snippet| snippet.place("WORD")),
            ExpectedValue::Formula(_) => {
                let usage = syntax.usage(attribute);
                let formula = usage.split('"').nth(1).unwrap_or("0").to_owned();
                self.text.push('"');
                self.place(&formula);
                self.text.push('"');
            }
        }
    }

    /// Adds a word, in quotes if the syntax needs them.
    fn quoted(&mut self, word: impl FnOnce(&mut Self)) {
        let quote = if self.view.syntax == Syntax::Toml { "\"" } else { "" };
        self.text += quote;
        word(self);
        self.text += quote;
    }

    /// Adds an attribute, with its name padded to a width.
    pub fn attribute(&mut self, entity: &Entity, attribute: &dyn Attribute, width: usize) {
        self.text += &format!("{:width$} ", attribute.name());
        if self.view.syntax == Syntax::Toml {
            self.text += "= ";
        }
        self.values(entity, attribute);
    }

    /// Adds an entity with the required attributes. In TOML, `has_bracket` tells whether the opening bracket is already
    /// there.
    pub fn entity(&mut self, known: &'static entity::Entity, has_bracket: bool) {
        let mut wanted: Vec<_> =
            known.attributes().filter(|attribute| attribute.default().is_none()).collect();
        for group in known.groups() {
            wanted.extend(
                known.attributes().filter(|attribute| group.names.first() == Some(&attribute.name())),
            );
        }
        let width = wanted.iter().map(|attribute| attribute.name().len()).max().unwrap_or(0);
        let (start, end, indent) = match self.view.syntax {
            Syntax::Notes => ("", "\n{\n", "    "),
            Syntax::Toml if has_bracket => ("", "]\n", ""),
            Syntax::Toml => ("[", "]\n", ""),
        };
        let between = if self.view.syntax == Syntax::Toml { "." } else { " " };
        self.text += &format!("{start}{}{between}", known.name);
        self.place("name");
        self.text += end;
        let nowhere = blank(known);
        for (index, attribute) in wanted.iter().enumerate() {
            self.text += if index > 0 { "\n" } else { "" };
            self.text += indent;
            self.attribute(&nowhere, *attribute, width);
        }
        if wanted.is_empty() {
            self.text += &format!("{indent}$0");
        }
        if self.view.syntax == Syntax::Notes {
            self.text += "\n}";
        }
    }
}

/// Makes an entity of a type, without a place in the text.
fn blank(known: &'static entity::Entity) -> Entity {
    let nowhere = super::view::Word { start: 0, end: 0, form: super::view::Form::Bare };
    Entity {
        kind: nowhere,
        known: Some(known),
        name: None,
        again: Vec::new(),
        attributes: Vec::new(),
        place: 0..0,
        body: 0..0,
    }
}
