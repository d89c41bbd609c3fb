//! Limits on how far light is followed, and on the number of rays that a primary ray may cost.

pub use crate::world::rules::MAX_DIST;

/// The ray budget: the number of simple rays whose work one primary ray may cost, itself included; the rays beyond are
/// black. Without a limit, mirrors that nearly touch would reflect each other almost endlessly. A ray whose hit takes as
/// long to find as those of many simple rays counts as many.
pub const MAX_RAYS: usize = 20_000;

/// The number of rays that may be followed for a pixel under the free rules, shadow rays apart. In most glass, the
/// bounds of a pixel's colour meet after a small part of them. A pixel's samples share them evenly, and also the work
/// of [`MAX_RAYS`] simple rays.
pub const MAX_TREE: u32 = 4096;

/// The part of both that a sample has at least, however many there are.
pub const LEAST_PART: u32 = 8;

/// The depth of the reflections that are traced even where the rays transmitted before them have used up the ray
/// budget: the reflections of primary rays, and of the rays by which these continue.
pub(crate) const KEPT_DEPTH: usize = 2;

/// The divisor of a primary ray's budget that gives the part reserved for each such reflection. At most three of them
/// follow from one primary ray, so that the budget is exceeded by less than a twentieth.
pub(crate) const KEPT_PART: u32 = 64;
