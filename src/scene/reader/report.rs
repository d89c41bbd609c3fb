//! All faults of a scene: the first of them are told, and the rest is counted.

use super::excerpt;
use super::fault::{Fault, Place, Severity};
use super::guesses::Guesses;
use crate::scene::syntax::Syntax;
use crate::words;
use annotate_snippets::Renderer;
use std::fmt;
use std::path::PathBuf;

/// The most errors of one scene that are told, and likewise the most warnings. The rest is counted.
const TOLD: usize = 100;

/// The most faults that differ in their places alone and are told one by one. Of more only the first is told, with
/// their number.
const ALIKE: usize = 8;

/// After so many errors in its form a scene is read no farther.
const ENOUGH: usize = 100_000;

/// The faults of one scene, in the order of its text: all of a few, the first of many, and how many there are.
#[derive(Clone, Debug, Default)]
pub struct Report {
    pub(super) name: String,
    pub(super) text: String,
    syntax: Syntax,
    pub(super) faults: Vec<Fault>,
    notes: Box<Notes>,
    files: Vec<PathBuf>,
}

/// What a report knows beside the faults themselves. It is kept elsewhere, so that a report is small to hand on.
#[derive(Clone, Debug, Default)]
struct Notes {
    /// How many errors and warnings there are, told or not.
    counts: [usize; 2],
    /// How many of them are told each on its own.
    told: [usize; 2],
    is_cut_short: bool,
    guesses: Guesses,
}

impl Report {
    /// A report without faults on a scene's text; `name` is what messages call it.
    pub fn new(name: impl Into<String>, text: impl Into<String>, syntax: Syntax) -> Self {
        Self { name: name.into(), text: text.into(), syntax, ..Self::default() }
    }

    /// The spelling in which messages tell what would be right.
    pub fn syntax(&self) -> Syntax {
        self.syntax
    }

    /// Adds a fault at its place in the order, or counts it where it comes after enough others.
    pub fn add(&mut self, mut fault: Fault) {
        self.notes.counts[fault.severity as usize] += 1;
        fault.tidy(&self.text);
        let gathered = |told: &&mut Fault| told.alike.0 > 0 && told.is_like(&fault);
        if let Some(first) = self.faults.iter_mut().find(gathered) {
            first.stand_for(fault.place);
        } else if self.tells(fault.severity, &fault.place) {
            self.insert(fault);
        }
    }

    fn insert(&mut self, fault: Fault) {
        let severity = fault.severity as usize;
        if self.faults.iter().filter(|told| told.is_like(&fault)).count() == ALIKE {
            let mut like: Vec<_> = self.faults.extract_if(.., |told| told.is_like(&fault)).collect();
            let mut first = like.remove(0);
            like.into_iter().chain([fault]).for_each(|fault| first.stand_for(fault.place));
            self.notes.told[severity] -= ALIKE;
            return self.insert(first);
        }
        let at = self.faults.partition_point(|earlier| earlier.start() <= fault.start());
        self.faults.insert(at, fault);
        self.notes.told[severity] += 1;
        if self.notes.told[severity] > TOLD
            && let Some(last) = self.faults.iter().rposition(|told| told.severity as usize == severity)
        {
            self.faults.remove(last);
            self.notes.told[severity] -= 1;
        }
    }

    /// Whether a fault there would be told. If not, there is no need to look for what would be right.
    pub(super) fn tells(&self, severity: Severity, place: &Place) -> bool {
        let is_after = |told: &Fault| place.as_ref().map_or(0, |place| place.start) >= told.start();
        let last = self.faults.iter().rfind(|told| told.severity == severity);
        self.notes.told[severity as usize] < TOLD || !last.is_some_and(is_after)
    }

    /// The faults that are told, in the order of the text.
    pub fn faults(&self) -> &[Fault] {
        &self.faults
    }

    /// The files that the scene names, whether they are there or not.
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// Adds a file that the scene names.
    pub(super) fn add_file(&mut self, file: PathBuf) {
        self.files.push(file);
    }

    /// Whether any fault leaves the scene without a meaning.
    pub fn is_fatal(&self) -> bool {
        self.count(Severity::Error) > 0
    }

    /// Whether there are so many errors that reading on is of no use. Then nothing is said of what follows.
    pub(super) fn has_enough(&mut self) -> bool {
        self.notes.is_cut_short |= self.count(Severity::Error) >= ENOUGH;
        self.notes.is_cut_short
    }

    /// What misspelt attributes were taken for.
    pub(super) fn guesses(&mut self) -> &mut Guesses {
        &mut self.notes.guesses
    }

    /// How many faults of this severity there are, whether they are told or not.
    pub fn count(&self, severity: Severity) -> usize {
        self.notes.counts[severity as usize]
    }

    /// How many faults there are beside those that are told, in words.
    pub(super) fn rest(&self) -> Option<String> {
        let told = |severity| {
            let told = self.faults.iter().filter(|fault| fault.severity == severity);
            told.map(|fault| 1 + fault.alike.0).sum::<usize>()
        };
        let rest =
            [(Severity::Error, "more error"), (Severity::Warning, "more warning")].map(|(severity, noun)| {
                let rest = self.count(severity) - told(severity);
                (rest > 0).then(|| words::count(rest, noun))
            });
        let rest: Vec<_> = rest.into_iter().flatten().collect();
        let cut = if self.notes.is_cut_short { "; the rest of the scene was not read" } else { "" };
        (!rest.is_empty()).then(|| format!("and {}{cut}", rest.join(" and ")))
    }

    /// The faults as text for a terminal that knows colours.
    pub fn styled(&self) -> String {
        self.render(&Renderer::styled())
    }

    fn render(&self, renderer: &Renderer) -> String {
        let mut text = String::new();
        let newlines: Vec<usize> = self.text.match_indices('\n').map(|(at, _)| at).collect();
        for fault in &self.faults {
            text += &self.render_fault(fault, &newlines, renderer);
            text += "\n\n";
        }
        if let Some(rest) = self.rest() {
            text += &format!("{rest}\n\n");
        }
        if self.is_fatal() {
            let mut counts = words::count(self.count(Severity::Error), "error");
            if self.count(Severity::Warning) > 0 {
                counts = format!("{counts}, {}", words::count(self.count(Severity::Warning), "warning"));
            }
            text += &format!("{}: {counts}\n", self.name);
        }
        text
    }

    pub(super) fn render_fault(&self, fault: &Fault, newlines: &[usize], renderer: &Renderer) -> String {
        excerpt::rendered(fault, (&self.name, &self.text), newlines, renderer)
    }
}

/// Plain text, free of colour.
impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(&Renderer::plain()))
    }
}

impl std::error::Error for Report {}
