//! Where a ray meets a surface of the second degree.
//!
//! The polynomial along a ray comes from the ray's point closest to the middle of its two hits: neither the viewer nor the
//! place that the equation counts from need be near. Every number has a bound of its rounding. Where that could decide
//! whether there is a hit, which one is first or whether a box keeps it, all of it is done again in twice the precision.

mod exact;
mod fine;
mod quadric;
mod quick;
mod surface;
#[cfg(test)]
mod tests;

pub use quadric::Quadric;
