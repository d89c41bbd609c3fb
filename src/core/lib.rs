//! The core of a ray tracer in which a scene is data: geometry, what a scene is made of, the tables of entity types,
//! shapes, rendering and images.
//!
//! A [`Model`](scene::Model) becomes a [`Plan`](render::Plan), and tile by tile an image
//! ([`Renderer`](render::Renderer), [`Format`](output::Format)). [`prelude`] has all that an entity type needs, which a
//! plugin registers as an [`Entity`](scene::Entity). Texts of scenes are read by `tabray-lang`, and the entity types of
//! tabray are in `tabray-plugins`.

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the system's functions"))]

// The vectors of positions and colours, and the numbers of formulas.
pub use glam;
pub use tabray_exact as exact;

pub mod files;
pub mod geometry;
pub mod memory;
pub mod output;
pub mod parallel;
pub mod prelude;
pub mod render;
pub mod scene;
pub mod shapes;
pub mod simd;
pub mod text;
pub mod world;
