//! Solids: unions, intersections and differences of closed shapes.
//!
//! The surface of a solid consists of parts of the surfaces of its shapes. Each part is an object with its own
//! material, and its shape is visible only where the other shapes allow it. A ray's search visits the hits of that
//! shape, one after the other, until one of them is visible.
//!
//! The equations of the other shapes, in interval arithmetic, tell whether a hit lies in them. Where two surfaces are
//! too close for that, a proof about the exact ray decides. For a ray without such a proof, points on both sides of the
//! surface decide. Of coincident surfaces, those that border the solid on exactly one side are visible, and only one of
//! them.

mod clip;
mod crossings;
mod hit_proofs;
mod make;
mod packets;
mod shader;
mod solid_part;

pub use clip::Clip;
pub use crossings::{Crossing, Crossings};
pub use make::{Objects, combined};
pub(crate) use make::{placed, union};
