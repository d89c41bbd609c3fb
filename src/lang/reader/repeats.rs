//! The `repeat`s of a scene, with the names and the numbers of their rounds.

use super::fault::{Fault, Place};
use super::guesses::Table;
use super::numbers::Numbers;
use super::parsed::{Parsed, Word};
use super::report::Report;
use super::sets::Sets;
use crate::registry::Registry;
use std::collections::{HashMap, HashSet};
use std::ops::Range;
use tabray_core::scene::choice::Choices;
use tabray_core::scene::value::Type;

/// The maximum number of rounds and repeated entities of a scene, and the maximum length of the texts of all rounds, in
/// bytes.
const MAX_ROUNDS: usize = 1_000_000;
const MAX_BYTES: usize = 1 << 28;

/// The maximum nesting of `repeat`s. With two or more rounds each, 20 of them are already too many.
const MAX_DEPTH: usize = 32;

/// The `repeat`s of a scene.
#[derive(Default)]
pub struct Repeats<'a> {
    /// The numbers of the scene, and of the rounds.
    numbers: Numbers<'a>,
    /// The values set beside the text.
    pub sets: Sets<'a>,
    open: Vec<Round>,
    /// The number of rounds and repeated entities so far, and the length of their texts, in bytes.
    count: usize,
    bytes: usize,
    /// The ranges of the text that are read more than once, and that have not been taken yet.
    repeated: Vec<Range<usize>>,
}

/// A `repeat` in progress.
struct Round {
    /// The place of the name.
    place: Place,
    index: u64,
    count: u64,
    /// Whether a number in the text says how many rounds there are.
    is_number: bool,
    /// The number of names outside of the `repeat`.
    names: usize,
    /// The position of the body in the text, in bytes.
    start: usize,
    /// The number of errors before the `repeat`.
    errors: usize,
    /// The names of the entities in the body.
    entities: HashSet<String>,
}

impl<'a> Repeats<'a> {
    /// Begins with a text in the notes' syntax.
    pub fn of(text: &'a str, sets: Sets<'a>) -> Self {
        Self { numbers: Numbers::of(text), sets, ..Self::default() }
    }

    /// Begins with a text that defines these numbers.
    pub fn of_names(names: HashMap<String, Place>, sets: Sets<'a>) -> Self {
        Self { numbers: Numbers::of_names(names), sets, ..Self::default() }
    }

    /// Tells whether a `repeat` is in progress.
    #[inline]
    pub fn is_open(&self) -> bool {
        !self.open.is_empty()
    }

    /// Tells whether all entities so far equal their text, and the next one will.
    pub fn is_plain(&self) -> bool {
        self.count == 0 && self.open.is_empty() && self.numbers.len() == 0 && self.sets.is_empty()
    }

    /// Adds the round to an entity's name, and replaces formulas and set values by numbers.
    pub fn entity(
        &mut self,
        entity: &mut Parsed<'a>,
        table: Option<&Table>,
        registry: &Registry,
        report: &mut Report<'_>,
    ) {
        if self.is_open() {
            self.rename(&mut entity.name);
        }
        // Values need no change, except within a `repeat`, in a scene with named numbers, or with quotes.
        if let Some(table) = table
            && (self.is_open() || self.numbers.len() > 0 || entity.has_quotes())
        {
            entity.change(|name, word| {
                let known = table.find(name).or_else(|| table.near(name, report.guesses()));
                self.word(word, known.map(|known| table[known].value_type), report)
            });
        }
        if !self.sets.is_empty() {
            self.sets.apply(entity, registry, &mut self.numbers, report);
        }
    }

    /// Defines a number, which an option may override, or a function.
    pub fn define(&mut self, name: &Word<'a>, value: &Word<'a>, report: &mut Report<'_>) {
        if self.numbers.function(name, value, report).is_some() {
            return;
        }
        let set = self.sets.number(&name.text);
        let value = self.numbers.number(set.as_ref().unwrap_or(value), report);
        self.numbers.define(name, value, report);
    }

    /// Returns the place of the name of the innermost `repeat`.
    pub fn innermost(&self) -> Place {
        self.open.last().and_then(|round| round.place.clone())
    }

    /// Begins the first round of a `repeat` with the counter `name`, or reports the reason why there are no rounds. The
    /// body begins at `start`, and has entities with the names `entities`.
    pub fn begin(
        &mut self,
        name: &Word<'_>,
        count_word: &Word<'_>,
        (start, entities): (usize, HashSet<String>),
        errors: usize,
        report: &mut Report<'_>,
    ) -> bool {
        let names = self.numbers.len();
        let is_too_deep = self.open.len() >= MAX_DEPTH;
        if is_too_deep {
            let message = format!("`repeat {}` is nested too deep", name.text);
            let help = format!("a `repeat` can be nested at most {MAX_DEPTH} deep");
            report.add(Fault::error(name.place.clone(), message).help(help));
        }
        let number = self.numbers.number(count_word, report);
        let rounds = number.map_or(0.0, |number| number);
        if rounds < 0.0 || rounds.fract() != 0.0 || rounds > MAX_ROUNDS as f64 {
            let message =
                format!("`repeat {}` cannot have {} rounds", name.text, tabray_core::text::shortest(rounds));
            let help = format!("the number of rounds is a whole number from 0 to {MAX_ROUNDS}");
            report.add(Fault::error(count_word.place.clone(), message).help(help));
        }
        self.numbers.define(name, Some(0.0), report);
        let count =
            if number.is_some() && rounds >= 0.0 && rounds <= MAX_ROUNDS as f64 { rounds as u64 } else { 1 };
        let (place, is_number) = (name.place.clone(), count_word.text.parse::<f64>().is_ok());
        self.open.push(Round { place, index: 0, count, is_number, names, start, errors, entities });
        let is_too_much = self.is_too_much();
        if is_too_much {
            self.report_too_much(report);
        }
        count > 0 && !is_too_deep && !is_too_much
    }

    /// Tells whether the `repeat`s in progress will certainly have too many rounds, as numbers say how many each has.
    fn is_too_much(&self) -> bool {
        let rounds = self.open.iter().map(|round| round.count).fold(1, u64::saturating_mul);
        rounds > MAX_ROUNDS as u64 && self.open.iter().all(|round| round.is_number)
    }

    fn report_too_much(&self, report: &mut Report<'_>) {
        let help = format!(
            "a scene has at most {MAX_ROUNDS} rounds and repeated entities, and at most {} MiB of repeated text",
            MAX_BYTES >> 20
        );
        report.add(Fault::error(self.innermost(), "the scene repeats too much").help(help));
    }

    /// Ends a round whose body ends at `end`. Returns the position of the body for another round, or `None` after the
    /// last one.
    pub fn next(&mut self, end: usize, errors: usize, report: &mut Report<'_>) -> Option<usize> {
        let is_more = {
            let round = self.open.last_mut()?;
            if round.index == 0 {
                self.repeated.push(round.start..end);
            }
            self.bytes = self.bytes.saturating_add(end - round.start);
            round.index += 1;
            round.index < round.count && round.errors == errors
        };
        if !is_more || !self.has_room(report) {
            self.end();
            return None;
        }
        let round = self.open.last()?;
        self.numbers.keep(round.names + 1);
        self.numbers.change(round.names, round.index as f64);
        Some(round.start)
    }

    /// Ends the innermost `repeat`.
    pub fn end(&mut self) {
        if let Some(round) = self.open.pop() {
            self.numbers.keep(round.names);
        }
    }

    /// Counts a round, and reports an error if there are too many.
    fn has_room(&mut self, report: &mut Report<'_>) -> bool {
        self.count += 1;
        let is_there = self.count <= MAX_ROUNDS && self.bytes <= MAX_BYTES;
        if !is_there {
            self.report_too_much(report);
        }
        is_there
    }

    /// Adds the number of the round to the name of an entity.
    fn rename(&mut self, name: &mut Word<'a>) {
        self.count += 1;
        *name.text.to_mut() += &self.suffix(self.open.len());
    }

    fn suffix(&self, depth: usize) -> String {
        self.open[..depth].iter().map(|round| format!("_{}", round.index)).collect()
    }

    /// Returns a value of an attribute, with formulas replaced by numbers, and with the name of an entity in the body
    /// replaced by its name in this round.
    fn word(&mut self, word: Word<'a>, value_type: Option<Type>, report: &mut Report<'_>) -> Word<'a> {
        if let Some(Type::Name(_) | Type::Choice(Choices { kind: Some(_), .. })) = value_type {
            let depth = self.open.iter().rposition(|round| round.entities.contains(&*word.text));
            return match depth {
                Some(depth) => {
                    Word { text: (word.text.to_string() + &self.suffix(depth + 1)).into(), ..word }
                }
                None => word,
            };
        }
        self.numbers.word(word, value_type, report)
    }

    /// Takes the ranges of the text that are read more than once.
    pub fn take_repeated(&mut self) -> Vec<Range<usize>> {
        std::mem::take(&mut self.repeated)
    }
}
