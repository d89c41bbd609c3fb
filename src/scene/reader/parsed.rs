//! Parsed entities: kind, name, attributes and values, each with its place and not yet checked.

use super::fault::{Fault, Place};
use super::report::Report;
use glam::{DVec2, DVec3};
use std::borrow::Cow;
use std::ops::Range;

/// A word of a scene and its place.
#[derive(Clone, Debug)]
pub(super) struct Word<'a> {
    pub text: Cow<'a, str>,
    pub form: Form,
    pub place: Place,
}

/// What the syntax says about a word's type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// Unknown: a word of the notes' syntax may be a number or a name.
    Any,
    /// A number, as TOML writes it.
    Number,
    /// Text, because the word stands in quotes.
    Text,
}

impl<'a> Word<'a> {
    pub fn at(text: impl Into<Cow<'a, str>>, form: Form, place: Range<usize>) -> Self {
        Self { text: text.into(), form, place: Some(place) }
    }

    fn unplaced(text: impl Into<String>) -> Self {
        Self { text: Cow::Owned(text.into()), form: Form::Any, place: None }
    }
}

/// The maximum number of values that are kept for an attribute. No attribute takes as many.
pub(super) const MAX_VALUES: usize = 1000;

/// The maximum number of attributes that are kept for an entity. No type has as many.
pub(super) const MAX_ATTRIBUTES: usize = 1000;

/// An entity as parsed, not yet checked.
#[derive(Clone, Debug)]
pub struct Parsed<'a> {
    pub(super) kind: Word<'a>,
    pub(super) name: Word<'a>,
    pub(super) attributes: Vec<(Word<'a>, Vec<Word<'a>>)>,
    /// The range from the entity's type to its end.
    pub(super) place: Place,
    /// Whether some of the entity's text could not be parsed. Then missing attributes are not reported.
    pub(super) is_damaged: bool,
}

impl<'a> Parsed<'a> {
    /// Adds an attribute; beyond [`MAX_ATTRIBUTES`] reports it instead.
    pub(super) fn add(&mut self, name: Word<'a>, mut values: Vec<Word<'a>>, report: &mut Report) {
        match self.attributes.len() {
            MAX_ATTRIBUTES if !self.is_damaged => {
                self.is_damaged = true;
                let message = format!("this {} has more than {MAX_ATTRIBUTES} attributes", self.kind.text);
                report.add(Fault::error(name.place, message).label("the first that is too many"));
            }
            MAX_ATTRIBUTES.. => {}
            _ => {
                values.shrink_to_fit();
                self.attributes.push((name, values));
            }
        }
    }
}

impl Parsed<'static> {
    /// Starts an entity built in Rust, with its type and its name.
    pub fn new(kind: &str, name: &str) -> Self {
        Self {
            kind: Word::unplaced(kind),
            name: Word::unplaced(name),
            attributes: Vec::new(),
            place: None,
            is_damaged: false,
        }
    }

    /// Adds an attribute and its values.
    pub fn set(mut self, attribute: &str, values: impl Values) -> Self {
        let values = values.words().into_iter().map(Word::unplaced).collect();
        self.attributes.push((Word::unplaced(attribute), values));
        self
    }
}

/// Values that can be given to an attribute in Rust. Numbers keep every bit.
pub trait Values {
    /// Returns the words that stand for the values in a scene.
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
