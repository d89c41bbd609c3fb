//! Panics, which are faults of the program itself. Each is reported as a message, and a server keeps running.

use crate::process::failure::{self, Failure};
use crate::process::program;
use std::panic::{self, AssertUnwindSafe, Location};
use std::sync::{Mutex, MutexGuard, PoisonError};

struct Last {
    /// The message of the last panic.
    said: String,
    /// The name of the scene that was read last.
    scene: String,
}

static LAST: Mutex<Last> = Mutex::new(Last { said: String::new(), scene: String::new() });

fn last() -> MutexGuard<'static, Last> {
    LAST.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Keeps panics, in place of printing them, so that [`catch`] can report them.
pub fn capture_panics() {
    panic::set_hook(Box::new(|info| {
        let payload = info.payload();
        let text = payload.downcast_ref::<String>().map(String::as_str);
        let said = text.or_else(|| payload.downcast_ref().copied()).unwrap_or("no reason");
        // So the standard library tells that a thread did not start for lack of memory, where nothing can be unwound.
        if said.contains("alternative stack") {
            let scene = scene().map_or(String::new(), |scene| format!(" for `{scene}`"));
            failure::end_keeping_bar(&Failure::Failed(format!(
                "not enough memory{scene}: a thread did not start"
            )));
        }
        let place = info.location().map(Location::to_string).unwrap_or_default();
        last().said = format!("{said} ({place})");
    }));
}

/// Names the scene that later panics are reported for.
pub fn set_scene(scene: &str) {
    scene.clone_into(&mut last().scene);
}

/// Returns the name of the scene that was read last, unless it is being set now.
pub fn scene() -> Option<String> {
    LAST.try_lock().ok().map(|last| last.scene.clone()).filter(|scene| !scene.is_empty())
}

/// Runs `work` and turns a panic into a failure.
pub fn catch<T>(work: impl FnOnce() -> T) -> Result<T, Failure> {
    panic::catch_unwind(AssertUnwindSafe(work)).map_err(|_| {
        let Last { said, scene } = &*last();
        let scene = if scene.is_empty() { String::new() } else { format!(" at `{scene}`") };
        Failure::Failed(format!(
            "internal error{scene}: {said}; this is a bug in {} {} or in one of its plugins; please report it with the scene",
            program::name(),
            env!("CARGO_PKG_VERSION")
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_a_failure_that_names_the_scene_and_the_version() {
        set_scene("ball.ray");
        let Err(Failure::Failed(told)) = catch(|| panic!("a bug")) else { panic!("no failure") };
        assert!(told.starts_with("internal error at `ball.ray`: "), "{told}");
        assert!(told.contains(env!("CARGO_PKG_VERSION")), "{told}");
        assert_eq!(catch(|| 1).ok(), Some(1));
    }
}
