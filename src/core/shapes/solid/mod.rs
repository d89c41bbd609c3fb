//! Solids: unions, intersections and differences of closed shapes.
//!
//! The surface of a solid consists of parts of the surfaces of its shapes. Each of these parts is an object of its own,
//! with its own material: a shape that is seen only at the points where the other shapes allow it. So a ray's first hit
//! is found like that of any object: the hits of the one shape are visited, one after the other, until one of them is
//! seen.
//!
//! The equation of another shape, in interval arithmetic, tells whether a point lies in that shape. Where the surfaces
//! of two shapes are too close to each other for that, a proof about the ray as the scene gives it decides; for rays
//! that have no such proof, points on both sides of the surface decide. Where surfaces coincide, those that border the
//! solid on one side only are seen, and only once.

mod clip;
mod crossings;
mod hit_proofs;
mod make;
mod packets;
mod shader;
mod solid_part;

pub use clip::Clip;
pub(crate) use crossings::{Crossing, Crossings};
pub use make::{Objects, combined};
