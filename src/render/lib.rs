//! From a model of a scene to an image: the plan, tiles, the tracer, and files of images.
//!
//! This is one of the three crates behind `tabray-core`, which has an overview of them all.

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the system's functions"))]

pub mod brightness;
pub mod bytes;
pub mod decisions;
pub mod division;
pub mod enclosed;
mod features;
pub mod flaws;
pub mod footprint;
mod frusta;
mod levels;
pub mod limits;
pub mod observer;
pub mod output;
pub mod plan;
pub mod progressive;
pub mod ray_stats;
pub mod renderer;
pub mod tiles;
pub mod trace;

pub use bytes::to_byte;
pub use flaws::{BudgetCuts, FarPaths, Flaws, Undecided};
pub use levels::{DARK, Levels};
pub use observer::{Count, DropReason, Event, Hit, LightOutcome, RayKind, RayPurpose, TraceObserver};
pub use plan::Plan;
pub use ray_stats::{RayStats, TestCounts};
pub use renderer::Renderer;

#[cfg(test)]
#[path = "../properties.rs"]
mod property_tests;
#[cfg(test)]
use property_tests::properties;
