//! Faults: what is wrong with a scene, where, and what would be right.

use crate::scene::syntax::Syntax;
use crate::words;
use annotate_snippets::{AnnotationKind, Level, Origin, Renderer, Snippet};
use std::fmt;
use std::ops::Range;
use std::path::PathBuf;

/// Where something stands in a scene's text, in bytes; nothing for what was built without a text.
pub type Place = Option<Range<usize>>;

/// How bad a fault is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The scene has no meaning.
    Error,
    /// The scene has a meaning, perhaps not the one intended.
    Warning,
}

/// One thing that is wrong with a scene.
#[derive(Clone, Debug)]
pub struct Fault {
    /// How bad it is.
    pub severity: Severity,
    /// What is wrong: lower case, no full stop, names in backticks.
    pub message: String,
    /// The words to mark.
    pub place: Place,
    /// What to write beside the mark; may be empty.
    pub label: String,
    /// Other places that help to understand, with a few words each.
    pub also: Vec<(Place, String)>,
    /// What would be right.
    pub help: Option<String>,
}

impl Fault {
    /// A fault that leaves the scene without a meaning.
    pub fn error(place: Place, message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Error,
            message: message.into(),
            place,
            label: String::new(),
            also: Vec::new(),
            help: None,
        }
    }

    /// A fault that leaves the scene a meaning.
    pub fn warning(place: Place, message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(place, message) }
    }

    /// With a few words beside the mark.
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// With another place that helps to understand.
    pub fn also(mut self, place: Place, label: impl Into<String>) -> Self {
        self.also.push((place, label.into()));
        self
    }

    /// With what would be right.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    fn title(&self) -> annotate_snippets::Title<'_> {
        let level = match self.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
        };
        level.primary_title(self.message.as_str())
    }
}

/// All faults of one scene, in the order of its text.
#[derive(Clone, Debug, Default)]
pub struct Report {
    pub(super) name: String,
    pub(super) text: String,
    syntax: Syntax,
    pub(super) faults: Vec<Fault>,
    files: Vec<PathBuf>,
}

impl Report {
    /// A report without faults on a scene's text; `name` is what messages call it.
    pub fn new(name: impl Into<String>, text: impl Into<String>, syntax: Syntax) -> Self {
        Self { name: name.into(), text: text.into(), syntax, faults: Vec::new(), files: Vec::new() }
    }

    /// The spelling in which messages tell what would be right.
    pub fn syntax(&self) -> Syntax {
        self.syntax
    }

    /// Adds a fault at its place in the order.
    pub fn add(&mut self, mut fault: Fault) {
        // A name with a line end must not look like a message of its own.
        if fault.message.contains(char::is_control) {
            fault.message = fault.message.replace(char::is_control, "\u{fffd}");
        }
        let start = |fault: &Fault| fault.place.as_ref().map_or(0, |place| place.start);
        let at = self.faults.partition_point(|earlier| start(earlier) <= start(&fault));
        self.faults.insert(at, fault);
    }

    /// The faults, in the order of the text.
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

    fn count(&self, severity: Severity) -> usize {
        self.faults.iter().filter(|fault| fault.severity == severity).count()
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
        let help = fault.help.as_deref().map(|help| Level::HELP.message(help));
        let Some(place) = &fault.place else {
            let origin = Origin::path(self.name.as_str());
            return renderer.render(&[fault.title().element(origin).elements(help)]);
        };
        // Only the lines that are marked: a long scene with many faults must not be read over and over.
        let places = || fault.also.iter().filter_map(|(place, _)| place.as_ref()).chain([place]);
        let first = places().map(|place| place.start).min().unwrap_or(0);
        let last = places().map(|place| place.end).max().unwrap_or(0);
        let lines_before = newlines.partition_point(|newline| *newline < first);
        let start = lines_before.checked_sub(1).map_or(0, |line| newlines[line] + 1);
        let end = newlines.get(newlines.partition_point(|newline| *newline < last)).copied();
        let end = end.unwrap_or(self.text.len());
        let end = if end > last && self.text[..end].ends_with('\r') { end - 1 } else { end };
        let shift = |place: &Range<usize>| place.start - start..place.end - start;

        let mark = AnnotationKind::Primary.span(shift(place));
        let mark = if fault.label.is_empty() { mark } else { mark.label(fault.label.as_str()) };
        let also = fault.also.iter().filter_map(|(place, label)| {
            Some(AnnotationKind::Context.span(shift(place.as_ref()?)).label(label.as_str()))
        });
        let snippet = Snippet::source(&self.text[start..end])
            .path(self.name.as_str())
            .line_start(1 + lines_before)
            .annotation(mark)
            .annotations(also);
        renderer.render(&[fault.title().element(snippet).elements(help)])
    }
}

/// Plain text, free of colour.
impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(&Renderer::plain()))
    }
}

impl std::error::Error for Report {}
