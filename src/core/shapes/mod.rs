//! Arithmetic that several shapes share.

mod ellipsoid;
pub mod field;
mod finite_plane;
pub(crate) mod implicit;
pub mod mesh;
pub mod outline;
pub(crate) mod placed;
pub mod plane;
pub(crate) mod quadratic;
pub mod rectangle;
pub(crate) mod revolution;
pub(crate) mod solid;
pub mod sphere;
pub(crate) mod triangle;
pub mod uv;

pub use ellipsoid::Ellipsoid;
pub use implicit::Implicit;
pub use placed::Placed;
pub use quadratic::Quadric;
pub use revolution::{ClassicRevolution, InFrame, Refinement, Revolution};
pub use solid::{Objects, combined};
pub use triangle::Triangle;

pub use crate::world::solid::Operation;
