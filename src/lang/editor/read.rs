//! Reads a text as far as possible.

use super::text::Text;
use super::view::View;
use super::{notes, toml};
use crate::reader::{Fault, is_older};
use crate::registry::Registry;
use crate::syntax::Syntax;

/// Reads a text. Its syntax is that of the file's name, or else that in which the text begins. Of the course's older
/// scenes, nothing is read: none of their numbers has a name.
pub fn read(registry: &Registry, name: &str, text: Text) -> View {
    let syntax = match Syntax::of_name(name) {
        Some(Syntax::Toml) => Syntax::Toml,
        _ => Syntax::of_text(text.as_str()),
    };
    let read = match syntax {
        Syntax::Notes if is_older(registry, text.as_str()) => {
            let message = "this is an older scene of numbers, not one in the scene language";
            let line = 0..text.as_str().find('\n').unwrap_or(0);
            (Vec::new(), vec![Fault::error(Some(line), message)])
        }
        Syntax::Notes => notes::read(registry, text.as_str()),
        Syntax::Toml => toml::read(registry, text.as_str()),
    };
    View::new(text, syntax, read)
}
