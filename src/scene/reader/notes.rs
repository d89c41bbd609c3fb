//! The notes' scene language: `entity-type name { attribute values ... }`, one word after another.

use super::attributes::{find_attribute, near_attribute};
use super::fault::{Fault, Report};
use super::written::{Form, Word, Written};
use crate::scene::entity::Entity;
use crate::scene::pparm::Attribute;
use crate::scene::registry::Registry;
use crate::scene::syntax::Syntax;
use crate::scene::value::Type;
use std::borrow::Cow;
use std::ops::Range;

/// Reads the entities of a text and reports what does not have their form. What can be made out beyond a
/// fault is read all the same, so that one run finds the faults that follow.
pub fn parse<'a>(registry: &Registry, text: &'a str, report: &mut Report) -> Vec<Written<'a>> {
    let tokens = tokens(text, report);
    let mut parser = Parser { registry, tokens, at: 0, end: text.len(), report, last: None };
    parser.scene()
}

/// A word or a brace, and where it stands.
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

/// Splits a text into words and braces. A `#` that begins a word begins a comment, and a `"` a word with blanks.
fn tokens<'a>(text: &'a str, report: &mut Report) -> Vec<Token<'a>> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        let length = match c {
            '#' => rest.find('\n').unwrap_or(rest.len()),
            '"' => {
                let (text, length) = quoted(rest, at, report);
                tokens.push(Token { text, form: Form::Text, at: at..at + length });
                at += length;
                continue;
            }
            '{' | '}' => 1,
            c if c.is_whitespace() => c.len_utf8(),
            _ => rest.find(|c: char| c.is_whitespace() || c == '{' || c == '}').unwrap_or(rest.len()),
        };
        if c != '#' && !c.is_whitespace() {
            let text = Cow::Borrowed(&rest[..length]);
            tokens.push(Token { text, form: Form::Any, at: at..at + length });
        }
        at += length;
    }
    tokens
}

/// What stands in the quotes that a text begins with, and how long it is with them. `\\` and `\"` stand for a
/// backslash and for a quote.
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
    // The first word was meant perhaps.
    let end = text.find(|c: char| c.is_whitespace() || c == '{' || c == '}').unwrap_or(text.len());
    (Cow::Borrowed(&text[1..end]), end)
}

struct Parser<'a, 'r> {
    registry: &'r Registry,
    tokens: Vec<Token<'a>>,
    at: usize,
    end: usize,
    report: &'r mut Report,
    /// The entity read last: its first word and where it ended.
    last: Option<(Range<usize>, Range<usize>)>,
}

impl<'a> Parser<'a, '_> {
    fn scene(&mut self) -> Vec<Written<'a>> {
        let mut written = Vec::new();
        if !self.tokens.is_empty() && !self.looks_like_a_scene() {
            let first = self.tokens[0].clone();
            self.report.add(
                Fault::error(Some(first.at), "this is not a scene")
                    .label("expected an entity type")
                    .help(self.registry.first_steps(Syntax::Notes)),
            );
            return written;
        }
        while self.at < self.tokens.len() {
            if self.begins_entity(self.at) {
                written.push(self.entity());
            } else {
                self.stray();
            }
        }
        written
    }

    fn token(&self, ahead: usize) -> Option<&Token<'a>> {
        self.tokens.get(self.at + ahead)
    }

    fn is(&self, at: usize, brace: &str) -> bool {
        self.tokens.get(at).is_some_and(|token| token.is(brace))
    }

    fn is_word(&self, at: usize) -> bool {
        self.tokens.get(at).is_some_and(|token| !token.is_brace())
    }

    fn is_entity_type(&self, at: usize) -> bool {
        self.tokens.get(at).is_some_and(|token| self.registry.find(&token.text).is_some())
    }

    fn looks_like_a_scene(&self) -> bool {
        self.begins_entity(0) || (0..self.tokens.len()).any(|at| self.is_entity_type(at) && self.has_form(at))
    }

    /// Whether a word, a name and an opening brace stand here.
    fn has_form(&self, at: usize) -> bool {
        self.is_word(at)
            && self.is_word(at + 1)
            && self.is(at + 2, "{")
            && !looks_like_number(&self.tokens[at].text)
    }

    /// Whether an entity begins here, its name or its brace forgotten perhaps.
    fn begins_entity(&self, at: usize) -> bool {
        self.has_form(at)
            || (self.is_word(at) && self.is(at + 1, "{"))
            || (self.is_entity_type(at) && self.is_word(at + 1))
    }

    /// Reads past words that belong to no entity.
    fn stray(&mut self) {
        let start = self.at;
        while self.at < self.tokens.len() && !self.begins_entity(self.at) {
            let closes = self.is(self.at, "}");
            self.at += 1;
            if closes {
                break;
            }
        }
        let run = &self.tokens[start..self.at];
        let (first, last) = (&run[0], &run[run.len() - 1]);
        let what = match (run.len(), first.is_brace()) {
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

    fn entity(&mut self) -> Written<'a> {
        let kind = self.tokens[self.at].clone();
        self.at += 1;
        let name = match self.token(0) {
            Some(name) if !name.is_brace() => {
                let name = name.word();
                self.at += 1;
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
        if self.is(self.at, "{") {
            self.at += 1;
        } else {
            let after = name.place.clone().unwrap_or_default();
            self.report.add(
                Fault::error(Some(after), format!("missing `{{` after {} `{}`", kind.text, name.text))
                    .label("expected `{` after this")
                    .help(format!("attributes go in braces: `{} {} {{ ... }}`", kind.text, name.text)),
            );
        }
        let mut entity =
            Written { kind: kind.word(), name, attributes: Vec::new(), place: None, is_damaged: false };
        let known = self.registry.find(&kind.text);
        while self.body_goes_on(&entity) {
            if self.is(self.at, "{") {
                let brace = self.tokens[self.at].at.clone();
                self.report.add(
                    Fault::error(Some(brace), "stray `{`")
                        .label("braces cannot be nested")
                        .also(Some(kind.at.clone()), "inside this entity"),
                );
                self.at += 1;
            } else {
                let attribute = self.attribute(known);
                entity.attributes.push(attribute);
            }
        }
        let closed = self.tokens.get(self.at - 1).map_or(self.end..self.end, |token| token.at.clone());
        entity.place = Some(kind.at.start..closed.end);
        self.last = Some((kind.at, closed));
        entity
    }

    /// Whether another attribute of the entity follows; reads past its closing brace if not.
    fn body_goes_on(&mut self, entity: &Written<'a>) -> bool {
        if self.is(self.at, "}") {
            self.at += 1;
            return false;
        }
        if self.at < self.tokens.len() && !self.has_form(self.at) {
            return true;
        }
        let place = self.token(0).map_or(self.end..self.end, |token| token.at.clone());
        let label = match self.token(0) {
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

    /// Reads an attribute and the values that are meant for it, however many and of whatever form.
    fn attribute(&mut self, entity: Option<&'static Entity>) -> (Word<'a>, Vec<Word<'a>>) {
        let name = self.tokens[self.at].clone();
        self.at += 1;
        let described = entity.and_then(|entity| {
            find_attribute(entity, &name.text).or_else(|| near_attribute(entity, &name.text))
        });
        let mut values = Vec::new();
        while let Some(token) = self.token(0)
            && !token.is_brace()
            && !self.has_form(self.at)
            && (token.form == Form::Text || is_value(entity, described, values.len(), &token.text))
        {
            values.push(token.word());
            self.at += 1;
        }
        (name.word(), values)
    }
}

/// Whether a word stands where a value belongs, rather than being the next attribute.
fn is_value(
    entity: Option<&'static Entity>,
    attribute: Option<&'static dyn Attribute>,
    already: usize,
    word: &str,
) -> bool {
    let most = attribute.map_or(1, |attribute| attribute.arity().iter().copied().max().unwrap_or(0));
    match attribute.map(|attribute| attribute.value_type()) {
        // A name may look like anything, even like a number or an attribute: `material material`.
        Some(Type::Word | Type::Name(_) | Type::Choice(_) | Type::Formula) => already < most,
        _ if looks_like_number(word) => true,
        _ => {
            let Some(entity) = entity else { return already < most };
            already < most && find_attribute(entity, word).is_none() && near_attribute(entity, word).is_none()
        }
    }
}

fn looks_like_number(word: &str) -> bool {
    let unsigned = word.trim_start_matches(['+', '-']);
    unsigned.starts_with(|c: char| c.is_ascii_digit() || c == '.')
        || ["nan", "inf", "infinity"].contains(&unsigned.to_ascii_lowercase().as_str())
}
