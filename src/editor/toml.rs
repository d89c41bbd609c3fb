//! The tolerant reader of a text in TOML.

use super::toml_events::events;
use super::view::{Attribute, Entity, Form, Include, Item, Let, Repeat, Word};
use std::mem::take;
use std::ops::Range;
use tabray_lang::reader::Keyword;
use tabray_lang::reader::{Fault, find_attribute};
use tabray_lang::registry::Registry;
use toml_parser::Span;
use toml_parser::decoder::Encoding;
use toml_parser::parser::{Event, EventKind};

/// The maximum number of parts of a key. Longer keys are skipped.
const MAX_PARTS: usize = 128;

/// The number of last items that are searched for an item to continue.
const NEAR: usize = 64;

/// Parses a text into items, and returns its syntax errors.
pub fn read(registry: &Registry, text: &str) -> (Vec<Item>, Vec<Fault>) {
    let (events, breaks) = events(text);
    let mut reader = Reader { registry, text, items: Vec::new(), path: Path::new() };
    reader.all(&events);
    end_bodies(&mut reader.items, text.len());
    (reader.items, breaks)
}

/// A key with all its parts.
type Path = Vec<Word>;

struct Reader<'a> {
    registry: &'a Registry,
    text: &'a str,
    items: Vec<Item>,
    /// The parts of the last value's path, kept here to reuse their memory.
    path: Path,
}

/// The current value: its key, the first byte after the `=`, and the words so far.
#[derive(Default)]
struct Leaf {
    key: Path,
    from: Option<usize>,
    values: Vec<Word>,
    end: usize,
}

fn word(text: &str, span: Span, encoding: Option<Encoding>) -> Word {
    let (start, end) = (span.start(), span.end().max(span.start()));
    let raw = &text[start..end];
    let closes = |quote: &str| raw.len() >= 2 * quote.len() && raw.ends_with(quote);
    let form = match encoding {
        None => Form::Bare,
        Some(Encoding::BasicString) if closes("\"") => Form::Quoted(1),
        Some(Encoding::LiteralString) if closes("'") => Form::Literal(1),
        Some(Encoding::MlBasicString) if closes("\"\"\"") => Form::Quoted(3),
        Some(Encoding::MlLiteralString) if closes("'''") => Form::Literal(3),
        Some(_) => Form::Unclosed,
    };
    Word { start, end, form }
}

impl Reader<'_> {
    fn says(&self, word: Word) -> &str {
        &self.text[word.inner()]
    }

    fn all(&mut self, events: &[Event]) {
        // The current table, and the inline tables around the position.
        let (mut table, mut outer): (Path, Vec<Path>) = (Path::new(), Vec::new());
        let (mut title, mut arrays) = (None, 0_usize);
        let mut leaf = Leaf::default();
        for event in events {
            let span = event.span();
            match event.kind() {
                EventKind::StdTableOpen | EventKind::ArrayTableOpen => {
                    self.leaf(&table, &outer, take(&mut leaf));
                    (outer, arrays) = (Vec::new(), 0);
                    table.clear();
                    title = Some((span.start(), event.kind() == EventKind::ArrayTableOpen));
                }
                EventKind::StdTableClose | EventKind::ArrayTableClose => {
                    if let Some((start, is_new)) = title.take() {
                        self.open(&table, start..span.end(), is_new);
                    }
                }
                EventKind::SimpleKey if title.is_some() => {
                    table.push(word(self.text, span, event.encoding()));
                }
                EventKind::SimpleKey => {
                    if leaf.from.is_some() || leaf.key.is_empty() {
                        self.leaf(&table, &outer, take(&mut leaf));
                    }
                    leaf.key.push(word(self.text, span, event.encoding()));
                    leaf.end = span.end();
                }
                EventKind::KeyValSep => leaf.from = Some(span.end()),
                EventKind::Scalar => {
                    leaf.values.push(word(self.text, span, event.encoding()));
                    leaf.end = span.end();
                }
                EventKind::ArrayOpen => arrays += 1,
                EventKind::ArrayClose => {
                    arrays = arrays.saturating_sub(1);
                    leaf.end = span.end();
                }
                EventKind::InlineTableOpen => {
                    let key = take(&mut leaf).key;
                    let path: Path =
                        table.iter().chain(outer.iter().flatten()).chain(&key).copied().collect();
                    let start = key.first().map_or(span.start(), |first| first.start);
                    self.open(&path, start..span.end(), true);
                    outer.push(key);
                }
                EventKind::InlineTableClose => {
                    self.leaf(&table, &outer, take(&mut leaf));
                    outer.pop();
                    self.end_of_line(span);
                }
                EventKind::ValueSep if arrays == 0 => self.leaf(&table, &outer, take(&mut leaf)),
                EventKind::Newline if arrays == 0 => {
                    if let Some((start, is_new)) = title.take() {
                        self.open(&table, start..span.start(), is_new);
                    }
                    self.leaf(&table, &outer, take(&mut leaf));
                    outer.clear();
                }
                _ => {}
            }
        }
        if let Some((start, is_new)) = title {
            self.open(&table, start..self.text.len(), is_new);
        }
        self.leaf(&table, &outer, leaf);
    }

    /// Ends the body of a single-line entity.
    fn end_of_line(&mut self, brace: Span) {
        if let Some(Item::Entity(entity)) = last(&mut self.items) {
            entity.place.end = brace.end();
            entity.body.end = brace.start();
        }
    }

    /// Begins the item of a title, unless the title continues the last one.
    fn open(&mut self, path: &[Word], title: Range<usize>, is_new: bool) {
        if path.len() > MAX_PARTS {
            return;
        }
        let (text, registry) = (self.text, self.registry);
        open(registry, text, &mut self.items, path, &title, is_new);
    }

    /// Adds a value to the item of its key.
    fn leaf(&mut self, table: &[Word], outer: &[Path], leaf: Leaf) {
        let Some(first) = leaf.key.first().map(|first| first.start) else { return };
        let mut path = take(&mut self.path);
        path.clear();
        path.extend(table.iter().chain(outer.iter().flatten()).chain(&leaf.key));
        let place = first..leaf.end.max(leaf.from.unwrap_or(0));
        match (Keyword::of(self.says(path[0])), &path[..]) {
            _ if path.len() > MAX_PARTS => {}
            (Some(Keyword::Include), [_]) => {
                self.items.push(Item::Include(Include { files: leaf.values, place }));
            }
            (Some(Keyword::Let), [_, name]) => {
                let value = leaf.values.first().copied();
                self.items.push(Item::Let(Let { name: Some(*name), value, place }));
            }
            _ => value(self.registry, self.text, &mut self.items, &path, leaf, &place),
        }
        self.path = path;
    }
}

fn says(text: &str, word: Word) -> &str {
    &text[word.inner()]
}

/// Returns the last, innermost item, which may continue.
fn last(items: &mut [Item]) -> Option<&mut Item> {
    let goes_on = matches!(items.last(), Some(Item::Repeat(repeat)) if !repeat.items.is_empty());
    match (items.last_mut()?, goes_on) {
        (Item::Repeat(repeat), true) => last(&mut repeat.items),
        (item, _) => Some(item),
    }
}

/// Finds the `repeat` with a name, or begins it.
fn repeated<'i>(
    text: &str,
    items: &'i mut Vec<Item>,
    name: Word,
    title: &Range<usize>,
    is_new: bool,
) -> &'i mut Repeat {
    let is_same = |item: &Item| match item {
        Item::Repeat(repeat) => repeat.name.is_some_and(|known| says(text, known) == says(text, name)),
        _ => false,
    };
    let found = if is_new { None } else { items.iter().rev().take(NEAR).position(is_same) };
    let at = match found {
        Some(back) => items.len() - 1 - back,
        None => {
            let (place, body) = (title.clone(), title.end..title.end);
            let (items_in, again) = (Vec::new(), Vec::new());
            items.push(Item::Repeat(Repeat {
                name: Some(name),
                again,
                count: None,
                items: items_in,
                place,
                body,
            }));
            items.len() - 1
        }
    };
    match &mut items[at] {
        Item::Repeat(repeat) => {
            let is_there = |known: &Word| known.start == name.start;
            // The words of a title are the same for each value below it.
            if found.is_some() && !repeat.name.iter().chain(repeat.again.last()).any(is_there) {
                repeat.again.push(name);
            }
            repeat.place.end = repeat.place.end.max(title.end);
            repeat.body.end = repeat.body.end.max(title.end);
            repeat
        }
        _ => unreachable!("what was found is what is repeated"),
    }
}

fn open(
    registry: &Registry,
    text: &str,
    items: &mut Vec<Item>,
    path: &[Word],
    title: &Range<usize>,
    is_new: bool,
) {
    let Some(first) = path.first() else { return };
    match (Keyword::of(says(text, *first)), path) {
        (Some(Keyword::Repeat), [_, name]) => {
            repeated(text, items, *name, title, is_new);
        }
        (Some(Keyword::Repeat), [_, name, rest @ ..]) => {
            let repeat = repeated(text, items, *name, title, false);
            open(registry, text, &mut repeat.items, rest, title, is_new);
        }
        (None, [kind]) => {
            // `[sphere` is incomplete, and `[sphere]` has its names below it.
            items.push(Item::Entity(entity(registry, text, *kind, None, title)));
        }
        (None, [kind, name, ..]) => {
            items.push(Item::Entity(entity(registry, text, *kind, Some(*name), title)))
        }
        _ => {}
    }
}

fn entity(registry: &Registry, text: &str, kind: Word, name: Option<Word>, title: &Range<usize>) -> Entity {
    Entity {
        kind,
        known: registry.find(says(text, kind)),
        name,
        again: Vec::new(),
        attributes: Vec::new(),
        place: title.clone(),
        body: title.end..title.end,
    }
}

/// Adds a value to the item of its key.
fn value(
    registry: &Registry,
    text: &str,
    items: &mut Vec<Item>,
    path: &[Word],
    leaf: Leaf,
    place: &Range<usize>,
) {
    match (Keyword::of(says(text, path[0])), path) {
        (Some(Keyword::Repeat), [_, name, rest @ ..]) if !rest.is_empty() => {
            let repeat = repeated(text, items, *name, place, false);
            match rest {
                [count] if says(text, *count) == "count" => repeat.count = leaf.values.first().copied(),
                [_] => {}
                [key, name] if Keyword::of(says(text, *key)) == Some(Keyword::Let) => {
                    let value = leaf.values.first().copied();
                    repeat.items.push(Item::Let(Let { name: Some(*name), value, place: place.clone() }));
                }
                rest => value(registry, text, &mut repeat.items, rest, leaf, place),
            }
        }
        (None, [kind, name, key]) => {
            let is_same = |entity: &Entity| {
                says(text, entity.kind) == says(text, *kind)
                    && entity.name.is_some_and(|known| says(text, known) == says(text, *name))
            };
            if !matches!(items.last(), Some(Item::Entity(entity)) if is_same(entity)) {
                items.push(Item::Entity(entity(registry, text, *kind, Some(*name), place)));
            }
            let Some(Item::Entity(entity)) = items.last_mut() else { return };
            // The words of a title are the same for each value below it.
            if entity.name.is_some_and(|known| known.start != name.start)
                && entity.again.last().is_none_or(|again| again.start != name.start)
            {
                entity.again.push(*name);
            }
            entity.place.end = entity.place.end.max(place.end);
            entity.body.end = entity.body.end.max(place.end);
            entity.attributes.push(Attribute {
                name: *key,
                known: entity.known.and_then(|entity| find_attribute(entity, says(text, *key))),
                values_from: leaf.from,
                values: leaf.values,
                end: place.end,
            });
        }
        (None, [kind, key]) => {
            // The title has no name yet.
            if let Some(Item::Entity(entity)) = items.last_mut()
                && entity.name.is_none()
                && entity.kind == *kind
            {
                entity.body.end = entity.body.end.max(place.end);
                entity.attributes.push(Attribute {
                    name: *key,
                    known: None,
                    values_from: leaf.from,
                    values: leaf.values,
                    end: place.end,
                });
            }
        }
        _ => {}
    }
}

/// Extends the body of each item that has its own title to the next item.
fn end_bodies(items: &mut [Item], end: usize) {
    let starts: Vec<_> = items.iter().map(|item| item.place().start).skip(1).chain([end]).collect();
    for (item, next) in items.iter_mut().zip(starts) {
        let next = next.min(end);
        match item {
            Item::Entity(entity) if entity.body.end >= entity.place.end => {
                entity.body.end = entity.body.end.max(next);
            }
            Item::Repeat(repeat) => {
                repeat.body.end = repeat.body.end.max(next);
                end_bodies(&mut repeat.items, next);
            }
            _ => {}
        }
    }
}
