//! Reads a scene in the notes' syntax: entities, `let`, `repeat` and `include`.

use super::fault::{Fault, Severity};
use super::keyword::Keyword;
use super::notes::{Grammar, Node, Statement};
use super::parsed::{Parsed, Word};
use super::repeats::Repeats;
use super::report::Report;
use super::sources::Sources;
use super::tokens::{Token, TokenForm, Tokens};
use crate::registry::Registry;
use crate::syntax::Syntax;
use std::collections::HashSet;
use std::mem::replace;

/// Reports the syntax errors of a text.
pub fn parse<'a>(registry: &Registry, sources: &'a Sources<'_>, report: &mut Report<'a>) {
    let mut memory = vec![None; 1];
    if let Some(mut parser) = parser(registry, sources, report).map(Parser::reading_on) {
        while parser.entities(&mut memory) > 0 {}
    }
}

/// Begins parsing the entities of a text. If the text has no entity, reports the reason and returns `None`.
pub fn parser<'a, 'r>(
    registry: &'r Registry,
    sources: &'a Sources<'_>,
    report: &'r mut Report<'a>,
) -> Option<Parser<'a, 'r>> {
    let text = &sources.text[..sources.own.end];
    let mut nowhere = Report::default();
    let begin = Grammar::new(registry, text, 0, &mut nowhere);
    if let Some(first) = begin.token()
        && !begin.looks_like_a_scene()
    {
        let mut tokens = Tokens::of(text, report);
        while tokens.ahead[0].is_some() {
            tokens.step(report);
        }
        report.add(
            Fault::error(Some(first.place()), "this is not a scene")
                .label("expected an entity type")
                .help(registry.first_steps(Syntax::Notes)),
        );
        return None;
    }
    let repeats = Repeats::of(text, sources.sets(report));
    let grammar = Grammar::new(registry, text, 0, report);
    Some(Parser { grammar, sources, repeats, outer: Vec::new(), is_over: false, stops: true })
}

/// The reader of a scene in the notes' syntax.
pub struct Parser<'a, 'r> {
    grammar: Grammar<'a, 'r>,
    sources: &'a Sources<'a>,
    /// The `repeat`s of the scene, and its numbers.
    pub repeats: Repeats<'a>,
    /// The rests of the texts that include this one.
    outer: Vec<Tokens<'a>>,
    /// Whether everything has been read.
    is_over: bool,
    /// Whether to stop at a syntax error.
    stops: bool,
}

impl<'a> Parser<'a, '_> {
    /// Makes the parser continue after a syntax error.
    pub fn reading_on(mut self) -> Self {
        self.stops = false;
        self
    }

    /// Parses the next entities, in the memory of others, until all slots are filled or the text ends. They end at a
    /// syntax error, unless parsing continues to find further errors in one run.
    pub fn entities(&mut self, parsed: &mut [Option<Parsed<'a>>]) -> usize {
        let mut count = 0;
        while count < parsed.len()
            && (self.grammar.token().is_some() || self.leave())
            && !self.grammar.report.has_enough()
        {
            if self.stops && self.grammar.report.is_fatal() {
                return 0;
            }
            if self.repeats.is_plain() {
                let same = self.grammar.same_words(&mut parsed[count..]);
                if same > 0 {
                    count += same;
                    continue;
                }
            }
            match self.grammar.next(self.repeats.is_open(), &mut parsed[count]) {
                Some(Node::Entity) => {
                    let grammar = &mut self.grammar;
                    if let Some(entity) = &mut parsed[count] {
                        let table = grammar.table.map(|table| &grammar.tables[table]);
                        self.repeats.entity(entity, table, grammar.registry, grammar.report);
                        count += 1;
                    }
                }
                Some(Node::Statement(statement)) => self.statement(statement),
                Some(Node::Close(close)) => self.end_of_round(close),
                Some(Node::Stray) | None => {}
            }
        }
        count
    }

    /// Executes a statement.
    fn statement(&mut self, statement: Statement<'a>) {
        match (statement.keyword, statement.words, statement.open) {
            (Keyword::Include, [Some(file), _], _) => self.include(&file),
            (Keyword::Let, [Some(name), Some(value)], _) => {
                self.repeats.define(&name, &value, self.grammar.report);
            }
            (Keyword::Repeat, [Some(name), Some(count)], Some(open)) => self.repeat(&name, &count, open),
            // Incomplete statements have been reported.
            _ => {}
        }
    }

    /// Continues with the file that an `include` names.
    fn include(&mut self, file: &Word<'a>) {
        let grammar = &mut self.grammar;
        if let Some(range) = self.sources.file(file, "outside of all braces", grammar.report) {
            let inner = Tokens::from(&self.sources.text[..range.end], range.start, grammar.report);
            self.outer.push(replace(&mut grammar.tokens, inner));
        }
    }

    /// Continues after the end of an included file. Returns whether there is more to read.
    fn leave(&mut self) -> bool {
        while self.repeats.is_open() {
            self.grammar.report.add(
                Fault::error(self.repeats.innermost(), "missing `}` for this `repeat`")
                    .help(Keyword::Repeat.usage()),
            );
            self.repeats.end();
        }
        while let Some(outer) = self.outer.pop() {
            self.grammar.tokens = outer;
            if self.grammar.token().is_some() {
                return true;
            }
        }
        if !replace(&mut self.is_over, true) {
            self.repeats.sets.report_unmatched(self.grammar.report);
        }
        false
    }

    /// Begins a `repeat` with the entities after a brace.
    fn repeat(&mut self, name: &Word<'a>, count: &Word<'a>, open: Token) {
        let grammar = &mut self.grammar;
        let (entities, close) = body(grammar.tokens.text, open.end);
        let errors = grammar.report.count(Severity::Error);
        if !self.repeats.begin(name, count, (open.end, entities), errors, grammar.report) {
            self.repeats.end();
            grammar.go_to(close);
        }
    }

    /// Begins the next round of a `repeat` after the closing brace of its body, or continues after the brace.
    fn end_of_round(&mut self, close: Token) {
        let grammar = &mut self.grammar;
        let errors = grammar.report.count(Severity::Error);
        if let Some(start) = self.repeats.next(close.start, errors, grammar.report) {
            grammar.go_to(start);
        }
    }
}

/// Returns the names of the entities of a `repeat`, except those of nested ones, and the position after its closing
/// brace, in bytes.
pub fn body(text: &str, start: usize) -> (HashSet<String>, usize) {
    let nowhere = &mut Report::default();
    let mut tokens = Tokens::from(text, start, nowhere);
    let (mut depth, mut entities) = (0, HashSet::new());
    let mut before = [None; 2];
    while let Some(token) = tokens.step(nowhere) {
        match token.form {
            TokenForm::Open => {
                if let (0, [Some(_), Some(name)]) = (depth, before) {
                    entities.insert(tokens.text(name).into_owned());
                }
                depth += 1;
            }
            TokenForm::Close if depth == 0 => return (entities, token.end),
            TokenForm::Close => depth -= 1,
            _ => {}
        }
        let is_repeat = token.form == TokenForm::Word && tokens.raw(token) == "repeat";
        // A `repeat` has two words before its brace, and neither is the name of an entity.
        before = match (token.is_brace(), before) {
            (true, _) => [None; 2],
            (false, _) if is_repeat && depth == 0 => [None; 2],
            (false, [_, last]) => [last, Some(token)],
        };
    }
    (entities, text.len())
}
