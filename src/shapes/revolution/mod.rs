//! Surfaces of revolution of a bounded profile: all points at the distance g(y) from the axis, for heights y from 0 to
//! the surface's own where g is not negative.
//!
//! A new surface is cut into slabs in which the square of the profile is a parabola to within a proven error
//! (`pieces`). Along a ray, these are quadrics of revolution with closed-form hits, which bracket the ray's first hit
//! or prove that there is none (`bracket`, for any number of rays). For a ray that grazes the shell of that error,
//! bounds of the second derivative decide ([`taylor`](tabray_exact::roots::taylor)) for that ray alone (`walk`), and if
//! rounding hides the decision, double-double arithmetic ([`twice`]). No parameter needs tuning. A profile without such
//! a proof within a fixed number of operations is refused, with the reason (`NoSurface`). The margins for a ray's own
//! rounding errors are derived in place, or tested in `tests/slow/truth.rs`, which compares hits with true ones.
//!
//! [`twice`]: tabray_exact::roots::twice

mod bracket;
mod budget;
mod classic;
mod lanes;
mod line;
mod local;
mod no_surface;
mod normal;
mod pieces;
mod quadratic;
mod ranges;
mod root;
mod runs;
mod shape;
mod slab;
mod surface;
#[cfg(test)]
mod tests;
mod walk;

pub use classic::ClassicRevolution;
pub use shape::InFrame;
pub use surface::{Refinement, Revolution};
