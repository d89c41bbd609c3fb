//! Ray-plane intersection: the arithmetic behind planes and their parts.
//!
//! The course notes subtract two numbers that grow with the distance from the world's origin. They treat a ray as
//! parallel if the dot product is 0, which is rare after rounding. Here, the ray's origin is subtracted first. A dot
//! product that cancels is computed with compensation for its rounding errors (Ogita, Rump and Oishi 2005), and if that
//! is not enough, exactly. A distance does not depend on the length of the normal, and so it comes from the scene's own
//! normal, not from the rounded unit vector.

mod crossing;
mod flat;
mod hits;
mod products;
mod surface;

pub use surface::{Plane, RoughCrossing};
