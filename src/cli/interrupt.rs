//! Ctrl-C: the first stops the work under way and cleans up, a second one ends the program at once.

use super::failure::Failure;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// From here on an interruption is only noted, for [`check`] to act on.
pub fn catch() -> Result<(), Failure> {
    catch_and(|| ())
}

/// As [`catch`], and the first one calls `then`, on a thread of its own.
pub fn catch_and(mut then: impl FnMut() + Send + 'static) -> Result<(), Failure> {
    ctrlc::set_handler(move || {
        if INTERRUPTED.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
        then();
    })
    .map_err(|error| Failure::Failed(format!("cannot catch interruptions: {error}")))
}

/// Breaks if the user wants to stop.
pub fn check() -> ControlFlow<()> {
    if INTERRUPTED.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}
