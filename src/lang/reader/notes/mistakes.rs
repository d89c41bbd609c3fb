//! Mistakes that beginners bring from other languages: loops, names of several words, files without braces, and other
//! brackets than braces. Each is reported once, with its cure, and what follows is read as meant.

use super::{Grammar, Node, Statement};
use crate::reader::fault::Fault;
use crate::reader::files;
use crate::reader::guesses::looks_like_number;
use crate::reader::keyword::Keyword;
use crate::reader::loops;
use crate::reader::parsed::{Form, Word};
use crate::reader::tokens::{Token, TokenForm};

impl<'a> Grammar<'a, '_> {
    /// Returns the word of a loop of another language that begins here, or a `repeat` without its name or its count.
    pub(super) fn foreign_loop(&self) -> Option<&'a str> {
        let token = self.token().filter(|token| token.form == TokenForm::Word)?;
        let word = loops::word(self.tokens.raw(token))?;
        let is_foreign = match Keyword::of(word) {
            Some(_) => {
                let is_number = |name: Token| looks_like_number(self.tokens.raw(name));
                let has_brace = |count: Token| self.tokens.text[count.end..].trim_start().starts_with('{');
                let [_, name, count] = self.tokens.ahead.map(|token| token.filter(|token| !token.is_brace()));
                name.is_none_or(is_number) || !count.is_some_and(has_brace)
            }
            None => !self.is_entity_type(),
        };
        is_foreign.then_some(word)
    }

    /// Reads a loop of another language as the `repeat` that it means, and reports it. One that is not clear is
    /// skipped.
    pub(super) fn loop_as_meant(&mut self, word: &'a str) -> Node<'a> {
        let Some(first) = self.token() else { return Node::Stray };
        let place = first.start..first.start + word.len();
        let message = match Keyword::of(word) {
            Some(_) => format!("this `{word}` is incomplete"),
            None => format!("there is no `{word}`"),
        };
        let head = loops::head(self.tokens.text, place.end).map(|head| {
            let entity = head.split_whitespace().find(|word| self.registry.find(word).is_some());
            entity.map_or(head, |entity| &head[..entity.as_ptr() as usize - head.as_ptr() as usize])
        });
        let Some(run) = head.and_then(loops::run) else {
            self.report.add(Fault::error(Some(place), message).help(Keyword::Repeat.usage()));
            self.skip_block();
            return Node::Stray;
        };
        self.report.add(Fault::error(Some(place.clone()), message).help(run.cure()));
        let end = place.end + head.map_or(0, str::len);
        while self.token().is_some_and(|token| token.start < end) {
            self.step();
        }
        if !self.is(0, TokenForm::Open) {
            return Node::Stray;
        }
        let open = self.step();
        let words = [run.name.to_owned(), run.count.to_string()];
        let words = words.map(|word| Some(Word::at(word, Form::Any, place.clone())));
        Node::Statement(Statement { keyword: Keyword::Repeat, first, words, open })
    }

    /// Skips words up to an opening brace, and up to the brace that closes it. Without one, skips the words before the
    /// next part.
    pub(super) fn skip_block(&mut self) {
        self.step();
        let is_part = |grammar: &Self| {
            grammar.keyword().is_some() || grammar.is_entity_type() || grammar.is(0, TokenForm::Close)
        };
        while !self.is(0, TokenForm::Open) {
            if is_part(self) || self.step().is_none() {
                return;
            }
        }
        self.step();
        self.skip_to_close();
    }

    /// Skips what follows an opening brace, with the brace that closes it.
    pub(super) fn skip_to_close(&mut self) {
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
    }

    /// Adds further words to an entity's name, and reports them. `after` is the byte where the type ends.
    pub(super) fn refuse_further_words(&mut self, kind: &Word<'_>, name: &mut Word<'a>, after: usize) {
        let further = self.further_words_of_name();
        if further == 0 {
            return;
        }
        let mut words = vec![name.text.to_string()];
        for _ in 0..further {
            words.extend(self.step().map(|word| self.text(word).into_owned()));
        }
        let start = name.place.clone().map_or(after, |place| place.start);
        name.place = Some(start..self.before.end);
        let words = words.join(" ");
        name.text = words.split_whitespace().collect::<Vec<_>>().join("_").into();
        let message = format!("`{words}` is not one word");
        self.report.add(
            Fault::error(name.place.clone(), message)
                .help(format!("a name is one word: `{} {} {{`", kind.text, name.text)),
        );
    }

    /// Returns how many words before a brace are further words of a name. The last one may be that of a type.
    fn further_words_of_name(&self) -> usize {
        let is_part = |word: &str| word.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
        if self.is(0, TokenForm::Open) {
            return 0;
        }
        let words = loops::head(self.tokens.text, self.before.end)
            .filter(|head| self.tokens.text[self.before.end + head.len()..].trim_start().starts_with('{'));
        let words: Vec<_> = words.unwrap_or_default().split_whitespace().collect();
        let Some((last, others)) = words.split_last() else { return 0 };
        let is_name =
            is_part(last) && others.iter().all(|word| is_part(word) && self.registry.find(word).is_none());
        if is_name { words.len() } else { 0 }
    }

    /// Takes the name of a file that stands after an entity's name in place of its braces, and reports it. Returns the
    /// attribute that is meant, with its value.
    pub(super) fn file_without_braces(
        &mut self,
        kind: &Word<'a>,
        name: &Word<'a>,
    ) -> Option<(Word<'a>, Word<'a>)> {
        let token = self.token().filter(|token| !token.is_brace())?;
        let file = self.tokens.word(token);
        let mut attributes = self.registry.find(&kind.text)?.attributes();
        let attribute =
            attributes.find(|attribute| files::takes(*attribute) && files::is_file(&file.text))?;
        self.step();
        let pair = self.report.syntax().pair(attribute.name(), &[self.report.syntax().word(&file.text)]);
        let message = format!("missing `{{` after {} `{}`", kind.text, name.text);
        self.report.add(
            Fault::error(name.place.clone(), message)
                .label("expected `{` after this")
                .help(format!("attributes go in braces: `{} {} {{ {pair} }}`", kind.text, name.text)),
        );
        Some((Word { text: attribute.name().into(), ..file.clone() }, file))
    }

    /// Skips a bracket where an entity's brace is expected, and reports it. Returns what closes it.
    pub(super) fn wrong_bracket(&mut self, kind: &Word<'_>, name: &Word<'_>) -> Option<&'static str> {
        let token = self.token()?;
        let closing = match self.tokens.raw(token) {
            "(" => ")",
            "[" => "]",
            "<" => ">",
            _ => return None,
        };
        self.step();
        let message = format!("`{}` in place of `{{`", self.text(token));
        self.report.add(
            Fault::error(Some(token.place()), message)
                .help(format!("attributes go in braces: `{} {} {{ ... }}`", kind.text, name.text)),
        );
        Some(closing)
    }
}
