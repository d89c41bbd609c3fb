//! Ray-plane intersection: the arithmetic behind planes and shapes that are cut out of them.
//!
//! The course notes' form subtracts two numbers that grow with the distance from the world's origin, and takes a ray
//! for parallel where the dot product is 0, which it hardly ever is after rounding. Here the ray's origin is subtracted
//! first, a dot product that cancels is computed with compensation for its rounding errors (Ogita, Rump and Oishi
//! 2005), and where that is not enough, it is computed exactly. A distance does not depend on the length of the normal,
//! so it comes from the scene's own normal, not from the rounded unit vector.

mod crossing;
mod flat;
mod hits;
mod products;
mod surface;

pub use flat::{ByPlane, Flat};
pub use surface::{Plane, RoughCrossing};
