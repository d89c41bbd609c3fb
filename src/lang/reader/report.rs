//! All faults of a scene. The first ones are listed, and the others are counted.

use super::excerpt::rendered;
use super::fault::{Fault, Place, Severity};
use super::guesses::Guesses;
use super::parts::{Parts, TextPart};
use crate::syntax::Syntax;
use annotate_snippets::Renderer;
use std::borrow::Cow;
use std::fmt;
use std::ops::Range;
use std::path::PathBuf;
use tabray_core::text;

/// The maximum number of listed errors of a scene, and that of listed warnings. The others are counted.
const MAX_LISTED: usize = 100;

/// The maximum number of faults that differ only in their places and are listed separately. If there are more, only the
/// first is listed, with their number.
const MAX_ALIKE: usize = 8;

/// The maximum number of repeated ranges of a text that are kept.
const MAX_REPEATED: usize = 1000;

/// The number of syntax errors after which the rest of a scene is not read.
const MAX_ERRORS: usize = 100_000;

/// The faults of one scene, in the order of its text: all of them, or the first ones and the number of all.
#[derive(Clone, Debug, Default)]
pub struct Report<'t> {
    pub(super) name: String,
    pub(super) text: Cow<'t, str>,
    syntax: Syntax,
    pub(super) faults: Vec<Fault>,
    notes: Box<Notes>,
    files: Vec<PathBuf>,
}

/// The data of a report beside the faults. It is boxed to make moving a report cheap.
#[derive(Clone, Debug, Default)]
struct Notes {
    /// The number of errors and of warnings, listed or not.
    counts: [usize; 2],
    /// The number of errors and of warnings that are listed separately.
    told: [usize; 2],
    is_cut_short: bool,
    guesses: Guesses,
    /// The parts of the text, if there are several.
    parts: Vec<TextPart>,
    /// The ranges of the text that are read more than once. For each place in such a range, only one fault is listed.
    repeated: Vec<Range<usize>>,
}

impl<'t> Report<'t> {
    /// Makes an empty report on a scene's text. `name` is the scene's name in messages.
    pub fn new(name: impl Into<String>, text: impl Into<Cow<'t, str>>, syntax: Syntax) -> Self {
        Self { name: name.into(), text: text.into(), syntax, ..Self::default() }
    }

    /// Divides the text into named parts.
    pub(super) fn in_parts(mut self, parts: &[TextPart]) -> Self {
        self.notes.parts = parts.to_vec();
        self
    }

    /// Notes that a range of the text is read more than once. For each place in it, only one fault is listed.
    pub(super) fn repeat(&mut self, range: Range<usize>) {
        if self.notes.repeated.len() < MAX_REPEATED {
            self.notes.repeated.push(range);
        }
    }

    /// Returns the report with its own copy of the text, if the text is needed.
    pub(super) fn into_owned(self) -> Report<'static> {
        let is_shown = !self.faults.is_empty();
        let text = if is_shown { self.text.into_owned() } else { String::new() };
        let Self { name, syntax, faults, mut notes, files, .. } = self;
        notes.parts = if is_shown { notes.parts } else { Vec::new() };
        Report { name, text: text.into(), syntax, faults, notes, files }
    }

    /// Removes the places of all faults, for a generated text.
    pub fn without_places(mut self) -> Self {
        for fault in &mut self.faults {
            fault.place = None;
            fault.also.clear();
            fault.similar_faults.1.clear();
        }
        self
    }

    /// Returns the syntax of corrections in messages.
    pub fn syntax(&self) -> Syntax {
        self.syntax
    }

    /// Adds a fault in the order of the text, or counts it if enough others come before it.
    pub fn add(&mut self, mut fault: Fault) {
        if self.conceal(&mut fault) && self.faults.iter().any(|told| told.is_like(&fault)) {
            return;
        }
        self.notes.counts[fault.severity as usize] += 1;
        fault.tidy(&self.text);
        if self.is_again(&fault) {
            return;
        }
        let gathered = |told: &&mut Fault| told.similar_faults.0 > 0 && told.is_like(&fault);
        if let Some(first) = self.faults.iter_mut().find(gathered) {
            first.count_similar(fault.place);
        } else if self.would_list(fault.severity, &fault.place) {
            self.insert(fault);
        }
    }

    /// Replaces a fault in a part whose text is not shown. Tells whether the fault is in such a part.
    fn conceal(&self, fault: &mut Fault) -> bool {
        let part_at = |place: &Place| {
            let place = place.as_ref()?;
            let after = self.notes.parts.partition_point(|part| part.range.start <= place.start);
            self.notes.parts.get(after.checked_sub(1)?).filter(|part| part.included_at.is_some())
        };
        fault.also.retain(|(place, _)| part_at(place).is_none());
        let mut concealed = false;
        while let Some(part) = part_at(&fault.place) {
            concealed = true;
            let what = match fault.severity {
                Severity::Error => "is not a scene",
                Severity::Warning => "may not mean what was intended",
            };
            *fault = Fault {
                severity: fault.severity,
                ..Fault::error(part.included_at.clone(), format!("`{}` {what}", part.name))
                    .help("faults are shown only in files whose names end in .ray or .toml")
            };
        }
        concealed
    }

    /// Adds a fault that represents similar ones.
    pub(super) fn add_gathered(&mut self, mut fault: Fault) {
        if self.conceal(&mut fault) {
            return self.add(fault);
        }
        self.notes.counts[fault.severity as usize] += 1 + fault.similar_faults.0;
        fault.tidy(&self.text);
        self.insert(fault);
    }

    /// Shows the faults in another version of the scene's own text, in which each character has the same place.
    pub(super) fn shows_in_place(&mut self, own: &str) {
        let mut text = own.to_owned();
        text += self.text.get(own.len()..).unwrap_or_default();
        // A place may begin or end within a character there, in place of several characters here.
        for fault in &mut self.faults {
            fault.tidy(&text);
        }
        self.text = text.into();
    }

    /// Tells whether a fault was found before, in another round of a repeated text.
    fn is_again(&self, fault: &Fault) -> bool {
        let is_repeated = |at: &usize| self.notes.repeated.iter().any(|range| range.contains(at));
        let is_there = fault.place.as_ref().is_some_and(|place| is_repeated(&place.start));
        is_there
            && self.faults.iter().any(|told| told.severity == fault.severity && told.place == fault.place)
    }

    /// Counts faults after so many others that none would be listed.
    pub(super) fn count_more(&mut self, severity: Severity, count: usize) {
        self.notes.counts[severity as usize] += count;
    }

    fn insert(&mut self, fault: Fault) {
        let severity = fault.severity as usize;
        if self.faults.iter().filter(|told| told.is_like(&fault)).count() == MAX_ALIKE {
            let mut like: Vec<_> = self.faults.extract_if(.., |told| told.is_like(&fault)).collect();
            let mut first = like.remove(0);
            like.into_iter().chain([fault]).for_each(|fault| first.count_similar(fault.place));
            self.notes.told[severity] -= MAX_ALIKE;
            return self.insert(first);
        }
        let at = self.faults.partition_point(|earlier| earlier.start() <= fault.start());
        self.faults.insert(at, fault);
        self.notes.told[severity] += 1;
        if self.notes.told[severity] > MAX_LISTED
            && let Some(last) = self.faults.iter().rposition(|told| told.severity as usize == severity)
        {
            self.faults.remove(last);
            self.notes.told[severity] -= 1;
        }
    }

    /// Tells whether a fault at a place would be listed. If not, its correction need not be found.
    pub(super) fn would_list(&self, severity: Severity, place: &Place) -> bool {
        let is_after = |told: &Fault| place.as_ref().map_or(0, |place| place.start) >= told.start();
        let last = self.faults.iter().rfind(|told| told.severity == severity);
        self.notes.told[severity as usize] < MAX_LISTED || !last.is_some_and(is_after)
    }

    /// Returns the listed faults, in the order of the text.
    pub fn faults(&self) -> &[Fault] {
        &self.faults
    }

    /// Returns the files that the scene names, whether they exist or not.
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// Adds a file that the scene names.
    pub(super) fn add_file(&mut self, file: PathBuf) {
        self.files.push(file);
    }

    /// Tells whether any fault is an error.
    pub fn is_fatal(&self) -> bool {
        self.count(Severity::Error) > 0
    }

    /// Tells whether there are so many errors that reading stops. From then on, the report is marked as cut short.
    pub fn has_enough(&mut self) -> bool {
        self.notes.is_cut_short |= self.count(Severity::Error) >= MAX_ERRORS;
        self.notes.is_cut_short
    }

    /// Returns the guesses for misspelt attributes.
    pub(super) fn guesses(&mut self) -> &mut Guesses {
        &mut self.notes.guesses
    }

    /// Returns the number of faults with this severity, listed or not.
    pub fn count(&self, severity: Severity) -> usize {
        self.notes.counts[severity as usize]
    }

    /// Describes the number of faults beside the listed ones.
    pub(super) fn rest(&self) -> Option<String> {
        let told = |severity| {
            let told = self.faults.iter().filter(|fault| fault.severity == severity);
            told.map(|fault| 1 + fault.similar_faults.0).sum::<usize>()
        };
        let rest =
            [(Severity::Error, "more error"), (Severity::Warning, "more warning")].map(|(severity, noun)| {
                let rest = self.count(severity) - told(severity);
                (rest > 0).then(|| text::count(rest, noun))
            });
        let rest: Vec<_> = rest.into_iter().flatten().collect();
        let cut = if self.notes.is_cut_short { "; the rest of the scene was not read" } else { "" };
        (!rest.is_empty()).then(|| format!("and {}{cut}", rest.join(" and ")))
    }

    /// Renders the faults as text with terminal colours.
    pub fn styled(&self) -> String {
        self.render(&Renderer::styled())
    }

    fn render(&self, renderer: &Renderer) -> String {
        let mut text = String::new();
        let parts = self.parts();
        for fault in &self.faults {
            text += &rendered(fault, &parts, renderer);
            text += "\n\n";
        }
        if let Some(rest) = self.rest() {
            text += &format!("{rest}\n\n");
        }
        if self.is_fatal() {
            let mut counts = text::count(self.count(Severity::Error), "error");
            if self.count(Severity::Warning) > 0 {
                counts = format!("{counts}, {}", text::count(self.count(Severity::Warning), "warning"));
            }
            text += &format!("{}: {counts}\n", self.name);
        }
        text
    }

    /// Returns the parts of the scene's text, with their lines.
    pub(super) fn parts(&self) -> Parts<'_> {
        Parts::of(&self.name, &self.text, &self.notes.parts)
    }
}

/// Renders the faults as plain text, without colours.
impl fmt::Display for Report<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(&Renderer::plain()))
    }
}

impl std::error::Error for Report<'_> {}
