//! The names of a text, for lookup.

use super::word::Word;
use std::collections::HashMap;
use std::ops::Range;
use tabray_core::scene::kind::Kind;

/// The namespaces. Equal names in different namespaces do not clash.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Namespace {
    /// The names of the entities of a kind.
    Entity(Kind),
    /// The names of the numbers of `let` and `repeat`.
    Number,
}

/// The contexts in which a name occurs in a text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NameContext {
    /// A word that is a key, or a word of the notes' syntax.
    Key(Word),
    /// A value.
    Value(Word),
    /// A word of a formula.
    Formula,
}

/// A name in a text.
#[derive(Clone, Debug)]
pub struct Name {
    pub namespace: Namespace,
    pub text: String,
    /// The range of the name, without quotes.
    pub place: Range<usize>,
    pub context: NameContext,
}

/// The definition of a name.
#[derive(Clone, Debug)]
pub struct Definition {
    pub name: Name,
    /// The other places where the definition repeats the name.
    pub again: Vec<Name>,
    /// The range of the named item.
    pub whole: Range<usize>,
    /// For a repeated definition, the range in which the name can be used as written. Without a range, the name can be
    /// used everywhere.
    pub scope: Option<Range<usize>>,
    /// The number of enclosing `repeat`s.
    pub depth: usize,
}

/// The names of a text.
#[derive(Debug, Default)]
pub struct Names {
    pub definitions: Vec<Definition>,
    pub uses: Vec<Name>,
    pub(super) by_name: HashMap<(Namespace, String), Vec<usize>>,
}

impl Names {
    /// Returns the indices of the definitions with exactly this name.
    pub fn named(&self, namespace: Namespace, text: &str) -> &[usize] {
        self.by_name.get(&(namespace, text.to_owned())).map_or(&[], Vec::as_slice)
    }

    /// Returns the name at a position, and the index of its definition if it is defined there.
    pub fn at(&self, at: usize) -> Option<(&Name, Option<usize>)> {
        let has = |name: &Name| name.place.start <= at && at <= name.place.end;
        let given = self.definitions.iter().enumerate().find_map(|(index, definition)| {
            let mut all = std::iter::once(&definition.name).chain(&definition.again);
            all.find(|name| has(name)).map(|name| (name, Some(index)))
        });
        given.or_else(|| self.uses.iter().find(|name| has(name)).map(|name| (name, None)))
    }
}
