//! The notes' scene language: `entity-type name { attribute values ... }`, one word after another.

use super::fault::Fault;
use super::guesses::{Guesses, KnownAttribute, Table, Tables};
use super::keyword::Keyword;
use super::parsed::{Form, Parsed, Word};
use super::report::Report;
use super::rounds::Rounds;
use super::sets::Sets;
use super::sources::Sources;
use super::tokens::{Token, TokenForm, Tokens};
use crate::registry::Registry;
use crate::syntax::Syntax;
use std::borrow::Cow;
use std::ops::Range;
use tabray_core::scene::kind::Kind;
use tabray_core::scene::value::Type;

/// Begins to parse the entities of a text. Returns `None`, and reports why, if no part of it is an entity.
pub fn parser<'a, 'r>(
    registry: &'r Registry,
    sources: &'a Sources<'_>,
    report: &'r mut Report<'a>,
) -> Option<Parser<'a, 'r>> {
    let text = &sources.text[..sources.own.end];
    let first = Tokens::of(text, &mut Report::default()).ahead[0];
    if let Some(first) = first
        && !looks_like_a_scene(registry, text)
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
    let sets = match &sources.options {
        Some(options) => Sets::of(&sources.text, options.clone(), report),
        None => Sets::default(),
    };
    let mut parser = Parser::new(registry, text, 0, report);
    (parser.rounds, parser.sets, parser.sources) = (Rounds::of(text), sets, Some(sources));
    Some(parser)
}

/// Parses the entity that begins at a byte of a text once more; what is wrong with it is reported already.
pub fn again<'a>(registry: &Registry, text: &'a str, at: usize) -> Option<Parsed<'a>> {
    let mut nowhere = Report::default();
    let mut entity = None;
    Parser::new(registry, text, at, &mut nowhere).entity(&mut entity);
    entity
}

/// Tells whether any part of a text is an entity.
fn looks_like_a_scene(registry: &Registry, text: &str) -> bool {
    let mut nowhere = Report::default();
    let parser = Parser::new(registry, text, 0, &mut nowhere);
    parser.begins_entity() || parser.keyword().is_some() || has_entities(registry, text).is_some()
}

/// Returns the place of the type of the first whole entity in a text, if it has one.
pub fn has_entities(registry: &Registry, text: &str) -> Option<Range<usize>> {
    let mut nowhere = Report::default();
    let mut parser = Parser::new(registry, text, 0, &mut nowhere);
    while let Some(token) = parser.token() {
        if parser.is_entity_type() && parser.has_form() {
            return Some(token.place());
        }
        parser.step();
    }
    None
}

/// The parser of a scene in the notes' syntax.
pub struct Parser<'a, 'r> {
    pub(super) registry: &'r Registry,
    pub(super) tokens: Tokens<'a>,
    pub(super) report: &'r mut Report<'a>,
    tables: Tables,
    /// Where the text comes from; `None` where one entity is parsed again.
    pub(super) sources: Option<&'a Sources<'a>>,
    /// What the scene repeats, and its numbers.
    pub(super) rounds: Rounds<'a>,
    /// The values that are set beside the text.
    pub(super) sets: Sets<'a>,
    /// The rests of the texts that include this one.
    pub(super) outer: Vec<Tokens<'a>>,
    /// Whether everything has been read.
    pub(super) is_over: bool,
    /// Whether a syntax error is a reason to stop.
    pub(super) stops: bool,
    /// The place of the token read last.
    before: Range<usize>,
    /// The entity read last: the place of its first word, and that of its end.
    last: Option<(Range<usize>, Range<usize>)>,
}

impl<'a, 'r> Parser<'a, 'r> {
    fn new(registry: &'r Registry, text: &'a str, at: usize, report: &'r mut Report<'a>) -> Self {
        Self {
            registry,
            tokens: Tokens::from(text, at, report),
            report,
            tables: Tables::default(),
            sources: None,
            rounds: Rounds::default(),
            sets: Sets::default(),
            outer: Vec::new(),
            is_over: false,
            stops: true,
            before: 0..0,
            last: None,
        }
    }

    /// Goes on after a syntax error.
    pub fn reading_on(mut self) -> Self {
        self.stops = false;
        self
    }

    pub(super) fn token(&self) -> Option<Token> {
        self.tokens.ahead[0]
    }

    pub(super) fn step(&mut self) -> Option<Token> {
        let token = self.tokens.step(self.report);
        if let Some(token) = &token {
            self.before = token.place();
        }
        token
    }

    /// Returns the keyword that follows, if there is one.
    pub(super) fn keyword(&self) -> Option<Keyword> {
        let token = self.token().filter(|token| token.form == TokenForm::Word)?;
        Keyword::of(self.tokens.raw(token))
    }

    fn text(&self, token: Token) -> Cow<'a, str> {
        self.tokens.text(token)
    }

    pub(super) fn is(&self, ahead: usize, form: TokenForm) -> bool {
        self.tokens.ahead[ahead].is_some_and(|token| token.form == form)
    }

    pub(super) fn is_word(&self, ahead: usize) -> bool {
        self.tokens.ahead[ahead].is_some_and(|token| !token.is_brace())
    }

    fn is_entity_type(&self) -> bool {
        self.token().is_some_and(|token| self.registry.find(&self.text(token)).is_some())
    }

    /// Tells whether a word, a name and an opening brace follow.
    fn has_form(&self) -> bool {
        self.is_word(0)
            && self.is_word(1)
            && self.is(2, TokenForm::Open)
            && self.token().is_some_and(|token| !looks_like_number(&self.text(token)))
    }

    /// Tells whether an entity begins here, even if its name or its brace is missing.
    pub(super) fn begins_entity(&self) -> bool {
        self.has_form()
            || (self.is_word(0) && self.is(1, TokenForm::Open))
            || (self.is_entity_type() && self.is_word(1))
    }

    /// Skips words that belong to no entity.
    pub(super) fn stray(&mut self) {
        let Some(first) = self.step() else { return };
        let (mut last, mut count) = (first, 1);
        while last.form != TokenForm::Close
            && !self.begins_entity()
            && self.keyword().is_none()
            && let Some(next) = self.step()
        {
            (last, count) = (next, count + 1);
        }
        let what = match (count, first.is_brace()) {
            (1, true) => format!("stray `{}`", self.text(first)),
            (1, false) => format!("stray word `{}`", self.text(first)),
            _ => format!("stray words from `{}` to `{}`", self.text(first), self.text(last)),
        };
        let mut fault = Fault::error(Some(first.start..last.end), what).label("not part of any entity");
        if let Some((opened, closed)) = &self.last {
            fault = fault
                .also(Some(opened.clone()), "the previous entity begins here")
                .also(Some(closed.clone()), "and ends here");
        }
        self.report
            .add(fault.help("every word of a scene must be part of an entity, `TYPE NAME { ATTRIBUTES }`"));
    }

    /// Parses an entity, in the memory of another one if there is one.
    pub(super) fn entity(&mut self, memory: &mut Option<Parsed<'a>>) -> Option<()> {
        let first = self.step()?;
        let (kind, kind_at) = (self.tokens.word(first), first.place());
        let name = match self.token() {
            Some(name) if !name.is_brace() => {
                let name = self.tokens.word(name);
                self.step();
                if self.rounds.is_open() { self.rounds.renamed(name) } else { name }
            }
            _ => {
                self.report.add(
                    Fault::error(Some(kind_at.clone()), format!("this `{}` has no name", kind.text))
                        .help(format!("write a name after the type: `{} NAME {{`", kind.text)),
                );
                Word::at("", Form::Any, first.end..first.end)
            }
        };
        if self.is(0, TokenForm::Open) {
            self.step();
        } else {
            let after = name.place.clone().unwrap_or_default();
            self.report.add(
                Fault::error(Some(after), format!("missing `{{` after {} `{}`", kind.text, name.text))
                    .label("expected `{` after this")
                    .help(format!("attributes go in braces: `{} {} {{ ... }}`", kind.text, name.text)),
            );
        }
        let known = self.tables.named(self.registry, &kind.text);
        let entity = match memory {
            Some(entity) => {
                entity.begin_again(kind, name);
                entity
            }
            None => memory.insert(Parsed::begin(kind, name)),
        };
        while !self.report.has_enough() && self.body_goes_on(entity) {
            if self.is(0, TokenForm::Open) {
                let brace = self.step().map(Token::place);
                self.report.add(
                    Fault::error(brace, "stray `{`")
                        .label("braces cannot be nested")
                        .also(Some(kind_at.clone()), "inside this entity"),
                );
            } else {
                self.attribute(known, entity);
            }
        }
        if !self.sets.is_empty() {
            self.sets.apply(entity, self.registry, &mut self.rounds.numbers, self.report);
        }
        entity.place = Some(first.start..self.before.end);
        self.last = Some((kind_at, self.before.clone()));
        Some(())
    }

    /// Tells whether another attribute of the entity follows; if not, skips the closing brace.
    fn body_goes_on(&mut self, entity: &Parsed<'a>) -> bool {
        if self.is(0, TokenForm::Close) {
            self.step();
            return false;
        }
        if self.token().is_some() && !self.has_form() {
            return true;
        }
        let end = self.tokens.text.len();
        let place = self.token().map_or(end..end, Token::place);
        let label = match self.token() {
            Some(next) => format!("expected `}}` before this `{}`", self.text(next)),
            None => "the text ends here".to_owned(),
        };
        self.report.add(
            Fault::error(
                Some(place),
                format!("missing `}}` for {} `{}`", entity.kind.text, entity.name.text),
            )
            .label(label)
            .also(entity.kind.place.clone(), "opened here"),
        );
        false
    }

    /// Reads an attribute and its values, however many there are and whatever their form.
    fn attribute(&mut self, table: Option<usize>, entity: &mut Parsed<'a>) {
        let Some(name) = self.step().map(|name| self.tokens.word(name)) else { return };
        let known = table.and_then(|table| {
            let table = &self.tables[table];
            let found = table.find_next(&name.text, entity.count());
            found.or_else(|| table.near(&name.text, self.report.guesses()))
        });
        let mut count = 0;
        while let Some(token) = self.token()
            && !token.is_brace()
            && !self.has_form()
            && (token.form() == Form::Text || {
                let (table, word) = (table.map(|table| &self.tables[table]), self.tokens.raw(token));
                let known = table.zip(known).map(|(table, known)| &table[known]);
                is_value(table, known, count, word, self.report.guesses())
            })
        {
            let word = self.tokens.word(token);
            let value_type = || table.zip(known).map(|(table, known)| self.tables[table][known].value_type);
            entity.value(if word.form == Form::Text || self.rounds.is_used() {
                self.rounds.word(word, value_type(), self.report)
            } else {
                word
            });
            count += 1;
            self.step();
        }
        let value_type = known.and_then(|known| table.map(|table| self.tables[table][known].value_type));
        if let (0, Some(Type::Name(kind)), true) = (count, value_type, self.is(0, TokenForm::Open)) {
            self.nested_entity(kind, &name, entity);
        }
        entity.add(name, self.report);
    }

    /// Skips an entity that is written in the place of its name, and reports it.
    fn nested_entity(&mut self, kind: Kind, name: &Word<'a>, entity: &mut Parsed<'a>) {
        let Some(open) = self.step() else { return };
        let mut depth = 1;
        while depth > 0
            && let Some(token) = self.step()
        {
            depth = match token.form {
                TokenForm::Open => depth + 1,
                TokenForm::Close => depth - 1,
                _ => depth,
            };
        }
        let place = open.start..self.before.end;
        let example = self.registry.example(kind, "NAME", self.report.syntax());
        let message = format!(
            "`{}` of {} `{}` takes the name of {}",
            name.text,
            entity.kind.text,
            entity.name.text,
            kind.with_article()
        );
        self.report.add(
            Fault::error(Some(place.clone()), message)
                .label("not defined here")
                .help(format!("define it before, {example}, and write `{} NAME` here", name.text)),
        );
        entity.value(Word::at("", Form::Faulty, place));
    }
}

/// Tells whether a word is a value, rather than the next attribute.
fn is_value(
    table: Option<&Table>,
    attribute: Option<&KnownAttribute>,
    already: usize,
    word: &str,
    guesses: &mut Guesses,
) -> bool {
    let max = attribute.map_or(1, |attribute| attribute.max);
    match attribute.map(|attribute| attribute.value_type) {
        // Of several formulas, the later ones may be left out.
        Some(Type::Formula(_)) if already > 0 && !looks_like_number(word) => {
            let is_attribute =
                table.is_some_and(|table| table.find(word).is_some() || table.near(word, guesses).is_some());
            already < max && !is_attribute
        }
        // A name may look like anything, even like a number or an attribute: `material material`.
        // The names of a list end where the next attribute begins, however many there are.
        Some(Type::Name(_)) if max > 1 => table.is_none_or(|table| table.find(word).is_none()),
        Some(Type::Word | Type::File | Type::Name(_) | Type::Choice(_) | Type::Formula(_) | Type::Truth) => {
            already < max
        }
        _ if looks_like_number(word) => true,
        _ => {
            let Some(table) = table else { return already < max };
            already < max && table.find(word).is_none() && table.near(word, guesses).is_none()
        }
    }
}

/// Tells whether a word begins as a number does.
pub fn looks_like_number(word: &str) -> bool {
    let is_digit = |word: &str| word.starts_with(|c: char| c.is_ascii_digit() || c == '.');
    let unsigned = || word.trim_start_matches(['+', '-']);
    is_digit(word)
        || is_digit(unsigned())
        || ["nan", "inf", "infinity"].iter().any(|number| unsigned().eq_ignore_ascii_case(number))
}
