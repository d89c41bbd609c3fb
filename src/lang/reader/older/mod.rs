//! Older scenes of the course: numbers in a fixed order, without names. A code such as 13 for a sphere is on its own
//! line, and its numbers are on the lines after it.

mod codes;
mod entities;
mod faults;
mod found;
mod rows;
mod unmapped;

use super::fault::Fault;
use super::notes::has_entities;
use super::report::Report;
use super::statement::Statement;
use crate::registry::Registry;
use codes::{Code, LIGHT, Line, MATERIAL, Numbers, PROJECTOR, REFRACTION, TRANSPARENCY, VIEWPOINT, WORLD};
use entities::Entities;
use faults::Context;
use found::{Found, Given};
use rows::{Number, Row, rows};
use std::ops::Range;
use std::path::Path;
use unmapped::Unmapped;

/// The usual first two lines of these scenes: the world's size and the viewpoint.
const USUAL: ([f64; 2], [f64; 3]) = ([8.0, 6.0], [0.0, 0.0, 3.0]);

/// Tells whether a text is an older scene, unlike scenes in the language of words or in TOML.
pub fn is_older(registry: &Registry, text: &str) -> bool {
    let mut all = rows(text, 0);
    let Some(first) = all.next() else { return false };
    if !first.is_of_numbers() && text.contains(['{', '=', '<', '[']) {
        return false;
    }
    let lines = Lines::of(text, 0);
    let (mut count, mut others) = (0, 0);
    for row in &lines.0 {
        *(if row.is_of_numbers() { &mut count } else { &mut others }) += 1;
    }
    if count <= others || has_entities(registry, text).is_some() {
        return false;
    }
    let begins = |at| lines.numbers(at, 4).len();
    let has_head = begins(0) >= 2 && begins(1) >= 3 && begins(2) == 1;
    has_head || (0..lines.0.len()).any(|at| lines.begins_object(at) && (at != 0 || begins(3) >= 3))
}

/// Reads the scene in a range of a text. File names are relative to `folder`.
pub fn parse<'a>(
    text: &'a str,
    range: Range<usize>,
    folder: &Path,
    report: &mut Report<'_>,
) -> Vec<Statement<'a>> {
    let lines = Lines::of(&text[range.clone()], range.start);
    let mut reader = Reader {
        at: 0,
        end: range.end,
        of_material: 3,
        entities: Entities::new(folder),
        unmapped: Unmapped::default(),
        lines,
        report,
    };
    if let Some(fault) = reader.other_numbering() {
        reader.report.add(fault);
        reader.entities.camera(USUAL.0, USUAL.1, 0..0, reader.report);
        return reader.entities.statements;
    }
    reader.head();
    while reader.object() {}
    if let Some(fault) = reader.unmapped.fault() {
        reader.report.add_gathered(fault);
    }
    reader.entities.statements
}

/// The lines of a scene that are not blank.
struct Lines<'a>(Vec<Row<'a>>);

impl<'a> Lines<'a> {
    fn of(text: &'a str, start: usize) -> Self {
        let lines = Self(rows(text, start).collect());
        if (0..lines.0.len()).any(|at| lines.begins_object(at)) {
            return lines;
        }
        // Without any code, words may stand for the types.
        let named = |row: Row<'a>| Row { code: codes::named(row.text), ..row };
        Self(lines.0.into_iter().map(named).collect())
    }

    /// Returns the numbers at the beginning of a line, up to `most` of them.
    fn numbers(&self, at: usize, most: usize) -> Vec<Number> {
        self.0.get(at).map_or_else(Vec::new, |row| row.numbers(most))
    }

    /// Returns the indices of the lines that begin with numbers, starting at `from`.
    fn of_numbers(&self, from: usize) -> impl Iterator<Item = usize> {
        (from..self.0.len()).filter(|at| self.0[*at].is_of_numbers())
    }

    /// Returns the possible code of an object or a light on a line: a known code, alone or with an index after it.
    fn code(&self, at: usize) -> Option<u32> {
        let numbers = self.numbers(at, 3);
        let code = numbers.first()?.code()?;
        (numbers.len() <= 2 && codes::is_known(code)).then_some(code)
    }

    /// Tells whether an object or a light begins at a line. Two lines of three numbers follow each of their codes.
    fn begins_object(&self, at: usize) -> bool {
        let mut after = self.of_numbers(at + 1).map(|at| self.numbers(at, 3).len());
        self.code(at).is_some() && after.next() == Some(3) && after.next() == Some(3)
    }
}

struct Reader<'a, 'r, 't> {
    lines: Lines<'a>,
    /// The index of the next line.
    at: usize,
    /// The position of the end of the text.
    end: usize,
    /// The number of lines of a material.
    of_material: usize,
    entities: Entities<'a, 'r>,
    unmapped: Unmapped,
    report: &'r mut Report<'t>,
}

impl<'a> Reader<'a, '_, '_> {
    /// Returns an error if the codes of the scene have other meanings.
    fn other_numbering(&self) -> Option<Fault> {
        let is_other = |at: &usize| match self.lines.code(*at) {
            Some(PROJECTOR) => self.lines.begins_object(*at),
            Some(LIGHT) => {
                let after: Vec<_> = self.lines.of_numbers(at + 1).take(3).collect();
                let count = |index: usize| after.get(index).map_or(0, |at| self.lines.numbers(*at, 3).len());
                let is_other = after.get(1).is_some_and(|at| self.lines.code(*at).is_some());
                [count(0), count(1), count(2)] == [3, 1, 3] && !is_other
            }
            _ => false,
        };
        let at = (0..self.lines.0.len()).find(is_other)?;
        Some(faults::other_numbering(&self.lines.numbers(at, 1)[0]))
    }

    /// Advances to the next line that begins with a number, and reports skipped lines.
    fn next(&mut self) -> Option<Row<'a>> {
        loop {
            let row = *self.lines.0.get(self.at)?;
            if row.is_of_numbers() {
                return Some(row);
            }
            self.report.add(faults::skipped(&row, "number"));
            self.at += 1;
        }
    }

    /// Reads the world's size, the viewpoint, and whether materials have more lines.
    fn head(&mut self) {
        let mut context = Context {
            name: "scene",
            place: None,
            usage: "a scene begins with a line each, of so many numbers: world size 2, viewpoint 3"
                .to_owned(),
        };
        self.next();
        if self.lines.begins_object(self.at) {
            let place = self.lines.0[self.at].place();
            self.report.add(faults::fragment(place.clone(), USUAL));
            return self.entities.camera(USUAL.0, USUAL.1, place, self.report);
        }
        let world = self.numbers(WORLD, &context);
        context.place = world.as_ref().map(Given::place);
        let viewpoint = self.numbers(VIEWPOINT, &context);
        let place = context.place.unwrap_or(0..0);
        let [size, from] = [&world, &viewpoint].map(|line| line.as_ref().map(|line| &line.values));
        let size = size.map_or(USUAL.0, |size| [size[0].value, size[1].value]);
        let from = from.map_or(USUAL.1, |from| [from[0].value, from[1].value, from[2].value]);
        let end = viewpoint.as_ref().map_or(place.end, |line| line.place().end);
        self.entities.camera(size, from, place.start..end, self.report);
        for (sign, lines) in [(TRANSPARENCY, 4), (REFRACTION, 5)] {
            let Some(row) = self.next() else { return };
            if row.numbers(1)[0].code() != Some(sign) {
                return;
            }
            self.of_material = lines;
            self.at += 1;
        }
    }

    /// Reads the next object or light. Returns whether there was one.
    fn object(&mut self) -> bool {
        let Some(row) = self.next() else { return false };
        self.at += 1;
        let Some(number) = self.lines.code(self.at - 1) else {
            self.report.add(faults::skipped(&row, "known code"));
            return true;
        };
        let place = row.numbers(1)[0].place.clone();
        if let Some(fault) = faults::unread(number, place.clone()) {
            self.report.add(fault);
            self.skip_to_object();
            return true;
        }
        let second = || {
            let line = self.lines.of_numbers(self.at).nth(self.of_material + 1);
            line.map_or(0, |at| self.lines.numbers(at, 3).len())
        };
        if let Some(code) = codes::of(number, second) {
            if let (Some(index), Some(Line::Material)) = (row.index(), code.lines.first()) {
                self.unmapped.index(&index);
            }
            match self.lines_of(code, place) {
                Some(Ok(found)) => self.entities.add(found, &mut self.unmapped, self.report),
                Some(Err(())) => {}
                None => self.skip_to_object(),
            }
        }
        true
    }

    /// Reads the lines after a code. Returns `None` if it is unclear which lines belong to the code, and an error if
    /// the lines themselves are wrong.
    fn lines_of(&mut self, code: &'static Code, place: Range<usize>) -> Option<Result<Found<'a>, ()>> {
        let context =
            Context { name: code.name, place: Some(place.clone()), usage: code.usage(self.of_material) };
        let mut found = Found { code, place, materials: Vec::new(), lines: Vec::new(), file: None };
        let mut is_sound = true;
        for line in code.lines {
            let given = |given: Option<Given>, all: &mut Vec<Given>, is_sound: &mut bool| match given {
                Some(given) => all.push(given),
                None => *is_sound = false,
            };
            match line {
                Line::Material => {
                    let mut material = Vec::new();
                    for line in &MATERIAL[..self.of_material] {
                        let line = self.checked(*line, &context)?;
                        given(line, &mut material, &mut is_sound);
                    }
                    found.materials.push(material);
                }
                Line::Numbers(line) => {
                    let line = self.checked(*line, &context)?;
                    given(line, &mut found.lines, &mut is_sound);
                }
                Line::File => match self.lines.0.get(self.at) {
                    Some(row) => {
                        found.file = Some(row.word());
                        self.at += 1;
                    }
                    None => {
                        self.report.add(faults::ends_early("file name", &context, self.end));
                        return None;
                    }
                },
            }
        }
        Some(if is_sound { Ok(found) } else { Err(()) })
    }

    /// Reads one of the first two lines, and reports its errors.
    fn numbers(&mut self, line: Numbers, context: &Context) -> Option<Given> {
        let given = self.checked(line, context);
        if given.is_none() && !self.lines.begins_object(self.at) {
            self.at += 1;
        }
        given.flatten()
    }

    /// Reads a line of numbers. Returns `None` if the line has too few numbers, and `Some(None)` if their values are
    /// not allowed.
    fn checked(&mut self, line: Numbers, context: &Context) -> Option<Option<Given>> {
        let Some(row) = self.next() else {
            self.report.add(faults::ends_early(line.name, context, self.end));
            return None;
        };
        let values = row.numbers(line.count);
        if values.len() < line.count {
            let begins_object = self.lines.begins_object(self.at);
            self.report.add(faults::too_few(&line, &row, values.len(), begins_object, context));
            return None;
        }
        self.at += 1;
        let found = values.iter().find_map(|value| faults::unlike_a_number(&row, value));
        let fault = found.or_else(|| faults::against_rule(&line, &values, context));
        Some(match fault {
            Some(fault) => {
                self.report.add(fault);
                None
            }
            None => Some(Given { line, values }),
        })
    }

    /// Skips lines up to the next object.
    fn skip_to_object(&mut self) {
        while self.at < self.lines.0.len() && !self.lines.begins_object(self.at) {
            self.at += 1;
        }
    }
}
