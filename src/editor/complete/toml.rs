//! Completions at a position of a text in TOML.

use super::proposal::{Completion, CompletionContext};
use crate::view::{Attribute, Entity, Item};
use tabray_lang::reader::Keyword;

impl CompletionContext<'_> {
    pub(super) fn in_toml(&self) -> Vec<Completion> {
        let text = self.view.text.as_str();
        let line = text[..self.at].rfind('\n').map_or(0, |end| end + 1);
        let before = text[line..self.at].trim_start();
        if let Some(title) = before.strip_prefix('[') {
            let title = title.trim_start_matches('[');
            // A type may also follow `[repeat.i.`.
            let mut parts: Vec<_> = title.split('.').collect();
            while parts.len() > 2 && Keyword::of(parts[0]) == Some(Keyword::Repeat) {
                parts.drain(..2);
            }
            return if parts.len() == 1 && !title.contains(']') { self.types(false) } else { Vec::new() };
        }
        let attribute_at = |entity: &Entity| {
            let is_there = |attribute: &&Attribute| attribute.values_from.is_some_and(|from| from <= self.at);
            let last = entity.attributes.iter().rfind(is_there)?;
            let is_last_line = last.end >= line || !text[last.end.min(self.at)..self.at].contains('\n');
            (self.at <= last.end || is_last_line).then_some(())
        };
        match self.view.at(self.at) {
            Some(Item::Entity(entity)) if self.is_in(&entity.body) => {
                if attribute_at(entity).is_some() {
                    self.value(entity)
                } else {
                    self.attributes(entity)
                }
            }
            Some(Item::Include(_)) => self.files(),
            Some(Item::Let(_)) => self.in_formula(&[]),
            _ if before.contains('=') => Vec::new(),
            _ => self.types(true),
        }
    }
}
