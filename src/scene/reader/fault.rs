//! Faults: what is wrong with a scene, where, and what would be right.

use crate::words;
use std::ops::Range;

/// The most places of other faults that one of them names.
const PLACES: usize = 3;

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
    /// How many other faults it stands for that differ in their places alone, and the first of those places.
    pub alike: (usize, Vec<Place>),
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
            alike: (0, Vec::new()),
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

    pub(super) fn start(&self) -> usize {
        self.place.as_ref().map_or(0, |place| place.start)
    }

    /// How many it stands for, in brackets; empty where that is itself alone.
    pub(super) fn more(&self) -> String {
        let (count, _) = self.alike;
        if count == 0 { String::new() } else { format!(" (and in {})", words::count(count, "more place")) }
    }

    /// Counts another fault that is like it, and keeps its place if that is one of the first.
    pub(super) fn stand_for(&mut self, place: Place) {
        let (count, places) = &mut self.alike;
        *count += 1;
        if places.len() < PLACES {
            places.push(place);
        }
    }

    pub(super) fn is_like(&self, other: &Self) -> bool {
        self.severity == other.severity && self.message == other.message
    }

    /// Cuts what is too long to be read, and what might look like a message of its own: a name with a line end. Its
    /// places then lie in this text, and none begins after it ends.
    pub(super) fn tidy(&mut self, text: &str) {
        let also = self.also.iter_mut().map(|(place, label)| (place, label));
        for (place, label) in also.chain([(&mut self.place, &mut self.label)]) {
            *label = words::abridged(label).into_owned();
            if let Some(place) = place {
                let (one, other) = (words::boundary(text, place.start), words::boundary(text, place.end));
                *place = one.min(other)..one.max(other);
            }
        }
        self.help = self.help.as_deref().map(|help| words::abridged(help).into_owned());
        self.message = words::abridged(&self.message).replace(char::is_control, "\u{fffd}");
    }
}
