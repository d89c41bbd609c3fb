//! Arithmetic that several shapes share.

pub mod ball;
pub mod flat;
pub(crate) mod implicit;
pub(crate) mod quadratic;
pub mod rectangle;
pub(crate) mod revolution;
pub(crate) mod triangle;

pub use implicit::Implicit;
pub use quadratic::Quadric;
pub use revolution::{Classic, Finish, InFrame, Revolution};
pub use triangle::Triangle;
