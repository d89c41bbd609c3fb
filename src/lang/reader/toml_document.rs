//! Reads the contents of a TOML document: `[entity-type.name]` tables of attributes.

use super::fault::Fault;
use super::keyword::Keyword;
use super::parsed::{Form, MAX_VALUES, Parsed, VALUES, Word};
use super::report::Report;
use super::statement::Statement;
use super::toml_faults::{SyntaxError, before_titles, fault_of, next, places};
use std::borrow::Cow;
use std::mem::{swap, take};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Error};

/// Reads a document parsed by `toml`.
pub struct Reader<'a, 'r, 't> {
    /// The text, or a piece of it.
    text: &'a str,
    /// The position of the piece in the text, in bytes.
    at: usize,
    /// The syntax errors of the piece, and whether each is still to be reported.
    errors: Vec<SyntaxError>,
    is_told: Vec<bool>,
    titles: Vec<usize>,
    report: &'r mut Report<'t>,
    parsed: &'r mut Vec<Statement<'a>>,
}

/// A key or a value, with its place.
type Key<'a> = Spanned<toml::de::DeString<'a>>;
type Value<'a> = Spanned<DeValue<'a>>;

impl<'a, 'r, 't> Reader<'a, 'r, 't> {
    /// Prepares to read a piece of a text that begins at `at` and was parsed with these errors.
    pub fn new(
        (text, at): (&'a str, usize),
        errors: &[Error],
        report: &'r mut Report<'t>,
        parsed: &'r mut Vec<Statement<'a>>,
    ) -> Self {
        let titles = before_titles(text);
        let errors = places(errors, text, &titles);
        Self { text, at, is_told: vec![true; errors.len()], errors, titles, report, parsed }
    }

    /// Reads the parsed piece, and reports its errors.
    pub fn read(&mut self, document: Spanned<DeTable<'a>>) {
        for (kind, value) in document.into_inner() {
            self.kind(&kind, value);
        }
        for ((place, message), is_told) in take(&mut self.errors).into_iter().zip(take(&mut self.is_told)) {
            if is_told {
                self.fault(fault_of(place, &message, self.text));
            }
        }
    }

    /// Reports a fault with a place relative to this piece.
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
        if let Some(keyword) = Keyword::of(kind.get_ref()) {
            return self.statement(keyword, kind, value);
        }
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

    /// Reads a statement other than an entity, such as `let`.
    fn statement(&mut self, keyword: Keyword, key: &Key<'a>, value: Value<'a>) {
        let help = keyword.usage_in_toml();
        let text = self.text;
        let wrong = |place| {
            let what = text.get(key.span()).unwrap_or_default();
            Fault::error(Some(place), format!("wrong form of `{what}`")).help(help)
        };
        match (keyword, value) {
            (Keyword::Let, value) => {
                let DeValue::Table(numbers) = value.into_inner() else {
                    return self.fault(wrong(key.span()));
                };
                for (name, value) in numbers {
                    let Some(value) = self.one(&value) else {
                        self.fault(wrong(value.span()));
                        continue;
                    };
                    let name = self.word(name.get_ref().clone(), Form::Text, name.span());
                    self.parsed.push(Statement::Let { name, value });
                }
            }
            (Keyword::Include, value) => {
                let files = match value.get_ref() {
                    DeValue::Array(files) => files.iter().cloned().collect(),
                    _ => vec![value],
                };
                for file in files {
                    match self.one(&file).filter(|file| file.form == Form::Text) {
                        Some(file) => self.parsed.push(Statement::Include { file }),
                        None => self.fault(wrong(file.span())),
                    }
                }
            }
            (Keyword::Repeat, value) => {
                let DeValue::Table(repeats) = value.into_inner() else {
                    return self.fault(wrong(key.span()));
                };
                for (name, value) in repeats {
                    let values = match value.get_ref() {
                        DeValue::Array(values) => values.iter().cloned().collect(),
                        _ => vec![value],
                    };
                    for value in values {
                        match (value.span(), value.into_inner()) {
                            (span, DeValue::Table(body)) => self.repeat(&name, span, body, &wrong),
                            (span, _) => self.fault(wrong(span)),
                        }
                    }
                }
            }
        }
    }

    /// Reads the body and the count of a `repeat`.
    fn repeat(
        &mut self,
        name: &Key<'a>,
        span: Range<usize>,
        body: DeTable<'a>,
        wrong: &dyn Fn(Range<usize>) -> Fault,
    ) {
        let (mut inner, mut count) = (Vec::new(), None);
        swap(self.parsed, &mut inner);
        for (kind, value) in body {
            if kind.get_ref() == "count" {
                count = self.one(&value);
            } else {
                self.kind(&kind, value);
            }
        }
        swap(self.parsed, &mut inner);
        inner.sort_by_key(Statement::start);
        match count {
            Some(count) => {
                let start = self.placed(span).start;
                let name = self.word(name.get_ref().clone(), Form::Text, name.span());
                self.parsed.push(Statement::Repeat { start, name, count, body: inner });
            }
            // If something could not be parsed, the number may be there.
            None if self.errors.is_empty() => self.fault(wrong(name.span())),
            None => {}
        }
    }

    /// Returns the only word of a value.
    fn one(&mut self, value: &Value<'a>) -> Option<Word<'a>> {
        let mut words = Parsed::begin(Word::at("", Form::Any, 0..0), Word::at("", Form::Any, 0..0));
        if matches!(value.get_ref(), DeValue::Table(_) | DeValue::Array(_) | DeValue::Datetime(_)) {
            return None;
        }
        self.values(value, &mut words);
        let name = Word::at("", Form::Any, 0..0);
        words.add(name, self.report);
        words.values_of(0).first().cloned()
    }

    fn no_entity(&mut self, at: &Key<'a>, what: String) {
        let help = "an entity is a table, `[TYPE.NAME]`, followed by its attributes, `NAME = VALUE`";
        self.fault(Fault::error(Some(at.span()), what).help(help));
    }

    /// Reads an entity. `span` is its title, or all of a single-line entity.
    fn entity(&mut self, kind: &Key<'a>, name: &Key<'a>, span: Range<usize>, attributes: DeTable<'a>) {
        let title = if self.text[span.clone()].starts_with('[') { span.clone() } else { 0..0 };
        let place_of = |key: &Key<'a>| {
            // A key only knows the first title that contains it.
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
            // The stand-in for a missing value has a place before its key, but the error is after the key.
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
        // Unparsed text lies between the last attribute and the next title.
        let next = next(&self.titles, end).unwrap_or(self.text.len());
        entity.is_damaged |= self.is_faulty(name_at.start..next);
        entity.shrink();
        self.parsed.push(Statement::Entity(entity));
    }

    /// Returns the errors that begin in a span, including its end.
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

    /// Drops all errors of a broken value except the first, because the others follow from it.
    fn only_the_first_error_of(&mut self, span: Range<usize>) {
        let mut is_first = true;
        for error in self.errors_in(span) {
            if self.is_told[error] {
                self.is_told[error] = take(&mut is_first);
            }
        }
    }

    /// Returns a number without allocating memory, if it is in the text unchanged.
    fn as_written(&self, number: &str, place: &Range<usize>) -> Cow<'a, str> {
        let text: &'a str = self.text;
        match text.get(place.clone()) {
            Some(written) if written == number => Cow::Borrowed(written),
            _ => Cow::Owned(number.to_owned()),
        }
    }

    /// Reads the values of an attribute. Returns whether they have the form of values.
    fn values(&mut self, value: &Value<'a>, entity: &mut Parsed<'a>) -> bool {
        let place = value.span();
        match value.get_ref() {
            DeValue::String(text) => entity.value(self.word(text.clone(), Form::Text, place)),
            DeValue::Float(number) => {
                entity.value(self.word(self.as_written(number.as_str(), &place), Form::Number, place))
            }
            DeValue::Integer(number) => {
                let digits = match number.radix() {
                    10 => self.as_written(number.as_str(), &place),
                    radix => i64::from_str_radix(number.as_str(), radix)
                        .map_or_else(|_| self.text[place.clone()].into(), |number| number.to_string().into()),
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
