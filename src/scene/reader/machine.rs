//! Reports for programs: a line for each fault, as editors read them, or an object of JSON.

use super::fault::{Fault, Report, Severity};
use annotate_snippets::Renderer;
use serde_json::{Value, json};
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
            format!("{}{place}: {}: {}{label}\n", self.name, fault.severity, fault.message)
        };
        self.faults.iter().map(line).collect()
    }

    /// An object of JSON for each fault, as `message` makes it, each on a line of its own.
    pub fn json(&self) -> String {
        let lines = Lines::of(&self.text);
        let line = |fault: &Fault| {
            let first = fault.place.iter().map(|place| lines.span(&self.name, place, &fault.label, true));
            let also = fault
                .also
                .iter()
                .filter_map(|(place, label)| Some(lines.span(&self.name, place.as_ref()?, label, false)));
            let rendered = self.render_fault(fault, &lines.ends, &Renderer::plain());
            let level = fault.severity.to_string();
            let help = fault.help.as_deref();
            message(&level, &fault.message, help, first.chain(also).collect(), &rendered).to_string() + "\n"
        };
        self.faults.iter().map(line).collect()
    }
}

/// A message as an object of JSON, its fields named as rustc names those of its own: `level`, `message`, `spans`
/// and `rendered`, the message as people read it; and `help`, which is null where there is none.
pub fn message(level: &str, message: &str, help: Option<&str>, spans: Vec<Value>, rendered: &str) -> Value {
    json!({ "level": level, "message": message, "help": help, "spans": spans, "rendered": rendered })
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

    fn span(&self, file: &str, place: &Range<usize>, label: &str, is_primary: bool) -> Value {
        let ((line_start, column_start), (line_end, column_end)) = (self.at(place.start), self.at(place.end));
        json!({
            "file_name": file,
            "byte_start": place.start,
            "byte_end": place.end,
            "line_start": line_start,
            "line_end": line_end,
            "column_start": column_start,
            "column_end": column_end,
            "is_primary": is_primary,
            "label": Some(label).filter(|label| !label.is_empty()),
        })
    }
}
