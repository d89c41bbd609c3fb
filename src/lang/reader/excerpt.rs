//! Renders errors and warnings as text: a message, with the lines of the scene that it marks, shortened if needed.

use super::fault::{Fault, Place, Severity};
use super::parts::{Lines, Parts};
use annotate_snippets::{AnnotationKind, Element, Level, Origin, Renderer, Snippet};
use std::ops::Range;
use tabray_core::text::{self, boundary};

/// The maximum length of an excerpt that is shown in full, in bytes, from the first marked line to the last. In a
/// longer one, each marked place is shown separately.
const WHOLE: usize = 4096;

/// The number of bytes of a long line that are shown before and after a mark, and the maximum length of the mark
/// itself.
const AROUND: usize = 48;
const MARK: usize = 64;

/// Renders an error or a warning as text.
pub fn rendered(fault: &Fault, parts: &Parts<'_>, renderer: &Renderer) -> String {
    let level = match fault.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let lines_of = parts.at(fault.start());
    let Lines { name, text, ends: newlines, .. } = lines_of;
    let title = level.primary_title(fault.message.as_str());
    let help = fault.help.as_deref().map(|help| Level::HELP.message(help));
    let similar_faults = similar_faults(fault, lines_of);
    let notes = help
        .into_iter()
        .chain(similar_faults.as_deref().map(|similar_faults| Level::NOTE.message(similar_faults)));
    let Some(place) = &fault.place else {
        return renderer.render(&[title.element(Origin::path(*name)).elements(notes)]);
    };
    let also = fault.also.iter().filter_map(|(place, label)| Some((place.as_ref()?, label.as_str())));
    let (here, elsewhere): (Vec<_>, Vec<_>) = also.partition(|(place, _)| lines_of.has(place.start));
    let marks = [(place, fault.label.as_str())].into_iter().chain(here);
    let marks: Vec<_> = marks.map(|(place, label)| (lines_of.place(place), label)).collect();
    let elsewhere: Vec<_> = elsewhere
        .into_iter()
        .map(|(place, label)| {
            let lines = parts.at(place.start);
            (Piece::of(lines.text, &lines.place(place), &lines.ends), label, lines.name)
        })
        .collect();
    let elsewhere =
        elsewhere.iter().map(|(piece, label, name)| piece.element(AnnotationKind::Context, label, name));
    // Only the marked lines are passed on, because scanning a long scene for each of many errors would be slow.
    let first = marks.iter().map(|(place, _)| place.start).min().unwrap_or(0);
    let last = marks.iter().map(|(place, _)| place.end).max().unwrap_or(0);
    let lines = lines(text, first..last, newlines);
    // The renderer shows some invisible characters in its own ways.
    let is_seen = |letter: char| letter == '\n' || letter == '\t' || !text::is_unseen(letter);
    if lines.len() <= WHOLE && text[lines.clone()].replace("\r\n", "\n").chars().all(is_seen) {
        let shift = |place: &Range<usize>| place.start - lines.start..place.end - lines.start;
        let mut kind = AnnotationKind::Primary;
        let annotations = marks.iter().map(|(place, label)| {
            let mark = std::mem::replace(&mut kind, AnnotationKind::Context).span(shift(place));
            if label.is_empty() { mark } else { mark.label(*label) }
        });
        let snippet = Snippet::source(&text[lines.clone()])
            .path(*name)
            .line_start(line(lines.start, newlines))
            .annotations(annotations);
        return renderer.render(&[title.element(snippet).elements(elsewhere).elements(notes)]);
    }
    let pieces: Vec<_> =
        marks.iter().map(|(place, label)| (Piece::of(text, place, newlines), *label)).collect();
    let mut kind = AnnotationKind::Primary;
    let elements = pieces.iter().map(|(piece, label)| {
        piece.element(std::mem::replace(&mut kind, AnnotationKind::Context), label, name)
    });
    let rendered = renderer.render(&[title.elements(elements).elements(elsewhere).elements(notes)]);
    // The renderer only knows the columns of the shortened line, which are replaced by the true ones.
    pieces.iter().fold(rendered, |rendered, (piece, _)| {
        let [shown, column] =
            [piece.shown, piece.column].map(|column| format!("{name}:{}:{column}", piece.line));
        rendered.replacen(&shown, &column, 1)
    })
}

/// Describes the similar errors that this one represents.
fn similar_faults(fault: &Fault, part: &Lines<'_>) -> Option<String> {
    let (count, places) = &fault.similar_faults;
    let here = places.iter().flatten().filter(|place| part.has(place.start));
    let mut lines: Vec<_> = here.map(|place| line(part.place(place).start, &part.ends)).collect();
    lines.dedup();
    let word = if lines.len() == 1 { "line" } else { "lines" };
    let lines = lines.iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
    let first = if lines.is_empty() { String::new() } else { format!(", first in {word} {lines}") };
    (*count > 0).then(|| format!("the same in {}{first}", text::count(*count, "more place")))
}

/// Returns the line of a byte, from 1.
fn line(at: usize, newlines: &[usize]) -> usize {
    1 + newlines.partition_point(|newline| *newline < at)
}

/// Returns the range of the lines of a place, without the last line end.
fn lines(text: &str, place: Range<usize>, newlines: &[usize]) -> Range<usize> {
    let start = newlines.partition_point(|newline| *newline < place.start);
    let start = start.checked_sub(1).map_or(0, |line| newlines[line] + 1);
    let end = newlines.get(newlines.partition_point(|newline| *newline < place.end)).copied();
    let end = end.unwrap_or(text.len());
    let end = if end > place.end && text[..end].ends_with('\r') { end - 1 } else { end };
    start..end
}

/// The line of a marked place, shortened around it if it is long, with invisible characters as escapes.
struct Piece {
    text: String,
    /// The marked range within the shortened text, in bytes.
    mark: Range<usize>,
    /// The line of the scene where the place begins, and the column there, in characters, both from 1.
    line: usize,
    column: usize,
    /// The column in the shortened text where the place begins.
    shown: usize,
}

impl Piece {
    fn of(text: &str, place: &Range<usize>, newlines: &[usize]) -> Self {
        let own = lines(text, place.start..place.start, newlines);
        let whole = own.len() <= WHOLE;
        let end = if whole { place.end } else { boundary(text, place.end.min(place.start + MARK)) };
        let mark = place.start..end.clamp(place.start, own.end.max(place.start));
        let (start, end) = if whole {
            (own.start, own.end.max(mark.end))
        } else {
            let start = boundary(text, place.start.saturating_sub(AROUND)).max(own.start);
            (start, boundary(text, mark.end + AROUND).min(own.end).max(mark.end))
        };
        let [before, after] =
            [(start > own.start), (end < own.end)].map(|is_cut| if is_cut { "…" } else { "" });
        let [left, marked, right] =
            [start..mark.start, mark.clone(), mark.end..end].map(|part| text::visible_lines(&text[part]));
        let at = before.len() + left.len();
        Self {
            shown: 1 + before.chars().count() + left.chars().count(),
            text: format!("{before}{left}{marked}{right}{after}"),
            mark: at..at + marked.len(),
            line: line(place.start, newlines),
            column: 1 + text[own.start..place.start].chars().count(),
        }
    }

    /// Returns the element for this piece and its mark, in the text with this name.
    fn element<'p>(&'p self, kind: AnnotationKind, label: &'p str, name: &'p str) -> Element<'p> {
        let mark = kind.span(self.mark.clone());
        let mark = if label.is_empty() { mark } else { mark.label(label) };
        Snippet::source(self.text.as_str()).path(name).line_start(self.line).annotation(mark).into()
    }
}

/// Returns the further places of an error: those that help to understand it, and the first few of similar errors.
pub fn others(fault: &Fault) -> impl Iterator<Item = (&Place, &str)> {
    let also = fault.also.iter().map(|(place, label)| (place, label.as_str()));
    also.chain(fault.similar_faults.1.iter().map(|place| (place, "and here")))
}
