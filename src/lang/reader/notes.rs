//! The grammar of the notes' scene language: `entity-type name { attribute values ... }`, one word after another. The
//! reader, `fmt` and editors share it.

mod mistakes;

use super::fault::Fault;
use super::guesses::{Tables, is_value, looks_like_number};
use super::keyword::Keyword;
use super::parsed::{Form, Parsed, Word};
use super::report::Report;
use super::same_words::SameWords;
use super::tokens::{Token, TokenForm, Tokens};
use crate::registry::Registry;
use std::borrow::Cow;
use std::ops::Range;
use tabray_core::scene::kind::Kind;
use tabray_core::scene::value::Type;

/// Parses an entity at a byte of a text again. Its faults have already been reported.
pub fn again<'a>(registry: &Registry, text: &'a str, at: usize) -> Option<Parsed<'a>> {
    let mut nowhere = Report::default();
    let mut entity = None;
    Grammar::new(registry, text, at, &mut nowhere).entity(&mut entity);
    entity
}

/// Returns the place of the type of the first complete entity in a text, if any.
pub fn has_entities(registry: &Registry, text: &str) -> Option<Range<usize>> {
    let mut nowhere = Report::default();
    let mut grammar = Grammar::new(registry, text, 0, &mut nowhere);
    while let Some(token) = grammar.token() {
        if grammar.is_entity_type() && grammar.has_form() {
            return Some(token.place());
        }
        grammar.step();
    }
    None
}

/// A part of a scene. Its errors are reported.
pub enum Node<'a> {
    /// An entity.
    Entity,
    /// A statement other than an entity, such as `let`.
    Statement(Statement<'a>),
    /// The closing brace of a `repeat`.
    Close(Token),
    /// Words outside of any part.
    Stray,
}

/// A keyword and its words.
pub struct Statement<'a> {
    /// The keyword.
    pub keyword: Keyword,
    /// The keyword's token.
    pub first: Token,
    /// The words after the keyword: a file, a name and a value, or a name and a count. A missing word is reported.
    pub words: [Option<Word<'a>>; 2],
    /// The opening brace of a `repeat`.
    pub open: Option<Token>,
}

/// The parser of a text in the notes' syntax, which returns its parts in order.
pub struct Grammar<'a, 'r> {
    pub(super) registry: &'r Registry,
    pub(super) tokens: Tokens<'a>,
    /// The faults so far.
    pub report: &'r mut Report<'a>,
    pub(super) tables: Tables,
    /// Whether the text is a draft. In a draft, a line break ends values before an attribute, an entity ends an
    /// incomplete entity before it, and all values are kept.
    is_draft: bool,
    /// The place of the last token.
    pub before: Range<usize>,
    /// The last entity: the place of its first word, and that of its end.
    last: Option<(Range<usize>, Range<usize>)>,
    /// The range between the braces of the last entity.
    pub body: Range<usize>,
    /// The table of the last entity.
    pub table: Option<usize>,
}

impl<'a, 'r> Grammar<'a, 'r> {
    /// Begins at a byte of a text.
    pub fn new(registry: &'r Registry, text: &'a str, at: usize, report: &'r mut Report<'a>) -> Self {
        Self {
            registry,
            tokens: Tokens::from(text, at, report),
            report,
            tables: Tables::default(),
            is_draft: false,
            before: 0..0,
            last: None,
            body: 0..0,
            table: None,
        }
    }

    /// Begins with a draft.
    pub fn of_draft(registry: &'r Registry, text: &'a str, report: &'r mut Report<'a>) -> Self {
        Self { is_draft: true, ..Self::new(registry, text, 0, report) }
    }

    #[inline]
    /// Returns the next token.
    pub fn token(&self) -> Option<Token> {
        self.tokens.ahead[0]
    }

    #[inline]
    fn step(&mut self) -> Option<Token> {
        let token = self.tokens.step(self.report);
        if let Some(token) = &token {
            self.before = token.place();
        }
        token
    }

    /// Continues at another byte of the text.
    pub fn go_to(&mut self, at: usize) {
        self.tokens = Tokens::from(self.tokens.text, at, self.report);
    }

    /// Returns the next token as a keyword, if it is one.
    #[inline]
    fn keyword(&self) -> Option<Keyword> {
        let token = self.token().filter(|token| token.form == TokenForm::Word)?;
        Keyword::of(self.tokens.raw(token))
    }

    fn text(&self, token: Token) -> Cow<'a, str> {
        self.tokens.text(token)
    }

    #[inline]
    fn is(&self, ahead: usize, form: TokenForm) -> bool {
        self.tokens.ahead[ahead].is_some_and(|token| token.form == form)
    }

    #[inline]
    fn is_word(&self, ahead: usize) -> bool {
        self.tokens.ahead[ahead].is_some_and(|token| !token.is_brace())
    }

    fn is_entity_type(&self) -> bool {
        self.token().is_some_and(|token| self.registry.find(&self.text(token)).is_some())
    }

    /// Tells whether a word, a name and an opening brace follow.
    #[inline]
    fn has_form(&self) -> bool {
        self.is(2, TokenForm::Open)
            && self.is_word(0)
            && self.is_word(1)
            && self.token().is_some_and(|token| !looks_like_number(&self.text(token)))
    }

    /// Tells whether an entity begins here, even with a missing name or brace.
    fn begins_entity(&self) -> bool {
        self.has_form()
            || (self.is_word(0) && self.is(1, TokenForm::Open))
            || (self.is_entity_type() && self.is_word(1))
    }

    /// Tells whether the text from here on has an entity.
    pub fn looks_like_a_scene(&self) -> bool {
        self.begins_entity()
            || self.keyword().is_some()
            || has_entities(self.registry, self.tokens.text).is_some()
    }

    /// Reads the next part. An entity reuses the memory of another one, if given. If `is_repeated`, a brace ends the
    /// text.
    pub fn next(&mut self, is_repeated: bool, memory: &mut Option<Parsed<'a>>) -> Option<Node<'a>> {
        if let Some(word) = self.foreign_loop() {
            Some(self.loop_as_meant(word))
        } else if let Some(keyword) = self.keyword() {
            self.statement(keyword).map(Node::Statement)
        } else if is_repeated && self.is(0, TokenForm::Close) {
            self.step().map(Node::Close)
        } else if self.begins_entity() {
            self.entity(memory).map(|()| Node::Entity)
        } else {
            self.stray(is_repeated).map(|()| Node::Stray)
        }
    }

    /// Reads entities with the same words as those in `memory`, in their place, as far as possible. Returns their
    /// number.
    pub fn same_words(&mut self, memory: &mut [Option<Parsed<'a>>]) -> usize {
        let Some(first) = self.token() else { return 0 };
        let (mut end, mut last, mut count) = (first.start, None, 0);
        while let Some(Some(entity)) = memory.get_mut(count)
            && let Some(same) = entity.take_same_words(self.tokens.text, end)
        {
            (end, count) = (same.body.end + 1, count + 1);
            last = Some(same);
        }
        if let Some(SameWords { kind, body }) = last {
            self.go_to(end);
            self.table = self.tables.named(self.registry, &self.tokens.text[kind.clone()]);
            (self.before, self.body) = (body.end..end, body);
            self.last = Some((kind, self.before.clone()));
        }
        count
    }

    /// Reads a keyword and its words.
    fn statement(&mut self, keyword: Keyword) -> Option<Statement<'a>> {
        let first = self.step()?;
        let mut words = [None, None];
        let count = if keyword == Keyword::Include { 1 } else { 2 };
        for (index, word) in words[..count].iter_mut().enumerate() {
            let is_next = self.is_draft && keyword != Keyword::Repeat && self.has_form();
            let token = self.token().filter(|token| !token.is_brace() && !is_next);
            let Some(mut token) = token else { break };
            self.step();
            if keyword == Keyword::Let && index == 0 {
                token = self.head(token);
            }
            *word = Some(self.tokens.word(token));
        }
        let is_whole = words[count - 1].is_some();
        let repeats = is_whole && keyword == Keyword::Repeat && self.is(0, TokenForm::Open);
        let open = if repeats { self.step() } else { None };
        if !is_whole || keyword == Keyword::Repeat && open.is_none() {
            let message = format!("this `{}` is incomplete", self.tokens.raw(first));
            self.report.add(Fault::error(Some(first.place()), message).help(keyword.usage()));
        }
        Some(Statement { keyword, first, words, open })
    }

    /// Consumes the rest of a function's head, `f(u, v)`, that begins with a word, and a `=` after it. Returns the
    /// whole head.
    fn head(&mut self, first: Token) -> Token {
        let is_word = |token: &Token| token.form == TokenForm::Word;
        let is_closed = |grammar: &Self, token: Token| grammar.tokens.raw(token).ends_with(')');
        if !is_word(&first) || !self.tokens.raw(first).contains('(') {
            return first;
        }
        let mut last = first;
        while !is_closed(self, last)
            && let Some(next) = self.token().filter(is_word)
        {
            last = next;
            self.step();
        }
        if self.token().is_some_and(|token| self.tokens.raw(token) == "=") {
            self.step();
        }
        Token { end: last.end, ..first }
    }

    /// Skips words outside of entities.
    fn stray(&mut self, is_repeated: bool) -> Option<()> {
        let first = self.step()?;
        let (mut last, mut count) = (first, 1);
        while last.form != TokenForm::Close
            && !(is_repeated && self.is(0, TokenForm::Close))
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
        Some(())
    }

    /// Parses an entity, in the memory of another one, if given.
    fn entity(&mut self, memory: &mut Option<Parsed<'a>>) -> Option<()> {
        let first = self.step()?;
        let (kind, kind_at) = (self.tokens.word(first), first.place());
        self.table = self.tables.named(self.registry, &kind.text);
        // The type stands alone, before another entity.
        let is_alone = self.is_draft && self.table.is_some() && self.is_entity_type() && self.is_word(1);
        let mut name = match self.token() {
            Some(name) if !name.is_brace() && !is_alone => {
                self.step();
                self.tokens.word(name)
            }
            _ => {
                self.report.add(
                    Fault::error(Some(kind_at.clone()), format!("this `{}` has no name", kind.text))
                        .help(format!("write a name after the type: `{} NAME {{`", kind.text)),
                );
                Word::at("", Form::Any, first.end..first.end)
            }
        };
        self.refuse_further_words(&kind, &mut name, first.end);
        let (mut bracket, mut file) = (None, None);
        if self.is(0, TokenForm::Open) {
            self.step();
        } else if !is_alone && let Some(found) = self.file_without_braces(&kind, &name) {
            file = Some(found);
        } else if !is_alone && let Some(closing) = self.wrong_bracket(&kind, &name) {
            bracket = Some(closing);
        } else if !is_alone {
            let after = name.place.clone().unwrap_or_default();
            self.report.add(
                Fault::error(Some(after), format!("missing `{{` after {} `{}`", kind.text, name.text))
                    .label("expected `{` after this")
                    .help(format!("attributes go in braces: `{} {} {{ ... }}`", kind.text, name.text)),
            );
        }
        let entity = match memory {
            Some(entity) => {
                entity.begin_again(kind, name);
                entity
            }
            None => memory.insert(Parsed::begin(kind, name)),
        };
        self.body = self.before.end..self.before.end;
        let mut has_body = !is_alone;
        if let Some((attribute, file)) = file {
            entity.value(file);
            entity.add(attribute, self.report);
            has_body = self.is(0, TokenForm::Open) && self.step().is_some();
        }
        while has_body && !self.report.has_enough() && self.body_goes_on(entity) {
            if bracket
                .is_some_and(|closing| self.token().is_some_and(|token| self.tokens.raw(token) == closing))
            {
                self.step();
                break;
            }
            if self.is(0, TokenForm::Open) {
                let brace = self.step().map(Token::place);
                self.report.add(
                    Fault::error(brace, "stray `{`")
                        .label("braces cannot be nested")
                        .also(Some(kind_at.clone()), "inside this entity"),
                );
            } else {
                self.attribute(entity);
            }
        }
        entity.place = Some(first.start..self.before.end);
        self.last = Some((kind_at, self.before.clone()));
        Some(())
    }

    /// Tells whether another attribute of the entity follows. Otherwise, skips the closing brace.
    fn body_goes_on(&mut self, entity: &Parsed<'a>) -> bool {
        self.body.end = self.token().map_or(self.tokens.text.len(), |token| token.start);
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

    /// Reads an attribute and its values, regardless of their number and form.
    fn attribute(&mut self, entity: &mut Parsed<'a>) {
        let Some(name) = self.step().map(|name| self.tokens.word(name)) else { return };
        let table = self.table.map(|table| &self.tables[table]);
        let known = table.and_then(|table| {
            let found = table.find_next(&name.text, entity.count());
            let found = found.or_else(|| table.near(&name.text, self.report.guesses()))?;
            Some(&table[found])
        });
        let value_type = known.map(|known| known.value_type);
        let mut count = 0;
        while let Some(token) = self.tokens.ahead[0]
            && !token.is_brace()
            && !self.has_form()
            && (token.form() == Form::Text || {
                let word = self.tokens.raw(token);
                let is_below = self.is_draft && self.tokens.text[self.before.end..token.start].contains('\n');
                is_value(table, known, (count, is_below), word, self.report.guesses())
            })
        {
            let word = self.tokens.word(token);
            if self.is_draft {
                entity.keep(word)
            } else {
                entity.value(word)
            }
            count += 1;
            self.tokens.step(self.report);
            self.before = token.place();
        }
        if let (0, Some(Type::Name(kind)), true) = (count, value_type, self.is(0, TokenForm::Open)) {
            self.nested_entity(kind, &name, entity);
        }
        entity.add(name, self.report);
    }

    /// Skips an entity in place of a name, and reports it.
    fn nested_entity(&mut self, kind: Kind, name: &Word<'a>, entity: &mut Parsed<'a>) {
        let Some(open) = self.step() else { return };
        self.skip_to_close();
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
                .help(format!("define it earlier, {example}, and write `{} NAME` here", name.text)),
        );
        entity.value(Word::at("", Form::Faulty, place));
    }
}
