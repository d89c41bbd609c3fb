//! What a scene in TOML says, in the order of its text: entities, and numbers, files and rounds, from which more entities
//! follow.

use super::fault::Severity;
use super::guesses::Tables;
use super::parsed::{Parsed, Word};
use super::report::Report;
use super::rounds::Rounds;
use super::sources::Sources;
use crate::registry::Registry;
use std::collections::{HashMap, HashSet};
use std::ops::Range;

/// How much more memory an entity takes than one in the notes' syntax: all of them are in memory before any is checked.
const WEIGHT: usize = 8;

/// A part of a scene in TOML.
pub enum Statement<'a> {
    Entity(Parsed<'a>),
    Let { name: Word<'a>, value: Word<'a> },
    Include { file: Word<'a> },
    Repeat { start: usize, name: Word<'a>, count: Word<'a>, body: Vec<Statement<'a>> },
}

impl Statement<'_> {
    /// Returns the position at which it begins, in bytes.
    pub fn start(&self) -> Option<usize> {
        let place = match self {
            Self::Entity(entity) => &entity.name.place,
            Self::Let { name, .. } => &name.place,
            Self::Include { file } => &file.place,
            Self::Repeat { start, .. } => return Some(*start),
        };
        place.as_ref().map(|place| place.start)
    }

    /// Returns the length of its text, in bytes, without empty space between its parts.
    fn len(&self) -> usize {
        match self {
            Self::Entity(entity) => entity.place.as_ref().map_or(0, Range::len),
            Self::Repeat { body, .. } => body.iter().map(Statement::len).sum(),
            _ => 1,
        }
    }
}

/// Parses a part of a text.
pub type Parse<'p, 'a, 't> = &'p dyn Fn(Range<usize>, &mut Report<'t>) -> Vec<Statement<'a>>;

/// Finds the entities that follow from what a scene says.
pub struct Lister<'a, 'r, 't> {
    registry: &'r Registry,
    sources: &'a Sources<'a>,
    parse: Parse<'r, 'a, 't>,
    report: &'r mut Report<'t>,
    rounds: Rounds<'a>,
    tables: Tables,
    entities: Vec<Parsed<'a>>,
}

/// Returns the entities of a scene, in their order.
pub fn entities<'a, 't>(
    registry: &Registry,
    sources: &'a Sources<'_>,
    parse: Parse<'_, 'a, 't>,
    report: &mut Report<'t>,
) -> Vec<Parsed<'a>> {
    let sets = sources.sets(report);
    let all = parse(sources.own.clone(), report);
    let mut names = HashMap::new();
    for statement in &all {
        if let Statement::Let { name, .. } = statement {
            names.insert(name.text.to_string(), name.place.clone());
        }
    }
    let mut lister = Lister {
        registry,
        sources,
        parse,
        report,
        rounds: Rounds::of_names(names, sets),
        tables: Tables::default(),
        entities: Vec::with_capacity(all.len()),
    };
    for statement in all {
        match statement {
            // Most entities are where they will stay.
            Statement::Entity(entity) => lister.entity(entity),
            statement => lister.statement(&statement),
        }
    }
    lister.rounds.sets.report_unmatched(lister.report);
    lister.entities
}

impl<'a> Lister<'a, '_, '_> {
    fn entity(&mut self, mut entity: Parsed<'a>) {
        let table = self.tables.named(self.registry, &entity.kind.text).map(|table| &self.tables[table]);
        self.rounds.entity(&mut entity, table, self.registry, self.report);
        self.entities.push(entity);
    }

    fn statement(&mut self, statement: &Statement<'a>) {
        match statement {
            Statement::Entity(entity) => self.entity(entity.clone()),
            Statement::Let { name, value } => self.rounds.define(name, value, self.report),
            Statement::Include { file } => self.include(file),
            Statement::Repeat { name, count, body, .. } => self.repeat(name, count, body),
        }
    }

    fn include(&mut self, file: &Word<'a>) {
        if let Some(range) = self.sources.file(file, "before the first table", self.report) {
            for statement in (self.parse)(range, self.report) {
                self.statement(&statement);
            }
        }
    }

    fn repeat(&mut self, name: &Word<'a>, count: &Word<'a>, body: &[Statement<'a>]) {
        let mut names = HashSet::new();
        for statement in body {
            if let Statement::Entity(entity) = statement {
                names.insert(entity.name.text.to_string());
                self.report.repeat(entity.place.clone().unwrap_or_default());
            }
        }
        let length = WEIGHT * body.iter().map(Statement::len).sum::<usize>();
        let errors = self.report.count(Severity::Error);
        let mut is_more = self.rounds.begin(name, count, (0, names), errors, self.report);
        if !is_more {
            self.rounds.end();
        }
        while is_more {
            body.iter().for_each(|statement| self.statement(statement));
            let errors = self.report.count(Severity::Error);
            is_more = self.rounds.next(length, errors, self.report).is_some();
        }
    }
}
