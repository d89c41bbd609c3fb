//! The scene language: from a scene's text to a [`Model`](tabray_core::scene::Model) and back, the documents generated
//! from the tables of entity types, and what an [`editor`] asks about a scene.

pub mod dump;
pub mod editor;
pub mod grammar;
mod json_schema;
pub mod list_json;
pub mod reader;
pub mod reference;
pub mod registry;
pub mod schema;
pub mod syntax;

pub use reader::{Fault, Loaded, Parsed, Place, Report, Severity, build, read};
pub use registry::Registry;
pub use syntax::Syntax;

// Tests read scenes, and so need entity types.
#[cfg(test)]
use tabray_plugins as _;
