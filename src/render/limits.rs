//! Limits on how far light is followed, and on the number of rays that a primary ray may cost.

pub use tabray_world::rules::MAX_DIST;

/// The ray budget: the work of one primary ray and its branches, counted in simple rays. Rays beyond it are black.
/// Without a limit, mirrors that nearly touch would reflect each other almost endlessly. A ray whose hit takes as
/// long to find as those of many simple rays counts as many.
pub const MAX_RAYS: usize = 20_000;

/// The maximum number of rays that are followed for a pixel under the free rules, shadow rays not counted. In most
/// glass, the bounds of a pixel's colour meet after a small part of them. A pixel's samples share these rays, and the
/// work of [`MAX_RAYS`] simple rays, evenly.
pub const MAX_TREE: u32 = 4096;

/// The largest number of parts into which a pixel's samples divide both.
pub const MIN_PART: u32 = 8;

/// Returns the maximum number of rays that are followed for a pixel under the free rules, and of simple rays whose work
/// they may take, where light bounces this often: each bounce has as many rays as there are without.
pub fn of_pixel(bounces: u32) -> [u32; 2] {
    [MAX_TREE, MAX_RAYS as u32].map(|most| (bounces + 1) * most)
}

/// The depth below which reflections are traced even where the rays transmitted before them have used up the ray
/// budget: those of primary rays, and of the rays that continue these.
pub(crate) const KEPT_DEPTH: usize = 2;

/// The divisor of a primary ray's budget that gives the part reserved for each such reflection. At most three of them
/// follow from one primary ray, so the budget is exceeded by less than a twentieth.
pub(crate) const KEPT_PART: u32 = 64;
