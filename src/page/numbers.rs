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
        let (range, label) = told(comment(&view, value));
        let value = set(shown.sets, &name).unwrap_or_else(|| view.word(value).into_owned());
        Field {
            name: name.into(),
            label,
            material: None,
            about: "a number of the scene".to_owned(),
            each: &[],
            values: vec![value],
            signs: "any",
            range,
            whole: false,
            fixed: None,
        }
    };
    let attributes: Vec<_> = all(&view).map(field).collect();
    let entity = Named { order: ORDER.to_owned(), kind: "let", name: NAME.to_owned() };
    (!attributes.is_empty()).then_some(Fields { entity, attributes })
}

/// Returns the comment after a word, in its line; nothing where none is.
fn comment(view: &View, after: Word) -> &str {
    let rest = view.text.as_str()[after.end..].lines().next().unwrap_or_default();
    let comment = rest.trim_start().strip_prefix('#').filter(|_| rest.starts_with(char::is_whitespace));
    comment.unwrap_or_default().trim()
}

/// Returns the range and the label that a comment gives a number, as in `0..2 height of the saddle`.
fn told(comment: &str) -> (Option<[f64; 2]>, Option<String>) {
    let (first, rest) = comment.split_once(char::is_whitespace).unwrap_or((comment, ""));
    let range = first.split_once("..").and_then(|(low, high)| Some([low.parse().ok()?, high.parse().ok()?]));
    let range = range.filter(|[low, high]: &[f64; 2]| low < high && (high - low).is_finite());
    let label = if range.is_some() { rest.trim() } else { comment };
    (range, (!label.is_empty()).then(|| label.to_owned()))
}

/// Returns the value that is set for a number in addition to the text: the last one counts.
fn set(sets: &[String], name: &str) -> Option<String> {
    let given = |set: &String| {
        let (target, value) = set.split_once('=')?;
        (target.trim() == name).then(|| value.trim().to_owned())
    };
    sets.iter().rev().find_map(given)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comment_gives_a_number_its_range_and_its_label() {
        for (text, range, label) in [
            ("0..2 height of the saddle", Some([0.0, 2.0]), Some("height of the saddle")),
            ("-1e3..0.5", Some([-1000.0, 0.5]), None),
            ("as in the paper", None, Some("as in the paper")),
            ("2..1 turned", None, Some("2..1 turned")),
            ("0..inf", None, Some("0..inf")),
            ("", None, None),
        ] {
            assert_eq!(told(text), (range, label.map(str::to_owned)), "{text}");
        }
        for (file, text) in [
            ("a.ray", "let k 0.5   # 0..1 k's label\nsphere ball { radius \"k\" }"),
            ("a.toml", "[let]\nk = 0.5 # 0..1 k's label\n"),
        ] {
            let view =
                tabray_editor::read(Registry::get().expect("plugins"), file, tabray_editor::Text::new(text));
            assert_eq!(comment(&view, value(&view, "k").expect("a number")), "0..1 k's label");
        }
        for text in ["let k 0.5", "let k 0.5 let m 1 # 0..1", "let k 0.5#0..1"] {
            let view = tabray_editor::read(
                Registry::get().expect("plugins"),
                "a.ray",
                tabray_editor::Text::new(text),
            );
            assert_eq!(value(&view, "k").map_or("", |word| comment(&view, word)), "", "{text}");
        }
    }
}
