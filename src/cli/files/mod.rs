//! Scenes and images as files: how they are named, read and written.

pub mod input;
pub mod made;
pub mod output;
pub mod picture;
pub mod several;
