//! Completions of entity types, and of keywords.

use super::proposal::{Completion, CompletionContext, CompletionKind, plain};
use crate::snippet::Snippet;
use tabray_lang::reader::Keyword;
use tabray_lang::syntax::Syntax;

impl CompletionContext<'_> {
    /// Returns the types of entities, and the keywords.
    pub(super) fn types(&self, is_outside: bool) -> Vec<Completion> {
        let place = self.prefix();
        let names = |kind| self.names(kind);
        let before = self.view.text.as_str()[..place.start].trim_end_matches(|c: char| c != '\n' && c != '[');
        let has_bracket = self.view.syntax == Syntax::Toml && before.ends_with('[');
        let mut all: Vec<_> = self
            .registry
            .iter()
            .map(|known| {
                let mut snippet = Snippet::new(self.view, &names);
                snippet.entity(known, has_bracket);
                // Editors often insert the closing bracket.
                let is_closed = has_bracket && self.view.text.as_str()[self.at..].starts_with(']');
                let text = if is_closed { known.name.to_owned() } else { snippet.text };
                Completion {
                    detail: known.kind().to_string(),
                    about: known.meaning.to_owned(),
                    snippet: text,
                    has_places: !is_closed,
                    ..plain(known.name, CompletionKind::Type, &place)
                }
            })
            .collect();
        let keywords = match self.view.syntax {
            Syntax::Notes => [
                ("let", "let ${1:name} ${2:value}"),
                ("repeat", "repeat ${1:i} ${2:count} {\n    $0\n}"),
                ("include", "include ${1:FILE}"),
            ],
            Syntax::Toml if has_bracket => {
                [("let", "let]\n${1:name} = ${2:0}"), ("repeat", "repeat.${1:i}]\ncount = ${2:2}"), ("", "")]
            }
            Syntax::Toml => [
                ("let", "[let]\n${1:name} = ${2:0}"),
                ("repeat", "[repeat.${1:i}]\ncount = ${2:2}"),
                ("include", "include = \"${1:FILE}\""),
            ],
        };
        let keywords = keywords.iter().filter(|(word, _)| {
            !word.is_empty() && (is_outside || Keyword::of(word) != Some(Keyword::Include))
        });
        all.extend(keywords.map(|(word, snippet)| {
            Completion {
                snippet: (*snippet).to_owned(),
                has_places: true,
                about: Keyword::of(word)
                    .map_or("", |keyword| match self.view.syntax {
                        Syntax::Notes => keyword.usage(),
                        Syntax::Toml => keyword.usage_in_toml(),
                    })
                    .to_owned(),
                ..plain(word, CompletionKind::Keyword, &place)
            }
        }));
        all
    }
}
