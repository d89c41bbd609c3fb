//! The kinds of the words of a text, for colouring in an editor.

use super::formulas::{self, WordKind};
use super::toml_events::events;
use super::types::{ExpectedValue, expected_value};
use super::view::{Attribute, Entity, Form, Item, Let, View, Word};
use std::collections::BTreeMap;
use std::ops::Range;
use tabray_exact::formula::functions;
use tabray_lang::reader::Keyword;
use tabray_lang::reader::report::Report;
use tabray_lang::reader::{Token, TokenForm};
use tabray_lang::syntax::Syntax;
use toml_parser::parser::EventKind;

/// The kinds of words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TokenKind {
    /// An entity type.
    Type,
    /// The name of an entity or of a number.
    Name,
    /// An attribute.
    Attribute,
    /// A number.
    Number,
    /// A file name, or any other word.
    Word,
    /// A comment.
    Comment,
    /// An operator of a formula.
    Operator,
    /// A function of formulas.
    Function,
    /// A variable of a formula.
    Variable,
    /// One of several alternatives, including `yes` and `no`.
    Choice,
    /// `let`, `repeat` or `include`.
    Keyword,
}

impl TokenKind {
    /// All kinds.
    pub const ALL: [Self; 11] = [
        Self::Type,
        Self::Name,
        Self::Attribute,
        Self::Number,
        Self::Word,
        Self::Comment,
        Self::Operator,
        Self::Function,
        Self::Variable,
        Self::Choice,
        Self::Keyword,
    ];

    /// Returns the name of the kind in the Language Server Protocol.
    pub fn name(self) -> &'static str {
        match self {
            Self::Type => "type",
            Self::Name => "variable",
            Self::Attribute => "property",
            Self::Number => "number",
            Self::Word => "string",
            Self::Comment => "comment",
            Self::Operator => "operator",
            Self::Function => "function",
            Self::Variable => "parameter",
            Self::Choice => "enumMember",
            Self::Keyword => "keyword",
        }
    }
}

/// A word of a text, or a part of one.
#[derive(Clone, Debug, PartialEq)]
pub struct SemanticToken {
    /// The range of the word, in bytes.
    pub place: Range<usize>,
    /// The kind of the word.
    pub kind: TokenKind,
    /// Whether the word is the name in a definition.
    pub is_definition: bool,
}

/// Returns the words of a text, in order, without overlaps.
pub fn semantic_tokens(view: &View) -> Vec<SemanticToken> {
    let mut words = Words { view, found: BTreeMap::new() };
    view.visit(&mut |item, _| words.item(item));
    match view.syntax {
        Syntax::Notes => words.comments(),
        Syntax::Toml => words.rest_of_toml(),
    }
    words.found.into_values().collect()
}

/// The words found so far, by their first bytes.
struct Words<'v> {
    view: &'v View,
    found: BTreeMap<usize, SemanticToken>,
}

impl Words<'_> {
    /// Adds a word, unless one is already known there. Words of items come first.
    fn add(&mut self, place: Range<usize>, kind: TokenKind, is_definition: bool) {
        if !place.is_empty() {
            self.found.entry(place.start).or_insert(SemanticToken { place, kind, is_definition });
        }
    }

    fn word(&mut self, word: Word, kind: TokenKind) {
        self.add(word.place(), kind, false);
    }

    fn item(&mut self, item: &Item) {
        let start = item.place().start;
        if self.view.syntax == Syntax::Notes && !matches!(item, Item::Entity(_)) {
            let rest = self.view.slice(start..item.place().end);
            let length = rest.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(rest.len());
            self.add(start..start + length, TokenKind::Keyword, false);
        }
        match item {
            Item::Entity(entity) => self.entity(entity),
            Item::Let(number) => self.number(number),
            Item::Include(include) => {
                include.files.iter().for_each(|file| self.word(*file, TokenKind::Word));
            }
            Item::Repeat(repeat) => {
                for name in repeat.name.iter().chain(&repeat.again) {
                    self.add(name.place(), TokenKind::Name, true);
                }
                repeat.count.into_iter().for_each(|count| self.formula(count, &[]));
            }
        }
    }

    fn entity(&mut self, entity: &Entity) {
        if entity.known.is_some() {
            self.word(entity.kind, TokenKind::Type);
        }
        for name in entity.name.iter().chain(&entity.again) {
            self.add(name.place(), TokenKind::Name, true);
        }
        for attribute in &entity.attributes {
            if attribute.known.is_some() {
                self.word(attribute.name, TokenKind::Attribute);
            }
            attribute.values.iter().for_each(|value| self.value(entity, attribute, *value));
        }
    }

    fn value(&mut self, entity: &Entity, attribute: &Attribute, word: Word) {
        let expected = attribute.known.map(|known| expected_value(entity, known));
        match expected {
            Some(ExpectedValue::Numbers) => self.formula(word, &[]),
            Some(ExpectedValue::Formula(variables)) => self.formula(word, variables),
            _ if self.is_number(word) => self.word(word, TokenKind::Number),
            Some(ExpectedValue::Name(_)) => self.word(word, TokenKind::Name),
            Some(ExpectedValue::Choice(_) | ExpectedValue::Truth) => self.word(word, TokenKind::Choice),
            Some(ExpectedValue::File | ExpectedValue::Word) => self.word(word, TokenKind::Word),
            None if word.form != Form::Bare => self.word(word, TokenKind::Word),
            None => {}
        }
    }

    fn is_number(&self, word: Word) -> bool {
        word.form == Form::Bare && self.view.slice(word.place()).parse::<f64>().is_ok()
    }

    /// Adds a named number, or a function with the names of its arguments.
    fn number(&mut self, number: &Let) {
        let mut arguments = Vec::new();
        if let Some(name) = number.name {
            let (head, start) = (self.view.slice(name.inner()), name.inner().start);
            let words = formulas::words(head).into_iter().filter(|(_, kind)| *kind == WordKind::Name);
            let mut places = words.map(|(place, _)| place);
            let is_function = head.contains('(');
            if let Some(place) = places.next() {
                let kind = if is_function { TokenKind::Function } else { TokenKind::Name };
                self.add(start + place.start..start + place.end, kind, true);
            }
            for place in places {
                arguments.push(&head[place.clone()]);
                self.add(start + place.start..start + place.end, TokenKind::Variable, true);
            }
        }
        number.value.into_iter().for_each(|value| self.formula(value, &arguments));
    }

    /// Adds the words of a formula, or the number in place of a formula.
    fn formula(&mut self, word: Word, variables: &[&str]) {
        if self.is_number(word) {
            return self.word(word, TokenKind::Number);
        }
        let (text, start) = (self.view.slice(word.inner()), word.inner().start);
        if text.contains('\\') {
            return self.word(word, TokenKind::Word);
        }
        for (place, kind) in formulas::words(text) {
            let is_called = || text[place.end..].trim_start().starts_with('(');
            let name = &text[place.clone()];
            let kind = match kind {
                WordKind::Number => TokenKind::Number,
                WordKind::Sign if "(),".contains(name) => continue,
                WordKind::Sign => TokenKind::Operator,
                WordKind::Name if variables.contains(&name) => TokenKind::Variable,
                WordKind::Name if ["pi", "π"].contains(&name) => TokenKind::Number,
                WordKind::Name if is_called() || functions().any(|(known, _)| known == name) => {
                    TokenKind::Function
                }
                WordKind::Name => TokenKind::Name,
            };
            self.add(start + place.start..start + place.end, kind, false);
        }
    }

    fn comments(&mut self) {
        let (text, mut at) = (self.view.text.as_str(), 0);
        let nowhere = &mut Report::default();
        while let Some(token) = Token::at(text, at, nowhere) {
            if token.form == TokenForm::Comment {
                self.add(token.place(), TokenKind::Comment, false);
            }
            at = token.end.max(at + 1);
        }
    }

    /// Adds comments, and the keys outside of entities.
    fn rest_of_toml(&mut self) {
        for event in events(self.view.text.as_str()).0 {
            let place = event.span().start()..event.span().end();
            match event.kind() {
                EventKind::Comment => self.add(place, TokenKind::Comment, false),
                EventKind::SimpleKey => match self.view.slice(place.clone()) {
                    "count" => self.add(place, TokenKind::Attribute, false),
                    key if Keyword::of(key).is_some() => self.add(place, TokenKind::Keyword, false),
                    _ => {}
                },
                _ => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Text, read};
    use tabray_lang::registry::Registry;

    /// Returns the words of a text with the names of their kinds. Words of definitions are marked by `!`.
    fn told(file: &str, text: &str) -> String {
        let view = read(Registry::get().expect("plugins"), file, Text::new(text));
        let word = |token: SemanticToken| {
            let mark = if token.is_definition { "!" } else { "" };
            format!("{}{mark}:{}", &text[token.place], token.kind.name())
        };
        semantic_tokens(&view).into_iter().map(word).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn words_of_both_syntaxes_have_their_kinds() {
        let notes = "# two\nlet wave(u) \"a*sin(u)\" include b.inc\nrepeat i 3 { sphere ball { center 1 \"2*r + pi\" -3 \
                     material red } }\nimplicit s { formula \"x^2 - 1e-3\" shader two }\ncamera c { pixeldim 8 6 tone clip raduis 2 }";
        assert_eq!(
            told("a.ray", notes),
            "# two:comment let:keyword wave!:function u!:parameter a:variable *:operator sin:function u:parameter \
             include:keyword b.inc:string repeat:keyword i!:variable 3:number sphere:type ball!:variable center:property \
             1:number 2:number *:operator r:variable +:operator pi:number -3:number material:property red:variable \
             implicit:type s!:variable formula:property x:parameter ^:operator 2:number -:operator 1e-3:number \
             shader:property two:variable camera:type c!:variable pixeldim:property 8:number 6:number tone:property \
             clip:enumMember 2:number"
        );
        let toml = "include = \"b.toml\" # two\n[let]\nr = 2\n[repeat.i]\ncount = 3\n[repeat.i.sphere.ball]\ncenter = [1, \"r/2\", -3]\n";
        assert_eq!(
            told("a.toml", toml),
            "include:keyword \"b.toml\":string # two:comment let:keyword r!:variable 2:number repeat:keyword \
             i!:variable count:property 3:number repeat:keyword i!:variable sphere:type ball!:variable center:property \
             1:number r:variable /:operator 2:number -3:number"
        );
    }
}
