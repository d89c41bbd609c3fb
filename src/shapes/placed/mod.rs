//! Copies of objects in other places. Copies share the object's shape.
//!
//! A ray is mapped to object space, and its hit back to world space. A `RayError` bounds the rounding of both maps, and
//! the shape returns a bracket of the hits of all rays within the drift. If the bracket leaves a hit in doubt, the
//! exact ray decides, with the sines and cosines of the angles enclosed in intervals.

mod body;
mod hit_proofs;
mod image_plane;
mod object_space;
mod packets;
mod shape;

pub use shape::Placed;
