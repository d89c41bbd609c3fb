//! A bounding volume hierarchy (BVH) of any objects that have boxes.

mod beam;
mod build;
mod node;
mod packet;
mod tree;

pub use packet::{PacketVisitor, visit};
pub use tree::{Bvh, Stack};
