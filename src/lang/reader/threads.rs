//! The threads that large scenes are read by.

use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::OnceLock;
use tabray_core::parallel;

/// The threads that the entities of large scenes are checked and constructed by: one on each core. They are started when
/// they are first needed.
#[derive(Default)]
pub struct Threads(OnceLock<Option<ThreadPool>>);

impl Threads {
    fn pool(&self) -> Option<&ThreadPool> {
        self.0.get_or_init(|| ThreadPoolBuilder::new().build().ok()).as_ref()
    }

    /// Does pieces of work, and returns the results in the order of the pieces.
    pub fn map<T: Send>(&self, pieces: usize, work: impl Fn(usize) -> T + Send + Sync) -> Vec<T> {
        match if pieces > 1 { self.pool() } else { None } {
            Some(pool) => parallel::run_on(pool, || parallel::map(pieces, work)),
            None => (0..pieces).map(work).collect(),
        }
    }

    /// Does two pieces of work, at the same time if both are large.
    pub fn join<A: Send, B: Send>(
        &self,
        are_large: bool,
        one: impl FnOnce() -> A + Send,
        other: impl FnOnce() -> B + Send,
    ) -> (A, B) {
        match if are_large { self.pool() } else { None } {
            Some(pool) => pool.join(one, other),
            None => (one(), other()),
        }
    }
}
