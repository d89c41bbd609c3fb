//! Ray-quadric intersection.
//!
//! The polynomial along a ray is expanded around the midpoint of its two hits, which keeps precision far from the
//! viewer and from the origin of the equation. Each number has a bound of its rounding error. If the error could affect
//! whether there is a hit, which hit is first or whether it is in the box, the computation is repeated in double-double
//! arithmetic.

mod exact;
mod fine;
mod hits;
mod quadric;
mod quick;
mod surface;
#[cfg(test)]
mod tests;

pub use quadric::Quadric;
