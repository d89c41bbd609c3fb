//! From a model to colours: the plan, the BVH, the tracer, and its observers.

pub(crate) mod bytes;
mod culling;
pub mod decisions;
pub(crate) mod division;
mod features;
pub(crate) mod flaws;
mod footprint;
mod frusta;
pub(crate) mod limits;
pub(crate) mod observer;
pub(crate) mod plan;
pub(crate) mod progressive;
pub(crate) mod ray_stats;
pub(crate) mod renderer;
pub(crate) mod tiles;
pub mod trace;

pub use bytes::to_byte;
pub use flaws::{BudgetCuts, Flaws, Undecided};
pub use observer::{Count, DropReason, Event, Hit, LightOutcome, RayKind, RayPurpose, TraceObserver};
pub use plan::Plan;
pub use ray_stats::{RayStats, TestCounts};
pub use renderer::Renderer;
