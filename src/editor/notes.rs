//! The view of a text in the notes' syntax.

use super::view::{Attribute, Entity, Form, Include, Item, Let, Repeat, Word};
use std::mem::{replace, take};
use tabray_lang::reader::Keyword;
use tabray_lang::reader::report::Report;
use tabray_lang::reader::{self as parsed, Parsed};
use tabray_lang::reader::{Fault, body_of_repeat, find_attribute};
use tabray_lang::reader::{Grammar, Node, Statement};
use tabray_lang::registry::Registry;
use tabray_lang::syntax::Syntax;

/// The maximum depth of nested `repeat`s. The contents of deeper ones are skipped.
const DEEPEST: usize = 64;

/// Parses a text into items, and returns its syntax errors.
pub fn read(registry: &Registry, text: &str) -> (Vec<Item>, Vec<Fault>) {
    let mut report = Report::new("", text, Syntax::Notes);
    let grammar = Grammar::of_draft(registry, text, &mut report);
    let mut reader = Reader { registry, text, grammar, items: Vec::new(), outer: Vec::new() };
    reader.all();
    let items = reader.items;
    (items, report.faults().to_vec())
}

struct Reader<'a, 'r> {
    registry: &'r Registry,
    text: &'a str,
    grammar: Grammar<'a, 'r>,
    items: Vec<Item>,
    /// The open `repeat`s, each with the items before it.
    outer: Vec<(Repeat, Vec<Item>)>,
}

impl<'a> Reader<'a, '_> {
    fn all(&mut self) {
        let mut memory = None;
        while !self.grammar.report.has_enough()
            && let Some(node) = self.grammar.next(!self.outer.is_empty(), &mut memory)
        {
            match node {
                Node::Entity => {
                    let entity = memory.as_ref().and_then(|parsed| self.entity(parsed));
                    self.items.extend(entity.map(Item::Entity));
                }
                Node::Statement(statement) => self.statement(&statement),
                Node::Close(brace) => self.close(brace.start),
                Node::Stray => {}
            }
        }
        while let Some((repeat, _)) = self.outer.last() {
            let start = repeat.place.start;
            let message = "missing `}` for this `repeat`";
            self.grammar.report.add(Fault::error(Some(start..start + "repeat".len()), message));
            self.close(self.text.len());
        }
    }

    fn statement(&mut self, statement: &Statement<'a>) {
        let Statement { keyword, first, words, open } = statement;
        let [name, second] = words.each_ref().map(|found| found.as_ref().and_then(|found| self.word(found)));
        let end = self.grammar.before.end;
        let place = first.start..end;
        match keyword {
            Keyword::Include => {
                self.items.push(Item::Include(Include { files: name.into_iter().collect(), place }));
            }
            Keyword::Let => self.items.push(Item::Let(Let { name, value: second, place })),
            Keyword::Repeat => {
                let (again, items, body) = (Vec::new(), Vec::new(), end..end);
                let repeat = Repeat { name, again, count: second, items, place, body };
                self.outer.push((repeat, take(&mut self.items)));
                if open.is_none() {
                    self.close(end);
                } else if self.outer.len() > DEEPEST {
                    let message = "this `repeat` is nested too deep";
                    self.grammar.report.add(Fault::error(Some(first.place()), message));
                    self.close(end);
                    self.grammar.go_to(body_of_repeat(self.text, end).1);
                }
            }
        }
    }

    /// Ends the innermost `repeat`. Its body ends at `end`.
    fn close(&mut self, end: usize) {
        let Some((mut repeat, before)) = self.outer.pop() else { return };
        repeat.items = replace(&mut self.items, before);
        repeat.body.end = end;
        repeat.place.end = self.grammar.before.end.max(end);
        self.items.push(Item::Repeat(repeat));
    }

    fn entity(&self, parsed: &Parsed<'a>) -> Option<Entity> {
        let known = self.registry.find(&parsed.kind.text);
        let attribute = |(name, values): (&parsed::Word<'a>, &[parsed::Word<'a>])| {
            let known = known.and_then(|known| find_attribute(known, &name.text));
            let (name, values) = (self.word(name)?, values.iter().filter_map(|value| self.word(value)));
            let values: Vec<_> = values.collect();
            let end = values.last().map_or(name.end, |last| last.end);
            Some(Attribute { name, known, values_from: Some(name.end), values, end })
        };
        Some(Entity {
            kind: self.word(&parsed.kind)?,
            known,
            name: self.word(&parsed.name),
            again: Vec::new(),
            attributes: parsed.attributes().filter_map(attribute).collect(),
            place: parsed.place.clone()?,
            body: self.grammar.body.clone(),
        })
    }

    /// Returns the place of a word, or `None` for a substitute of a missing word.
    fn word(&self, word: &parsed::Word<'a>) -> Option<Word> {
        let place = word.place.clone().filter(|place| !place.is_empty())?;
        let form = match word.form {
            parsed::Form::Faulty => return None,
            parsed::Form::Text if place.len() > 1 && self.text[place.clone()].ends_with('"') => {
                Form::Quoted(1)
            }
            parsed::Form::Text => Form::Unclosed,
            _ => Form::Bare,
        };
        Some(Word { start: place.start, end: place.end, form })
    }
}
