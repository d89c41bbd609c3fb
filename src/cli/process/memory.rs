//! The memory of the program: how much the system provides and, on Linux, how much is used.

use crate::heap;
use crate::process::crash;
use crate::process::failure::{self, Failure};
use bytesize::ByteSize;
use std::fs;
use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, OnceLock};
use std::thread;
use std::time::Duration;
use tabray_core::memory::may_fail;

/// The memory in reserve for the message that there is no more, in bytes. It is more than what the system's
/// allocator takes from the system piece by piece, so that giving it up helps every thread.
const KEPT: usize = 1 << 20;

static RESERVE: Mutex<Vec<u8>> = Mutex::new(Vec::new());

/// The least limit on allocations, in bytes: less would not even do for messages. A render keeps to a smaller limit by
/// itself.
const LEAST: u64 = 64 << 20;

/// The limit that was chosen, if it was, and the one that holds.
static LIMIT: OnceLock<(Option<ByteSize>, ByteSize)> = OnceLock::new();

static IS_ENDING: AtomicBool = AtomicBool::new(false);

/// Limits the memory that the program allocates from here on: to half of the machine's, unless another limit is chosen.
pub fn limit(chosen: Option<ByteSize>) {
    let half = || Some(ByteSize(in_kib("/proc/meminfo", "MemTotal:")? / 2));
    if let Some(limit) = chosen.or_else(half) {
        LIMIT.get_or_init(|| (chosen, limit));
        heap::limit(usize::try_from(limit.as_u64().max(LEAST)).unwrap_or(usize::MAX));
    }
}

/// Returns the limit that was chosen.
pub fn chosen() -> Option<ByteSize> {
    LIMIT.get().and_then(|(chosen, _)| *chosen)
}

/// The minimum memory of a render beside the image, in bytes.
pub const ASIDE: u64 = 2 << 20;

/// Returns how many bytes the chosen limit leaves, if there is a limit.
pub fn left() -> Option<u64> {
    let taken = now().unwrap_or(0) + ASIDE;
    chosen().map(|limit| limit.as_u64().saturating_sub(taken))
}

/// Names the chosen limit, in a message about something that takes too much.
pub fn beyond_chosen() -> String {
    chosen().map_or(String::new(), |limit| format!(" for `--max-memory {limit}`"))
}

/// Lets a render exceed the chosen limit for a moment: it stops soon, and keeps what is done.
pub fn stops_at_limit() {
    if chosen().is_some() {
        heap::limit(usize::MAX);
    }
}

/// Returns an error if the system would not provide about `bytes` bytes.
pub fn refuse_too_large(bytes: usize, what: &str) -> Result<(), Failure> {
    if heap::has_room(bytes) {
        return Ok(());
    }
    let beyond = if heap::is_near_full(bytes) { beyond_limit() } else { String::new() };
    let bytes = ByteSize(bytes as u64);
    Err(Failure::Failed(format!("not enough memory for {what}: it takes about {bytes}{beyond}")))
}

/// Ends the program with a message, from now on, if the system refuses it memory.
pub fn report_refused_allocations() {
    if let Ok(mut reserve) = RESERVE.lock() {
        may_fail(|| reserve.try_reserve_exact(KEPT).ok());
    }
    heap::when_refused(end);
}

/// Ends the program. This is called wherever memory is allocated, so it waits for no lock that such code may hold.
fn end(bytes: usize) {
    if IS_ENDING.swap(true, Ordering::Relaxed) {
        // Another thread is telling the user, or this one was and the reserve did not suffice.
        thread::sleep(Duration::from_secs(1));
        let _ = io::stderr().write_all(b"error: not enough memory\n");
        heap::exit_at_once(1);
    }
    let is_full = heap::is_near_full(bytes);
    if let Ok(mut reserve) = RESERVE.try_lock() {
        *reserve = Vec::new();
    }
    let scene = crash::scene().map_or(String::new(), |scene| format!(" for `{scene}`"));
    // The message takes memory, too.
    heap::limit(usize::MAX);
    let bytes = ByteSize(bytes as u64);
    let message = match is_full {
        true => format!("not enough memory{scene}: it takes {bytes} more{}", beyond_limit()),
        false => format!("not enough memory{scene}: the system refused {bytes} more"),
    };
    failure::end_keeping_bar(&Failure::Failed(message))
}

/// Says what the limit is.
fn beyond_limit() -> String {
    LIMIT.get().map_or(String::new(), |(_, limit)| format!(", and `--max-memory` is {limit}"))
}

/// Returns the memory that the program uses now, in bytes.
pub fn now() -> Option<u64> {
    status("VmRSS:")
}

/// Returns the most memory that the program has used at one time, in bytes.
///
/// The number from `getrusage` would include the program that started this one.
pub fn peak() -> Option<u64> {
    status("VmHWM:")
}

fn status(name: &str) -> Option<u64> {
    in_kib("/proc/self/status", name)
}

/// Returns a size that a file of the system's tells in KiB, in bytes.
fn in_kib(file: &str, name: &str) -> Option<u64> {
    let status = fs::read_to_string(file).ok()?;
    let size = status.lines().find_map(|line| line.strip_prefix(name))?;
    Some(size.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? << 10)
}
