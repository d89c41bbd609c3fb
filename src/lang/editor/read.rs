//! Reads a text as far as possible.

use super::text::Text;
use super::view::View;
use super::{notes, toml};
use crate::registry::Registry;
use crate::syntax::Syntax;

/// Reads a text. Its syntax is that of the file's name, or else that in which the text begins.
pub fn read(registry: &Registry, name: &str, text: Text) -> View {
    let syntax = match Syntax::of_name(name) {
        Some(Syntax::Toml) => Syntax::Toml,
        _ => Syntax::of_text(text.as_str()),
    };
    let read = match syntax {
        Syntax::Notes => notes::read(registry, text.as_str()),
        Syntax::Toml => toml::read(registry, text.as_str()),
    };
    View::new(text, syntax, read)
}
