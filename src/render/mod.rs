//! From a model to colours: the plan, the tree of boxes, the tracer, and who watches it.

mod bundles;
pub(crate) mod bytes;
mod culling;
pub mod decisions;
pub(crate) mod limits;
pub(crate) mod plan;
pub(crate) mod progressive;
pub(crate) mod renderer;
pub(crate) mod tally;
pub(crate) mod tiles;
pub mod trace;
pub(crate) mod tree;
pub(crate) mod watch;

pub use bytes::to_byte;
pub use plan::Plan;
pub use renderer::Renderer;
pub use tally::{Tally, Tests};
pub use watch::{Count, Event, Hit, Kind, Outcome, Purpose, Reason, Watch};
