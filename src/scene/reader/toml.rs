//! Parses scenes in TOML: `[entity-type.name]` tables of the same attributes.

use super::fault::Fault;
use super::parsed::{Form, MAX_VALUES, Parsed, VALUES, Word};
use super::report::Report;
use crate::scene::registry::Registry;
use crate::scene::syntax::Syntax;
use std::borrow::Cow;
use std::mem::take;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Error};

/// The maximum length of a line, and of the part of a text that is parsed at once before the whole text is known to be
/// free of syntax errors, in bytes. For each token and each error, the parser keeps many times as much memory as it
/// takes in the text.
const LINE: usize = 1 << 16;
const PART: usize = 1 << 17;

/// Parses the entities of a text, in their order, and reports syntax errors. Parsing goes on after an error, so that
/// one run finds the faults that follow.
pub fn parse<'a>(registry: &Registry, text: &'a str, report: &mut Report<'_>) -> Vec<Parsed<'a>> {
    if let Some(place) = long_line(text) {
        let message = format!("this line is {} bytes long", place.len());
        let help = format!("a line of a scene in TOML is at most {LINE} bytes long");
        report.add(Fault::error(Some(place), message).help(help));
        return Vec::new();
    }
    let mut parsed = Vec::new();
    if is_sound(text) {
        let (document, errors) = DeTable::parse_recoverable(text);
        if document.get_ref().is_empty()
            && let Some(first) = errors.first()
        {
            let fault = Fault::error(first.span().or(Some(0..0)), "this is not a scene in TOML");
            report.add(fault.help(registry.first_steps(Syntax::Toml)));
            return Vec::new();
        }
        if errors.iter().all(is_duplicate) {
            Parser::new((text, 0), &errors, report, &mut parsed).read(document);
            parsed.sort_by_key(|entity| entity.name.place.as_ref().map(|place| place.start));
            return parsed;
        }
    }
    // After a bracket that is never closed, nothing can be parsed. Parsing starts again at the next title.
    for piece in pieces(text) {
        if report.has_enough() {
            break;
        }
        let at = piece.start;
        let text = &text[piece];
        let (document, errors) = DeTable::parse_recoverable(text);
        Parser::new((text, at), &errors, report, &mut parsed).read(document);
    }
    parsed.sort_by_key(|entity| entity.name.place.as_ref().map(|place| place.start));
    parsed
}

/// Finds the first line that is too long.
fn long_line(text: &str) -> Option<Range<usize>> {
    let mut at = 0;
    let mut lines = text.split('\n').map(|line| {
        at += line.len() + 1;
        at - 1 - line.len()..at - 1
    });
    lines.find(|line| line.len() > LINE)
}

/// Tells whether a text can be parsed at once: it is short, or its parts have no syntax errors.
fn is_sound(text: &str) -> bool {
    let mut parts = pieces(text);
    // Each part joins as many pieces as fit.
    parts.dedup_by(|next, part| {
        let fits = next.end - part.start <= PART;
        if fits {
            part.end = next.end;
        }
        fits
    });
    let has_errors = |part: Range<usize>| {
        let (_, errors) = DeTable::parse_recoverable(&text[part]);
        !errors.iter().all(is_duplicate)
    };
    text.len() <= PART || !parts.into_iter().any(has_errors)
}

/// A syntax error: its place and its message.
type SyntaxError = (Range<usize>, String);

fn is_duplicate(error: &Error) -> bool {
    error.message() == DUPLICATE
}

const DUPLICATE: &str = "duplicate key";

/// Splits a text: before each line that is a title, and before other lines where no title comes for a long time.
fn pieces(text: &str) -> Vec<Range<usize>> {
    let is_title = |line: &str| {
        let line = line.split('#').next().unwrap_or_default().trim();
        let name = line.strip_prefix('[').and_then(|line| line.strip_suffix(']'));
        name.is_some_and(|name| name.contains('.') && !name.contains([',', '=']))
    };
    let mut starts = vec![0];
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        let is_long = at + line.len() - starts[starts.len() - 1] > PART;
        if at > 0 && (is_long || is_title(line)) {
            starts.push(at);
        }
        at += line.len();
    }
    let ends = starts[1..].iter().copied().chain([text.len()]);
    starts.iter().copied().zip(ends).map(|(start, end)| start..end).collect()
}

/// Returns the ends of the lines that are followed by a line beginning with a bracket.
fn before_titles(text: &str) -> Vec<usize> {
    text.match_indices("\n[").map(|(at, _)| at).collect()
}

/// Returns the first syntax error of each line, in order: later errors on a line mostly follow from the first.
fn places(errors: &[Error], text: &str, titles: &[usize]) -> Vec<SyntaxError> {
    let place = |error: &Error| {
        let place = error.span().unwrap_or(text.len()..text.len());
        // The range of a token missing between two others may end before it begins.
        place.start.min(place.end)..place.start.max(place.end)
    };
    let mut places: Vec<_> = errors.iter().map(|error| (place(error), error.message().to_owned())).collect();
    places.sort_unstable_by_key(|(place, _)| place.start);
    let mut end = 0;
    let mut second_title = 0..0;
    places.retain(|(place, message)| {
        // Duplicates below a repeated title follow from the title, so they are not reported.
        if message == DUPLICATE {
            let line = text[..place.start].rfind('\n').map_or(0, |end| end + 1);
            if text[line..].starts_with('[') {
                second_title = place.end..next(titles, place.end).unwrap_or(text.len());
            }
            if second_title.contains(&place.start) {
                return false;
            }
        }
        let is_first = place.start >= end;
        if is_first {
            end = text[place.start..].find('\n').map_or(text.len() + 1, |length| place.start + length + 1);
        }
        is_first
    });
    places
}

/// Returns the first of these sorted positions that is not before `from`.
fn next(places: &[usize], from: usize) -> Option<usize> {
    places.get(places.partition_point(|place| *place < from)).copied()
}

/// Makes a fault of a syntax error.
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

struct Parser<'a, 'r, 't> {
    /// The text, or a piece of it.
    text: &'a str,
    /// The position at which the piece begins, in bytes.
    at: usize,
    /// The syntax errors of the piece, and which of them need not be reported any more.
    errors: Vec<SyntaxError>,
    is_told: Vec<bool>,
    titles: Vec<usize>,
    report: &'r mut Report<'t>,
    parsed: &'r mut Vec<Parsed<'a>>,
}

/// A key with its place, and a value with its place.
type Key<'a> = Spanned<toml::de::DeString<'a>>;
type Value<'a> = Spanned<DeValue<'a>>;

impl<'a, 'r, 't> Parser<'a, 'r, 't> {
    fn new(
        (text, at): (&'a str, usize),
        errors: &[Error],
        report: &'r mut Report<'t>,
        parsed: &'r mut Vec<Parsed<'a>>,
    ) -> Self {
        let titles = before_titles(text);
        let errors = places(errors, text, &titles);
        Self { text, at, is_told: vec![true; errors.len()], errors, titles, report, parsed }
    }

    fn read(&mut self, document: Spanned<DeTable<'a>>) {
        for (kind, value) in document.into_inner() {
            self.kind(&kind, value);
        }
        for ((place, message), is_told) in take(&mut self.errors).into_iter().zip(take(&mut self.is_told)) {
            if is_told {
                self.fault(fault_of(place, &message, self.text));
            }
        }
    }

    /// Reports a fault whose place is relative to this piece.
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

    /// Reads an entity; `span` is its title, or all of it where it stands on one line.
    fn entity(&mut self, kind: &Key<'a>, name: &Key<'a>, span: Range<usize>, attributes: DeTable<'a>) {
        let title = if self.text[span.clone()].starts_with('[') { span.clone() } else { 0..0 };
        let place_of = |key: &Key<'a>| {
            // A key knows only the first title in which it stands.
            let source = self.text.get(key.span()).unwrap_or_default();
            let found = self.text[title.clone()].rfind(source).map(|at| title.start + at);
            found.map_or(key.span(), |start| start..start + source.len())
        };
        let (kind_at, name_at) = (place_of(kind), place_of(name));
        let start = kind_at.start;
        let mut entity = Parsed::begin(
            self.word(kind.get_ref().clone(), Form::Text, kind_at),
            self.word(name.get_ref().clone(), Form::Text, name_at.clone()),
        );
        let mut attributes: Vec<_> = attributes.into_iter().collect();
        attributes.sort_unstable_by_key(|(key, _)| key.span().start);
        let mut end = name_at.end.max(span.end);
        for (key, value) in attributes {
            end = end.max(value.span().end);
            // The stand-in for a missing value has a place before its key; the error comes after the key.
            let is_before = value.span().start < key.span().end;
            let value_end = if is_before { self.line_end(key.span().end) } else { value.span().end };
            if self.is_faulty(key.span().start..value_end) {
                self.only_the_first_error_of(value.span());
                entity.is_damaged = true;
                continue;
            }
            if self.values(&value, &mut entity) {
                let key = self.word(key.get_ref().clone(), Form::Text, key.span());
                entity.add(key, self.report);
            } else {
                entity.drop_values();
                entity.is_damaged = true;
            }
        }
        entity.place = Some(self.placed(start..end));
        // What could not be parsed at all stands between the last attribute and the next title.
        let next = next(&self.titles, end).unwrap_or(self.text.len());
        entity.is_damaged |= self.is_faulty(name_at.start..next);
        entity.shrink();
        self.parsed.push(entity);
    }

    /// Returns the errors that begin in a span, its end included.
    fn errors_in(&self, span: Range<usize>) -> Range<usize> {
        let first = self.errors.partition_point(|(place, _)| place.start < span.start);
        first..self.errors.partition_point(|(place, _)| place.start <= span.end).max(first)
    }

    fn line_end(&self, at: usize) -> usize {
        self.text[at..].find('\n').map_or(self.text.len(), |length| at + length)
    }

    fn is_faulty(&self, span: Range<usize>) -> bool {
        self.errors_in(span).any(|error| self.is_told[error])
    }

    /// Drops all but the first error of a broken value: the others follow from it.
    fn only_the_first_error_of(&mut self, span: Range<usize>) {
        let mut is_first = true;
        for error in self.errors_in(span) {
            if self.is_told[error] {
                self.is_told[error] = take(&mut is_first);
            }
        }
    }

    /// Reads the values of an attribute; returns whether they have the form of values.
    fn values(&mut self, value: &Value<'a>, entity: &mut Parsed<'a>) -> bool {
        let place = value.span();
        match value.get_ref() {
            DeValue::String(text) => entity.value(self.word(text.clone(), Form::Text, place)),
            DeValue::Float(number) => {
                entity.value(self.word(number.as_str().to_owned(), Form::Number, place))
            }
            DeValue::Integer(number) => {
                let digits = match number.radix() {
                    10 => number.as_str().to_owned(),
                    radix => i64::from_str_radix(number.as_str(), radix)
                        .map_or_else(|_| self.text[place.clone()].to_owned(), |number| number.to_string()),
                };
                entity.value(self.word(digits, Form::Number, place));
            }
            DeValue::Array(values) if values.iter().all(|value| !value.get_ref().is_array()) => {
                let mut sound = true;
                for value in values.iter().take(MAX_VALUES) {
                    sound &= self.values(value, entity);
                }
                return sound;
            }
            DeValue::Boolean(truth) => entity.value(self.word(truth.to_string(), Form::Truth, place)),
            DeValue::Datetime(_) | DeValue::Array(_) | DeValue::Table(_) => {
                let what = match value.get_ref() {
                    DeValue::Datetime(_) => "a date cannot be the value of an attribute".to_owned(),
                    DeValue::Array(_) => "a nested array cannot be the value of an attribute".to_owned(),
                    _ => "a table cannot be the value of an attribute".to_owned(),
                };
                self.fault(Fault::error(Some(place), what).help(VALUES));
                return false;
            }
        }
        true
    }
}
