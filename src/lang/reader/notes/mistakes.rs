//! Mistakes that beginners bring from other languages: loops, names of several words, and other brackets than braces.
//! Each is reported once, with its cure, and what follows is read as meant.

use super::Grammar;
use crate::reader::fault::Fault;
use crate::reader::keyword::Keyword;
use crate::reader::parsed::Word;
use crate::reader::tokens::{Token, TokenForm};

impl Grammar<'_, '_> {
    /// Tells whether a loop of another language begins here, in the form of a `repeat`.
    pub(super) fn is_loop(&self) -> bool {
        let is_before_brace = |token: Token| self.tokens.text[token.end..].trim_start().starts_with('{');
        self.has_loop_word()
            && self.is_word(1)
            && self.is_word(2)
            && self.tokens.ahead[2].is_some_and(is_before_brace)
    }

    /// Tells whether a loop of another language begins here, in a form of its own.
    pub(super) fn is_other_loop(&self) -> bool {
        self.has_loop_word() && !self.is_entity_type()
    }

    fn has_loop_word(&self) -> bool {
        let word = self.token().filter(|token| token.form == TokenForm::Word);
        word.is_some_and(|word| matches!(self.tokens.raw(word), "for" | "foreach" | "loop" | "while"))
    }

    /// Reports a loop of another language.
    pub(super) fn refuse_loop(&mut self) {
        let Some(word) = self.token() else { return };
        let message = format!("there is no `{}`", self.text(word));
        self.report.add(Fault::error(Some(word.place()), message).help(Keyword::Repeat.usage()));
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

    /// Skips further words of an entity's name, and reports them. `after` is the byte where the type ends.
    pub(super) fn refuse_further_words(&mut self, kind: &Word<'_>, name: &Word<'_>, after: usize) {
        let further = self.further_words_of_name();
        if further == 0 {
            return;
        }
        let mut words = vec![name.text.to_string()];
        let mut end = after;
        for _ in 0..further {
            if let Some(word) = self.step() {
                words.push(self.text(word).into_owned());
                end = word.end;
            }
        }
        let start = name.place.clone().map_or(after, |place| place.start);
        let message = format!("`{}` is not one word", words.join(" "));
        self.report.add(Fault::error(Some(start..end), message).help(format!(
            "a name is one word: `{} {} {{`",
            kind.text,
            words.join("_")
        )));
    }

    /// Returns how many words before a brace are further words of a name.
    fn further_words_of_name(&self) -> usize {
        let is_part = |ahead: usize| {
            self.tokens.ahead[ahead].is_some_and(|token| {
                !token.is_brace()
                    && self.tokens.raw(token).bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_')
                    && self.registry.find(&self.text(token)).is_none()
            })
        };
        (1..3).find(|count| (0..*count).all(is_part) && self.is(*count, TokenForm::Open)).unwrap_or(0)
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
