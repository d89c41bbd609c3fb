//! Images of every scene, by each way to render them, and the reports about their pixels.

#![allow(clippy::disallowed_methods, reason = "no picture depends on what a test computes")]

#[path = "../common/mod.rs"]
mod common;

mod alpha;
mod backgrounds;
mod bounces;
mod colours;
mod coverage;
mod cuts;
mod differences;
mod docs;
mod emitted;
mod footprints;
mod glass;
mod gloss;
mod inside;
mod laws;
mod left_out;
mod materials;
mod needs;
mod packets;
mod patches;
mod plan;
mod plastic;
mod ray_budget;
mod readme;
mod rules;
mod sealed;
mod shaders;
mod snapshots;
mod unbounded;
mod verify;
