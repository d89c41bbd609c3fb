//! Rays, boxes and frames: space without shapes.

pub(crate) mod bounds;
pub(crate) mod frame;
pub(crate) mod packet;
pub(crate) mod ray;
pub(crate) mod roots;
pub(crate) mod sight;

pub use bounds::{Bounds, clearance};
pub use frame::Frame;
pub use packet::{Nearest, Rays};
pub use ray::{Bracket, MISS, Ray, Side, Span};
pub use sight::Sight;
