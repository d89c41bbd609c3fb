//! Scenes as text: how they are read, refused, built in Rust, dumped and converted.

#[path = "../common/mod.rs"]
mod common;

mod computed;
mod dump;
mod extremes;
mod grammar;
mod many;
mod model;
mod names;
mod older;
mod python;
mod robust;
mod toml;
