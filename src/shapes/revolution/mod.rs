//! Surfaces of revolution of a profile that has a bound: every point at the distance g(y) from the axis, for heights y from 0 to
//! the surface's own, wherever g is not negative.
//!
//! Each is cut, when it is made, into slabs in which the profile's square is a parabola but for a proven error
//! (`slabs`). A ray meets the quadrics of revolution around those in closed form, which brackets its first hit or
//! proves that there is none (`bracket`, for any number of rays). Where it grazes the error's shell, bounds of the second
//! derivative decide ([`taylor`](crate::geometry::roots::taylor)) on its way alone (`walk`), and where rounding hides what they
//! say, twice the precision ([`twice`]). Nothing has to be tuned. A profile of which all that cannot be proven within a
//! stated number of operations is refused, with the reason ([`NoSurface`](no_surface::NoSurface)). The rounding of a ray's own arithmetic is held
//! by margins that are derived where they stand, and tried against the truth in `tests/slow/truth.rs`.

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
mod shape;
mod surface;
#[cfg(test)]
mod tests;
mod walk;

pub use classic::Classic;
pub use shape::InFrame;
pub use surface::{Finish, Revolution};
