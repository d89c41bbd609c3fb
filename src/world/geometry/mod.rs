//! Geometry without shapes: rays, bounding boxes and frames.

pub mod aabb;
pub mod bvh;
pub mod facet;
pub mod frame;
pub mod image_point;
pub mod orientation;
pub mod placement;
pub mod ray;
pub mod ray_packet;
pub mod sight;
pub mod view_frame;

pub use aabb::{Aabb, clearance};
pub use bvh::{Bvh, Stack};
pub use facet::Facet;
pub use frame::Frame;
pub use image_point::ImagePoint;
pub use placement::{Placement, Rotation};
pub use ray::{Bracket, MISS, Ray, RayBall, RayError, RayRange, Side};
pub use ray_packet::{HitRecordMut, RayPacket};
pub use sight::{Line, Sight};
pub use view_frame::ViewFrame;
