//! Completion: what can be written at a position.

mod files;
mod notes;
mod toml;
mod types;
mod values;

use super::names::Sort;
use super::project::Group;
use super::view::View;
use crate::scene::kind::Kind;
use crate::scene::registry::Registry;
use crate::scene::syntax::Syntax;
use std::ops::Range;
use std::path::Path;

/// What a proposal is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum What {
    Type,
    Attribute,
    Choice,
    Name,
    File,
    Folder,
    Number,
    Function,
    Keyword,
}

/// A proposal of what to write.
#[derive(Clone, Debug)]
pub struct Completion {
    /// What is shown, and compared with what was typed.
    pub label: String,
    pub what: What,
    /// A few words beside the label.
    pub detail: String,
    /// More about it, in Markdown.
    pub about: String,
    /// What is written: places to fill in are as in `${1:N}`.
    pub snippet: String,
    /// Whether there are such places.
    pub has_places: bool,
    /// The range of the text that it replaces.
    pub place: Range<usize>,
}

struct At<'v> {
    registry: &'v Registry,
    view: &'v View,
    group: &'v Group,
    folder: &'v Path,
    at: usize,
}

/// Returns what can be written at a position of the group's first file.
pub fn completions(registry: &Registry, group: &Group, at: usize) -> Vec<Completion> {
    let Some((path, view)) = group.first() else { return Vec::new() };
    let at = crate::text::boundary(view.text.as_str(), at);
    let here = At { registry, view, group, folder: path.parent().unwrap_or(path), at };
    if in_comment(view, at) {
        return Vec::new();
    }
    match view.syntax {
        Syntax::Notes => here.in_notes(),
        Syntax::Toml => here.in_toml(),
    }
}

/// Tells whether a position is in a comment: after a `#` that begins a word and is in no quotes.
fn in_comment(view: &View, at: usize) -> bool {
    let text = view.text.as_str();
    let line = text[..at].rfind('\n').map_or(0, |end| end + 1);
    let mut is_quoted = false;
    let mut before = ' ';
    for letter in text[line..at].chars() {
        match letter {
            '"' if before != '\\' => is_quoted = !is_quoted,
            '#' if !is_quoted
                && (view.syntax == Syntax::Toml || before.is_whitespace() || "{}".contains(before)) =>
            {
                return true;
            }
            _ => {}
        }
        before = letter;
    }
    false
}

fn plain(label: &str, what: What, place: &Range<usize>) -> Completion {
    Completion {
        label: label.to_owned(),
        what,
        detail: String::new(),
        about: String::new(),
        snippet: label.to_owned(),
        has_places: false,
        place: place.clone(),
    }
}

impl At<'_> {
    /// Returns the range of the word that is being written.
    fn prefix(&self) -> Range<usize> {
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

    fn is_in(&self, body: &Range<usize>) -> bool {
        body.start <= self.at && self.at <= body.end && body.start < self.view.text.as_str().len() + 1
    }

    /// Tells whether a quote opens right before the word at the position.
    fn at_quote(&self) -> bool {
        self.view.text.as_str()[..self.prefix().start].ends_with(['"', '\''])
    }

    /// Returns the names of the entities of a kind that are defined before the position, and those of other files.
    fn names(&self, kind: Kind) -> Vec<String> {
        let mut names = Vec::new();
        for (index, (_, view)) in self.group.iter().enumerate().rev() {
            let all = view.names();
            let usable = all.definitions.iter().filter(|definition| {
                let is_visible =
                    definition.scope.as_ref().is_none_or(|scope| index == 0 && scope.contains(&self.at));
                let is_before = index > 0 || definition.whole.end <= self.at;
                definition.name.sort == Sort::Entity(kind) && is_before && is_visible
            });
            names.extend(usable.map(|definition| definition.name.text.clone()));
        }
        names
    }
}
