//! The formatter of scenes: one attribute on each line, in columns, like the scenes of this repository. The order and
//! the comments stay, and entities on one line stay on one line.

use super::format_toml;
use super::toml_events;
use super::view::{Attribute, Entity, Item, Repeat, View, Word};
use std::fmt::Write;
use std::mem::replace;
use std::ops::Range;
use tabray_lang::reader::{Fault, Report};
use tabray_lang::reader::{Token, TokenForm};
use tabray_lang::syntax::Syntax;

/// The maximum width of a type or name, and of an attribute with its values, that others are aligned with.
const WIDEST: usize = 24;
const WIDEST_CELL: usize = 48;

/// The maximum number of values in a row with equal gaps.
const SHORT_ROW: usize = 4;

/// Returns an error that prevents formatting.
pub fn problem(view: &View) -> Option<Fault> {
    view.breaks.first().cloned().or_else(|| match view.syntax {
        Syntax::Notes => None,
        Syntax::Toml => {
            toml_events::wrong_word(view.text.as_str(), &toml_events::events(view.text.as_str()).0)
        }
    })
}

/// Returns the formatted text of a scene, or `None` if it has syntax errors.
pub fn formatted(view: &View) -> Option<String> {
    if !view.breaks.is_empty() {
        return None;
    }
    let text = match view.syntax {
        Syntax::Notes => in_notes(view),
        Syntax::Toml => {
            let (text, events) = (view.text.as_str(), toml_events::events(view.text.as_str()).0);
            match toml_events::wrong_word(text, &events) {
                None => format_toml::formatted(text, &events),
                Some(_) => return None,
            }
        }
    };
    let is_dos = view.text.as_str().contains("\r\n");
    Some(if is_dos { text.replace("\r\n", "\n").replace('\n', "\r\n") } else { text })
}

/// A line of the result.
struct Line {
    indent: usize,
    content: LineContent,
    comment: String,
}

enum LineContent {
    Blank,
    /// A comment alone.
    Comment,
    /// A line without columns.
    Plain(String),
    /// An entity on one line: its type and name, and each attribute's name and values.
    Entity([String; 2], Vec<[String; 2]>),
    /// A named number.
    Let([String; 2]),
    /// An attribute, or further values of the attribute above.
    Attribute([String; 2]),
}

fn in_notes(view: &View) -> String {
    let mut writer = Writer { view, at: 0, lines: Vec::new() };
    writer.items(&view.items, 0);
    writer.gap(view.text.as_str().len(), 0);
    while matches!(writer.lines.last(), Some(Line { content: LineContent::Blank, .. })) {
        writer.lines.pop();
    }
    written(&writer.lines)
}

struct Writer<'v> {
    view: &'v View,
    /// The end of the last written word or comment.
    at: usize,
    lines: Vec<Line>,
}

impl Writer<'_> {
    fn push(&mut self, indent: usize, content: LineContent) {
        self.lines.push(Line { indent, content, comment: String::new() });
    }

    fn raw(&self, word: Word) -> String {
        self.view.slice(word.place()).to_owned()
    }

    /// Writes the comments up to the next word, and one of the blank lines before it.
    fn gap(&mut self, to: usize, indent: usize) {
        let text = self.view.text.as_str();
        let (mut newlines, nowhere) = (0, &mut Report::default());
        while self.at < to
            && let Some(token) = Token::at(text, self.at, nowhere)
        {
            let raw = self.view.slice(token.start..token.end.min(to));
            if token.form == TokenForm::Comment {
                self.comment(raw.trim_end(), replace(&mut newlines, 0), indent);
            } else {
                newlines += raw.matches('\n').count();
            }
            self.at = token.end;
        }
        self.blank(newlines);
        self.at = to.max(self.at);
    }

    /// Writes a comment on the line of the word before it, or on its own line.
    fn comment(&mut self, text: &str, newlines: usize, indent: usize) {
        if let Some(last) = self.lines.last_mut()
            && newlines == 0
            && last.comment.is_empty()
            && !matches!(last.content, LineContent::Blank)
        {
            last.comment = text.to_owned();
            return;
        }
        self.blank(newlines);
        self.lines.push(Line { indent, content: LineContent::Comment, comment: text.to_owned() });
    }

    /// Writes one of several blank lines, but none after a brace.
    fn blank(&mut self, newlines: usize) {
        let is_open = |line: &Line| matches!(&line.content, LineContent::Plain(text) if text.ends_with('{'));
        let follows = self
            .lines
            .last()
            .is_some_and(|line| !is_open(line) && !matches!(line.content, LineContent::Blank));
        if newlines > 1 && follows {
            self.push(0, LineContent::Blank);
        }
    }

    fn items(&mut self, items: &[Item], indent: usize) {
        for item in items {
            self.gap(item.place().start, indent);
            match item {
                Item::Entity(entity) if !self.view.slice(entity.place.clone()).contains('\n') => {
                    self.short(entity, indent);
                }
                Item::Entity(entity) => self.entity(entity, indent),
                Item::Let(number) => {
                    let words = [number.name, number.value].map(|word| word.map(|word| self.raw(word)));
                    self.push(indent, LineContent::Let(words.map(Option::unwrap_or_default)));
                    self.words([number.name, number.value].into_iter().flatten(), indent);
                }
                Item::Include(include) => {
                    let files: String =
                        include.files.iter().map(|file| format!(" {}", self.raw(*file))).collect();
                    self.push(indent, LineContent::Plain(format!("include{files}")));
                    self.words(include.files.iter().copied(), indent);
                }
                Item::Repeat(repeat) => self.repeat(repeat, indent),
            }
            self.at = self.at.max(item.place().end);
        }
    }

    /// Writes the comments between words that are already on one line.
    fn words(&mut self, words: impl Iterator<Item = Word>, indent: usize) {
        // The keyword itself is not a comment.
        for word in words {
            let start = self.view.slice(self.at..word.start).find(char::is_whitespace).unwrap_or(0);
            self.at += start;
            self.gap(word.start, indent);
            self.at = word.end;
        }
        while matches!(self.lines.last(), Some(Line { content: LineContent::Blank, .. })) {
            self.lines.pop();
        }
    }

    /// Writes an entity on one line.
    fn short(&mut self, entity: &Entity, indent: usize) {
        let title =
            [Some(entity.kind), entity.name].map(|word| word.map(|word| self.raw(word)).unwrap_or_default());
        let attributes = entity.attributes.iter().map(|attribute| {
            let mut values = String::new();
            for (index, word) in attribute.values.iter().enumerate() {
                let before = index.checked_sub(1).map(|before| attribute.values[before].end);
                values += before.map_or("", |end| self.between(attribute, end..word.start));
                values += &self.raw(*word);
            }
            [self.raw(attribute.name), values]
        });
        let attributes = attributes.collect();
        self.push(indent, LineContent::Entity(title, attributes));
    }

    /// Writes an entity on several lines.
    fn entity(&mut self, entity: &Entity, indent: usize) {
        let title =
            [Some(entity.kind), entity.name].map(|word| word.map(|word| self.raw(word)).unwrap_or_default());
        self.push(indent, LineContent::Plain(title.join(" ").trim_end().to_owned()));
        self.at = entity.kind.end;
        self.words(entity.name.into_iter(), indent);
        self.gap(entity.body.start.saturating_sub(1), indent);
        self.no_blank();
        self.push(indent, LineContent::Plain("{".to_owned()));
        self.at = entity.body.start;
        for attribute in &entity.attributes {
            self.gap(attribute.name.start, indent + 1);
            self.push(indent + 1, LineContent::Attribute([self.raw(attribute.name), String::new()]));
            self.at = attribute.name.end;
            for word in &attribute.values {
                let is_below = self.view.slice(self.at..word.start).contains('\n');
                let gap = self.at..word.start;
                self.gap(word.start, indent + 1);
                self.no_blank();
                let goes_on = matches!(self.lines.last(), Some(Line { content: LineContent::Attribute([_, values]), comment, .. })
                    if comment.is_empty() && (values.is_empty() || !is_below));
                if !goes_on {
                    self.push(indent + 1, LineContent::Attribute([String::new(), String::new()]));
                }
                let raw = self.between(attribute, gap).to_owned() + &self.raw(*word);
                if let Some(Line { content: LineContent::Attribute([_, values]), .. }) = self.lines.last_mut()
                {
                    *values += if values.is_empty() { raw.trim_start() } else { &raw };
                }
                self.at = word.end;
            }
        }
        self.gap(entity.body.end, indent + 1);
        self.no_blank();
        self.push(indent, LineContent::Plain("}".to_owned()));
        self.at = entity.place.end;
    }

    fn repeat(&mut self, repeat: &Repeat, indent: usize) {
        let words = [repeat.name, repeat.count].into_iter().flatten();
        let title: String = words.clone().map(|word| format!(" {}", self.raw(word))).collect();
        self.push(indent, LineContent::Plain(format!("repeat{title} {{")));
        self.words(words, indent);
        self.gap(repeat.body.start.saturating_sub(1), indent + 1);
        self.at = repeat.body.start;
        self.items(&repeat.items, indent + 1);
        self.gap(repeat.body.end, indent + 1);
        self.no_blank();
        self.push(indent, LineContent::Plain("}".to_owned()));
        self.at = repeat.place.end;
    }

    /// Returns the text between two values on a line. Groups of a long row may be separated.
    fn between(&self, attribute: &Attribute, gap: Range<usize>) -> &'static str {
        let is_long = attribute.known.is_some_and(|known| known.arity().most() > SHORT_ROW);
        if is_long && gap.len() > 1 { "  " } else { " " }
    }

    fn no_blank(&mut self) {
        while matches!(self.lines.last(), Some(Line { content: LineContent::Blank, .. })) {
            self.lines.pop();
        }
    }
}

/// Returns the width for padding texts: the maximum width of those that are at most `widest` wide.
fn width<'t>(texts: impl Iterator<Item = &'t String>, widest: usize) -> usize {
    texts.map(|text| text.chars().count()).filter(|width| *width <= widest).max().unwrap_or(0)
}

/// Writes the lines, with columns for each run of similar lines.
fn written(lines: &[Line]) -> String {
    let mut text = String::new();
    let mut at = 0;
    while let Some(first) = lines.get(at) {
        let count = lines[at..].iter().take_while(|line| goes_with(first, line)).count().max(1);
        let run = &lines[at..at + count];
        let bodies = match &first.content {
            LineContent::Entity(..) => entities(run),
            LineContent::Let(_) => lets(run),
            LineContent::Attribute(_) => attributes(run),
            LineContent::Plain(plain) => vec![plain.clone()],
            LineContent::Blank | LineContent::Comment => vec![String::new()],
        };
        for (line, body) in run.iter().zip(bodies) {
            let indent = "    ".repeat(line.indent);
            let between = if body.trim_end().is_empty() || line.comment.is_empty() { "" } else { " " };
            let whole = format!("{indent}{}{between}{}", body.trim_end(), line.comment);
            let _ = writeln!(text, "{}", whole.trim_end());
        }
        at += count;
    }
    text
}

/// Tells whether a line shares columns with another one.
fn goes_with(first: &Line, line: &Line) -> bool {
    match (&first.content, &line.content) {
        (LineContent::Entity(..), LineContent::Entity(..)) | (LineContent::Let(_), LineContent::Let(_)) => {
            first.indent == line.indent
        }
        // Comments and blank lines between attributes do not end the columns.
        (LineContent::Attribute(_), LineContent::Attribute(_) | LineContent::Comment) => {
            first.indent == line.indent
        }
        (LineContent::Attribute(_), LineContent::Blank) => true,
        _ => false,
    }
}

fn lets(run: &[Line]) -> Vec<String> {
    let words = |line: &Line| match &line.content {
        LineContent::Let(words) => words.clone(),
        _ => Default::default(),
    };
    let all: Vec<_> = run.iter().map(words).collect();
    let width = width(all.iter().map(|[name, _]| name), WIDEST);
    all.iter().map(|[name, value]| format!("let {name:width$} {value}")).collect()
}

fn attributes(run: &[Line]) -> Vec<String> {
    let width = run.iter().filter_map(|line| match &line.content {
        LineContent::Attribute([name, _]) => Some(name),
        _ => None,
    });
    let width = self::width(width, WIDEST);
    let body = |line: &Line| match &line.content {
        LineContent::Attribute([name, values]) => format!("{name:width$} {values}"),
        _ => String::new(),
    };
    run.iter().map(body).collect()
}

/// Writes single-line entities, with types, names and equal attributes in columns.
fn entities(run: &[Line]) -> Vec<String> {
    let parts: Vec<_> = run
        .iter()
        .filter_map(|line| match &line.content {
            LineContent::Entity(title, attributes) => Some((title, attributes)),
            _ => None,
        })
        .collect();
    let [kinds, names] = [0, 1].map(|part| width(parts.iter().map(|(title, _)| &title[part]), WIDEST));
    let cell = |[name, values]: &[String; 2]| format!("{name} {values}").trim_end().to_owned();
    let names_of = |attributes: &[[String; 2]]| -> Vec<String> {
        attributes.iter().map(|[name, _]| name.clone()).collect()
    };
    // The widths of the columns. Entities with the same first attributes share the width of the last of these, if more
    // attributes follow.
    let mut widths = std::collections::HashMap::<Vec<String>, usize>::new();
    for (_, attributes) in &parts {
        for end in 1..attributes.len() {
            let wide = cell(&attributes[end - 1]).chars().count();
            let width = widths.entry(names_of(&attributes[..end])).or_default();
            *width = (*width).max(if wide <= WIDEST_CELL { wide } else { 0 });
        }
    }
    let line = |([kind, name], attributes): &(&[String; 2], &Vec<[String; 2]>)| {
        let mut text = format!("{kind:kinds$} {name:names$} {{ ");
        for (index, attribute) in attributes.iter().enumerate() {
            let is_last = index + 1 == attributes.len();
            let width = if is_last { 0 } else { widths[&names_of(&attributes[..=index])] };
            let _ = write!(text, "{:width$}{}", cell(attribute), if is_last { " " } else { "  " });
        }
        text + "}"
    };
    parts.iter().map(line).collect()
}
