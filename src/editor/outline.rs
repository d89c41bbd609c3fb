//! The outline of a scene, and its foldable lines.

use super::view::{Item, View};
use std::ops::Range;
use tabray_core::scene::kind::Kind;

/// An entry of the outline.
#[derive(Clone, Debug)]
pub struct Symbol {
    /// The displayed name.
    pub name: String,
    /// The type of an entity, or the keyword.
    pub detail: String,
    /// The kind of an entity, or `None` for other items.
    pub kind: Option<Kind>,
    /// The range of the entry's text.
    pub place: Range<usize>,
    /// The range of the name.
    pub name_place: Range<usize>,
    /// The nested entries.
    pub inner: Vec<Symbol>,
}

/// Returns the outline of a text.
pub fn outline(view: &View) -> Vec<Symbol> {
    view.items.iter().map(|item| symbol(view, item)).collect()
}

fn symbol(view: &View, item: &Item) -> Symbol {
    let (name, detail, kind, inner) = match item {
        Item::Entity(entity) => {
            let kind = entity.known.map(|known| known.kind());
            (entity.name.or(Some(entity.kind)), view.word(entity.kind).into_owned(), kind, Vec::new())
        }
        Item::Let(number) => (number.name, "let".to_owned(), None, Vec::new()),
        Item::Include(include) => (include.files.first().copied(), "include".to_owned(), None, Vec::new()),
        Item::Repeat(repeat) => {
            let inner = repeat.items.iter().map(|item| symbol(view, item)).collect();
            (repeat.name, "repeat".to_owned(), None, inner)
        }
    };
    let place = item.place().clone();
    let name_place = name.map_or(place.start..place.start, |name| name.place());
    let said = name.map(|name| view.word(name).into_owned()).filter(|name| !name.is_empty());
    // In TOML, the entries of a `repeat` extend beyond its title.
    let end =
        inner.iter().map(|inner: &Symbol| inner.place.end).fold(place.end.max(name_place.end), usize::max);
    Symbol {
        name: said.unwrap_or_else(|| detail.clone()),
        detail,
        kind,
        place: place.start.min(name_place.start)..end,
        name_place,
        inner,
    }
}

/// Foldable lines.
#[derive(Clone, Debug, PartialEq)]
pub struct Fold {
    /// The first and the last line, from 0.
    pub lines: [usize; 2],
    /// Whether the lines are a comment.
    pub is_comment: bool,
}

/// Returns the foldable lines: entities, `repeat`s, and comments of several lines.
pub fn folds(view: &View) -> Vec<Fold> {
    let mut folds = Vec::new();
    view.visit(&mut |item, _| {
        let lines = [item.place().start, item.place().end.max(1) - 1].map(|at| view.text.line_of(at));
        if lines[0] < lines[1] {
            folds.push(Fold { lines, is_comment: false });
        }
    });
    let mut first = None;
    let ends = view.text.as_str().lines().chain([""]).enumerate();
    for (line, text) in ends {
        match (text.trim_start().starts_with('#'), first) {
            (true, None) => first = Some(line),
            (false, Some(start)) => {
                if line > start + 1 {
                    folds.push(Fold { lines: [start, line - 1], is_comment: true });
                }
                first = None;
            }
            _ => {}
        }
    }
    folds
}
