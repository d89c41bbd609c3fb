//! A ray tracer in which a scene is data and every entity type is a plugin.
//!
//! Data flows in one direction: a scene's text becomes entities, checked against the tables of their types, then a
//! [`Model`](scene::Model), then a [`Plan`](render::Plan), and tile by tile an image ([`Renderer`](render::Renderer),
//! [`Format`](output::Format)). A model can also be built without any text ([`scene::build`]), and printed again
//! ([`scene::dump`]). `docs/architecture.md` draws this flow, and the module of each step.
//!
//! A file in `plugins/` adds an entity type: it registers an [`Entity`](scene::Entity) and implements a trait of
//! [`world`]; [`prelude`] has all that it needs. No other file mentions it. A plugin outside of this package does the
//! same, and calls [`cli::run`] from its own `main` (see `docs/plugins.md`).

// The vectors of positions and colours.
pub use glam;

pub mod cli;
mod editor;
mod files;
pub mod geometry;
mod heap;
pub mod numeric;
pub mod output;
mod parallel;
pub mod prelude;
pub mod render;
pub mod scene;
pub mod shapes;
pub mod simd;
mod text;
pub mod tools;
pub mod world;

include!(concat!(env!("OUT_DIR"), "/plugins.rs"));

#[path = "../plugins"]
mod plugins {
    plugins!();
}
