//! What a scene in the notes' syntax says beside its entities: `let`, `repeat` and `include`.

use super::fault::{Fault, Severity};
use super::keyword::Keyword;
use super::notes::{Parser, parser};
use super::parsed::{Parsed, Word};
use super::report::Report;
use super::sources::Sources;
use super::tokens::{Token, TokenForm, Tokens};
use crate::registry::Registry;
use std::collections::HashSet;
use std::mem::replace;

/// Reports the syntax errors of a text.
pub fn parse<'a>(registry: &Registry, sources: &'a Sources<'_>, report: &mut Report<'a>) {
    let mut memory = vec![None; 1];
    if let Some(mut parser) = parser(registry, sources, report).map(Parser::reading_on) {
        while parser.entities(&mut memory) > 0 {}
    }
}

impl<'a> Parser<'a, '_> {
    /// Parses the next entities, in the memory of others, until there are as many as asked for or no more. After a syntax
    /// error there are no more, except where parsing goes on so that one run finds the faults that follow.
    pub fn entities(&mut self, parsed: &mut [Option<Parsed<'a>>]) -> usize {
        let mut count = 0;
        while count < parsed.len() && (self.token().is_some() || self.leave()) && !self.report.has_enough() {
            if self.stops && self.report.is_fatal() {
                return 0;
            }
            if let Some(keyword) = self.keyword() {
                self.statement(keyword);
            } else if self.rounds.is_open() && self.is(0, TokenForm::Close) {
                self.end_of_round();
            } else if !self.begins_entity() {
                self.stray();
            } else if self.entity(&mut parsed[count]).is_some() {
                count += 1;
            }
        }
        count
    }

    /// Does what a keyword says.
    fn statement(&mut self, keyword: Keyword) {
        let Some(first) = self.step() else { return };
        let [one, two] = match (keyword, self.next_word()) {
            (_, None) => return self.incomplete(first, keyword),
            (Keyword::Include, Some(file)) => return self.include(file),
            (_, Some(name)) => match self.next_word() {
                Some(value) => [name, value],
                None => return self.incomplete(first, keyword),
            },
        };
        match keyword {
            Keyword::Let => {
                let value = self.sets.number(&one.text).unwrap_or(two);
                let value = self.rounds.numbers.number(&value, self.report);
                self.rounds.numbers.define(&one, value, self.report);
            }
            _ if !self.is(0, TokenForm::Open) => self.incomplete(first, keyword),
            _ => self.repeat(&one, &two),
        }
    }

    /// Reads the next word, if it is not a brace.
    fn next_word(&mut self) -> Option<Word<'a>> {
        let token = self.token().filter(|_| self.is_word(0))?;
        self.step();
        Some(self.tokens.word(token))
    }

    fn incomplete(&mut self, first: Token, keyword: Keyword) {
        let message = format!("this `{}` is incomplete", self.tokens.raw(first));
        self.report.add(Fault::error(Some(first.place()), message).help(keyword.usage()));
    }

    /// Goes on with the file that an `include` names.
    fn include(&mut self, file: Word<'a>) {
        let Some(sources) = self.sources else { return };
        let place = file.place.as_ref().map_or(0, |place| place.start);
        match sources.included(place) {
            Some(Ok(range)) => {
                let inner = Tokens::from(&sources.text[..range.end], range.start, self.report);
                self.outer.push(replace(&mut self.tokens, inner));
            }
            Some(Err(fault)) => self.report.add(fault.clone()),
            None => {
                let fault = Fault::error(file.place, "a file cannot be included here");
                self.report.add(fault.help("an `include` stands outside of all braces"));
            }
        }
    }

    /// Goes on after the end of an included file; returns whether there is more to read.
    fn leave(&mut self) -> bool {
        while self.rounds.is_open() {
            self.report.add(
                Fault::error(self.rounds.innermost(), "missing `}` for this `repeat`")
                    .help(Keyword::Repeat.usage()),
            );
            self.rounds.end();
        }
        while let Some(outer) = self.outer.pop() {
            self.tokens = outer;
            if self.token().is_some() {
                return true;
            }
        }
        if !replace(&mut self.is_over, true) {
            self.sets.report_unmatched(self.report);
        }
        false
    }

    /// Begins to repeat the entities between the braces that follow.
    fn repeat(&mut self, name: &Word<'a>, count: &Word<'a>) {
        let Some(open) = self.step() else { return };
        let (entities, close) = body(self.tokens.text, open.end);
        let errors = self.report.count(Severity::Error);
        if !self.rounds.begin(name, count, (open.end, entities), errors, self.report) {
            self.rounds.end();
            self.tokens = Tokens::from(self.tokens.text, close, self.report);
        }
    }

    /// Begins the next round of a `repeat` after the brace that ends its body, or goes on after the brace.
    fn end_of_round(&mut self) {
        let Some(close) = self.step() else { return };
        let errors = self.report.count(Severity::Error);
        if let Some(start) = self.rounds.next(close.start, errors, self.report) {
            self.tokens = Tokens::from(self.tokens.text, start, self.report);
        }
    }
}

/// Returns the names of the entities of a `repeat`, without those of others in it, and the position after its closing
/// brace, in bytes.
fn body(text: &str, start: usize) -> (HashSet<String>, usize) {
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
        // A `repeat` has two words before its brace, of which none is the name of an entity.
        before = match (token.is_brace(), before) {
            (true, _) => [None; 2],
            (false, _) if is_repeat && depth == 0 => [None; 2],
            (false, [_, last]) => [last, Some(token)],
        };
    }
    (entities, text.len())
}
