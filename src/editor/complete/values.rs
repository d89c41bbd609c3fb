//! Completions of an entity's missing attributes, and of the values of an attribute.

use super::proposal::{Completion, CompletionContext, CompletionKind, plain};
use crate::hover::about;
use crate::names::Namespace;
use crate::snippet::Snippet;
use crate::types::{ExpectedValue, expected_value, truths};
use crate::view::{Attribute, Entity, Form};
use tabray_exact::formula::functions;

impl CompletionContext<'_> {
    /// Returns the attributes that are not given yet.
    pub(super) fn attributes(&self, entity: &Entity) -> Vec<Completion> {
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
                ..plain(attribute.name(), CompletionKind::Attribute, &place)
            }
        })
        .collect()
    }

    /// Returns the values of the attribute before the position.
    pub(super) fn value(&self, entity: &Entity) -> Vec<Completion> {
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
        // A word gets quotes if it has none yet.
        let written = |name: &str| match self.view.syntax {
            _ if is_quoted => name.to_owned(),
            syntax => syntax.values(&tabray_core::scene::value::Datum::Word(name.to_owned())).concat(),
        };
        match expected_value(entity, known) {
            ExpectedValue::Name(kind) => {
                let proposal = |name: String| Completion {
                    detail: kind.to_string(),
                    snippet: written(&name),
                    ..plain(&name, CompletionKind::Name, &place)
                };
                self.names(kind).into_iter().rev().map(proposal).collect()
            }
            ExpectedValue::Choice(choices) => {
                let all = choices.all().into_iter();
                all.map(|choice| Completion {
                    detail: choice.number.map(|number| number.to_string()).unwrap_or_default(),
                    about: choice.meaning.to_owned(),
                    snippet: written(choice.name),
                    ..plain(choice.name, CompletionKind::Choice, &place)
                })
                .collect()
            }
            ExpectedValue::Truth => {
                truths(self.view).iter().map(|truth| plain(truth, CompletionKind::Choice, &place)).collect()
            }
            ExpectedValue::File => self.files(),
            ExpectedValue::Numbers if is_quoted => self.in_formula(&[]),
            ExpectedValue::Formula(variables) if is_quoted => self.in_formula(variables),
            ExpectedValue::Numbers | ExpectedValue::Formula(_) | ExpectedValue::Word => Vec::new(),
        }
    }

    /// Returns the words that are allowed in a formula.
    pub(super) fn in_formula(&self, variables: &[&str]) -> Vec<Completion> {
        let before = &self.view.text.as_str()[..self.at];
        let start = before.rfind(|c: char| !c.is_alphanumeric() && c != '_');
        let start = start.map_or(0, |end| end + before[end..].chars().next().map_or(1, char::len_utf8));
        let place = start..self.at;
        let mut all: Vec<_> =
            variables.iter().chain(&["pi"]).map(|name| plain(name, CompletionKind::Number, &place)).collect();
        for (index, (_, view)) in self.group.iter().enumerate() {
            let names = view.names();
            let usable = names.definitions.iter().filter(|definition| {
                let is_visible =
                    definition.scope.as_ref().is_none_or(|scope| index == 0 && scope.contains(&self.at));
                definition.name.namespace == Namespace::Number && is_visible
            });
            all.extend(usable.map(|definition| Completion {
                detail: view.slice(definition.whole.clone()).trim().to_owned(),
                ..plain(&definition.name.text, CompletionKind::Number, &place)
            }));
        }
        all.extend(functions().map(|(name, arguments)| Completion {
            snippet: {
                let places =
                    arguments.iter().zip(1..).map(|(argument, place)| format!("${{{place}:{argument}}}"));
                format!("{name}({})", places.collect::<Vec<_>>().join(", "))
            },
            has_places: true,
            ..plain(name, CompletionKind::Function, &place)
        }));
        all
    }
}
