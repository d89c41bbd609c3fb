//! The names that a scene defines, and their uses.

use super::formulas;
pub use super::named::{Definition, Name, NameContext, Names, Namespace};
use super::types::{ExpectedValue, expected_value};
use super::view::{Attribute, Entity, Form, Item, Repeat, View, Word};
use std::ops::Range;
use tabray_core::scene::value::Datum;
use tabray_lang::syntax::Syntax;

impl Names {
    /// Finds the names of a text.
    pub fn of(view: &View) -> Self {
        let mut names = Self::default();
        view.visit(&mut |item, outer| names.add(view, item, outer));
        for (index, definition) in names.definitions.iter().enumerate() {
            let name = (definition.name.namespace, definition.name.text.clone());
            names.by_name.entry(name).or_default().push(index);
        }
        names
    }

    fn add(&mut self, view: &View, item: &Item, outer: &[&Repeat]) {
        let name = |namespace, word: Word| {
            let (mut text, mut place) = (view.word(word).into_owned(), word.inner());
            // The name of a function ends before its arguments.
            if let (Namespace::Number, Some(end)) = (namespace, text.find('(')) {
                text.truncate(end);
                place.end = place.start + end;
            }
            Name { namespace, text, place, context: NameContext::Key(word) }
        };
        let scope = outer.last().map(|repeat| repeat.body.clone());
        let mut define = |namespace, word: Word, again: &[Word], whole: Range<usize>, scope, depth| {
            let again = again.iter().map(|word| name(namespace, *word)).collect();
            self.definitions.push(Definition { name: name(namespace, word), again, whole, scope, depth });
        };
        match item {
            Item::Entity(entity) => {
                if let Some((known, word)) = entity.known.zip(entity.name) {
                    let namespace = Namespace::Entity(known.kind());
                    define(namespace, word, &entity.again, entity.place.clone(), scope, outer.len());
                }
                entity.attributes.iter().for_each(|attribute| self.values(view, entity, attribute));
            }
            Item::Let(number) => {
                if let Some(word) = number.name {
                    define(Namespace::Number, word, &[], number.place.clone(), scope, outer.len());
                }
                self.formula(view, number.value);
            }
            Item::Repeat(repeat) => {
                if let Some(word) = repeat.name {
                    let title = repeat.place.start..repeat.body.start;
                    define(
                        Namespace::Number,
                        word,
                        &repeat.again,
                        title,
                        Some(repeat.body.clone()),
                        outer.len() + 1,
                    );
                }
                self.formula(view, repeat.count);
            }
            Item::Include(_) => {}
        }
    }

    fn values(&mut self, view: &View, entity: &Entity, attribute: &Attribute) {
        let Some(known) = attribute.known else { return };
        match expected_value(entity, known) {
            ExpectedValue::Name(kind) => {
                let name = |word: &Word| Name {
                    namespace: Namespace::Entity(kind),
                    text: view.word(*word).into_owned(),
                    place: word.inner(),
                    context: NameContext::Value(*word),
                };
                self.uses.extend(attribute.values.iter().map(name));
            }
            ExpectedValue::Numbers | ExpectedValue::Formula(_) => {
                attribute.values.iter().for_each(|word| self.formula(view, Some(*word)));
            }
            ExpectedValue::File | ExpectedValue::Choice(_) | ExpectedValue::Truth | ExpectedValue::Word => {}
        }
    }

    fn formula(&mut self, view: &View, word: Option<Word>) {
        let Some(word) = word.filter(|word| word.form != Form::Bare) else { return };
        let formula = view.slice(word.inner());
        self.uses.extend(formulas::names(formula).into_iter().map(|at| Name {
            namespace: Namespace::Number,
            text: formula[at.clone()].to_owned(),
            place: word.inner().start + at.start..word.inner().start + at.end,
            context: NameContext::Formula,
        }));
    }
}

impl View {
    /// Returns the names of the text, found on first use.
    pub fn names(&self) -> &Names {
        self.names.get_or_init(|| Names::of(self))
    }
}

/// The name at the cursor.
#[derive(Clone, Debug)]
pub struct NameAtCursor {
    /// The noun for the named item: `material`, `number`.
    pub kind: String,
    /// The name.
    pub text: String,
    /// The range of the name, without quotes.
    pub place: Range<usize>,
}

/// Returns the name at a position.
pub fn name_at_cursor(view: &View, at: usize) -> Option<NameAtCursor> {
    let names = view.names();
    let (name, _) = names.at(at)?;
    Some(NameAtCursor { kind: describe(name.namespace), text: name.text.clone(), place: name.place.clone() })
}

/// Returns the unknown names in the formula at a range of a text: neither words of formulas nor numbers of the text.
/// Names of functions are omitted.
pub fn unknown_numbers(view: &View, formula: &Range<usize>) -> Vec<String> {
    let (names, text) = (view.names(), view.slice(formula.clone()));
    let mut unknown: Vec<String> = Vec::new();
    for place in formulas::names(text) {
        let is_called = text[place.end..].trim_start().starts_with('(');
        let name = &text[place];
        let is_known = !names.named(Namespace::Number, name).is_empty();
        if !is_known && !is_called && !unknown.iter().any(|other| other == name) {
            unknown.push(name.to_owned());
        }
    }
    unknown
}

/// Returns the noun for items of a namespace.
pub fn describe(namespace: Namespace) -> String {
    match namespace {
        Namespace::Entity(kind) => kind.to_string(),
        Namespace::Number => "number".to_owned(),
    }
}

/// Checks whether an item can have a name.
///
/// # Errors
/// Returns the reason why it cannot.
pub fn check_name(namespace: Namespace, name: &str) -> Result<(), String> {
    match namespace {
        Namespace::Number if !formulas::is_name(name) => Err(format!(
            "`{name}` cannot be the name of a number: it begins with a letter, has only letters, digits and `_`, and is \
             not a word of formulas"
        )),
        Namespace::Entity(_) if name.is_empty() || name.contains(char::is_control) => {
            Err("a name is at least one character, and none of them is a control character".to_owned())
        }
        _ => Ok(()),
    }
}

/// Returns a name as written in a context, with quotes if needed.
pub fn written(syntax: Syntax, context: NameContext, name: &str) -> String {
    match context {
        NameContext::Formula => name.to_owned(),
        NameContext::Key(_) => syntax.key(name),
        NameContext::Value(_) => syntax.values(&Datum::Word(name.to_owned())).concat(),
    }
}
