//! The formatter of scenes in TOML: spaces around `=` and after commas, and keys in columns. The order, the comments,
//! and the lines of arrays and tables stay.

use std::iter::repeat_n;
use std::ops::Range;
use toml_parser::parser::{Event, EventKind};

/// The maximum width of a key that others are aligned with.
const WIDEST: usize = 24;

/// A line: a key with its value, a title, or nothing. The ranges refer to the writer's text.
#[derive(Default)]
struct Line<'t> {
    /// The key, if it is aligned with others.
    key: Option<Range<usize>>,
    /// The rest, without the `=` after the key.
    rest: Range<usize>,
    comment: &'t str,
}

/// A writer, with the lines so far.
#[derive(Default)]
struct Writer<'t> {
    /// The words of all lines, one line after another.
    text: String,
    lines: Vec<Line<'t>>,
    /// The key of the current line, the beginning of its rest, and its comment.
    key: Option<Range<usize>>,
    start: usize,
    comment: &'t str,
    /// The text between the last word and the next one.
    between: &'static str,
    /// Whether a line of an array begins, which is already indented.
    begins: bool,
    /// The numbers of open arrays and tables on one line.
    arrays: usize,
    tables: usize,
}

/// Returns the formatted text of a scene, given its events. The text must have no syntax errors.
pub fn formatted(text: &str, events: &[Event]) -> String {
    let mut writer = Writer { text: String::with_capacity(text.len()), ..Writer::default() };
    for event in events {
        writer.event(event.kind(), &text[event.span().start()..event.span().end()]);
    }
    writer.end_line();
    written(&writer.text, writer.lines)
}

impl<'t> Writer<'t> {
    fn add(&mut self, raw: &str, after: &'static str) {
        self.text += if self.begins { "" } else { self.between };
        self.text += raw;
        (self.between, self.begins) = (after, false);
    }

    fn end_line(&mut self) {
        let rest = self.start..self.text.len();
        self.lines.push(Line { key: self.key.take(), rest, comment: self.comment });
        (self.start, self.comment) = (self.text.len(), "");
    }

    /// Begins a line of an array.
    fn indent(&mut self) {
        let end = self.start + self.text[self.start..].trim_end().len();
        self.text.truncate(end);
        self.text.push('\n');
        self.text.extend(repeat_n("    ", self.arrays));
        self.begins = true;
    }

    fn event(&mut self, kind: EventKind, raw: &'t str) {
        match kind {
            EventKind::KeyValSep if self.arrays == 0 && self.tables == 0 => {
                self.key = Some(self.start..self.text.len());
                self.start = self.text.len();
                self.between = "";
            }
            EventKind::KeyValSep => {
                self.text += " =";
                self.between = " ";
            }
            EventKind::ValueSep => {
                self.text.push(',');
                (self.between, self.begins) = (" ", false);
            }
            EventKind::InlineTableOpen => {
                self.tables += 1;
                self.add("{", " ");
            }
            EventKind::InlineTableClose => {
                self.tables = self.tables.saturating_sub(1);
                self.between = if self.text[self.start..].ends_with('{') { "" } else { " " };
                self.add("}", "");
            }
            EventKind::ArrayOpen => {
                self.add("[", "");
                self.arrays += 1;
            }
            EventKind::ArrayClose => {
                self.arrays = self.arrays.saturating_sub(1);
                if self.begins {
                    self.indent();
                }
                self.between = "";
                self.add("]", "");
            }
            EventKind::Comment if self.arrays > 0 => {
                self.text += if self.begins { "" } else { " " };
                self.text += raw.trim_end();
                self.begins = false;
            }
            EventKind::Comment => self.comment = raw.trim_end(),
            EventKind::Newline if self.arrays > 0 => {
                self.indent();
                self.between = "";
            }
            EventKind::Newline => {
                self.end_line();
                (self.between, self.begins) = ("", false);
            }
            EventKind::Whitespace => {}
            _ => self.add(raw, ""),
        }
    }
}

/// Writes lines with their keys in columns. `words` has the text of the lines.
fn written(words: &str, lines: Vec<Line>) -> String {
    let is_blank = |line: &Line| line.key.is_none() && line.rest.is_empty() && line.comment.is_empty();
    let is_aligned = |line: &Line| line.key.is_some() && !words[line.rest.clone()].starts_with('{');
    let mut kept: Vec<Line> = Vec::with_capacity(lines.len());
    for line in lines {
        if !is_blank(&line) || kept.last().is_some_and(|last| !is_blank(last)) {
            kept.push(line);
        }
    }
    while kept.last().is_some_and(is_blank) {
        kept.pop();
    }
    let mut text = String::with_capacity(2 * words.len());
    let mut at = 0;
    while at < kept.len() {
        let count = kept[at..].iter().take_while(|line| is_aligned(line)).count();
        let run = &kept[at..at + count.max(1)];
        let keys = run.iter().filter(|line| is_aligned(line)).filter_map(|line| line.key.clone());
        let width =
            keys.map(|key| words[key].chars().count()).filter(|width| *width <= WIDEST).max().unwrap_or(0);
        for line in run {
            let start = text.len();
            if let Some(key) = line.key.clone().map(|key| &words[key]) {
                text += key;
                text.extend(repeat_n(' ', width.saturating_sub(key.chars().count())));
                text += " = ";
            }
            text += &words[line.rest.clone()];
            if text.len() > start {
                text.push(' ');
            }
            text += line.comment;
            text.truncate(start + text[start..].trim_end().len());
            text.push('\n');
        }
        at += run.len();
    }
    text
}
