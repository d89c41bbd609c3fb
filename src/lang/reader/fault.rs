//! Faults: the errors and warnings of a scene, with their places and corrections.

use std::ops::Range;
use tabray_core::text;

/// The maximum number of places of similar faults that one fault lists.
const PLACES: usize = 3;

/// A range of a scene's text, in bytes, or `None` for an entity built without a text. The texts of included files and
/// of options that set values follow the scene's own text.
pub type Place = Option<Range<usize>>;

/// The places of a scene's entities, each from its type to its end, by their orders.
#[derive(Clone, Debug, Default)]
pub struct Places(Vec<[u32; 2]>);

impl Places {
    /// Adds the place of the next entity.
    pub(super) fn add(&mut self, place: &Place) {
        let place = place.as_ref().map(|place| [place.start as u32, place.end as u32]);
        self.0.push(place.unwrap_or([u32::MAX; 2]));
    }

    /// Tells whether there are no entities.
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns the place of the entity with this [order](tabray_core::scene::Record::order).
    pub fn get(&self, order: usize) -> Place {
        let [start, end] = self.0.get(order).filter(|place| **place != [u32::MAX; 2])?;
        Some(*start as usize..*end as usize)
    }
}

/// The severity of a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The scene cannot be rendered.
    Error,
    /// The scene can be rendered, but perhaps not as intended.
    Warning,
}

/// An error or a warning about a scene.
#[derive(Clone, Debug)]
pub struct Fault {
    /// The severity.
    pub severity: Severity,
    /// The message: lower case, no full stop, names in backticks.
    pub message: String,
    /// The range of the text to mark.
    pub place: Place,
    /// A note beside the mark, which may be empty.
    pub label: String,
    /// Further places that help to understand the fault, with a few words each.
    pub also: Vec<(Place, String)>,
    /// The correction.
    pub help: Option<String>,
    /// The likely correction of the marked word, without quotes.
    pub meant: Option<String>,
    /// The number of other faults that differ only in their places and are not listed separately, and the first of
    /// these places.
    pub similar_faults: (usize, Vec<Place>),
}

impl Fault {
    /// Makes an error, which prevents rendering.
    pub fn error(place: Place, message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Error,
            message: message.into(),
            place,
            label: String::new(),
            also: Vec::new(),
            help: None,
            meant: None,
            similar_faults: (0, Vec::new()),
        }
    }

    /// Makes a warning, which does not prevent rendering.
    pub fn warning(place: Place, message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(place, message) }
    }

    /// Adds a note beside the mark.
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// Adds a further place that helps to understand the fault.
    pub fn also(mut self, place: Place, label: impl Into<String>) -> Self {
        self.also.push((place, label.into()));
        self
    }

    /// Adds the correction.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Adds the likely correction of the marked word.
    pub fn meant(mut self, word: Option<&str>) -> Self {
        self.meant = word.map(str::to_owned);
        self
    }

    pub(super) fn start(&self) -> usize {
        self.place.as_ref().map_or(0, |place| place.start)
    }

    /// Returns the number of similar faults, in brackets, or an empty string if there are none.
    pub(super) fn more(&self) -> String {
        let (count, _) = self.similar_faults;
        if count == 0 { String::new() } else { format!(" (and in {})", text::count(count, "more place")) }
    }

    /// Counts a similar fault, and keeps its place if it is one of the first.
    pub(super) fn count_similar(&mut self, place: Place) {
        let (count, places) = &mut self.similar_faults;
        *count += 1;
        if places.len() < PLACES {
            places.push(place);
        }
    }

    pub(super) fn is_like(&self, other: &Self) -> bool {
        self.severity == other.severity && self.message == other.message
    }

    /// Shortens long texts, and escapes invisible characters, because a name with a line end could look like a message
    /// of its own. Also limits the fault's places to `text`, with none beginning after its end.
    pub(super) fn tidy(&mut self, text: &str) {
        let tidy = |words: &str| text::visible(&text::abridged(words)).into_owned();
        let also = self.also.iter_mut().map(|(place, label)| (place, label));
        let whole = |place: &mut Place| {
            if let Some(place) = place {
                let (one, other) = (text::boundary(text, place.start), text::boundary(text, place.end));
                *place = one.min(other)..one.max(other);
            }
        };
        for (place, label) in also.chain([(&mut self.place, &mut self.label)]) {
            *label = tidy(label);
            whole(place);
        }
        self.similar_faults.1.iter_mut().for_each(whole);
        self.help = self.help.as_deref().map(tidy);
        self.message = tidy(&self.message);
    }
}
