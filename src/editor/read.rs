//! The tolerant reader of a text.

use super::text::Text;
use super::view::View;
use super::{notes, toml};
use tabray_lang::reader::{Fault, is_older};
use tabray_lang::registry::Registry;
use tabray_lang::syntax::Syntax;

/// Reads a text. The syntax follows from the file's name, or else from the beginning of the text. The course's older
/// scenes are not read, because none of their numbers has a name.
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
