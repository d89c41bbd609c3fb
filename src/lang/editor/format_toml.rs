//! Formats a scene in TOML: spaces around `=` and after commas, and keys in columns. The order, the comments, and what
//! stands on one line stay.

use super::toml::events;
use std::iter::repeat_n;
use std::mem::take;
use toml_parser::parser::EventKind;

/// The width of the widest key to which others are aligned.
const WIDEST: usize = 24;

/// A line: a key with its value, a title, or nothing.
#[derive(Default)]
struct Line {
    /// The key, if it is aligned with others.
    key: Option<String>,
    /// The rest, without the `=` after the key.
    text: String,
    comment: String,
}

/// A writer, with the text so far.
#[derive(Default)]
struct Writer {
    lines: Vec<Line>,
    line: Line,
    /// The text between the last word and the next one.
    between: &'static str,
    /// Whether a line of an array begins, which is indented already.
    begins: bool,
    /// The number of arrays and tables on one line that are open.
    arrays: usize,
    tables: usize,
}

/// Returns the text of a scene as it should be written. Its form has no faults.
pub fn formatted(text: &str) -> String {
    let mut writer = Writer::default();
    for event in events(text).0 {
        writer.event(event.kind(), &text[event.span().start()..event.span().end()]);
    }
    writer.lines.push(writer.line);
    written(writer.lines, text.len())
}

impl Writer {
    fn add(&mut self, raw: &str, after: &'static str) {
        self.line.text += if self.begins { "" } else { self.between };
        self.line.text += raw;
        (self.between, self.begins) = (after, false);
    }

    /// Begins a line of an array.
    fn indent(&mut self) {
        let end = self.line.text.trim_end().len();
        self.line.text.truncate(end);
        self.line.text += &format!("\n{}", "    ".repeat(self.arrays));
        self.begins = true;
    }

    fn event(&mut self, kind: EventKind, raw: &str) {
        match kind {
            EventKind::KeyValSep if self.arrays == 0 && self.tables == 0 => {
                self.line.key = Some(take(&mut self.line.text));
                self.between = "";
            }
            EventKind::KeyValSep => {
                self.line.text += " =";
                self.between = " ";
            }
            EventKind::ValueSep => {
                self.line.text.push(',');
                (self.between, self.begins) = (" ", false);
            }
            EventKind::InlineTableOpen => {
                self.tables += 1;
                self.add("{", " ");
            }
            EventKind::InlineTableClose => {
                self.tables = self.tables.saturating_sub(1);
                self.between = if self.line.text.ends_with('{') { "" } else { " " };
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
                self.line.text += if self.begins { "" } else { " " };
                self.line.text += raw.trim_end();
                self.begins = false;
            }
            EventKind::Comment => raw.trim_end().clone_into(&mut self.line.comment),
            EventKind::Newline if self.arrays > 0 => {
                self.indent();
                self.between = "";
            }
            EventKind::Newline => {
                let line = take(&mut self.line);
                self.lines.push(line);
                (self.between, self.begins) = ("", false);
            }
            EventKind::Whitespace => {}
            _ => self.add(raw, ""),
        }
    }
}

/// Writes lines with their keys in columns, in a text of about this length in bytes.
fn written(lines: Vec<Line>, length: usize) -> String {
    let is_blank = |line: &Line| line.key.is_none() && line.text.is_empty() && line.comment.is_empty();
    let is_aligned = |line: &Line| line.key.is_some() && !line.text.starts_with('{');
    let mut kept: Vec<Line> = Vec::new();
    for line in lines {
        if !is_blank(&line) || kept.last().is_some_and(|last| !is_blank(last)) {
            kept.push(line);
        }
    }
    while kept.last().is_some_and(is_blank) {
        kept.pop();
    }
    let mut text = String::with_capacity(length);
    let mut at = 0;
    while at < kept.len() {
        let count = kept[at..].iter().take_while(|line| is_aligned(line)).count();
        let run = &kept[at..at + count.max(1)];
        let widths = run.iter().filter(|line| is_aligned(line)).filter_map(|line| line.key.as_deref());
        let width = widths.map(|key| key.chars().count()).filter(|width| *width <= WIDEST).max().unwrap_or(0);
        for line in run {
            let start = text.len();
            if let Some(key) = &line.key {
                text += key;
                text.extend(repeat_n(' ', width.saturating_sub(key.chars().count())));
                text += " = ";
            }
            text += &line.text;
            if text.len() > start {
                text.push(' ');
            }
            text += &line.comment;
            text.truncate(start + text[start..].trim_end().len());
            text.push('\n');
        }
        at += run.len();
    }
    text
}
