//! Pictures and other files that are made of what is rendered.

pub mod aov;
pub mod checkpoint;
pub mod compare;
pub mod picture;
