//! The recognised content of a text: entities, attributes and values with their places, in either syntax.

use super::named::Names;
use super::text::Text;
pub use super::word::{Form, Word};
use std::borrow::Cow;
use std::ops::Range;
use std::sync::OnceLock;
use tabray_core::scene::attribute;
use tabray_core::scene::entity;
use tabray_lang::reader::{self, Fault};
use tabray_lang::syntax::Syntax;
use toml_parser::decoder::Encoding;
use toml_parser::{ParseError, Raw, Span};

/// An item of a scene.
#[derive(Debug)]
pub enum Item {
    /// An entity.
    Entity(Entity),
    /// A named number.
    Let(Let),
    /// Included files.
    Include(Include),
    /// A `repeat`.
    Repeat(Repeat),
}

impl Item {
    /// Returns the range of the item's text.
    pub fn place(&self) -> &Range<usize> {
        match self {
            Self::Entity(entity) => &entity.place,
            Self::Let(number) => &number.place,
            Self::Include(include) => &include.place,
            Self::Repeat(repeat) => &repeat.place,
        }
    }
}

/// An entity.
#[derive(Debug)]
pub struct Entity {
    /// The type as written.
    pub kind: Word,
    /// The type in the registry, if known.
    pub known: Option<&'static entity::Entity>,
    /// The name.
    pub name: Option<Word>,
    /// The other places of the name: TOML may repeat it with each attribute.
    pub again: Vec<Word>,
    pub attributes: Vec<Attribute>,
    pub place: Range<usize>,
    /// The range of the attributes, including room for more.
    pub body: Range<usize>,
}

/// An attribute and its values.
pub struct Attribute {
    /// The name.
    pub name: Word,
    /// The attribute in the table of the entity's type, if known.
    pub known: Option<&'static dyn attribute::Attribute>,
    /// The first byte after the `=` in TOML, or else after the name, or `None` if there is no `=` yet.
    pub values_from: Option<usize>,
    /// The values as written.
    pub values: Vec<Word>,
    /// The first byte after the attribute.
    pub end: usize,
}

impl std::fmt::Debug for Attribute {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Attribute").field("name", &self.name).field("values", &self.values).finish()
    }
}

/// A named number.
#[derive(Debug)]
pub struct Let {
    pub name: Option<Word>,
    pub value: Option<Word>,
    pub place: Range<usize>,
}

/// Included files.
#[derive(Debug)]
pub struct Include {
    pub files: Vec<Word>,
    pub place: Range<usize>,
}

/// A `repeat` with its entities.
#[derive(Debug)]
pub struct Repeat {
    pub name: Option<Word>,
    /// The other places of the name.
    pub again: Vec<Word>,
    pub count: Option<Word>,
    /// The repeated items, in the order of the text.
    pub items: Vec<Item>,
    pub place: Range<usize>,
    /// The range of the entities, including room for more.
    pub body: Range<usize>,
}

/// The items of a text.
#[derive(Debug)]
pub struct View {
    /// The text.
    pub text: Text,
    /// The syntax of the text.
    pub syntax: Syntax,
    /// The items, in the order of the text.
    pub items: Vec<Item>,
    /// The syntax errors.
    pub breaks: Vec<Fault>,
    /// The names, found on first use.
    pub(super) names: OnceLock<Names>,
}

impl View {
    /// Makes the view of a text from its items and syntax errors.
    pub fn new(text: Text, syntax: Syntax, (items, breaks): (Vec<Item>, Vec<Fault>)) -> Self {
        Self { text, syntax, items, breaks, names: OnceLock::new() }
    }

    /// Returns the text of a range, or an empty text for a range outside.
    pub fn slice(&self, place: Range<usize>) -> &str {
        self.text.as_str().get(place).unwrap_or_default()
    }

    /// Returns the text of a word, without quotes and escape sequences.
    pub fn word(&self, word: Word) -> Cow<'_, str> {
        let inner = self.slice(word.inner());
        match word.form {
            Form::Quoted(_) if inner.contains('\\') => match self.syntax {
                Syntax::Notes => reader::unescaped(inner),
                Syntax::Toml => unescaped(self.slice(word.place())),
            },
            _ => Cow::Borrowed(inner),
        }
    }

    /// Calls a function with each item and the `repeat`s around it, from the outermost one inward.
    pub fn visit<'v>(&'v self, visit: &mut dyn FnMut(&'v Item, &[&'v Repeat])) {
        fn walk<'v>(
            items: &'v [Item],
            outer: &mut Vec<&'v Repeat>,
            visit: &mut dyn FnMut(&'v Item, &[&'v Repeat]),
        ) {
            for item in items {
                visit(item, outer);
                if let Item::Repeat(repeat) = item {
                    outer.push(repeat);
                    walk(&repeat.items, outer, visit);
                    outer.pop();
                }
            }
        }
        walk(&self.items, &mut Vec::new(), visit);
    }

    /// Returns the innermost item at a position, including the room for more text.
    pub fn at(&self, at: usize) -> Option<&Item> {
        let has = |item: &&Item| {
            let body = match item {
                Item::Entity(entity) => &entity.body,
                Item::Repeat(repeat) => &repeat.body,
                _ => item.place(),
            };
            (item.place().start..=item.place().end.max(body.end)).contains(&at)
        };
        let mut found: Option<&Item> = None;
        let mut items = &self.items;
        loop {
            // At the border between two items, the next one counts.
            let after = items.partition_point(|item| item.place().start <= at);
            let Some(item) = items[..after].iter().rev().take(2).find(has) else { return found };
            found = Some(item);
            match item {
                Item::Repeat(repeat) => items = &repeat.items,
                _ => return found,
            }
        }
    }

    /// Returns the entity at a position.
    pub fn entity_at(&self, at: usize) -> Option<&Entity> {
        match self.at(at)? {
            Item::Entity(entity) => Some(entity),
            _ => None,
        }
    }

    /// Returns the entity with a name, if the name occurs only once and the entity is not repeated.
    pub fn entity(&self, name: &str) -> Option<&Entity> {
        let mut found = self.items.iter().filter_map(|item| match item {
            Item::Entity(entity) if entity.name.is_some_and(|word| self.word(word) == name) => Some(entity),
            _ => None,
        });
        found.next().filter(|_| found.next().is_none())
    }

    /// Returns the place for one more attribute of an entity, and the separator before it.
    pub fn room(&self, entity: &Entity) -> (usize, String) {
        let (at, is_first) = match entity.attributes.last() {
            Some(last) => (last.end, false),
            None => (entity.body.start, true),
        };
        let (before, after) = self.text.as_str().split_at(at);
        if self.slice(entity.place.clone()).contains('\n') {
            let line = &before[before.rfind('\n').map_or(0, |end| end + 1)..];
            let indent = &line[..line.len() - line.trim_start().len()];
            // A comment stays with its attribute.
            let rest = after.lines().next().unwrap_or_default();
            let is_last = !is_first && (rest.trim().is_empty() || rest.trim_start().starts_with('#'));
            return (at + if is_last { rest.len() } else { 0 }, format!("\n{indent}"));
        }
        let between = if self.syntax == Syntax::Toml && !is_first { ", " } else { "  " };
        (at, between.to_owned())
    }

    /// Tells whether a formula computes a value of an attribute of numbers.
    pub fn computes(&self, entity: &Entity, attribute: &str) -> bool {
        let mut given = entity
            .attributes
            .iter()
            .filter(|given| given.known.is_some_and(|known| known.name() == attribute));
        given.any(|given| given.values.iter().any(|word| word.form != Form::Bare))
    }

    /// Tells whether the text has items of a scene. A TOML file may be about something else.
    pub fn is_scene(&self) -> bool {
        self.syntax == Syntax::Notes
            || self.items.iter().any(|item| match item {
                Item::Entity(entity) => entity.known.is_some(),
                _ => true,
            })
    }
}

/// Returns the text of a quoted word in TOML.
fn unescaped(quoted: &str) -> Cow<'_, str> {
    let encoding = if quoted.starts_with("\"\"\"") { Encoding::MlBasicString } else { Encoding::BasicString };
    let raw = Raw::new_unchecked(quoted, Some(encoding), Span::new_unchecked(0, quoted.len()));
    let mut word = Cow::Borrowed("");
    let _ = raw.decode_scalar(&mut word, &mut |_: ParseError| {});
    word
}
