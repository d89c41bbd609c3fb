//! The notes' scene language: `entity-type name { attribute values ... }`, one word after another.

use super::fault::Fault;
use super::guesses::{Guesses, find_attribute, near_attribute};
use super::parsed::{Form, MAX_VALUES, Parsed, Word};
use super::report::Report;
use crate::scene::entity::Entity;
use crate::scene::pparm::Attribute;
use crate::scene::registry::Registry;
use crate::scene::syntax::Syntax;
use crate::scene::value::Type;
use std::borrow::Cow;
use std::ops::Range;

/// Parses the entities of a text and reports syntax errors. Parsing goes on after an error, so that one run finds the
/// faults that follow.
pub fn parse<'a>(registry: &Registry, text: &'a str, report: &mut Report) -> Vec<Parsed<'a>> {
    let first = Tokens::of(text, &mut Report::new("", "", Syntax::Notes)).ahead[0].clone();
    if let Some(first) = first
        && !looks_like_a_scene(registry, text)
    {
        let mut tokens = Tokens::of(text, report);
        while tokens.ahead[0].is_some() {
            tokens.step(report);
        }
        report.add(
            Fault::error(Some(first.at), "this is not a scene")
                .label("expected an entity type")
                .help(registry.first_steps(Syntax::Notes)),
        );
        return Vec::new();
    }
    let tokens = Tokens::of(text, report);
    Parser { registry, tokens, end: text.len(), report, before: 0..0, last: None }.scene()
}

/// Tells whether any part of a text is an entity.
fn looks_like_a_scene(registry: &Registry, text: &str) -> bool {
    let mut nowhere = Report::new("", "", Syntax::Notes);
    let tokens = Tokens::of(text, &mut nowhere);
    let mut parser =
        Parser { registry, tokens, end: text.len(), report: &mut nowhere, before: 0..0, last: None };
    if parser.begins_entity() {
        return true;
    }
    while parser.token().is_some() {
        if parser.is_entity_type() && parser.has_form() {
            return true;
        }
        parser.step();
    }
    false
}

/// A word or a brace, and its place.
#[derive(Clone)]
struct Token<'a> {
    text: Cow<'a, str>,
    form: Form,
    at: Range<usize>,
}

impl<'a> Token<'a> {
    fn is(&self, brace: &str) -> bool {
        self.form == Form::Any && self.text == brace
    }

    fn is_brace(&self) -> bool {
        self.is("{") || self.is("}")
    }

    fn word(&self) -> Word<'a> {
        Word::at(self.text.clone(), self.form, self.at.clone())
    }
}

/// The tokens of a text, with enough lookahead to recognise the beginning of an entity.
struct Tokens<'a> {
    text: &'a str,
    at: usize,
    ahead: [Option<Token<'a>>; 3],
}

impl<'a> Tokens<'a> {
    fn of(text: &'a str, report: &mut Report) -> Self {
        let mut tokens = Self { text, at: 0, ahead: [const { None }; 3] };
        (0..3).for_each(|_| drop(tokens.step(report)));
        tokens
    }

    /// Advances by one token and returns it.
    fn step(&mut self, report: &mut Report) -> Option<Token<'a>> {
        self.ahead.rotate_left(1);
        let next = self.read(report);
        std::mem::replace(&mut self.ahead[2], next)
    }

    /// Reads the token after the lookahead. A `#` at the beginning of a word begins a comment, and a `"` a word in
    /// quotes.
    fn read(&mut self, report: &mut Report) -> Option<Token<'a>> {
        loop {
            let (at, rest) = (self.at, &self.text[self.at..]);
            let (length, text, form) = match rest.chars().next()? {
                '#' => (rest.find('\n').unwrap_or(rest.len()), None, Form::Any),
                '"' => {
                    let (text, length) = quoted(rest, at, report);
                    (length, Some(text), Form::Text)
                }
                c @ ('{' | '}') => (1, Some(Cow::Borrowed(if c == '{' { "{" } else { "}" })), Form::Any),
                c if c.is_whitespace() => (c.len_utf8(), None, Form::Any),
                _ => {
                    let end = |c: char| c.is_whitespace() || c == '{' || c == '}';
                    let length = rest.find(end).unwrap_or(rest.len());
                    (length, Some(Cow::Borrowed(&rest[..length])), Form::Any)
                }
            };
            self.at += length;
            if let Some(text) = text {
                return Some(Token { text, form, at: at..at + length });
            }
        }
    }
}

/// Reads the quoted word that a text begins with; returns the word and its length in bytes, quotes included. `\\` and
/// `\"` stand for a backslash and for a quote.
fn quoted<'a>(text: &'a str, at: usize, report: &mut Report) -> (Cow<'a, str>, usize) {
    let mut word = String::new();
    let mut letters = text.char_indices().skip(1);
    while let Some((index, letter)) = letters.next().filter(|(_, letter)| *letter != '\n') {
        match letter {
            '"' => return (word.into(), index + 1),
            '\\' => match letters.next() {
                Some((_, letter @ ('"' | '\\'))) => word.push(letter),
                other => {
                    let end = index + 1 + other.map_or(0, |(_, letter)| letter.len_utf8());
                    report.add(
                        Fault::error(Some(at + index..at + end), "unknown escape sequence")
                            .help("in quotes, write `\\\\` for a backslash and `\\\"` for a quote"),
                    );
                }
            },
            letter => word.push(letter),
        }
    }
    report.add(
        Fault::error(Some(at..at + 1), "missing closing quote")
            .help("a quoted word must end on the line on which it begins"),
    );
    // The closing quote is missing: probably only the first word was meant.
    let end = text.find(|c: char| c.is_whitespace() || c == '{' || c == '}').unwrap_or(text.len());
    (Cow::Borrowed(&text[1..end]), end)
}

struct Parser<'a, 'r> {
    registry: &'r Registry,
    tokens: Tokens<'a>,
    end: usize,
    report: &'r mut Report,
    /// The place of the token read last.
    before: Range<usize>,
    /// The entity read last: the place of its first word, and that of its end.
    last: Option<(Range<usize>, Range<usize>)>,
}

impl<'a> Parser<'a, '_> {
    fn scene(&mut self) -> Vec<Parsed<'a>> {
        let mut parsed = Vec::new();
        while self.token().is_some() && !self.report.has_enough() {
            if self.begins_entity() {
                parsed.extend(self.entity());
            } else {
                self.stray();
            }
        }
        parsed
    }

    fn token(&self) -> Option<&Token<'a>> {
        self.tokens.ahead[0].as_ref()
    }

    fn step(&mut self) -> Option<Token<'a>> {
        let token = self.tokens.step(self.report);
        if let Some(token) = &token {
            self.before = token.at.clone();
        }
        token
    }

    fn is(&self, ahead: usize, brace: &str) -> bool {
        self.tokens.ahead[ahead].as_ref().is_some_and(|token| token.is(brace))
    }

    fn is_word(&self, ahead: usize) -> bool {
        self.tokens.ahead[ahead].as_ref().is_some_and(|token| !token.is_brace())
    }

    fn is_entity_type(&self) -> bool {
        self.token().is_some_and(|token| self.registry.find(&token.text).is_some())
    }

    /// Tells whether a word, a name and an opening brace follow.
    fn has_form(&self) -> bool {
        self.is_word(0)
            && self.is_word(1)
            && self.is(2, "{")
            && self.token().is_some_and(|token| !looks_like_number(&token.text))
    }

    /// Tells whether an entity begins here, even if its name or its brace is missing.
    fn begins_entity(&self) -> bool {
        self.has_form() || (self.is_word(0) && self.is(1, "{")) || (self.is_entity_type() && self.is_word(1))
    }

    /// Skips words that belong to no entity.
    fn stray(&mut self) {
        let Some(first) = self.step() else { return };
        let (mut last, mut count) = (first.clone(), 1);
        while !last.is("}")
            && !self.begins_entity()
            && let Some(next) = self.step()
        {
            (last, count) = (next, count + 1);
        }
        let what = match (count, first.is_brace()) {
            (1, true) => format!("stray `{}`", first.text),
            (1, false) => format!("stray word `{}`", first.text),
            _ => format!("stray words from `{}` to `{}`", first.text, last.text),
        };
        let mut fault = Fault::error(Some(first.at.start..last.at.end), what).label("not part of any entity");
        if let Some((opened, closed)) = &self.last {
            fault = fault
                .also(Some(opened.clone()), "the previous entity begins here")
                .also(Some(closed.clone()), "and ends here");
        }
        self.report
            .add(fault.help("every word of a scene must be part of an entity, `TYPE NAME { ATTRIBUTES }`"));
    }

    fn entity(&mut self) -> Option<Parsed<'a>> {
        let kind = self.step()?;
        let name = match self.token() {
            Some(name) if !name.is_brace() => {
                let name = name.word();
                self.step();
                name
            }
            _ => {
                self.report.add(
                    Fault::error(Some(kind.at.clone()), format!("this `{}` has no name", kind.text))
                        .help(format!("write a name after the type: `{} NAME {{`", kind.text)),
                );
                Word::at("", Form::Any, kind.at.end..kind.at.end)
            }
        };
        if self.is(0, "{") {
            self.step();
        } else {
            let after = name.place.clone().unwrap_or_default();
            self.report.add(
                Fault::error(Some(after), format!("missing `{{` after {} `{}`", kind.text, name.text))
                    .label("expected `{` after this")
                    .help(format!("attributes go in braces: `{} {} {{ ... }}`", kind.text, name.text)),
            );
        }
        let mut entity =
            Parsed { kind: kind.word(), name, attributes: Vec::new(), place: None, is_damaged: false };
        let known = self.registry.find(&kind.text);
        while !self.report.has_enough() && self.body_goes_on(&entity) {
            if self.is(0, "{") {
                let brace = self.step().map(|brace| brace.at);
                self.report.add(
                    Fault::error(brace, "stray `{`")
                        .label("braces cannot be nested")
                        .also(Some(kind.at.clone()), "inside this entity"),
                );
            } else if let Some((name, values)) = self.attribute(known) {
                entity.add(name, values, self.report);
            }
        }
        entity.attributes.shrink_to_fit();
        entity.place = Some(kind.at.start..self.before.end);
        self.last = Some((kind.at, self.before.clone()));
        Some(entity)
    }

    /// Tells whether another attribute of the entity follows; if not, skips the closing brace.
    fn body_goes_on(&mut self, entity: &Parsed<'a>) -> bool {
        if self.is(0, "}") {
            self.step();
            return false;
        }
        if self.token().is_some() && !self.has_form() {
            return true;
        }
        let place = self.token().map_or(self.end..self.end, |token| token.at.clone());
        let label = match self.token() {
            Some(next) => format!("expected `}}` before this `{}`", next.text),
            None => "the text ends here".to_owned(),
        };
        self.report.add(
            Fault::error(
                Some(place),
                format!("missing `}}` for {} `{}`", entity.kind.text, entity.name.text),
            )
            .label(label)
            .also(entity.kind.place.clone(), "opened here"),
        );
        false
    }

    /// Reads an attribute and its values, however many there are and whatever their form.
    fn attribute(&mut self, entity: Option<&'static Entity>) -> Option<(Word<'a>, Vec<Word<'a>>)> {
        let name = self.step()?;
        let described = entity.and_then(|entity| {
            let known = find_attribute(entity, &name.text);
            known.or_else(|| near_attribute(entity, &name.text, self.report.guesses()))
        });
        let (mut values, mut count) = (Vec::new(), 0);
        while let Some(token) = &self.tokens.ahead[0]
            && !token.is_brace()
            && !self.has_form()
            && (token.form == Form::Text
                || is_value(entity, described, count, &token.text, self.report.guesses()))
        {
            if count < MAX_VALUES {
                values.push(token.word());
            }
            count += 1;
            self.step();
        }
        Some((name.word(), values))
    }
}

/// Tells whether a word is a value, rather than the next attribute.
fn is_value(
    entity: Option<&'static Entity>,
    attribute: Option<&'static dyn Attribute>,
    already: usize,
    word: &str,
    guesses: &mut Guesses,
) -> bool {
    let max = attribute.map_or(1, |attribute| attribute.arity().iter().copied().max().unwrap_or(0));
    match attribute.map(|attribute| attribute.value_type()) {
        // A name may look like anything, even like a number or an attribute: `material material`.
        Some(Type::Word | Type::File | Type::Name(_) | Type::Choice(_) | Type::Formula) => already < max,
        _ if looks_like_number(word) => true,
        _ => {
            let Some(entity) = entity else { return already < max };
            already < max
                && find_attribute(entity, word).is_none()
                && near_attribute(entity, word, guesses).is_none()
        }
    }
}

fn looks_like_number(word: &str) -> bool {
    let unsigned = word.trim_start_matches(['+', '-']);
    unsigned.starts_with(|c: char| c.is_ascii_digit() || c == '.')
        || ["nan", "inf", "infinity"].contains(&unsigned.to_ascii_lowercase().as_str())
}
