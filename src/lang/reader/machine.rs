//! Reports for other programs: one line per fault in the format of editors, or one JSON object per fault.

use super::excerpt::{self, rendered};
use super::fault::{Fault, Severity};
use super::parts::Parts;
use super::report::Report;
use annotate_snippets::Renderer;
use serde::Serialize;
use std::fmt;
use std::ops::Range;
use tabray_core::text;

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
        let parts = self.parts();
        let line = |fault: &Fault| {
            let place = fault.place.as_ref().map(|place| {
                let lines = parts.at(place.start);
                let (line, column) = lines.line_and_column(lines.place(place).start);
                format!("{}:{line}:{column}", lines.name)
            });
            let place = place.unwrap_or_else(|| self.name.clone());
            let label = if fault.label.is_empty() { String::new() } else { format!(": {}", fault.label) };
            let label = label + &fault.more();
            format!("{place}: {}: {}{label}\n", fault.severity, fault.message)
        };
        let rest = self.rest().map(|rest| format!("{}: {rest}\n", self.name));
        self.faults.iter().map(line).chain(rest).collect()
    }

    /// Writes one JSON object per fault, a `Message`, each on its own line.
    pub fn json(&self) -> String {
        let parts = self.parts();
        let line = |fault: &Fault| {
            let first = fault.place.iter().map(|place| span(&parts, place, &fault.label, true));
            let also = excerpt::others(fault)
                .filter_map(|(place, label)| Some(span(&parts, place.as_ref()?, label, false)));
            Message {
                help: fault.help.as_deref(),
                level: &fault.severity.to_string(),
                message: &fault.message,
                rendered: &rendered(fault, &parts, &Renderer::plain()),
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
    /// The correction, or null.
    pub help: Option<&'m str>,
    /// `error`, `warning` or `note`.
    pub level: &'m str,
    /// The error, or the action.
    pub message: &'m str,
    /// The message for people, without colours.
    pub rendered: &'m str,
    /// The places in the scene, or none if the message is not about a scene.
    pub spans: Vec<Span<'m>>,
}

impl Message<'_> {
    /// Returns the message as JSON, on its own line.
    pub fn line(&self) -> String {
        text::json(self) + "\n"
    }
}

/// A place in a scene. Bytes count from 0, after a byte order mark. Lines and columns count from 1, columns in
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
    /// The scene as named on the command line, `<stdin>` for standard input, an included file, or `--set`.
    pub file_name: &'m str,
    /// Whether the message is about this place. Other places help to understand it.
    pub is_primary: bool,
    /// A note about the place, or null.
    pub label: Option<&'m str>,
    /// The last line of the place.
    pub line_end: usize,
    /// The first line of the place.
    pub line_start: usize,
}

/// Describes a place in one of the parts of a scene.
fn span<'m>(parts: &Parts<'m>, place: &Range<usize>, label: &'m str, is_primary: bool) -> Span<'m> {
    let lines = parts.at(place.start);
    let place = lines.place(place);
    let ((line_start, column_start), (line_end, column_end)) =
        (lines.line_and_column(place.start), lines.line_and_column(place.end));
    let label = Some(label).filter(|label| !label.is_empty());
    let Range { start: byte_start, end: byte_end } = place;
    Span {
        byte_end,
        byte_start,
        column_end,
        column_start,
        file_name: lines.name,
        is_primary,
        label,
        line_end,
        line_start,
    }
}
