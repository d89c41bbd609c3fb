//! Arithmetic that several shapes share.

pub mod ball;
pub mod flat;
pub mod implicit;
pub mod quadratic;
pub mod rectangle;
pub mod revolution;
