//! Reads a text in the notes' syntax as far as possible.

use super::view::{Attribute, Break, Entity, Form, Include, Item, Let, Repeat, Word};
use crate::reader::keyword::Keyword;
use crate::reader::tokens::{Token, TokenForm, Tokens};
use crate::reader::{Report, looks_like_number};
use crate::registry::Registry;
use std::collections::HashMap;
use std::ops::Range;
use tabray_core::scene::attribute;
use tabray_core::scene::entity;
use tabray_core::scene::value::Type;
use tabray_core::text::nearest;

/// The maximum depth of nested `repeat`s. Deeper ones are skipped.
const DEEPEST: usize = 64;

/// The most misspelt words for which the attribute that was meant is looked up.
const MOST_GUESSES: usize = 1000;

/// Parses a text into items, and returns the places where it is not in the form of a scene.
pub fn read(registry: &Registry, text: &str) -> (Vec<Item>, Vec<Break>) {
    let mut report = Report::default();
    let tokens = Tokens::of(text, &mut report);
    let mut reader =
        Reader { registry, tokens, report, before: 0, breaks: Vec::new(), guesses: HashMap::new() };
    let items = reader.items(0);
    let (report, mut breaks) = (reader.report, reader.breaks);
    breaks.extend(report.faults().iter().map(|fault| {
        let place = fault.place.clone().unwrap_or(0..0);
        (place, fault.message.clone())
    }));
    breaks.sort_by_key(|(place, _)| place.start);
    (items, breaks)
}

struct Reader<'a> {
    registry: &'a Registry,
    tokens: Tokens<'a>,
    report: Report,
    /// The end of the token read last.
    before: usize,
    breaks: Vec<Break>,
    /// Whether words that are no attributes of a type are misspelt ones.
    guesses: HashMap<(&'static str, &'a str), bool>,
}

fn word(token: Token) -> Word {
    let form = match token.form {
        TokenForm::Quoted => Form::Quoted(1),
        TokenForm::Unclosed => Form::Unclosed,
        _ => Form::Bare,
    };
    Word { start: token.start, end: token.end, form }
}

impl<'a> Reader<'a> {
    fn step(&mut self) -> Option<Token> {
        let token = self.tokens.step(&mut self.report)?;
        self.before = token.end;
        Some(token)
    }

    fn is(&self, ahead: usize, form: TokenForm) -> bool {
        self.tokens.ahead[ahead].is_some_and(|token| token.form == form)
    }

    fn is_word(&self, ahead: usize) -> bool {
        self.tokens.ahead[ahead].is_some_and(|token| !token.is_brace())
    }

    fn known(&self, ahead: usize) -> Option<&'static entity::Entity> {
        self.registry.find(&self.tokens.text(self.tokens.ahead[ahead]?))
    }

    fn has_form(&self) -> bool {
        self.is_word(0)
            && self.is_word(1)
            && self.is(2, TokenForm::Open)
            && self.tokens.ahead[0].is_some_and(|token| !looks_like_number(&self.tokens.text(token)))
    }

    fn wrong(&mut self, place: Range<usize>, message: impl Into<String>) {
        self.breaks.push((place, message.into()));
    }

    fn items(&mut self, depth: usize) -> Vec<Item> {
        let mut items = Vec::new();
        while let Some(first) = self.tokens.ahead[0] {
            let keyword = Some(self.tokens.raw(first)).filter(|_| first.form == TokenForm::Word);
            if depth > 0 && first.form == TokenForm::Close {
                break;
            } else if let Some(keyword) = keyword.and_then(Keyword::of) {
                items.extend(self.statement(keyword, depth));
            } else if self.has_form()
                || self.is_word(0) && self.is(1, TokenForm::Open)
                || self.known(0).is_some() && self.is_word(1)
            {
                items.push(Item::Entity(self.entity(first)));
            } else {
                self.step();
                self.wrong(first.place(), format!("stray `{}`", self.tokens.raw(first)));
            }
        }
        items
    }

    /// Reads the next word, if it is not a brace and an entity does not begin there.
    fn next_word(&mut self) -> Option<Word> {
        let token = self.tokens.ahead[0].filter(|token| !token.is_brace())?;
        self.step();
        Some(word(token))
    }

    fn statement(&mut self, keyword: Keyword, depth: usize) -> Option<Item> {
        let first = self.step()?;
        let mut words = [None; 2];
        let count = if keyword == Keyword::Include { 1 } else { 2 };
        for word in &mut words[..count] {
            // A half-written statement must not swallow the entity after it.
            if keyword == Keyword::Repeat || !self.has_form() {
                *word = self.next_word();
            }
        }
        let [name, second] = words;
        if words[count - 1].is_none() {
            self.wrong(first.place(), format!("this `{}` is incomplete", self.tokens.raw(first)));
        }
        let place = first.start..self.before;
        Some(match keyword {
            Keyword::Include => Item::Include(Include { files: name.into_iter().collect(), place }),
            Keyword::Let => Item::Let(Let { name, value: second, place }),
            Keyword::Repeat if self.is(0, TokenForm::Open) && depth < DEEPEST => {
                let open = self.step()?;
                let items = self.items(depth + 1);
                let body = open.end..self.body_end();
                self.close(first.place(), "repeat");
                let place = first.start..self.before.max(body.end);
                Item::Repeat(Repeat { name, again: Vec::new(), count: second, items, place, body })
            }
            Keyword::Repeat => {
                self.wrong(first.place(), "this `repeat` is incomplete, or too deep in others");
                let body = place.end..place.end;
                Item::Repeat(Repeat {
                    name,
                    again: Vec::new(),
                    count: second,
                    items: Vec::new(),
                    place,
                    body,
                })
            }
        })
    }

    /// Returns the end of a body that is read: the next token, or the end of the text.
    fn body_end(&self) -> usize {
        self.tokens.ahead[0].map_or(self.tokens.text.len(), |token| token.start)
    }

    fn close(&mut self, opened: Range<usize>, what: &str) {
        if self.is(0, TokenForm::Close) {
            self.step();
        } else {
            self.wrong(opened, format!("missing `}}` for this `{what}`"));
        }
    }

    fn entity(&mut self, first: Token) -> Entity {
        let known = self.known(0);
        self.step();
        let kind = word(first);
        let is_alone = known.is_some() && self.known(0).is_some() && self.is_word(1);
        let name = if is_alone { None } else { self.next_word() };
        let raw = self.tokens.raw(first);
        if name.is_none() {
            self.wrong(kind.place(), format!("this `{raw}` has no name"));
        }
        let mut entity = Entity {
            kind,
            known,
            name,
            again: Vec::new(),
            attributes: Vec::new(),
            place: first.start..self.before,
            body: self.before..self.before,
        };
        if is_alone {
            return entity;
        }
        if self.is(0, TokenForm::Open) {
            self.step();
        } else {
            self.wrong(kind.place(), format!("missing `{{` for this `{raw}`"));
        }
        entity.body.start = self.before;
        while self.tokens.ahead[0].is_some() && !self.is(0, TokenForm::Close) && !self.has_form() {
            if self.is(0, TokenForm::Open) {
                let brace = self.step().map_or(0..0, Token::place);
                self.wrong(brace, "stray `{`");
            } else {
                entity.attributes.extend(self.attribute(known));
            }
        }
        entity.body.end = self.body_end();
        self.close(kind.place(), raw);
        entity.place.end = self.before;
        entity
    }

    fn attribute(&mut self, entity: Option<&'static entity::Entity>) -> Option<Attribute> {
        let name = self.step()?;
        let raw = self.tokens.text(name);
        let known = entity.and_then(|entity| attribute(entity, &raw));
        let mut values = Vec::new();
        while let Some(token) = self.tokens.ahead[0]
            && !token.is_brace()
            && !self.has_form()
            && (token.form != TokenForm::Word || self.is_value(entity, known, values.len(), token))
        {
            values.push(word(token));
            self.step();
        }
        Some(Attribute { name: word(name), known, values_from: Some(name.end), values, end: self.before })
    }

    /// Tells whether a word is a value, rather than the next attribute.
    fn is_value(
        &mut self,
        entity: Option<&'static entity::Entity>,
        known: Option<&'static dyn attribute::Attribute>,
        already: usize,
        token: Token,
    ) -> bool {
        let max = known.map_or(1, |known| known.arity().most());
        let raw = self.tokens.raw(token);
        let is_attribute = || entity.is_some_and(|entity| attribute(entity, raw).is_some());
        match known.map(|known| known.value_type()) {
            // A name may look like an attribute, but on another line it is one.
            Some(value_type) if !matches!(value_type, Type::Number | Type::Whole) => {
                let is_below = self.tokens.text[self.before..token.start].contains('\n');
                already < max && !(is_below && is_attribute())
            }
            _ => {
                looks_like_number(raw)
                    || already < max
                        && !is_attribute()
                        && !entity.is_some_and(|entity| self.is_misspelt(entity, raw))
            }
        }
    }

    /// Tells whether a word is probably a misspelt attribute.
    fn is_misspelt(&mut self, entity: &'static entity::Entity, word: &'a str) -> bool {
        let is_full = self.guesses.len() >= MOST_GUESSES;
        *self.guesses.entry((entity.name, word)).or_insert_with(|| {
            !is_full && nearest(word, entity.attributes().map(|attribute| attribute.name())).is_some()
        })
    }
}

/// Finds the attribute of a type by its name or by another one.
pub fn attribute(entity: &'static entity::Entity, name: &str) -> Option<&'static dyn attribute::Attribute> {
    entity.attributes().find(|known| known.name() == name || known.aliases().contains(&name))
}
