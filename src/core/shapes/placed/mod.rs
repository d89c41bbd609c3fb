//! Copies of objects in other places, which share the object's shape.
//!
//! A ray is taken to the object's own coordinates, and its hit back to the world. A `RayError` bounds the rounding of
//! both, and the shape returns a bracket of the hits of all rays within the drift. Where the bracket leaves a hit in
//! doubt, the ray as the scene gives it decides, with the sines and cosines of the angles enclosed in intervals.

mod body;
mod hit_proofs;
mod image_plane;
mod object_space;
mod packets;
mod shape;

pub use shape::Placed;
