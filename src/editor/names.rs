//! The names that a scene gives, and where it uses them.

use super::formulas;
pub use super::named::{Definition, Name, Names, Sort, Stands};
use super::types::{Wanted, wanted};
use super::view::{Attribute, Entity, Form, Item, Repeat, View, Word};
use crate::scene::syntax::Syntax;
use crate::scene::value::Datum;
use std::ops::Range;

impl Names {
    /// Finds the names of a text.
    pub fn of(view: &View) -> Self {
        let mut names = Self::default();
        view.visit(&mut |item, outer| names.add(view, item, outer));
        for (index, definition) in names.definitions.iter().enumerate() {
            let name = (definition.name.sort, definition.name.text.clone());
            names.by_name.entry(name).or_default().push(index);
        }
        names
    }

    fn add(&mut self, view: &View, item: &Item, outer: &[&Repeat]) {
        let name = |sort, word: Word| Name {
            sort,
            text: view.word(word).into_owned(),
            place: word.inner(),
            stands: Stands::Key(word),
        };
        let scope = outer.last().map(|repeat| repeat.body.clone());
        let mut define = |sort, word: Word, again: &[Word], whole: Range<usize>, scope, depth| {
            let again = again.iter().map(|word| name(sort, *word)).collect();
            self.definitions.push(Definition { name: name(sort, word), again, whole, scope, depth });
        };
        match item {
            Item::Entity(entity) => {
                if let Some((known, word)) = entity.known.zip(entity.name) {
                    let sort = Sort::Entity(known.kind());
                    define(sort, word, &entity.again, entity.place.clone(), scope, outer.len());
                }
                entity.attributes.iter().for_each(|attribute| self.values(view, entity, attribute));
            }
            Item::Let(number) => {
                if let Some(word) = number.name {
                    define(Sort::Number, word, &[], number.place.clone(), scope, outer.len());
                }
                self.formula(view, number.value);
            }
            Item::Repeat(repeat) => {
                if let Some(word) = repeat.name {
                    let title = repeat.place.start..repeat.body.start;
                    define(
                        Sort::Number,
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
        match wanted(entity, known) {
            Wanted::Name(kind) => {
                let name = |word: &Word| Name {
                    sort: Sort::Entity(kind),
                    text: view.word(*word).into_owned(),
                    place: word.inner(),
                    stands: Stands::Value(*word),
                };
                self.uses.extend(attribute.values.iter().map(name));
            }
            Wanted::Numbers | Wanted::Formula(_) => {
                attribute.values.iter().for_each(|word| self.formula(view, Some(*word)));
            }
            Wanted::File | Wanted::Choice(_) | Wanted::Truth | Wanted::Word => {}
        }
    }

    fn formula(&mut self, view: &View, word: Option<Word>) {
        let Some(word) = word.filter(|word| word.form != Form::Bare) else { return };
        let formula = view.slice(word.inner());
        self.uses.extend(formulas::names(formula).into_iter().map(|at| Name {
            sort: Sort::Number,
            text: formula[at.clone()].to_owned(),
            place: word.inner().start + at.start..word.inner().start + at.end,
            stands: Stands::InFormula,
        }));
    }
}

impl View {
    /// Returns the names of the text, which are found once.
    pub fn names(&self) -> &Names {
        self.names.get_or_init(|| Names::of(self))
    }
}

/// A name that the cursor is at.
#[derive(Clone, Debug)]
pub struct Meant {
    /// The noun for the named thing: `material`, `number`.
    pub what: String,
    /// The name.
    pub text: String,
    /// Its range, without quotes.
    pub place: Range<usize>,
}

/// Returns the name at a position.
pub fn meant(view: &View, at: usize) -> Option<Meant> {
    let names = view.names();
    let (name, _) = names.at(at)?;
    Some(Meant { what: told(name.sort), text: name.text.clone(), place: name.place.clone() })
}

/// Returns the word for what is named.
pub fn told(sort: Sort) -> String {
    match sort {
        Sort::Entity(kind) => kind.to_string(),
        Sort::Number => "number".to_owned(),
    }
}

/// Says why something cannot have a name.
///
/// # Errors
/// The reason.
pub fn check_name(sort: Sort, name: &str) -> Result<(), String> {
    match sort {
        Sort::Number if !formulas::is_name(name) => Err(format!(
            "`{name}` cannot be the name of a number: it begins with a letter, has only letters, digits and `_`, and is \
             not a word of formulas"
        )),
        Sort::Entity(_) if name.is_empty() || name.contains(char::is_control) => {
            Err("a name is at least one character, and none of them is a control character".to_owned())
        }
        _ => Ok(()),
    }
}

/// Returns a name with the numbers of rounds that a use adds to that of its definition.
pub fn written(syntax: Syntax, stands: Stands, name: &str) -> String {
    match stands {
        Stands::InFormula => name.to_owned(),
        Stands::Key(_) => syntax.key(name),
        Stands::Value(_) => syntax.values(&Datum::Word(name.to_owned())).concat(),
    }
}
