//! Arithmetic shared by several shapes or shaders: planes, spheres, quadrics, formulas, meshes, solids.
//!
//! This is one of the three crates behind `tabray-core`, which has an overview of them all.

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the system's functions"))]

pub mod by_method;
pub mod cosine_palette;
mod ellipsoid;
pub mod field;
mod finite_plane;
pub mod implicit;
mod made;
pub mod mesh;
pub mod outline;
pub mod parametric;
pub mod placed;
pub mod plane;
pub mod quadratic;
pub mod rectangle;
pub mod revolution;
pub mod solid;
pub mod sphere;
pub mod triangle;
pub mod uv;

pub use ellipsoid::Ellipsoid;
pub use implicit::Implicit;
pub use made::Made;
pub use placed::Placed;
pub use quadratic::Quadric;
pub use revolution::{ClassicRevolution, InFrame, Refinement, Revolution};
pub use solid::{Clip, Objects, combined};
pub use triangle::loose::LooseTriangle;

pub use tabray_world::solid::Operation;

#[cfg(test)]
#[path = "../properties.rs"]
mod property_tests;
#[cfg(test)]
use property_tests::properties;
