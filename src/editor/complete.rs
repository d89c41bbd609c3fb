//! Completion: what can be written at a position.

use super::hover::about;
use super::names::Sort;
use super::project::Group;
use super::snippet::Snippet;
use super::types::{Wanted, truths, wanted};
use super::view::{Attribute, Entity, Form, Item, View};
use crate::numeric::formula::functions;
use crate::scene::kind::Kind;
use crate::scene::reader::keyword::Keyword;
use crate::scene::registry::Registry;
use crate::scene::syntax::Syntax;
use std::ops::Range;
use std::path::Path;

/// The most files of a folder that are proposed.
const MOST_FILES: usize = 1000;

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

    fn in_notes(&self) -> Vec<Completion> {
        match self.view.at(self.at) {
            Some(Item::Entity(entity)) if self.is_in(&entity.body) => self.in_entity(entity),
            // After the type comes a name that nobody knows.
            Some(Item::Entity(entity)) if self.at > entity.kind.end && self.at < entity.body.start => {
                Vec::new()
            }
            Some(Item::Let(number)) if number.value.is_some_and(|word| word.has(self.at)) => {
                self.in_formula(&[])
            }
            Some(Item::Let(number)) if number.name.is_some_and(|word| word.has(self.at)) => Vec::new(),
            Some(Item::Repeat(repeat)) if repeat.count.is_some_and(|word| word.has(self.at)) => {
                self.in_formula(&[])
            }
            Some(Item::Repeat(repeat)) if repeat.name.is_some_and(|word| word.has(self.at)) => Vec::new(),
            Some(Item::Include(include)) if include.files.iter().any(|word| word.has(self.at)) => {
                self.files()
            }
            Some(Item::Include(include)) if self.at > include.place.end && include.files.is_empty() => {
                self.files()
            }
            Some(Item::Repeat(repeat)) if self.is_in(&repeat.body) => self.types(false),
            _ if self.follows(Keyword::Include) => self.files(),
            _ => self.types(true),
        }
    }

    fn is_in(&self, body: &Range<usize>) -> bool {
        body.start <= self.at && self.at <= body.end && body.start < self.view.text.as_str().len() + 1
    }

    /// Tells whether the word before the one at the position is a keyword, on the same line.
    fn follows(&self, keyword: Keyword) -> bool {
        let before = &self.view.text.as_str()[..self.prefix().start];
        let line = before.rsplit('\n').next().unwrap_or_default();
        line.split_whitespace().next_back().and_then(Keyword::of) == Some(keyword)
    }

    fn in_toml(&self) -> Vec<Completion> {
        let text = self.view.text.as_str();
        let line = text[..self.at].rfind('\n').map_or(0, |end| end + 1);
        let before = text[line..self.at].trim_start();
        if let Some(title) = before.strip_prefix('[') {
            let title = title.trim_start_matches('[');
            // `[repeat.i.` is followed by a type, too.
            let mut parts: Vec<_> = title.split('.').collect();
            while parts.len() > 2 && Keyword::of(parts[0]) == Some(Keyword::Repeat) {
                parts.drain(..2);
            }
            return if parts.len() == 1 && !title.contains(']') { self.types(false) } else { Vec::new() };
        }
        let attribute_at = |entity: &Entity| {
            let is_there = |attribute: &&Attribute| attribute.values_from.is_some_and(|from| from <= self.at);
            let last = entity.attributes.iter().rfind(is_there)?;
            let is_last_line = last.end >= line || !text[last.end.min(self.at)..self.at].contains('\n');
            (self.at <= last.end || is_last_line).then_some(())
        };
        match self.view.at(self.at) {
            Some(Item::Entity(entity)) if self.is_in(&entity.body) => {
                if attribute_at(entity).is_some() {
                    self.value(entity)
                } else {
                    self.attributes(entity)
                }
            }
            Some(Item::Include(_)) => self.files(),
            Some(Item::Let(_)) => self.in_formula(&[]),
            _ if before.contains('=') => Vec::new(),
            _ => self.types(true),
        }
    }

    /// Returns what can stand between the braces of an entity.
    fn in_entity(&self, entity: &Entity) -> Vec<Completion> {
        let last = entity.attributes.iter().rfind(|attribute| attribute.name.start < self.at);
        let Some(last) = last else { return self.attributes(entity) };
        if last.name.has(self.at) {
            return self.attributes(entity);
        }
        let Some(known) = last.known else { return self.attributes(entity) };
        let before = last.values.iter().filter(|word| word.end < self.at).count();
        let at_value = last.values.iter().find(|word| word.has(self.at));
        let is_full = before >= known.arity().most();
        match wanted(entity, known) {
            Wanted::Numbers | Wanted::Formula(_) => match at_value {
                Some(word) if word.form != Form::Bare => self.value(entity),
                _ if known.arity().allow(before) => self.attributes(entity),
                _ => Vec::new(),
            },
            _ if is_full => self.attributes(entity),
            _ => self.value(entity),
        }
    }

    /// Returns the attributes that are not given yet.
    fn attributes(&self, entity: &Entity) -> Vec<Completion> {
        let Some(known) = entity.known else { return Vec::new() };
        let place = self.prefix();
        let is_given = |name: &str| {
            let mut given = entity.attributes.iter().filter(|given| given.name.start != place.start);
            given.any(|given| given.known.is_some_and(|known| known.name() == name))
        };
        let names = |kind| self.names(kind);
        let excluded: Vec<&str> = known
            .groups()
            .filter(|group| group.names.iter().any(|name| is_given(name)))
            .flat_map(|group| group.names.iter().copied())
            .collect();
        let free = known
            .attributes()
            .filter(|attribute| !is_given(attribute.name()) && !excluded.contains(&attribute.name()));
        free.map(|attribute| {
            let mut snippet = Snippet::new(self.view, &names);
            snippet.attribute(entity, attribute, 0);
            Completion {
                detail: attribute.takes(),
                about: about(self.view.syntax, attribute),
                snippet: snippet.text,
                has_places: true,
                ..plain(attribute.name(), What::Attribute, &place)
            }
        })
        .collect()
    }

    /// Returns the values of the attribute before the position.
    fn value(&self, entity: &Entity) -> Vec<Completion> {
        let is_before = |attribute: &&Attribute| attribute.values_from.is_some_and(|from| from <= self.at);
        let Some(attribute) = entity.attributes.iter().rfind(is_before) else { return Vec::new() };
        let Some(known) = attribute.known else { return Vec::new() };
        let word = attribute.values.iter().find(|word| word.has(self.at));
        let is_quoted = word.is_some_and(|word| word.form != Form::Bare && word.inner().start <= self.at);
        let place =
            word.map_or_else(|| self.prefix(), |word| if is_quoted { word.inner() } else { word.place() });
        let place = if is_quoted || self.at_quote() {
            place.start.min(self.at)..place.end.max(self.at)
        } else {
            place
        };
        let is_quoted = is_quoted || self.at_quote();
        // A word is written in quotes if they are not there yet.
        let written = |name: &str| match self.view.syntax {
            _ if is_quoted => name.to_owned(),
            syntax => syntax.values(&crate::scene::value::Datum::Word(name.to_owned())).concat(),
        };
        match wanted(entity, known) {
            Wanted::Name(kind) => {
                let proposal = |name: String| Completion {
                    detail: kind.to_string(),
                    snippet: written(&name),
                    ..plain(&name, What::Name, &place)
                };
                self.names(kind).into_iter().rev().map(proposal).collect()
            }
            Wanted::Choice(choices) => {
                let all = choices.all().into_iter();
                all.map(|choice| Completion {
                    detail: choice.number.map(|number| number.to_string()).unwrap_or_default(),
                    about: choice.meaning.to_owned(),
                    snippet: written(choice.name),
                    ..plain(choice.name, What::Choice, &place)
                })
                .collect()
            }
            Wanted::Truth => {
                truths(self.view).iter().map(|truth| plain(truth, What::Choice, &place)).collect()
            }
            Wanted::File => self.files(),
            Wanted::Numbers if is_quoted => self.in_formula(&[]),
            Wanted::Formula(variables) if is_quoted => self.in_formula(variables),
            Wanted::Numbers | Wanted::Formula(_) | Wanted::Word => Vec::new(),
        }
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

    /// Returns what a formula can contain.
    fn in_formula(&self, variables: &[&str]) -> Vec<Completion> {
        let before = &self.view.text.as_str()[..self.at];
        let start = before.rfind(|c: char| !c.is_alphanumeric() && c != '_');
        let start = start.map_or(0, |end| end + before[end..].chars().next().map_or(1, char::len_utf8));
        let place = start..self.at;
        let mut all: Vec<_> =
            variables.iter().chain(&["pi"]).map(|name| plain(name, What::Number, &place)).collect();
        for (index, (_, view)) in self.group.iter().enumerate() {
            let names = view.names();
            let usable = names.definitions.iter().filter(|definition| {
                let is_visible =
                    definition.scope.as_ref().is_none_or(|scope| index == 0 && scope.contains(&self.at));
                definition.name.sort == Sort::Number && is_visible
            });
            all.extend(usable.map(|definition| Completion {
                detail: view.slice(definition.whole.clone()).trim().to_owned(),
                ..plain(&definition.name.text, What::Number, &place)
            }));
        }
        all.extend(functions().map(|(name, count)| Completion {
            snippet: if count == 1 {
                format!("{name}(${{1:x}})")
            } else {
                format!("{name}(${{1:x}}, ${{2:y}})")
            },
            has_places: true,
            ..plain(name, What::Function, &place)
        }));
        all
    }

    /// Returns the types of entities, and the words that begin something else.
    fn types(&self, is_outside: bool) -> Vec<Completion> {
        let place = self.prefix();
        let names = |kind| self.names(kind);
        let before = self.view.text.as_str()[..place.start].trim_end_matches(|c: char| c != '\n' && c != '[');
        let has_bracket = self.view.syntax == Syntax::Toml && before.ends_with('[');
        let mut all: Vec<_> = self
            .registry
            .iter()
            .map(|known| {
                let mut snippet = Snippet::new(self.view, &names);
                snippet.entity(known, has_bracket);
                // Editors often close a bracket by themselves.
                let is_closed = has_bracket && self.view.text.as_str()[self.at..].starts_with(']');
                let text = if is_closed { known.name.to_owned() } else { snippet.text };
                Completion {
                    detail: known.kind().to_string(),
                    about: known.meaning.to_owned(),
                    snippet: text,
                    has_places: !is_closed,
                    ..plain(known.name, What::Type, &place)
                }
            })
            .collect();
        let keywords = match self.view.syntax {
            Syntax::Notes => [
                ("let", "let ${1:name} ${2:value}"),
                ("repeat", "repeat ${1:i} ${2:count} {\n    $0\n}"),
                ("include", "include ${1:FILE}"),
            ],
            Syntax::Toml if has_bracket => {
                [("let", "let]\n${1:name} = ${2:0}"), ("repeat", "repeat.${1:i}]\ncount = ${2:2}"), ("", "")]
            }
            Syntax::Toml => [
                ("let", "[let]\n${1:name} = ${2:0}"),
                ("repeat", "[repeat.${1:i}]\ncount = ${2:2}"),
                ("include", "include = \"${1:FILE}\""),
            ],
        };
        let keywords = keywords.iter().filter(|(word, _)| {
            !word.is_empty() && (is_outside || Keyword::of(word) != Some(Keyword::Include))
        });
        all.extend(keywords.map(|(word, snippet)| {
            Completion {
                snippet: (*snippet).to_owned(),
                has_places: true,
                about: Keyword::of(word)
                    .map_or("", |keyword| match self.view.syntax {
                        Syntax::Notes => keyword.usage(),
                        Syntax::Toml => keyword.usage_in_toml(),
                    })
                    .to_owned(),
                ..plain(word, What::Keyword, &place)
            }
        }));
        all
    }

    /// Returns the files and folders in the folder that is being named.
    fn files(&self) -> Vec<Completion> {
        let text = self.view.text.as_str();
        let start = text[..self.at].rfind(|c: char| c.is_whitespace() || c == '"' || c == '\'' || c == '{');
        let after = |end: usize| end + text[end..].chars().next().map_or(1, char::len_utf8);
        let typed = &text[start.map_or(0, after)..self.at];
        let (folder, prefix) =
            typed.rsplit_once('/').map_or(("", typed), |(folder, prefix)| (folder, prefix));
        let place = self.at - prefix.len()..self.at;
        let folder =
            if typed.starts_with('/') { Path::new("/").join(folder) } else { self.folder.join(folder) };
        let entries = folder.read_dir().ok().into_iter().flatten().filter_map(Result::ok).take(MOST_FILES);
        let mut names: Vec<_> = entries
            .filter_map(|entry| Some((entry.file_name().into_string().ok()?, entry.path().is_dir())))
            .filter(|(name, _)| !name.starts_with('.'))
            .collect();
        names.sort_unstable();
        let proposal = |(name, is_folder): (String, bool)| {
            let label = if is_folder { format!("{name}/") } else { name };
            plain(&label, if is_folder { What::Folder } else { What::File }, &place)
        };
        names.into_iter().map(proposal).collect()
    }
}
