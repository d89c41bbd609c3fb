//! Pictures: of every scene, whoever makes them, and what is told of their pixels.

#[path = "../common/mod.rs"]
mod common;

mod differences;
mod inside;
mod plan;
mod readme;
mod snapshots;
mod verify;
