//! Completion: proposals for the text at a position.

mod files;
mod notes;
mod proposal;
mod toml;
mod types;
mod values;

use super::project::Group;
use super::view::View;
use proposal::CompletionContext;
pub use proposal::{Completion, CompletionKind};
use tabray_lang::reader::is_older;
use tabray_lang::registry::Registry;
use tabray_lang::syntax::Syntax;

/// Returns the completions at a position of the group's first file.
pub fn completions(registry: &Registry, group: &Group, at: usize) -> Vec<Completion> {
    let Some((path, view)) = group.first() else { return Vec::new() };
    let at = tabray_core::text::boundary(view.text.as_str(), at);
    let here = CompletionContext { registry, view, group, folder: path.parent().unwrap_or(path), at };
    if in_comment(view, at) || is_older(registry, view.text.as_str()) {
        return Vec::new();
    }
    match view.syntax {
        Syntax::Notes => here.in_notes(),
        Syntax::Toml => here.in_toml(),
    }
}

/// Tells whether a position is in a comment: after a `#` that begins a word outside of quotes.
fn in_comment(view: &View, at: usize) -> bool {
    let text = view.text.as_str();
    let line = text[..at].rfind('\n').map_or(0, |end| end + 1);
    let mut is_quoted = false;
    let mut before = ' ';
    for letter in text[line..at].chars() {
        match letter {
            '"' if before != '\\' => is_quoted = !is_quoted,
            '#' if !is_quoted
                && (view.syntax == Syntax::Toml || before.is_whitespace() || "{}".contains(before)) =>
            {
                return true;
            }
            _ => {}
        }
        before = letter;
    }
    false
}
