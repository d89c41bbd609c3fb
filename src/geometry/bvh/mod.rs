//! A bounding volume hierarchy (BVH) of any objects that have boxes.

mod beam;
mod build;
mod node;
mod tree;

pub use tree::{Bvh, Stack};
