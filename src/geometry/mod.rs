//! Rays, boxes and frames: space without shapes.

pub mod bounds;
pub mod frame;
pub mod packet;
pub mod ray;
pub mod roots;
pub mod sight;
