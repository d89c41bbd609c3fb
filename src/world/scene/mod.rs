//! Scenes as data: the tables of entity types, the values of attributes, and the model that is made of them.

pub mod attribute;
pub mod choice;
mod common;
pub mod counts;
pub mod entity;
pub mod kind;
pub mod list;
pub mod model;
pub mod pparm;
pub mod procedural;
pub mod profile;
pub mod references;
pub(crate) mod rotation;
mod setting;
pub mod store;
pub mod value;

pub use attribute::{Attribute, Pose};
pub use choice::Choice;
pub use counts::{Counts, OneOf};
pub use entity::{Args, Entity, Refusal};
pub use kind::Kind;
pub use list::List;
pub use model::Model;
pub use pparm::{Derived, Pparm, Row, Table};
pub use profile::Profile;
pub use store::Record;
pub use value::{COLOUR, Datum, Type};
