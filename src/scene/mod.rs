//! From a scene's text to a model, and back: the tables of entity types, and the documents generated from them.

pub(crate) mod attribute;
pub(crate) mod choice;
pub(crate) mod counts;
pub mod dump;
pub(crate) mod entity;
pub mod grammar;
pub(crate) mod kind;
pub(crate) mod list;
pub(crate) mod list_json;
pub(crate) mod model;
pub(crate) mod pparm;
pub(crate) mod procedural;
pub(crate) mod profile;
pub(crate) mod reader;
pub mod reference;
pub(crate) mod references;
pub(crate) mod registry;
pub(crate) mod rotation;
pub mod schema;
pub(crate) mod store;
pub(crate) mod syntax;
pub(crate) mod value;

pub use attribute::{Attribute, Pose};
pub use choice::Choice;
pub use counts::{Counts, OneOf};
pub use entity::{Args, Entity, Refusal};
pub use kind::Kind;
pub use list::List;
pub use model::Model;
pub use pparm::{Derived, Pparm, Row, Table};
pub use profile::Profile;
pub use reader::{Fault, Loaded, Parsed, Place, Report, Severity, build, read};
pub use registry::Registry;
pub use store::Record;
pub use syntax::Syntax;
pub use value::{COLOUR, Datum, Type};
