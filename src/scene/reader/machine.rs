//! Reports for other programs: one line per fault, as editors read them, or one JSON object per fault.

use super::excerpt;
use super::fault::{Fault, Severity};
use super::report::Report;
use crate::text;
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

impl Report<'_> {
    /// Writes one line per fault, `FILE:LINE:COLUMN: error: MESSAGE`. Lines and columns count from 1, columns in
    /// characters.
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

    /// Writes one JSON object per fault, a `Message`, each on a line of its own.
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

/// A message for other programs: a JSON object, with fields named after those of rustc.
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
    /// The places in the scene; empty where the message is not about a scene.
    pub spans: Vec<Span<'m>>,
}

impl Message<'_> {
    /// Returns the message as JSON, on a line of its own.
    pub fn line(&self) -> String {
        text::json(self) + "\n"
    }
}

/// A place in a scene. Bytes count from 0, after a byte order mark; lines and columns count from 1, columns in
/// characters.
#[derive(Serialize)]
pub struct Span<'m> {
    /// The first byte after the place.
    pub byte_end: usize,
    /// The first byte of the place.
    pub byte_start: usize,
    /// The first column after the place, on its last line.
    pub column_end: usize,
    /// The first column of the place.
    pub column_start: usize,
    /// The scene as the command line names it, `<stdin>` for standard input.
    pub file_name: &'m str,
    /// Whether the message is about this place; other places help to understand it.
    pub is_primary: bool,
    /// A few words about the place, or null.
    pub label: Option<&'m str>,
    /// The last line of the place.
    pub line_end: usize,
    /// The first line of the place.
    pub line_start: usize,
}

/// The lines of a text.
struct Lines<'t> {
    text: &'t str,
    /// The positions of the line ends, in bytes, without that of the last line.
    ends: Vec<usize>,
}

impl<'t> Lines<'t> {
    fn of(text: &'t str) -> Self {
        Self { text, ends: text.match_indices('\n').map(|(at, _)| at).collect() }
    }

    /// Returns the line and the column of a byte, both from 1.
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
