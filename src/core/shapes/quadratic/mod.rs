//! Ray-quadric intersection.
//!
//! The polynomial along a ray is expanded around the midpoint of its two hits: neither the viewer nor the origin of the
//! equation need be near. Every number has a bound of its rounding error. Where that could decide whether there is a
//! hit, which one is first or whether a box keeps it, everything is computed again in double-double arithmetic.

mod exact;
mod fine;
mod hits;
mod quadric;
mod quick;
mod surface;
#[cfg(test)]
mod tests;

pub use quadric::Quadric;
