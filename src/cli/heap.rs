//! The program's allocator: the system's, except that a function is called when the system refuses memory.
//!
//! Rust ends a program with a signal if memory is refused, unless the code asked for memory in a way that can fail. No
//! stable interface changes that, so the allocator itself calls a function of the command line, which tells the user.
#![allow(
    unsafe_code,
    reason = "the trait of allocators is unsafe, and so is to end at once; this one hands everything on to the system's"
)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::OnceLock;
use tabray_core::memory::{is_allowed_to_fail, may_fail};

/// The allocator: a program makes it its own with `#[global_allocator]`.
pub struct Heap;

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

/// Tells whether the system would provide so many bytes in one piece.
pub fn has_room(bytes: usize) -> bool {
    may_fail(|| Vec::<u8>::new().try_reserve_exact(bytes).is_ok())
}

// SAFETY: each method hands its arguments on to the system's allocator as they are, and returns what that returns.
unsafe impl GlobalAlloc for Heap {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        checked(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        checked(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        checked(unsafe { System.realloc(memory, layout, size) }, size)
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        unsafe { System.dealloc(memory, layout) }
    }
}

#[inline(always)]
fn checked(memory: *mut u8, bytes: usize) -> *mut u8 {
    if memory.is_null() {
        refused(bytes);
    }
    memory
}

#[cold]
fn refused(bytes: usize) {
    if let Some(call) = REFUSED.get().filter(|_| !is_allowed_to_fail()) {
        call(bytes);
    }
}
