//! `--time-limit`, for every command. A render, a chart and a choice keep to it by themselves, and keep what is done: a
//! render from its beginning, and the others from when there is something to keep.

use super::failure::{self, Failure};
use super::messages;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;
use tabray_core::text;

static LIMIT: OnceLock<Duration> = OnceLock::new();

/// Whether the command ends itself.
static IS_KEPT: AtomicBool = AtomicBool::new(false);

/// Limits the time of the command that follows.
pub fn set(limit: Duration) {
    LIMIT.get_or_init(|| limit);
}

/// Ends the program at the limit, if there is one, unless [`keep`] is called before.
pub fn watch() -> Result<(), Failure> {
    let Some(limit) = given() else { return Ok(()) };
    let end = move || {
        thread::sleep(limit);
        if !IS_KEPT.load(Ordering::Relaxed) {
            failure::end_even_if_blocked(&Failure::Stopped);
            report(limit);
            failure::end(&Failure::Stopped);
        }
    };
    let started = thread::Builder::new().name("time limit".to_owned()).spawn(end);
    started.map(drop).map_err(|error| {
        Failure::Failed(format!("cannot start a thread to watch the time: {}", text::reason(&error)))
    })
}

/// Returns the limit, if there is one.
pub fn given() -> Option<Duration> {
    LIMIT.get().copied()
}

/// Returns the limit, if there is one, to a command that ends itself then.
pub fn keep() -> Option<Duration> {
    IS_KEPT.store(true, Ordering::Relaxed);
    given()
}

fn report(limit: Duration) {
    messages::note(&format!("the time limit of {} has been reached", humantime::format_duration(limit)));
}

/// Reads a time, such as `90s` or `1.5h`.
///
/// # Errors
/// A message for people, if the text is no time above 0.
pub fn time(text: &str) -> Result<Duration, String> {
    let time = humantime::parse_duration(text).ok().filter(|time| !time.is_zero());
    time.ok_or_else(|| "give a time above 0 and its unit, as `90s`, `5m` or `1.5h`".to_owned())
}
