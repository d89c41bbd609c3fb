//! Scenes in TOML: `[entity-type.name]` tables of the same attributes.

use super::fault::{Fault, Report};
use super::written::{Form, Word, Written};
use crate::scene::registry::Registry;
use crate::scene::syntax::Syntax;
use std::borrow::Cow;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Error};

/// Reads the entities of a text, in their order, and reports what does not have their form. What can be made
/// out beyond a fault is read all the same, so that one run finds the faults that follow.
pub fn parse<'a>(registry: &Registry, text: &'a str, report: &mut Report) -> Vec<Written<'a>> {
    let (document, errors) = DeTable::parse_recoverable(text);
    if document.get_ref().is_empty()
        && let Some(first) = errors.first()
    {
        let fault = Fault::error(first.span().or(Some(0..0)), "this is not a scene in TOML");
        report.add(fault.help(registry.first_steps(Syntax::Toml)));
        return Vec::new();
    }
    let mut written = Vec::new();
    if errors.iter().all(is_duplicate) {
        Parser { text, at: 0, errors: places(&errors, text), report, written: &mut written }.read(document);
    } else {
        // A bracket that is never closed makes nonsense of all that follows. The next title is a new start.
        for piece in pieces(text) {
            let at = piece.start;
            let text = &text[piece];
            let (document, errors) = DeTable::parse_recoverable(text);
            Parser { text, at, errors: places(&errors, text), report, written: &mut written }.read(document);
        }
    }
    written.sort_by_key(|entity| entity.name.place.as_ref().map(|place| place.start));
    written
}

/// A syntax error: its place and what it is.
type SyntaxError = (Range<usize>, String);

fn is_duplicate(error: &Error) -> bool {
    error.message() == DUPLICATE
}

const DUPLICATE: &str = "duplicate key";

/// Where a text can be parted: before each line that is a title.
fn pieces(text: &str) -> Vec<Range<usize>> {
    let is_title = |line: &str| {
        let line = line.split('#').next().unwrap_or_default().trim();
        let name = line.strip_prefix('[').and_then(|line| line.strip_suffix(']'));
        name.is_some_and(|name| name.contains('.') && !name.contains([',', '=']))
    };
    let mut starts = vec![0];
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        if is_title(line) && at > 0 {
            starts.push(at);
        }
        at += line.len();
    }
    let ends = starts[1..].iter().copied().chain([text.len()]);
    starts.iter().copied().zip(ends).map(|(start, end)| start..end).collect()
}

/// The first syntax error of each line, in their order: what follows one on its line mostly follows from it.
fn places(errors: &[Error], text: &str) -> Vec<SyntaxError> {
    let mut places: Vec<_> = errors
        .iter()
        .map(|error| (error.span().unwrap_or(text.len()..text.len()), error.message().to_owned()))
        .collect();
    places.sort_by_key(|(place, _)| place.start);
    let mut end = 0;
    let mut second_title = 0..0;
    places.retain(|(place, message)| {
        // What a second title repeats of the first one is no fault of its own.
        let line = text[..place.start].rfind('\n').map_or(0, |end| end + 1);
        if message == DUPLICATE && text[line..].starts_with('[') {
            let next = text[place.end..].find("\n[").map_or(text.len(), |length| place.end + length);
            second_title = place.end..next;
        }
        if message == DUPLICATE && second_title.contains(&place.start) {
            return false;
        }
        let is_first = place.start >= end;
        if is_first {
            end = text[place.start..].find('\n').map_or(text.len() + 1, |length| place.start + length + 1);
        }
        is_first
    });
    places
}

/// A syntax error as the fault that it is.
fn fault_of(place: Range<usize>, message: &str, text: &str) -> Fault {
    let before = &text[..place.start];
    let begins_line = before.rfind('\n').is_some_and(|end| before[end..].trim().is_empty());
    let (place, message, help) = match message {
        DUPLICATE => {
            let key = text[place.clone()].to_owned();
            let help = "a table or an attribute may appear only once; for lights that share a name, write `[[TYPE.NAME]]`";
            (place, format!("duplicate `{key}`"), help)
        }
        _ if message.contains("array") && (begins_line || place.start == text.len()) => {
            let end = before.trim_end().len();
            (end..end, "missing `]`".to_owned(), "several values go in brackets: `center = [4, 2, -4]`")
        }
        _ if message.starts_with("string values") => {
            (place, "unquoted word".to_owned(), "names need quotes: `material = \"red\"`")
        }
        _ if message.starts_with("key with no value") => {
            (place, "missing `=`".to_owned(), "write attributes as `NAME = VALUE`")
        }
        _ => {
            (place, message.to_owned(), "a value is a number, a quoted word, or several of them in brackets")
        }
    };
    Fault::error(Some(place), message).help(help)
}

struct Parser<'a, 'r> {
    /// A text, or a piece of one.
    text: &'a str,
    /// Where it begins.
    at: usize,
    errors: Vec<SyntaxError>,
    report: &'r mut Report,
    written: &'r mut Vec<Written<'a>>,
}

/// A key, and a value.
type Key<'a> = Spanned<toml::de::DeString<'a>>;
type Value<'a> = Spanned<DeValue<'a>>;

impl<'a> Parser<'a, '_> {
    fn read(&mut self, document: Spanned<DeTable<'a>>) {
        for (kind, value) in document.into_inner() {
            self.kind(&kind, value);
        }
        for (place, message) in std::mem::take(&mut self.errors) {
            self.fault(fault_of(place, &message, self.text));
        }
    }

    /// Reports a fault whose place is one in this piece.
    fn fault(&mut self, mut fault: Fault) {
        fault.place = fault.place.map(|place| self.placed(place));
        self.report.add(fault);
    }

    fn placed(&self, place: Range<usize>) -> Range<usize> {
        self.at + place.start..self.at + place.end
    }

    fn word(&self, text: impl Into<Cow<'a, str>>, form: Form, place: Range<usize>) -> Word<'a> {
        Word::at(text, form, self.placed(place))
    }

    /// Reads the entities of one type.
    fn kind(&mut self, kind: &Key<'a>, value: Value<'a>) {
        let DeValue::Table(entities) = value.into_inner() else {
            let what = format!("`{}` is not part of any entity", kind.get_ref());
            self.no_entity(kind, what);
            return;
        };
        if entities.is_empty() {
            self.no_entity(kind, format!("this `{}` has no name", kind.get_ref()));
        }
        for (name, value) in entities {
            let span = value.span();
            match value.into_inner() {
                DeValue::Table(attributes) => self.entity(kind, &name, span, attributes),
                DeValue::Array(entities) if entities.iter().any(|entity| entity.get_ref().is_table()) => {
                    for entity in entities {
                        let span = entity.span();
                        if let DeValue::Table(attributes) = entity.into_inner() {
                            self.entity(kind, &name, span, attributes);
                        }
                    }
                }
                _ => {
                    let what = format!(
                        "`{}` is not part of any entity: this `{}` has no name",
                        name.get_ref(),
                        kind.get_ref()
                    );
                    self.no_entity(&name, what);
                }
            }
        }
    }

    fn no_entity(&mut self, at: &Key<'a>, what: String) {
        let help = "an entity is a table, `[TYPE.NAME]`, followed by its attributes, `NAME = VALUE`";
        self.fault(Fault::error(Some(at.span()), what).help(help));
    }

    /// Reads an entity; `span` is its title, or all of it where it stands in one line.
    fn entity(&mut self, kind: &Key<'a>, name: &Key<'a>, span: Range<usize>, attributes: DeTable<'a>) {
        let title = if self.text[span.clone()].starts_with('[') { span.clone() } else { 0..0 };
        let place_of = |key: &Key<'a>| {
            // A key knows only the first of the titles that it stands in.
            let source = self.text.get(key.span()).unwrap_or_default();
            let found = self.text[title.clone()].rfind(source).map(|at| title.start + at);
            found.map_or(key.span(), |start| start..start + source.len())
        };
        let (kind_at, name_at) = (place_of(kind), place_of(name));
        let start = kind_at.start;
        let mut entity = Written {
            kind: self.word(kind.get_ref().clone(), Form::Text, kind_at),
            name: self.word(name.get_ref().clone(), Form::Text, name_at.clone()),
            attributes: Vec::new(),
            place: None,
            is_damaged: false,
        };
        let mut attributes: Vec<_> = attributes.into_iter().collect();
        attributes.sort_by_key(|(key, _)| key.span().start);
        let mut end = name_at.end.max(span.end);
        for (key, value) in attributes {
            end = end.max(value.span().end);
            if self.is_faulty(key.span().start..value.span().end) {
                self.only_the_first_error_of(value.span());
                entity.is_damaged = true;
                continue;
            }
            let mut values = Vec::new();
            if self.values(&value, &mut values) {
                let key = self.word(key.get_ref().clone(), Form::Text, key.span());
                entity.attributes.push((key, values));
            } else {
                entity.is_damaged = true;
            }
        }
        entity.place = Some(self.placed(start..end));
        // What could not be made out at all stands after the last attribute, and before the next title.
        let next = self.text[end..].find("\n[").map_or(self.text.len(), |length| end + length);
        entity.is_damaged |= self.is_faulty(name_at.start..next);
        self.written.push(entity);
    }

    fn is_faulty(&self, span: Range<usize>) -> bool {
        self.errors.iter().any(|(place, _)| place.start >= span.start && place.start <= span.end)
    }

    /// Where a value is broken, what follows inside it follows from that.
    fn only_the_first_error_of(&mut self, span: Range<usize>) {
        let mut is_first = true;
        self.errors.retain(|(place, _)| {
            let inside = place.start >= span.start && place.start <= span.end;
            !inside || std::mem::take(&mut is_first)
        });
    }

    /// Reads the values of an attribute; whether they have the form of values.
    fn values(&mut self, value: &Value<'a>, words: &mut Vec<Word<'a>>) -> bool {
        let place = value.span();
        match value.get_ref() {
            DeValue::String(text) => words.push(self.word(text.clone(), Form::Text, place)),
            DeValue::Float(number) => words.push(self.word(number.as_str().to_owned(), Form::Number, place)),
            DeValue::Integer(number) => {
                let digits = match number.radix() {
                    10 => number.as_str().to_owned(),
                    radix => i64::from_str_radix(number.as_str(), radix)
                        .map_or_else(|_| self.text[place.clone()].to_owned(), |number| number.to_string()),
                };
                words.push(self.word(digits, Form::Number, place));
            }
            DeValue::Array(values) if values.iter().all(|value| !value.get_ref().is_array()) => {
                let mut sound = true;
                for value in values.iter() {
                    sound &= self.values(value, words);
                }
                return sound;
            }
            DeValue::Boolean(_) | DeValue::Datetime(_) | DeValue::Array(_) | DeValue::Table(_) => {
                let what = match value.get_ref() {
                    DeValue::Boolean(truth) => format!("`{truth}` cannot be the value of an attribute"),
                    DeValue::Datetime(_) => "a date cannot be the value of an attribute".to_owned(),
                    DeValue::Array(_) => "a nested array cannot be the value of an attribute".to_owned(),
                    _ => "a table cannot be the value of an attribute".to_owned(),
                };
                let help = "values are numbers, quoted words, or several of them in brackets";
                self.fault(Fault::error(Some(place), what).help(help));
                return false;
            }
        }
        true
    }
}
