//! Images of every scene, by each way to render them, and the reports about their pixels.

#[path = "../common/mod.rs"]
mod common;

mod backgrounds;
mod colours;
mod differences;
mod glass;
mod inside;
mod needs;
mod plan;
mod readme;
mod sealed;
mod shaders;
mod snapshots;
mod verify;
