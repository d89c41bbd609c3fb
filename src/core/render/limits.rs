//! The limits of how far light is followed, and of how many rays a primary ray may cost.

pub use crate::world::rules::MAX_DIST;

/// The ray budget: the number of simple rays whose work one primary ray may cost, itself included; the rays beyond are
/// black. Without a limit, mirrors that nearly touch would reflect each other almost endlessly. A ray whose hit takes as
/// long to find as those of many simple rays counts as many.
pub const MAX_RAYS: usize = 20_000;

/// The ray budget of a pixel by the free rules, which its samples share evenly. Two bounds of a pixel's colour meet after a
/// tenth of it in most glass.
pub const MAX_TREE: u32 = 2048;

/// The least ray budget of a sample by the free rules.
pub(crate) const LEAST_TREE: u32 = 128;

/// The depth of the reflections that are traced even where the rays that were transmitted before them have used up the
/// ray budget: that of primary rays, and that of the rays which these continue as.
pub(crate) const KEPT_DEPTH: usize = 2;

/// The divisor of a primary ray's budget that gives the part reserved for each such reflection. At most three of them
/// follow from one primary ray, so that the budget is exceeded by less than a twentieth.
pub(crate) const KEPT_PART: u32 = 64;
