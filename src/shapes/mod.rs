//! Arithmetic that several shapes share.

mod finite_plane;
pub(crate) mod implicit;
pub mod mesh;
pub mod plane;
pub(crate) mod quadratic;
pub mod rectangle;
pub(crate) mod revolution;
pub mod sphere;
pub(crate) mod triangle;

pub use implicit::Implicit;
pub use quadratic::Quadric;
pub use revolution::{Classic, Finish, InFrame, Revolution};
pub use triangle::Triangle;
