//! Rays, bounding boxes and frames: space without shapes.

pub(crate) mod aabb;
pub(crate) mod bvh;
pub(crate) mod frame;
pub(crate) mod placement;
pub(crate) mod ray;
pub(crate) mod ray_packet;
pub(crate) mod roots;
pub(crate) mod sight;

pub use aabb::{Aabb, clearance};
pub use bvh::{Bvh, Stack};
pub use frame::Frame;
pub use placement::Placement;
pub use ray::{Bracket, MISS, Ray, RayRange, Side};
pub use ray_packet::{Nearest, RayPacket};
pub use sight::Sight;
