//! Values set beside the text of a scene: `--set ball.radius=3`.

use super::fault::Fault;
use super::guesses::find_attribute;
use super::numbers::Numbers;
use super::parsed::{Form, Parsed, Word};
use super::report::Report;
use super::tokens::Tokens;
use crate::registry::Registry;
use std::collections::BTreeSet;
use std::ops::Range;
use tabray_core::text::nearest;

/// The name of the options in messages.
pub const OPTION: &str = "--set";

/// The maximum number of names that are kept for suggestions.
const MAX_NAMES: usize = 10_000;

/// The set values.
#[derive(Default)]
pub struct Sets<'a> {
    all: Vec<Set<'a>>,
    /// The names of the scene's entities.
    names: BTreeSet<String>,
    /// The names of the scene's numbers.
    numbers: BTreeSet<String>,
}

/// The values set for an attribute or a number.
struct Set<'a> {
    /// The name of the entity or of the number.
    name: Word<'a>,
    /// The attribute, or `None` for a number.
    attribute: Option<Word<'a>>,
    values: Vec<Word<'a>>,
    /// Whether the scene has this attribute or number.
    is_met: bool,
}

impl<'a> Sets<'a> {
    /// Reads the options in a range of a text, each on its own line.
    pub fn of(text: &'a str, range: Range<usize>, report: &mut Report<'_>) -> Self {
        let (mut sets, mut start) = (Self::default(), range.start);
        for line in text[range].split('\n') {
            sets.all.extend(Set::read(&text[..start + line.len()], start, report));
            start += line.len() + 1;
        }
        sets
    }

    /// Tells whether no value is set.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// Returns the word set for a number, if any.
    pub fn number(&mut self, name: &str) -> Option<Word<'a>> {
        if self.all.is_empty() {
            return None;
        }
        self.numbers.insert(name.to_owned());
        let mut found = None;
        for set in self.all.iter_mut().filter(|set| set.attribute.is_none() && set.name.text == name) {
            set.is_met = true;
            found = set.values.first().cloned();
        }
        found
    }

    /// Applies the values set for an entity, with formulas replaced by numbers.
    pub fn apply(
        &mut self,
        entity: &mut Parsed<'a>,
        registry: &Registry,
        numbers: &mut Numbers<'a>,
        report: &mut Report<'_>,
    ) {
        if self.names.len() < MAX_NAMES {
            self.names.insert(entity.name.text.to_string());
        }
        for set in self.all.iter_mut().filter(|set| set.is_of(entity)) {
            set.is_met = true;
        }
        self.put(entity, registry, Some((numbers, report)));
    }

    /// Applies the words set for an entity. If named numbers are given, formulas are replaced by numbers.
    pub fn put(
        &self,
        entity: &mut Parsed<'a>,
        registry: &Registry,
        mut numbers: Option<(&mut Numbers<'a>, &mut Report<'_>)>,
    ) {
        let sets = self.all.iter().filter(|set| set.is_of(entity)).collect::<Vec<_>>();
        for set in sets {
            let Some(attribute) = &set.attribute else { continue };
            let table = registry.find(&entity.kind.text);
            let known = table.and_then(|table| find_attribute(table, &attribute.text));
            let value_type = known.map(|known| known.value_type());
            let mut values = set.values.clone();
            if let Some((numbers, report)) = &mut numbers {
                values = values.into_iter().map(|word| numbers.word(word, value_type, report)).collect();
            }
            let is_same = |name: &str| match (table, known) {
                (Some(table), Some(known)) => {
                    find_attribute(table, name).is_some_and(|other| other.name() == known.name())
                }
                _ => name == attribute.text,
            };
            entity.replace(attribute.clone(), values, is_same);
        }
    }

    /// Reports values set for names that are not in the scene.
    pub fn report_unmatched(&self, report: &mut Report<'_>) {
        for set in self.all.iter().filter(|set| !set.is_met) {
            let (what, known) = match set.attribute {
                Some(_) => ("the scene has no entity", &self.names),
                None => ("the scene has no number", &self.numbers),
            };
            let fault = Fault::error(set.name.place.clone(), format!("{what} `{}`", set.name.text));
            let fault = match nearest(&set.name.text, known.iter().map(String::as_str)) {
                Some(near) => fault.label(format!("did you mean `{near}`?")),
                None => fault,
            };
            report.add(fault.help(HELP));
        }
    }
}

const HELP: &str = "`--set ENTITY.ATTRIBUTE=VALUES` sets the values of an attribute, and `--set NUMBER=VALUE` that of a `let`";

impl<'a> Set<'a> {
    /// Tells whether an attribute of this entity is set, by its name alone or by its type and name.
    fn is_of(&self, entity: &Parsed<'_>) -> bool {
        let (kind, name) = (&*entity.kind.text, &*entity.name.text);
        let rest = || self.name.text.strip_prefix(kind).and_then(|rest| rest.strip_prefix('.'));
        self.attribute.is_some() && (self.name.text == name || rest() == Some(name))
    }

    /// Reads the option at the end of a text.
    fn read(text: &'a str, start: usize, report: &mut Report<'_>) -> Option<Self> {
        let option = &text[start..];
        let Some((target, _)) = option.split_once('=') else {
            report.add(Fault::error(Some(start..text.len()), format!("`{option}` sets no value")).help(HELP));
            return None;
        };
        let begin = start + target.len() - target.trim_start().len();
        let word = |range: Range<usize>| Word::at(&text[range.clone()], Form::Any, range);
        let end = begin + target.trim().len();
        let dot = text[begin..end].rfind('.').map(|at| begin + at);
        let (name, attribute) = match dot {
            Some(dot) => (word(begin..dot), Some(word(dot + 1..end))),
            None => (word(begin..end), None),
        };
        if name.text.is_empty() || attribute.as_ref().is_some_and(|attribute| attribute.text.is_empty()) {
            report
                .add(Fault::error(Some(start..start + target.len() + 1), "nothing is named here").help(HELP));
            return None;
        }
        let mut values = Vec::new();
        let mut tokens = Tokens::from(text, start + target.len() + 1, report);
        while let Some(token) = tokens.step(report) {
            if token.is_brace() {
                let message = format!("stray `{}`", tokens.raw(token));
                report.add(Fault::error(Some(token.place()), message).label("a value cannot contain braces"));
                return None;
            }
            values.push(tokens.word(token));
        }
        if attribute.is_none() && values.len() != 1 {
            let message = format!("the number `{}` takes 1 value, not {}", name.text, values.len());
            report.add(Fault::error(Some(begin..text.len()), message).help(HELP));
            return None;
        }
        Some(Self { name, attribute, values, is_met: false })
    }
}
