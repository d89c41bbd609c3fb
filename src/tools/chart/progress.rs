//! How far the work is.

use std::ops::ControlFlow;

/// Whoever is told how far the work is, and may break it off.
pub trait Progress: Send {
    /// So much more work is known of, in units of about a microsecond.
    fn more(&mut self, units: usize);
    /// So much of it is done; breaks where no more is to be done.
    fn done(&mut self, units: usize) -> ControlFlow<()>;
    /// Something is measured that is kept when the rest is broken off.
    fn kept(&mut self) {}
}
