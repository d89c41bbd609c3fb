//! What a scene's text means: it is read, refused, built, dumped and spelled otherwise.

#[path = "../common/mod.rs"]
mod common;

mod dump;
mod extremes;
mod grammar;
mod model;
mod names;
mod robust;
mod toml;
