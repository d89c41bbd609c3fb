//! Geometry without shapes: rays, bounding boxes and frames.

pub(crate) mod aabb;
pub(crate) mod bvh;
pub(crate) mod facet;
pub(crate) mod frame;
pub(crate) mod image_point;
pub(crate) mod orientation;
pub(crate) mod placement;
pub(crate) mod ray;
pub(crate) mod ray_packet;
pub(crate) mod roots;
pub(crate) mod sight;
pub(crate) mod view_frame;

pub use aabb::{Aabb, clearance};
pub use bvh::{Bvh, Stack};
pub use facet::Facet;
pub use frame::Frame;
pub use image_point::ImagePoint;
pub use placement::{Placement, Rotation};
pub use ray::{Bracket, MISS, Ray, RayRange, Side};
pub use ray_packet::{Nearest, RayPacket};
pub use sight::{Line, Sight};
pub use view_frame::ViewFrame;
