//! The numbers that a scene's text names by `let`, as a page offers them to be changed.

use super::Shown;
use super::fields::{Field, Fields, Named};
use tabray_editor::{Item, View, Word};
use tabray_lang::registry::Registry;

/// The word for numbers in a page's list of entities.
pub const ORDER: &str = "numbers";

/// The word in place of an entity's name where a number is tried out: no entity has this name.
pub const NAME: &str = "";

/// Returns the names of a text's numbers, in its order, and the words of their values. It leaves out formulas, and
/// the names of a `repeat` or of another file.
fn all(view: &View) -> impl Iterator<Item = (Word, Word)> {
    view.items.iter().filter_map(|item| match item {
        Item::Let(number) => {
            let (name, value) = number.name.zip(number.value)?;
            view.word(value).parse::<f64>().is_ok().then_some((name, value))
        }
        _ => None,
    })
}

/// Returns the word of a number's value.
pub fn value(view: &View, name: &str) -> Option<Word> {
    all(view).find(|(word, _)| view.word(*word) == name).map(|(_, value)| value)
}

/// Returns the numbers in the form of an entity; `None` where the text has none.
pub fn of(registry: &Registry, shown: Shown) -> Option<Fields> {
    let view = shown.view(registry);
    let field = |(name, value): (Word, Word)| {
        let name = view.word(name).into_owned();
        let value = set(shown.sets, &name).unwrap_or_else(|| view.word(value).into_owned());
        Field {
            name: name.into(),
            material: None,
            about: "a number of the scene".to_owned(),
            each: &[],
            values: vec![value],
            signs: "any",
            range: None,
            whole: false,
            fixed: None,
        }
    };
    let attributes: Vec<_> = all(&view).map(field).collect();
    let entity = Named { order: ORDER.to_owned(), kind: "let", name: NAME.to_owned() };
    (!attributes.is_empty()).then_some(Fields { entity, attributes })
}

/// Returns the value that is set for a number in addition to the text: the last one counts.
fn set(sets: &[String], name: &str) -> Option<String> {
    let given = |set: &String| {
        let (target, value) = set.split_once('=')?;
        (target.trim() == name).then(|| value.trim().to_owned())
    };
    sets.iter().rev().find_map(given)
}
