//! From a scene's text to a model, and back: the tables of entity types, and what is written from them.

pub mod choice;
pub mod dump;
pub mod entity;
pub mod grammar;
pub mod kind;
pub mod model;
pub mod pparm;
pub mod procedural;
pub mod profile;
pub mod reader;
pub mod reference;
pub mod registry;
pub mod schema;
pub mod syntax;
pub mod tables;
pub mod value;
