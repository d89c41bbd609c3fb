//! From a model to colours: the plan, the BVH, the tracer, and its observers.

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
pub mod plan;
pub mod progressive;
pub mod ray_stats;
pub mod renderer;
pub mod tiles;
pub mod trace;

pub use bytes::to_byte;
pub use flaws::{BudgetCuts, FarPaths, Flaws, Undecided};
pub use levels::Levels;
pub use observer::{Count, DropReason, Event, Hit, LightOutcome, RayKind, RayPurpose, TraceObserver};
pub use plan::Plan;
pub use ray_stats::{RayStats, TestCounts};
pub use renderer::Renderer;
