//! Copies of objects in other places, which share its shape.
//!
//! A ray is taken to the object's own coordinates, and its hit back to the world. The rounding of that is bounded by a
//! `Drift`, and the shape tells what all rays within the drift hit. Where that is in doubt, the ray as the scene gives
//! it decides, for which the angles' sines and cosines are enclosed in intervals.

mod body;
mod onward;
mod own;
mod packets;
mod shape;

pub use shape::Placed;
