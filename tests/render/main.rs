//! Images of every scene, however they are rendered, and the reports about their pixels.

#[path = "../common/mod.rs"]
mod common;

mod differences;
mod inside;
mod plan;
mod readme;
mod snapshots;
mod verify;
