//! Solids: unions, intersections and differences of closed shapes.
//!
//! The surface of a solid consists of parts of the surfaces of its shapes. Each of these is an object of its own, with
//! its own material: a shape of which only those points are seen at which the other shapes allow it. So a ray's first hit
//! is found as that of any object: the hits of the one shape are visited, one after the other, until one is seen there.
//!
//! Whether a point lies in another shape is told by its equation in interval arithmetic. Where the surfaces of two shapes
//! are too close to each other for that, a proof about the ray as the scene gives it decides, and for rays that have no
//! such proof, points on both sides of the surface do. Of surfaces that coincide, those that border the solid on one side
//! only are seen, once.

mod crossings;
mod make;
mod onward;
mod packets;
mod shader;
mod trimmed;

pub use make::{Objects, combined};
