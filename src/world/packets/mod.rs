//! What follows from the traits of shapes, looks and lights for packets of rays. No plugin needs to know of it.

pub mod light;
pub mod shader;
pub mod shape;
