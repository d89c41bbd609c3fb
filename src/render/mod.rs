//! From a model to colours: the plan, the tree of boxes, the tracer, and who watches it.

mod bundles;
pub mod bytes;
pub mod decisions;
pub mod limits;
pub mod plan;
pub mod progressive;
pub mod renderer;
pub mod tally;
pub mod tiles;
pub mod trace;
pub mod tree;
pub mod watch;
