//! Answers to an editor's questions about a scene: pure functions of its text, which may be incomplete.
//!
//! All names come from the tables of the registered entity types. With the feature `commands`, also the subcommands.

mod colours;
#[cfg(feature = "commands")]
mod commands;
mod complete;
mod diagnose;
mod format;
mod format_toml;
mod formulas;
pub mod grammar;
mod hints;
mod hover;
mod json_schema;
mod look_at;
mod named;
mod names;
mod notes;
mod outline;
mod project;
mod read;
pub mod schema;
mod semantic;
mod signature;
mod snippet;
#[cfg(test)]
mod tests;
mod text;
mod toml;
mod toml_events;
mod types;
mod view;
mod word;

pub use colours::{Swatch, colours, presented};
pub use complete::{Completion, CompletionKind, completions};
pub use diagnose::{Diagnosis, diagnose};
pub use format::{formatted, problem};
pub use hints::{Hint, hints};
pub use hover::hover;
pub use look_at::{Change, LookAt, look_at};
pub use names::{name_at_cursor, unknown_numbers};
pub use outline::{Fold, Symbol, folds, outline};
pub use project::{Files, Group, Location, definitions, group, renamed, usages};
pub use read::read;
pub use semantic::{SemanticToken, TokenKind, semantic_tokens};
pub use signature::signature;
pub use text::{Position, Text};
pub use view::{Attribute, Item, View, Word};

// Tests read scenes, and so need entity types.
#[cfg(test)]
use tabray_plugins as _;

#[cfg(test)]
#[path = "../properties.rs"]
mod property_tests;
#[cfg(test)]
use property_tests::properties;
