//! The content of a scene in TOML, in the order of its text: entities, and the numbers, files and rounds that lead to
//! more entities.

use super::fault::Severity;
use super::guesses::Tables;
use super::parsed::{Parsed, Word};
use super::repeats::Repeats;
use super::report::Report;
use super::sources::Sources;
use super::statement::Statement;
use super::toml::{self, IndependentParts};
use crate::registry::Registry;
use std::collections::HashSet;
use std::mem::take;
use std::ops::Range;
use tabray_core::parallel;

/// The memory of an entity as a multiple of one in the notes' syntax, because all are in memory before the first is
/// checked.
const WEIGHT: usize = 8;

/// The number of parts that are parsed together.
const TOGETHER: usize = 16;

/// Parses a part of a text.
pub type Parse<'p, 'a, 't> = &'p (dyn Fn(Range<usize>, &mut Report<'t>) -> Vec<Statement<'a>> + Sync);

/// Finds the entities that result from the statements of a scene.
pub struct Lister<'a, 'r, 't> {
    registry: &'r Registry,
    sources: &'a Sources<'a>,
    parse: Parse<'r, 'a, 't>,
    report: &'r mut Report<'t>,
    repeats: Repeats<'a>,
    tables: Tables,
    entities: Vec<Parsed<'a>>,
}

/// Returns the entities of a scene, in order.
pub fn entities<'a, 't>(
    registry: &Registry,
    sources: &'a Sources<'_>,
    parse: Parse<'_, 'a, 't>,
    report: &mut Report<'t>,
) -> Vec<Parsed<'a>> {
    let sets = sources.sets(report);
    let all = parse(sources.own.clone(), report);
    let names = all.iter().filter_map(Statement::number).collect();
    let repeats = Repeats::of_names(names, sets);
    let entities = Vec::with_capacity(all.len());
    let mut lister =
        Lister { registry, sources, parse, report, repeats, tables: Tables::default(), entities };
    lister.statements(all);
    lister.repeats.sets.report_unmatched(lister.report);
    lister.entities
}

/// The entities of a long scene, some thousand at a time. While some are checked, the next ones are parsed, and only
/// these are in memory.
pub struct Stream<'a, 'r, 't> {
    lister: Lister<'a, 'r, 't>,
    parts: IndependentParts,
    /// The number of parsed parts.
    parsed: usize,
}

impl<'a, 'r, 't> Stream<'a, 'r, 't> {
    /// Begins with the parts of a scene.
    pub fn new(
        registry: &'r Registry,
        sources: &'a Sources<'_>,
        parse: Parse<'r, 'a, 't>,
        report: &'r mut Report<'t>,
        mut parts: IndependentParts,
    ) -> Self {
        let repeats = Repeats::of_names(take(&mut parts.numbers), sources.sets(report));
        let (tables, entities) = (Tables::default(), Vec::new());
        let lister = Lister { registry, sources, parse, report, repeats, tables, entities };
        Self { lister, parts, parsed: 0 }
    }

    /// Returns the next entities, or none after the last ones.
    pub fn next(&mut self) -> Vec<Parsed<'a>> {
        let Self { lister, parts: IndependentParts { ranges, .. }, parsed } = self;
        while lister.entities.is_empty() && *parsed < ranges.len() {
            let some = &ranges[*parsed..ranges.len().min(*parsed + TOGETHER)];
            let text = &lister.sources.text[..lister.sources.own.end];
            let statements = parallel::map(some.len(), |part| toml::part(text, some[part].clone()));
            *parsed += some.len();
            statements.into_iter().for_each(|statements| lister.statements(statements));
            if *parsed == ranges.len() {
                lister.repeats.sets.report_unmatched(lister.report);
            }
        }
        take(&mut lister.entities)
    }
}

impl<'a> Lister<'a, '_, '_> {
    fn statements(&mut self, statements: Vec<Statement<'a>>) {
        for statement in statements {
            match statement {
                // Most entities are already in their final place.
                Statement::Entity(entity) => self.entity(entity),
                statement => self.statement(&statement),
            }
        }
    }

    fn entity(&mut self, mut entity: Parsed<'a>) {
        let table = self.tables.named(self.registry, &entity.kind.text).map(|table| &self.tables[table]);
        self.repeats.entity(&mut entity, table, self.registry, self.report);
        self.entities.push(entity);
    }

    fn statement(&mut self, statement: &Statement<'a>) {
        match statement {
            Statement::Entity(entity) => self.entity(entity.clone()),
            Statement::Let { name, value } => self.repeats.define(name, value, self.report),
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
        let mut is_more = self.repeats.begin(name, count, (0, names), errors, self.report);
        if !is_more {
            self.repeats.end();
        }
        while is_more {
            body.iter().for_each(|statement| self.statement(statement));
            let errors = self.report.count(Severity::Error);
            is_more = self.repeats.next(length, errors, self.report).is_some();
        }
    }
}
