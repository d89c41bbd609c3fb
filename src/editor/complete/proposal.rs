//! Completion proposals, and the position that they are for.

use crate::names::Namespace;
use crate::project::Group;
use crate::view::View;
use std::ops::Range;
use std::path::Path;
use tabray_core::scene::kind::Kind;
use tabray_lang::registry::Registry;
use tabray_lang::syntax::Syntax;

/// The kind of a completion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CompletionKind {
    /// The name of an entity type.
    Type,
    /// The name of an attribute.
    Attribute,
    /// One of the alternatives of an attribute.
    Choice,
    /// The name of an entity or of a number.
    Name,
    /// The name of a file.
    File,
    /// The name of a folder.
    Folder,
    /// A number.
    Number,
    /// A function in a formula.
    Function,
    /// A word of the language, such as `repeat`.
    Keyword,
}

/// A completion proposal.
#[derive(Clone, Debug)]
pub struct Completion {
    /// The text that is shown, and compared with the typed text.
    pub label: String,
    /// The kind of the proposal.
    pub kind: CompletionKind,
    /// A short description beside the label.
    pub detail: String,
    /// A longer description, in Markdown.
    pub about: String,
    /// The inserted text. It has placeholders such as `${1:N}`.
    pub snippet: String,
    /// Whether the inserted text has placeholders.
    pub has_places: bool,
    /// The range of the replaced text.
    pub place: Range<usize>,
}

/// A position to complete, and its context.
pub(super) struct CompletionContext<'v> {
    pub(super) registry: &'v Registry,
    pub(super) view: &'v View,
    pub(super) group: &'v Group,
    pub(super) folder: &'v Path,
    pub(super) at: usize,
}

/// Returns a proposal that inserts its label.
pub(super) fn plain(label: &str, kind: CompletionKind, place: &Range<usize>) -> Completion {
    Completion {
        label: label.to_owned(),
        kind,
        detail: String::new(),
        about: String::new(),
        snippet: label.to_owned(),
        has_places: false,
        place: place.clone(),
    }
}

impl CompletionContext<'_> {
    /// Returns the range of the word before the position.
    pub(super) fn prefix(&self) -> Range<usize> {
        let is_end = |c: char| {
            let in_toml = self.view.syntax == Syntax::Toml && ".[]=,\"'".contains(c);
            c.is_whitespace() || c == '{' || c == '}' || in_toml
        };
        let before = &self.view.text.as_str()[..self.at];
        let start = before
            .rfind(is_end)
            .map_or(0, |end| end + before[end..].chars().next().map_or(1, char::len_utf8));
        start..self.at
    }

    pub(super) fn is_in(&self, body: &Range<usize>) -> bool {
        body.start <= self.at && self.at <= body.end && body.start < self.view.text.as_str().len() + 1
    }

    /// Tells whether a quote opens right before the word at the position.
    pub(super) fn at_quote(&self) -> bool {
        self.view.text.as_str()[..self.prefix().start].ends_with(['"', '\''])
    }

    /// Returns the names of the entities of a kind that are defined before the position, and those of other files.
    pub(super) fn names(&self, kind: Kind) -> Vec<String> {
        let mut names = Vec::new();
        for (index, (_, view)) in self.group.iter().enumerate().rev() {
            let all = view.names();
            let usable = all.definitions.iter().filter(|definition| {
                let is_visible =
                    definition.scope.as_ref().is_none_or(|scope| index == 0 && scope.contains(&self.at));
                let is_before = index > 0 || definition.whole.end <= self.at;
                definition.name.namespace == Namespace::Entity(kind) && is_before && is_visible
            });
            names.extend(usable.map(|definition| definition.name.text.clone()));
        }
        names
    }
}
