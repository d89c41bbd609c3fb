//! Completions at a position of a text in the notes' syntax.

use super::proposal::{Completion, CompletionContext};
use crate::types::{ExpectedValue, expected_value};
use crate::view::{Entity, Form, Item};
use tabray_lang::reader::Keyword;

impl CompletionContext<'_> {
    pub(super) fn in_notes(&self) -> Vec<Completion> {
        match self.view.at(self.at) {
            Some(Item::Entity(entity)) if self.is_in(&entity.body) => self.in_entity(entity),
            // The new name after the type cannot be proposed.
            Some(Item::Entity(entity)) if self.at > entity.kind.end && self.at < entity.body.start => {
                Vec::new()
            }
            Some(Item::Let(number)) if number.value.is_some_and(|word| word.has(self.at)) => {
                self.in_formula(&[])
            }
            Some(Item::Let(number)) if number.name.is_some_and(|word| word.has(self.at)) => Vec::new(),
            Some(Item::Repeat(repeat)) if repeat.count.is_some_and(|word| word.has(self.at)) => {
                self.in_formula(&[])
            }
            Some(Item::Repeat(repeat)) if repeat.name.is_some_and(|word| word.has(self.at)) => Vec::new(),
            Some(Item::Include(include)) if include.files.iter().any(|word| word.has(self.at)) => {
                self.files()
            }
            Some(Item::Include(include)) if self.at > include.place.end && include.files.is_empty() => {
                self.files()
            }
            Some(Item::Repeat(repeat)) if self.is_in(&repeat.body) => self.types(false),
            _ if self.follows(Keyword::Include) => self.files(),
            _ => self.types(true),
        }
    }

    /// Tells whether the word before the one at the position is a keyword, on the same line.
    fn follows(&self, keyword: Keyword) -> bool {
        let before = &self.view.text.as_str()[..self.prefix().start];
        let line = before.rsplit('\n').next().unwrap_or_default();
        line.split_whitespace().next_back().and_then(Keyword::of) == Some(keyword)
    }

    /// Returns the completions between the braces of an entity.
    fn in_entity(&self, entity: &Entity) -> Vec<Completion> {
        let last = entity.attributes.iter().rfind(|attribute| attribute.name.start < self.at);
        let Some(last) = last else { return self.attributes(entity) };
        if last.name.has(self.at) {
            return self.attributes(entity);
        }
        let Some(known) = last.known else { return self.attributes(entity) };
        let before = last.values.iter().filter(|word| word.end < self.at).count();
        let at_value = last.values.iter().find(|word| word.has(self.at));
        let is_full = before >= known.arity().most();
        match expected_value(entity, known) {
            ExpectedValue::Numbers | ExpectedValue::Formula(_) => match at_value {
                Some(word) if word.form != Form::Bare => self.value(entity),
                _ if known.arity().allow(before) => self.attributes(entity),
                _ => Vec::new(),
            },
            _ if is_full => self.attributes(entity),
            _ => self.value(entity),
        }
    }
}
