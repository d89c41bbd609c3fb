//! Entities as they are written: kind, name, attributes and values, each with its place, none of it checked.

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

/// What a word's spelling says of its meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// Nothing: a word of the notes' spelling may be a number or a name.
    Any,
    /// It is a number, as TOML writes them.
    Number,
    /// It is not: it stands in quotes.
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

/// The most values of an attribute that are kept. No attribute takes as many.
pub(super) const MOST_VALUES: usize = 1000;

/// The most attributes of an entity that are kept. No type has as many.
pub(super) const MOST_ATTRIBUTES: usize = 1000;

/// An entity as it is written.
#[derive(Clone, Debug)]
pub struct Written<'a> {
    pub(super) kind: Word<'a>,
    pub(super) name: Word<'a>,
    pub(super) attributes: Vec<(Word<'a>, Vec<Word<'a>>)>,
    /// From its type to its end.
    pub(super) place: Place,
    /// Whether its text could not all be made out: then what it lacks is no fault of its own.
    pub(super) is_damaged: bool,
}

impl<'a> Written<'a> {
    /// Adds an attribute, but no more than can be of use.
    pub(super) fn add(&mut self, name: Word<'a>, mut values: Vec<Word<'a>>, report: &mut Report) {
        match self.attributes.len() {
            MOST_ATTRIBUTES if !self.is_damaged => {
                self.is_damaged = true;
                let message = format!("this {} has more than {MOST_ATTRIBUTES} attributes", self.kind.text);
                report.add(Fault::error(name.place, message).label("the first that is too many"));
            }
            MOST_ATTRIBUTES.. => {}
            _ => {
                values.shrink_to_fit();
                self.attributes.push((name, values));
            }
        }
    }
}

impl Written<'static> {
    /// An entity written in Rust: its type and its name.
    pub fn new(kind: &str, name: &str) -> Self {
        Self {
            kind: Word::unplaced(kind),
            name: Word::unplaced(name),
            attributes: Vec::new(),
            place: None,
            is_damaged: false,
        }
    }

    /// Gives it an attribute.
    pub fn set(mut self, attribute: &str, values: impl Values) -> Self {
        let values = values.words().into_iter().map(Word::unplaced).collect();
        self.attributes.push((Word::unplaced(attribute), values));
        self
    }
}

/// What can be given as an attribute's values in Rust. Numbers keep every bit.
pub trait Values {
    /// The words that stand for the values in a scene.
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
