//! The differences from the images of the programs of the time, in one note.

use super::rows::Number;
use crate::reader::fault::Fault;
use std::ops::Range;
use tabray_core::text::{count, shortest};

/// The maximum number of differences that the note lists.
const MAX_LISTED: usize = 12;

/// The differences, each with its first place and the number of occurrences.
#[derive(Default)]
pub struct Unmapped(Vec<(String, Range<usize>, usize)>);

impl Unmapped {
    /// Notes a difference at a place.
    pub fn add(&mut self, what: impl Into<String>, place: Range<usize>) {
        let what = what.into();
        if let Some((.., count)) = self.0.iter_mut().find(|(known, ..)| *known == what) {
            *count += 1;
        } else if self.0.len() < MAX_LISTED {
            self.0.push((what, place, 1));
        }
    }

    /// Notes a shader with a number that only its own program knows.
    pub fn shader(&mut self, number: &Number) {
        let value = shortest(number.value);
        let what = match value.as_str() {
            "1" => "shader 1 is taken for the swirl, which not all programs had under this number".to_owned(),
            "2" => "shader 2 is taken for the hues, which not all programs had under this number".to_owned(),
            _ => format!("shader {value} was its program's own: plain colours are used instead"),
        };
        self.add(what, number.place.clone());
    }

    /// Notes an index of refraction.
    pub fn index(&mut self, index: &Number) {
        if index.value != 0.0 {
            let what = "an index of refraction bends no light here; a `glass` does, in a scene of words";
            self.add(what, index.place.clone());
        }
    }

    /// Returns the note, if there are differences.
    pub fn fault(self) -> Option<Fault> {
        let text = |what: String, times: usize| match times {
            1 => what,
            times => format!("{what} ({})", count(times, "time")),
        };
        let mut all = self.0.into_iter();
        let (what, place, times) = all.next()?;
        let fault = Fault::warning(Some(place), "not all of this scene is drawn as its own program drew it");
        let first = fault.label(text(what, times));
        Some(all.fold(first, |fault, (what, place, times)| fault.also(Some(place), text(what, times))))
    }
}
