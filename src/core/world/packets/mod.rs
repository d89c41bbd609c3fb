//! The packet versions of the traits of shapes, shaders and lights. Plugins do not use them.

pub(crate) mod brackets;
pub mod light;
mod proofs;
pub mod shader;
pub mod shape;
