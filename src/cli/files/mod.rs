//! Scenes and images as files: how they are named, read and written.

pub mod folders;
#[cfg(unix)]
mod in_place;
pub mod input;
pub mod mesh;
pub mod output;
pub mod paths;
pub mod picture;
pub mod provenance;
pub mod several;
pub mod standard;
