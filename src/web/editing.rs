//! An editor's queries about a text. Positions are numbers of UTF-16 units from its beginning, as a text area counts
//! them.

use crate::text::{NAME, view, without_files};
use serde_json::{Value, json};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tabray_editor::{self as editor, CompletionKind, Group, Text};
use tabray_lang::reader::Severity;
use tabray_lang::registry::Registry;

/// Returns the number of UTF-16 units before a byte.
fn units(text: &str, at: usize) -> usize {
    text.get(..at).map_or(0, |before| before.chars().map(char::len_utf16).sum())
}

/// Returns the byte after this many UTF-16 units, or the end of a shorter text.
fn byte(text: &str, units: usize) -> usize {
    let mut left = units;
    for (at, letter) in text.char_indices() {
        let Some(rest) = left.checked_sub(letter.len_utf16()).filter(|_| left > 0) else { return at };
        left = rest;
    }
    text.len()
}

fn place(text: &str, range: &Range<usize>) -> [usize; 2] {
    [range.start, range.end].map(|at| units(text, at))
}

/// Reads a text without other files.
fn read(registry: &Registry, text: &str) -> Group {
    let view = Arc::new(view(registry, text));
    vec![(PathBuf::from(NAME), view)]
}

/// Returns the faults of a scene, each with its place and its correction.
pub fn diagnose(registry: &Registry, text: &str) -> Vec<Value> {
    let whole = Text::new(text);
    let told = |fault: editor::Diagnosis| {
        let [start, end] = fault.range.map(|position| units(text, whole.offset(position)));
        let severity = if fault.severity == Severity::Error { "error" } else { "warning" };
        json!({
            "severity": severity,
            "message": without_files(&fault.message),
            "line": fault.range[0].line + 1,
            "place": [start, end],
            "marked": fault.marked,
            "meant": fault.meant,
        })
    };
    editor::diagnose(registry, Path::new(NAME), text, &[]).into_iter().map(told).collect()
}

/// Returns the completions at a position.
pub fn completions(registry: &Registry, text: &str, at: usize) -> Vec<Value> {
    let group = read(registry, text);
    let told = |proposal: editor::Completion| {
        let kind = match proposal.kind {
            CompletionKind::Type => "type",
            CompletionKind::Attribute => "attribute",
            CompletionKind::Choice => "choice",
            CompletionKind::Name => "name",
            CompletionKind::File | CompletionKind::Folder => "file",
            CompletionKind::Number => "number",
            CompletionKind::Function => "function",
            CompletionKind::Keyword => "word",
        };
        json!({
            "label": proposal.label,
            "kind": kind,
            "detail": proposal.detail,
            "about": proposal.about,
            "snippet": proposal.snippet,
            "has_places": proposal.has_places,
            "place": place(text, &proposal.place),
        })
    };
    editor::completions(registry, &group, byte(text, at)).into_iter().map(told).collect()
}

/// Returns the meaning of a word, in Markdown, and its place.
pub fn hover(registry: &Registry, text: &str, at: usize) -> Option<Value> {
    let found = editor::hover(&read(registry, text), byte(text, at))?;
    Some(json!({ "text": found.text, "place": place(text, &found.place) }))
}

/// Returns the values of the attribute at a position.
pub fn signature(registry: &Registry, text: &str, at: usize) -> Option<Value> {
    let group = read(registry, text);
    let (_, view) = group.first()?;
    let found = editor::signature(view, byte(text, at))?;
    let values: Vec<_> = found.values.iter().map(|value| [value.start, value.end]).collect();
    Some(json!({ "label": found.label, "values": values, "active": found.active }))
}

/// Returns the formatted text.
///
/// # Errors
/// Returns why the text cannot be formatted.
pub fn formatted(registry: &Registry, text: &str) -> Result<String, String> {
    let view = view(registry, text);
    editor::formatted(&view).ok_or_else(|| {
        let what = editor::problem(&view).map_or_else(String::new, |fault| fault.message);
        format!("a scene with syntax errors cannot be formatted: {what}")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_utf_16_are_counted() {
        let text = "a\u{1f600}b\nß";
        for (at, count) in [(0, 0), (1, 1), (5, 3), (6, 4), (7, 5), (9, 6)] {
            assert_eq!((units(text, at), byte(text, count)), (count, at));
        }
        assert_eq!(byte(text, 2), 1, "within a character: before it");
        assert_eq!(byte(text, 99), text.len());
    }
}
