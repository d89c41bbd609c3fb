//! Loops on the threads of the caller.
//!
//! The loops run on the rayon pool that the caller is in (`pool.install(...)`), and otherwise on rayon's global pool,
//! with a thread for each core. Where no threads can be started, as in a browser, the calling thread does all of the
//! work.
//!
//! Rayon's functions are generic in the whole body of a loop, so each loop costs the compiler some thousand lines.
//! Here that code is compiled once, and only the bodies of loops are compiled separately.

use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::error::Error;
use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock};

/// The number of parts per thread into which a loop is divided. With many parts, no thread waits long for the last
/// one.
const PARTS: usize = 32;

/// The number of elements that a thread fills at a time.
const FILLED: usize = 1 << 12;

/// Returns the number of threads on which loops of the calling thread run.
pub fn threads() -> usize {
    static HAS_OWN: OnceLock<bool> = OnceLock::new();
    let has_own = || {
        // An error without a source means that the pool has been started already.
        ThreadPoolBuilder::new().build_global().map_or_else(|error| error.source().is_none(), |()| true)
    };
    if rayon::current_thread_index().is_some() || *HAS_OWN.get_or_init(has_own) {
        rayon::current_num_threads()
    } else {
        1
    }
}

/// Runs work on the threads of a pool, and returns its result.
pub fn run_on<T: Send>(pool: &ThreadPool, work: impl FnOnce() -> T + Send) -> T {
    let (mut work, mut result) = (Some(work), None);
    let mut once = || result = work.take().map(|work| work());
    install(pool, &mut once);
    result.expect("the work is done")
}

fn install(pool: &ThreadPool, work: &mut (dyn FnMut() + Send)) {
    pool.install(work);
}

/// Does two pieces of work, at the same time if both are large.
pub fn join<A: Send, B: Send>(
    are_large: bool,
    one: impl FnOnce() -> A + Send,
    other: impl FnOnce() -> B + Send,
) -> (A, B) {
    if are_large && threads() > 1 { rayon::join(one, other) } else { (one(), other()) }
}

/// Runs work for each index below `count`.
pub fn for_each(count: usize, work: &(dyn Fn(usize) + Sync)) {
    if threads() == 1 {
        (0..count).for_each(work);
    } else {
        (0..count).into_par_iter().with_max_len(1).for_each(work);
    }
}

/// Runs work for each index below `count`, in their order: each thread takes the next index when it is free. Each
/// thread makes the state that the work needs once.
pub fn for_each_in_order<S: Default>(count: usize, work: &(dyn Fn(&mut S, usize) + Sync)) {
    let next = AtomicUsize::new(0);
    for_each(threads(), &|_| {
        let mut own = S::default();
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            if index >= count {
                break;
            }
            work(&mut own, index);
        }
    });
}

/// Runs work for each index below `count`, and returns the results in their order.
pub fn map<T: Send>(count: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    map_ranges(count, 2, &|range| range.map(&work).collect())
}

/// Runs work for ranges that cover all indices below `count`, and returns the results in their order. If the indices
/// are fewer than `many`, this thread does all of the work.
pub fn map_ranges<T: Send>(
    count: usize,
    many: usize,
    work: &(dyn Fn(Range<usize>) -> Vec<T> + Sync),
) -> Vec<T> {
    if count < many {
        return work(0..count);
    }
    let length = count.div_ceil(PARTS * threads()).max(1);
    let mut parts = Vec::new();
    parts.resize_with(count.div_ceil(length), || Mutex::new(Vec::new()));
    for_each(parts.len(), &|index| {
        let part = work(index * length..count.min((index + 1) * length));
        *parts[index].lock().expect("no thread panicked") = part;
    });
    let mut all = Vec::with_capacity(count);
    for part in parts {
        all.append(&mut part.into_inner().expect("no thread panicked"));
    }
    all
}

/// Returns the first index below `count` for which a condition holds.
pub fn find_first(count: usize, is: impl Fn(usize) -> bool + Sync) -> Option<usize> {
    map_ranges(count, 2, &|mut range| range.find(|index| is(*index)).into_iter().collect()).first().copied()
}

/// Runs work for each index below `count`, and returns the results in their order, in one allocation. If the indices
/// are fewer than `many`, this thread does all of the work.
pub fn filled<T: Clone + Default + Send>(
    count: usize,
    many: usize,
    work: impl Fn(usize) -> T + Sync,
) -> Vec<T> {
    if count < many {
        return (0..count).map(work).collect();
    }
    let mut all = vec![T::default(); count];
    fill(&mut all, work);
    all
}

/// Fills a slice with the results of some work for each index.
pub fn fill<T: Send>(all: &mut [T], work: impl Fn(usize) -> T + Sync) {
    let _ = chunks(all, FILLED, |index, chunk| {
        for (offset, place) in chunk.iter_mut().enumerate() {
            *place = work(FILLED * index + offset);
        }
        ControlFlow::Continue(())
    });
}

/// Runs work for each chunk of a slice, with its index. Once the work breaks, chunks may be skipped.
pub fn chunks<T: Send>(
    all: &mut [T],
    size: usize,
    work: impl Fn(usize, &mut [T]) -> ControlFlow<()> + Sync,
) -> ControlFlow<()> {
    let chunks: Vec<_> = all.chunks_mut(size).map(Mutex::new).collect();
    let is_over = AtomicBool::new(false);
    for_each(chunks.len(), &|index| {
        if !is_over.load(Ordering::Relaxed) {
            let mut chunk = chunks[index].lock().expect("no thread panicked");
            if work(index, &mut chunk).is_break() {
                is_over.store(true, Ordering::Relaxed);
            }
        }
    });
    if is_over.into_inner() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}
