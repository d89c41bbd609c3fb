//! The statements of a scene in TOML.

use super::fault::Place;
use super::parsed::{Parsed, Word};
use std::ops::Range;

/// A statement of a scene in TOML.
pub enum Statement<'a> {
    Entity(Parsed<'a>),
    Let { name: Word<'a>, value: Word<'a> },
    Include { file: Word<'a> },
    Repeat { start: usize, name: Word<'a>, count: Word<'a>, body: Vec<Statement<'a>> },
}

impl Statement<'_> {
    /// Returns the beginning of the statement, in bytes.
    pub fn start(&self) -> Option<usize> {
        let place = match self {
            Self::Entity(entity) => &entity.name.place,
            Self::Let { name, .. } => &name.place,
            Self::Include { file } => &file.place,
            Self::Repeat { start, .. } => return Some(*start),
        };
        place.as_ref().map(|place| place.start)
    }

    /// Returns the name of a number, and its place.
    pub fn number(&self) -> Option<(String, Place)> {
        match self {
            Self::Let { name, .. } => Some((name.text.to_string(), name.place.clone())),
            _ => None,
        }
    }

    /// Returns the length of the statement's text, in bytes, without space between its parts.
    pub fn len(&self) -> usize {
        match self {
            Self::Entity(entity) => entity.place.as_ref().map_or(0, Range::len),
            Self::Repeat { body, .. } => body.iter().map(Statement::len).sum(),
            _ => 1,
        }
    }
}
