//! Memory allocations that are allowed to fail.
//!
//! Rust ends a program when an allocation fails, unless the code asked for memory in a way that can fail. An
//! allocator that reports failures to the user can ask here whether a failure is an ordinary error.

use std::cell::Cell;

thread_local! {
    static MAY_FAIL: Cell<bool> = const { Cell::new(false) };
}

/// Runs work in which a failed allocation is an ordinary error.
pub fn may_fail<T>(work: impl FnOnce() -> T) -> T {
    let before = MAY_FAIL.replace(true);
    let done = work();
    MAY_FAIL.set(before);
    done
}

/// Tells whether this thread runs work in which a failed allocation is an ordinary error.
pub fn is_allowed_to_fail() -> bool {
    MAY_FAIL.get()
}
