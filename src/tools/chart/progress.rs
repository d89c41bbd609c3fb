//! How far a measurement is.

use std::ops::ControlFlow;

/// Receives the progress of a measurement, and may break it off.
pub trait Progress: Send {
    /// Adds work that is to be done, in units of about a microsecond.
    fn more(&mut self, units: usize);
    /// Counts work as done, in the same units; breaks if no more is to be done.
    fn done(&mut self, units: usize) -> ControlFlow<()>;
    /// Says that there are measurements that are kept if the rest is broken off.
    fn kept(&mut self) {}
}
