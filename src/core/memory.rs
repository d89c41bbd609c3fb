//! Memory that may be refused.
//!
//! Rust ends a program if memory is refused, unless the code asked for memory in a way that can fail. A program whose
//! allocator tells the user of refused memory can find out here whether the refused allocation was one that may fail.

use std::cell::Cell;

thread_local! {
    static MAY_FAIL: Cell<bool> = const { Cell::new(false) };
}

/// Runs work in which a refused allocation is an ordinary error.
pub fn may_fail<T>(work: impl FnOnce() -> T) -> T {
    let before = MAY_FAIL.replace(true);
    let done = work();
    MAY_FAIL.set(before);
    done
}

/// Tells whether this thread is in work in which a refused allocation is an ordinary error.
pub fn is_allowed_to_fail() -> bool {
    MAY_FAIL.get()
}
