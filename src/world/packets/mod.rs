//! The packet versions of the traits of shapes, shaders and lights. Plugins do not use them.

pub mod brackets;
pub mod light;
mod proofs;
pub mod shader;
pub mod shape;
