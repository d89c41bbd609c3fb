//! Parsed entities: type, name, attributes and values, each with its place, before any check.

use super::fault::{Fault, Place};
use super::report::Report;
use glam::{DVec2, DVec3};
use std::borrow::Cow;
use std::mem::replace;
use std::ops::Range;

/// A word of a scene and its place.
#[derive(Clone, Debug)]
pub struct Word<'a> {
    /// The word, without quotes.
    pub text: Cow<'a, str>,
    /// Its type.
    pub form: Form,
    /// Where it stands.
    pub place: Place,
}

/// The type of a word according to the syntax.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Unknown: a word of the notes' syntax may be a number or a name.
    Any,
    /// A number in TOML.
    Number,
    /// Text, because the word is quoted.
    Text,
    /// Yes or no in TOML: `true` or `false`.
    Truth,
    /// A formula with a reported error.
    Faulty,
}

impl<'a> Word<'a> {
    /// Makes a word at a place.
    #[inline]
    pub fn at(text: impl Into<Cow<'a, str>>, form: Form, place: Range<usize>) -> Self {
        Self { text: text.into(), form, place: Some(place) }
    }

    fn unplaced(text: impl Into<String>) -> Self {
        Self { text: Cow::Owned(text.into()), form: Form::Any, place: None }
    }

    /// Returns the place of a part of the word, given in bytes. If the text does not contain the word exactly as it is,
    /// without escapes, returns the place of the whole word.
    pub fn within(&self, part: &Range<usize>) -> Place {
        let quotes = usize::from(self.form == Form::Text);
        let place = self.place.clone()?;
        if place.len() != self.text.len() + 2 * quotes {
            return Some(place);
        }
        let at = place.start + quotes;
        Some(at + part.start..at + part.end)
    }
}

/// The maximum number of values that are kept for an attribute. No attribute takes as many
/// (`every_table_keeps_its_own_rules`).
pub(crate) const MAX_VALUES: usize = 1000;

/// A description of attribute values, for messages about invalid ones.
pub(crate) const VALUES: &str = "values are numbers, quoted words, or several of them in brackets";

/// The maximum number of attributes that are kept for an entity. No type has as many.
pub(crate) const MAX_ATTRIBUTES: usize = 1000;

/// A parsed entity, before any check.
#[derive(Clone, Debug)]
pub struct Parsed<'a> {
    /// Its type.
    pub kind: Word<'a>,
    /// Its name.
    pub name: Word<'a>,
    /// The names of the attributes, each with the number of values up to its own last one.
    attributes: Vec<(Word<'a>, usize)>,
    /// The values of all attributes.
    values: Vec<Word<'a>>,
    /// The range from the entity's type to its end.
    pub place: Place,
    /// Whether some of the entity's text could not be parsed. Missing attributes are then not reported.
    pub(crate) is_damaged: bool,
}

impl<'a> Parsed<'a> {
    /// Begins an entity without attributes.
    pub(crate) fn begin(kind: Word<'a>, name: Word<'a>) -> Self {
        let (attributes, values) = (Vec::new(), Vec::new());
        Self { kind, name, attributes, values, place: None, is_damaged: false }
    }

    /// Begins another entity in the same memory.
    pub(crate) fn begin_again(&mut self, kind: Word<'a>, name: Word<'a>) {
        self.attributes.clear();
        self.values.clear();
        (self.kind, self.name) = (kind, name);
        (self.place, self.is_damaged) = (None, false);
    }

    /// Adds a value to the next attribute that [`add`](Self::add) adds. Values beyond [`MAX_VALUES`] are not kept.
    #[inline]
    pub(crate) fn value(&mut self, value: Word<'a>) {
        if self.values.len() - self.attributes.last().map_or(0, |(_, end)| *end) < MAX_VALUES {
            self.keep(value);
        }
    }

    /// Adds a value, regardless of their number.
    #[inline]
    pub(crate) fn keep(&mut self, value: Word<'a>) {
        self.values.push(value);
    }

    /// Adds an attribute with the values added since the one before. Beyond [`MAX_ATTRIBUTES`], reports it instead.
    #[inline]
    pub(crate) fn add(&mut self, name: Word<'a>, report: &mut Report<'_>) {
        match self.attributes.len() {
            MAX_ATTRIBUTES.. => {
                self.drop_values();
                if !replace(&mut self.is_damaged, true) {
                    let message =
                        format!("this {} has more than {MAX_ATTRIBUTES} attributes", self.kind.text);
                    report.add(Fault::error(name.place, message).label("the first that is too many"));
                }
            }
            _ => self.attributes.push((name, self.values.len())),
        }
    }

    /// Drops the values added since the last attribute.
    pub(crate) fn drop_values(&mut self) {
        self.values.truncate(self.attributes.last().map_or(0, |(_, end)| *end));
    }

    /// Replaces the values of an attribute, under any of its names, or adds the attribute.
    pub(crate) fn replace(&mut self, name: Word<'a>, values: Vec<Word<'a>>, is_same: impl Fn(&str) -> bool) {
        let old = self.clone();
        self.attributes.clear();
        self.values.clear();
        for (name, values) in old.attributes().filter(|(name, _)| !is_same(&name.text)) {
            self.values.extend_from_slice(values);
            self.attributes.push((name.clone(), self.values.len()));
        }
        self.values.extend(values.into_iter().take(MAX_VALUES));
        self.attributes.push((name, self.values.len()));
    }

    /// Tells whether any value is quoted.
    pub(crate) fn has_quotes(&self) -> bool {
        self.values.iter().any(|value| value.form == Form::Text)
    }

    /// Changes the values of all attributes.
    pub(crate) fn change(&mut self, mut change: impl FnMut(&str, Word<'a>) -> Word<'a>) {
        let mut start = 0;
        for (name, end) in &self.attributes {
            for value in &mut self.values[start..*end] {
                let empty = Word { text: Cow::Borrowed(""), form: Form::Any, place: None };
                *value = change(&name.text, replace(value, empty));
            }
            start = *end;
        }
    }

    /// Changes the names of all attributes and all values, in the order of the text, until `change` fails. Its second
    /// argument tells whether the word is a value.
    pub(super) fn all_words(&mut self, mut change: impl FnMut(&mut Word<'a>, bool) -> bool) -> bool {
        let mut start = 0;
        for (name, end) in &mut self.attributes {
            let values = &mut self.values[start..*end];
            if !change(name, false) || !values.iter_mut().all(|value| change(value, true)) {
                return false;
            }
            start = *end;
        }
        start == self.values.len()
    }

    /// Frees unneeded memory.
    pub(crate) fn shrink(&mut self) {
        self.attributes.shrink_to_fit();
        self.values.shrink_to_fit();
    }

    /// Returns the attributes, each with its values.
    pub fn attributes(&self) -> impl DoubleEndedIterator<Item = (&Word<'a>, &[Word<'a>])> {
        let indexed = self.attributes.iter().enumerate();
        indexed.map(|(index, (name, _))| (name, self.values_of(index)))
    }

    /// Returns the values of the attribute with this index.
    #[inline]
    pub(crate) fn values_of(&self, index: usize) -> &[Word<'a>] {
        let start = index.checked_sub(1).map_or(0, |before| self.attributes[before].1);
        &self.values[start..self.attributes[index].1]
    }

    /// Returns the number of attributes.
    #[inline]
    pub(crate) fn count(&self) -> usize {
        self.attributes.len()
    }
}

impl Parsed<'static> {
    /// Starts an entity built in Rust, with its type and its name.
    pub fn new(kind: &str, name: &str) -> Self {
        Self::begin(Word::unplaced(kind), Word::unplaced(name))
    }

    /// Adds an attribute and its values.
    pub fn set(mut self, attribute: &str, values: impl Values) -> Self {
        self.values.extend(values.words().into_iter().map(Word::unplaced));
        self.attributes.push((Word::unplaced(attribute), self.values.len()));
        self
    }
}

/// Values for attributes in Rust. Numbers keep all bits.
pub trait Values {
    /// Returns the words for the values in a scene.
    fn words(self) -> Vec<String>;
}

impl Values for &str {
    fn words(self) -> Vec<String> {
        vec![self.to_owned()]
    }
}

impl Values for f64 {
    fn words(self) -> Vec<String> {
        vec![format!("{self:?}")]
    }
}

impl Values for i64 {
    fn words(self) -> Vec<String> {
        vec![self.to_string()]
    }
}

impl<const N: usize> Values for [f64; N] {
    fn words(self) -> Vec<String> {
        self.into_iter().flat_map(f64::words).collect()
    }
}

impl<const N: usize> Values for [i64; N] {
    fn words(self) -> Vec<String> {
        self.into_iter().flat_map(i64::words).collect()
    }
}

impl Values for DVec2 {
    fn words(self) -> Vec<String> {
        self.to_array().words()
    }
}

impl Values for DVec3 {
    fn words(self) -> Vec<String> {
        self.to_array().words()
    }
}
