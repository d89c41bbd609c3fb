//! The progress of a measurement.

use super::data::Panel;
use std::ops::ControlFlow;

/// Receives the progress of a measurement, and may break it off.
pub trait Progress: Send {
    /// Adds work that is to be done, in units of about a microsecond.
    fn more(&mut self, units: usize);
    /// Counts work as done, in the same units; breaks if no more is to be done.
    fn done(&mut self, units: usize) -> ControlFlow<()>;
    /// Says how many panels share the time that is left. The panel that begins may take its share.
    fn share(&mut self, _panels: usize) {}
    /// Tells whether half of the panel's share of time is used. Then the part of the truth that is known must do.
    fn is_late(&self) -> bool {
        false
    }
    /// Passes on the panels so far, which are kept if the rest is broken off.
    fn kept(&mut self, _panels: &[Panel]) {}
}
