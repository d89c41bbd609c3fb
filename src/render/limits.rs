//! How far light is followed, and how many rays a look costs at most.

/// Light that has travelled farther than this is black.
pub(crate) const MAX_DIST: f64 = 20.0;

/// The rays that one camera ray may cost. Mirrors that nearly touch would otherwise reflect each other for ever;
/// what lies beyond is black.
pub(crate) const MAX_RAYS: usize = 20_000;
