//! Rendering that does not wait for the last tile when it stops: one packet of rays may take minutes.

use std::panic;
use std::sync::Arc;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread::{Builder, Scope};
use std::time::{Duration, Instant};
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::{ImageObserver, RenderCallbacks, Renderer};
use tabray_core::render::tiles::Band;

/// The time between two questions whether rendering is to stop, while no tile is finished that would ask.
const ASK: Duration = Duration::from_millis(20);

/// The time that unfinished tiles may take when rendering stops.
const GRACE: Duration = Duration::from_millis(100);

/// Renders as [`Renderer::fill`] does, until the overseer has stopped it for a moment: then threads may be left that are at
/// work on tiles, which the band does not get any more. The scope ends when they are done, so that whoever does not want to
/// wait ends the program before.
pub fn fill<'s, W: ImageObserver>(
    scope: &'s Scope<'s, '_>,
    (renderer, plan): (&'s Renderer, &'s Plan),
    band: &mut Band,
    overseer: RenderCallbacks<'s>,
    watched: &'s (dyn Fn(W) + Sync),
) {
    if (overseer.stops)() {
        return;
    }
    let (done, is_done) = mpsc::channel();
    let theirs =
        Band { columns: band.columns.clone(), rows: band.rows.clone(), strips: Arc::clone(&band.strips) };
    let work = move || {
        renderer.fill(plan, &theirs, overseer, watched);
        let _ = done.send(());
    };
    if Builder::new().spawn_scoped(scope, work).is_err() {
        // Without one more thread, the last tiles are waited for.
        return renderer.fill(plan, band, overseer, watched);
    }
    let mut stopped = None;
    loop {
        match is_done.recv_timeout(ASK) {
            Err(RecvTimeoutError::Timeout) => {}
            Ok(()) => return,
            // A thread panicked, and has said so.
            Err(RecvTimeoutError::Disconnected) => panic::resume_unwind(Box::new(())),
        }
        if (overseer.stops)() && stopped.get_or_insert_with(Instant::now).elapsed() >= GRACE {
            renderer.leave_threads();
            *band = band.copied();
            return;
        }
    }
}
