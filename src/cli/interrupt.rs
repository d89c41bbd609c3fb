//! Ctrl-C: a command that keeps nothing ends at once; one that keeps what is done notes it, and stops soon. A second one
//! always ends the program at once.

use super::failure::{self, Failure};
use super::temporary;
use std::ops::ControlFlow;
use std::process;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

static MANNER: Mutex<Manner> = Mutex::new(Manner::Notes);

/// How long a command may take to stop that would rather keep what is done.
const PATIENCE: Duration = Duration::from_millis(800);

/// What comes of the first interruption.
#[derive(Clone, Copy)]
pub enum Manner {
    /// The program ends, and says this.
    Ends(&'static str),
    /// [`check`] knows of it.
    Notes,
    /// [`check`] knows of it, and if this is still so a moment later, the program ends and says this.
    NotesFirst(&'static str),
}

fn manner() -> MutexGuard<'static, Manner> {
    MANNER.lock().unwrap_or_else(PoisonError::into_inner)
}

/// From here on the first interruption comes to this.
pub fn from_here(next: Manner) {
    *manner() = next;
}

/// From here on interruptions are caught.
pub fn catch(first: Manner) -> Result<(), Failure> {
    from_here(first);
    handle(|| {
        // Held while the program ends, so that no other manner begins meanwhile.
        match *manner() {
            Manner::Ends(said) => failure::end(&Failure::Interrupted(said)),
            Manner::Notes => {}
            Manner::NotesFirst(_) => drop(thread::spawn(|| {
                thread::sleep(PATIENCE);
                if let Manner::NotesFirst(said) = *manner() {
                    failure::end(&Failure::Interrupted(said));
                }
            })),
        }
    })
}

/// From here on the first interruption is noted and calls `then`, on a thread of its own.
pub fn catch_and(then: impl FnMut() + Send + 'static) -> Result<(), Failure> {
    handle(then)
}

fn handle(mut then: impl FnMut() + Send + 'static) -> Result<(), Failure> {
    ctrlc::set_handler(move || {
        if INTERRUPTED.swap(true, Ordering::Relaxed) {
            temporary::remove_all();
            process::exit(130);
        }
        then();
    })
    .map_err(|error| Failure::Failed(format!("cannot catch interruptions: {error}")))
}

/// Ends the program if an interruption would, after `tell` has said why.
pub fn end_if_it_would(tell: impl FnOnce()) {
    if let Manner::Ends(_) = *manner() {
        tell();
        failure::end(&Failure::Stopped);
    }
}

/// Breaks if the user wants to stop.
pub fn check() -> ControlFlow<()> {
    if INTERRUPTED.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}
