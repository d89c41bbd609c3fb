//! The program's allocator: the system's, except that there may be a limit, and that a function is called when memory is
//! refused.
//!
//! Rust ends a program with a signal if memory is refused, unless the code asked for memory in a way that can fail. No
//! stable interface changes that, so the allocator itself calls a function of the command line, which tells the user.
#![allow(
    unsafe_code,
    reason = "the trait of allocators is unsafe, and so is to end at once; this one hands on to the system's what is within \
              the limit"
)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::ptr;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicIsize, AtomicUsize, Ordering};
use tabray_core::memory::{is_allowed_to_fail, may_fail};

/// The allocator: a program makes it its own with `#[global_allocator]`.
pub struct Heap;

/// The allocated bytes, except those that threads have not reported yet, and the greatest number that is allowed.
static USED: AtomicIsize = AtomicIsize::new(0);
static LIMIT: AtomicUsize = AtomicUsize::new(usize::MAX);

/// The bytes that a thread allocates or frees before it tells. Threads that told of each would wait for one another.
const UNTOLD: isize = 1 << 16;

thread_local! {
    /// What this thread has allocated and freed since it told last, in bytes.
    static OWN: Cell<isize> = const { Cell::new(0) };
}

/// Refuses memory beyond a number of bytes, as if the system did.
pub fn limit(bytes: usize) {
    LIMIT.store(bytes, Ordering::Relaxed);
}

/// Tells whether this many more bytes are beyond the limit.
fn is_full(more: usize) -> bool {
    let used = usize::try_from(USED.load(Ordering::Relaxed)).unwrap_or(0);
    used.saturating_add(more) > LIMIT.load(Ordering::Relaxed)
}

/// Tells whether the limit may be why this many more bytes are refused, given that a thread may not have reported all of its
/// bytes yet.
pub fn is_near_full(more: usize) -> bool {
    is_full(more.saturating_add(UNTOLD.unsigned_abs()))
}

/// Tells whether this thread may allocate this many more bytes.
#[inline(always)]
fn may_add(bytes: isize) -> bool {
    let with_own = OWN.try_with(|own| own.get().saturating_add(bytes)).unwrap_or(0);
    with_own < UNTOLD || !is_full(with_own.unsigned_abs())
}

/// Counts bytes that were allocated, or freed if they are below 0. A thread that ends leaves some of its bytes uncounted.
#[inline(always)]
fn add(bytes: isize) {
    let _ = OWN.try_with(|own| {
        let now = own.get().saturating_add(bytes);
        if now.abs() < UNTOLD {
            own.set(now);
        } else {
            own.set(0);
            USED.fetch_add(now, Ordering::Relaxed);
        }
    });
}

/// The function that is called with the length, in bytes, of a refused allocation.
static REFUSED: OnceLock<fn(usize)> = OnceLock::new();

/// Registers the function that is called, with the length of the allocation in bytes, if memory is refused. If it
/// returns, the program ends with a signal.
pub fn when_refused(call: fn(usize)) {
    REFUSED.get_or_init(|| call);
}

/// Ends the program at once, without anything that runs at its end. The standard library's `exit` ends with a signal where
/// the thread is in it already: there, memory can be refused, too.
#[cfg(target_os = "linux")]
pub fn exit_at_once(status: i32) -> ! {
    // SAFETY: nothing of the program runs any more.
    unsafe { nix::libc::_exit(status) }
}

/// Ends the program.
#[cfg(not(target_os = "linux"))]
pub fn exit_at_once(status: i32) -> ! {
    std::process::exit(status)
}

/// Tells whether the system would provide this many bytes in one piece.
pub fn has_room(bytes: usize) -> bool {
    may_fail(|| Vec::<u8>::new().try_reserve_exact(bytes).is_ok())
}

// SAFETY: each method hands its arguments on to the system's allocator as they are, and returns what that returns, or null,
// which is how memory is refused.
unsafe impl GlobalAlloc for Heap {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        within(layout.size(), 0, || unsafe { System.alloc(layout) })
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        within(layout.size(), 0, || unsafe { System.alloc_zeroed(layout) })
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        within(size, layout.size(), || unsafe { System.realloc(memory, layout, size) })
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        unsafe { System.dealloc(memory, layout) }
        add(-signed(layout.size()));
    }
}

fn signed(bytes: usize) -> isize {
    isize::try_from(bytes).unwrap_or(isize::MAX)
}

/// Allocates bytes within the limit, in place of some that are freed. A refusal is reported.
#[inline(always)]
fn within(bytes: usize, freed: usize, allocate: impl FnOnce() -> *mut u8) -> *mut u8 {
    let more = signed(bytes).saturating_sub(signed(freed));
    if may_add(more) {
        let memory = allocate();
        if !memory.is_null() {
            add(more);
            return memory;
        }
    }
    refused(bytes);
    ptr::null_mut()
}

#[cold]
fn refused(bytes: usize) {
    if let Some(call) = REFUSED.get().filter(|_| !is_allowed_to_fail()) {
        call(bytes);
    }
}
