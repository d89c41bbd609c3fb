//! A ray tracer in which a scene is data and every entity type is a plugin.
//!
//! The way of the data is one street: a scene's text becomes entities as written ([`scene`]), checked against
//! the tables of their types ([`entity`], [`pparm`]), then a [`Model`](model::Model), then a picture
//! ([`render`], [`picture`]). A model can also be built
//! without any text ([`scene::build`]), and printed again ([`dump`]).
//!
//! A file in `plugins/` adds an entity type: it registers an [`Entity`](entity::Entity) and implements a trait
//! of [`geometry`]. No other file knows its name. A plugin outside of this package does the same, and its program is
//! [`cli::run`] (see `docs/plugins.md`).

// What a plugin outside of this package writes its types and its registration with.
pub use {glam, inventory};

pub mod accuracy;
pub mod aov;
pub mod ball;
pub mod bench;
pub mod bounds;
mod bundles;
pub mod camera;
pub mod certify;
pub mod chart;
pub mod checkpoint;
pub mod choice;
pub mod cli;
pub mod coincidence;
pub mod compare;
pub mod contract;
pub mod cpu;
pub mod debug;
pub mod dual;
pub mod dump;
pub mod entity;
pub mod facing;
pub mod flat;
pub mod formula;
pub mod frame;
pub mod geometry;
pub mod grammar;
pub mod implicit;
pub mod interval;
pub mod landing;
pub mod material;
pub mod model;
pub mod number;
pub mod octet;
pub mod packet;
pub mod picture;
pub mod plan;
pub mod pparm;
pub mod probe;
pub mod profile;
pub mod progressive;
pub mod quadratic;
pub mod rectangle;
pub mod reference;
pub mod registry;
pub mod render;
pub mod revolution;
pub mod roots;
pub mod sample;
pub mod scene;
pub mod schema;
pub mod shading;
pub mod sight;
pub mod syntax;
pub mod tables;
pub mod tally;
pub mod texture;
pub mod tiles;
pub mod trace;
pub mod tree;
pub mod triangle;
pub mod twofold;
pub mod value;
pub mod verify;
pub mod watch;
pub mod words;

include!(concat!(env!("OUT_DIR"), "/plugins.rs"));

#[path = "../plugins"]
mod plugins {
    plugins!();
}
