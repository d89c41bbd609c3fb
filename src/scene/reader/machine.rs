//! Reports for programs: a line for each fault, as editors read them, or an object of JSON.

use super::excerpt;
use super::fault::{Fault, Severity};
use super::report::Report;
use crate::words;
use annotate_snippets::Renderer;
use serde::Serialize;
use std::fmt;
use std::ops::Range;

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Error => "error",
            Self::Warning => "warning",
        })
    }
}

impl Report {
    /// A line for each fault, `FILE:LINE:COLUMN: error: MESSAGE`. Lines count from 1, and so do columns, in characters.
    pub fn short(&self) -> String {
        let lines = Lines::of(&self.text);
        let line = |fault: &Fault| {
            let place = fault.place.as_ref().map(|place| lines.at(place.start));
            let place = place.map(|(line, column)| format!(":{line}:{column}")).unwrap_or_default();
            let label = if fault.label.is_empty() { String::new() } else { format!(": {}", fault.label) };
            let label = label + &fault.more();
            format!("{}{place}: {}: {}{label}\n", self.name, fault.severity, fault.message)
        };
        let rest = self.rest().map(|rest| format!("{}: {rest}\n", self.name));
        self.faults.iter().map(line).chain(rest).collect()
    }

    /// an object of JSON for each fault, a `Message`, each on a line of its own.
    pub fn json(&self) -> String {
        let lines = Lines::of(&self.text);
        let line = |fault: &Fault| {
            let first = fault.place.iter().map(|place| lines.span(&self.name, place, &fault.label, true));
            let also = excerpt::others(fault)
                .filter_map(|(place, label)| Some(lines.span(&self.name, place.as_ref()?, label, false)));
            Message {
                help: fault.help.as_deref(),
                level: &fault.severity.to_string(),
                message: &fault.message,
                rendered: &self.render_fault(fault, &lines.ends, &Renderer::plain()),
                spans: first.chain(also).collect(),
            }
            .line()
        };
        let rest = self.rest().map(|rest| {
            Message { help: None, level: "note", message: &rest, rendered: &rest, spans: Vec::new() }.line()
        });
        self.faults.iter().map(line).chain(rest).collect()
    }
}

/// A message for programs: an object of JSON, its fields named after those of rustc.
#[derive(Serialize)]
pub struct Message<'m> {
    /// What would be right, or null.
    pub help: Option<&'m str>,
    /// `error`, `warning` or `note`.
    pub level: &'m str,
    /// What is wrong, or what was done.
    pub message: &'m str,
    /// The message as people read it, without colours.
    pub rendered: &'m str,
    /// The places in the scene, none where the message is about no scene.
    pub spans: Vec<Span<'m>>,
}

impl Message<'_> {
    /// Its JSON, on a line of its own.
    pub fn line(&self) -> String {
        words::json(self) + "\n"
    }
}

/// A place in a scene. Bytes count from 0, after a byte order mark; lines and columns from 1, columns in characters.
#[derive(Serialize)]
pub struct Span<'m> {
    /// The byte behind its last one.
    pub byte_end: usize,
    /// Its first byte.
    pub byte_start: usize,
    /// The column behind its last one.
    pub column_end: usize,
    /// Its first column.
    pub column_start: usize,
    /// The scene as the command line names it, `<stdin>` for standard input.
    pub file_name: &'m str,
    /// Whether it is what the message is about; others help to understand.
    pub is_primary: bool,
    /// A few words about the place, or null.
    pub label: Option<&'m str>,
    /// Its last line.
    pub line_end: usize,
    /// Its first line.
    pub line_start: usize,
}

/// A text's lines.
struct Lines<'t> {
    text: &'t str,
    /// Where each line ends, but for the last one.
    ends: Vec<usize>,
}

impl<'t> Lines<'t> {
    fn of(text: &'t str) -> Self {
        Self { text, ends: text.match_indices('\n').map(|(at, _)| at).collect() }
    }

    /// The line and the column of a byte, both from 1.
    fn at(&self, byte: usize) -> (usize, usize) {
        let before = self.ends.partition_point(|end| *end < byte);
        let start = before.checked_sub(1).map_or(0, |line| self.ends[line] + 1);
        (1 + before, 1 + self.text[start..byte].chars().count())
    }

    fn span<'m>(
        &self,
        file_name: &'m str,
        place: &Range<usize>,
        label: &'m str,
        is_primary: bool,
    ) -> Span<'m> {
        let ((line_start, column_start), (line_end, column_end)) = (self.at(place.start), self.at(place.end));
        let label = Some(label).filter(|label| !label.is_empty());
        let Range { start: byte_start, end: byte_end } = *place;
        Span {
            byte_end,
            byte_start,
            column_end,
            column_start,
            file_name,
            is_primary,
            label,
            line_end,
            line_start,
        }
    }
}
